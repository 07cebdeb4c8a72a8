"""Every file of the table of reports is tried, and each sound is decoded once."""

import re

import numpy as np
import pytest

from tools.results import files


def test_every_report_is_tried_and_ends_as_it_should(real_data):
    folder = real_data / "reports"
    table = re.findall(r"(?m)^\| ([\d, ]+) \|", (folder / "README.md").read_text())
    asked = {int(number) for row in table for number in row.split(",")}
    right = files.reported(folder, files.heard(folder))
    tried = {int(name[:2]) for name in right}
    assert {30, 37} <= asked == tried
    assert [name for name, one in right.items() if not one] == []


def test_a_sound_is_decoded_once(tmp_path, monkeypatch):
    decoded = []

    def read_audio(path):
        decoded.append(path.name)
        return np.zeros(16_000 * 6)

    monkeypatch.setattr(files, "read_audio", read_audio)
    monkeypatch.setattr(files, "EXPECTED", {})
    monkeypatch.setattr(files, "players_on_the_page", lambda folder: 2)
    monkeypatch.setattr(files, "shown_or_told", lambda *_: True)
    sounds = files.heard(tmp_path)
    right = files.reported(tmp_path, sounds)
    assert decoded == list(files.SECONDS_OF)
    assert sounds["27_gsm.wav"] == (0, "") and sounds["23_two_mp3_joined.mp3"] == (74, "")
    assert right["27_gsm.wav"] and not right["23_two_mp3_joined.mp3"]


@pytest.mark.parametrize(
    "z, lifted, notes, right",
    [(-1.5, 1, (), True), (1.5, 1, (), False), (-1.5, 0, (), False), (0, 0, ("waves",), True)],
)
def test_a_figure_walks_back_and_waves_or_it_is_said(monkeypatch, z, lifted, notes, right):
    positions = np.zeros((7, 21, 3))
    positions[:, :, 2] = np.linspace(0, z, 7)[:, None]
    positions[:, files.joint_index("LeftHand"), 1] = lifted - 0.5

    class Mover:
        def act(self, text, seed):
            for words in notes:
                files.warnings.warn(f"asked: {text}; but {words} is not seen", stacklevel=1)
            return files.Motion(positions)

    monkeypatch.setattr(files.md, "load", lambda name: Mover())
    assert files.shown_or_told("walks back and waves", ("Left",), 0) is right
