"""Broken BVH files: one error type, with file, line, joint and what to do."""

import signal
from pathlib import Path

import numpy as np
import pytest
from bvh_text import SMALL

from motiondiff_edu.motion.formats.bvh import BvhError, read_bvh

# name of the real file: (line, joint, words of the message)
REAL = {
    "bad_binary": (None, None, "binary"),
    "bad_channel_count_lie": (9, "RightUpLeg", "'4' but 3"),
    "bad_comma_decimal": (120, "Hips", "decimal comma"),
    "bad_duplicate_joint_names": (29, "RightLeg", "line 10"),
    "bad_empty_file": (None, None, "empty"),
    "bad_frame_time_fps_confusion": (119, None, "fps="),
    "bad_frames_too_many_declared": (118, None, "Frames: 40"),
    "bad_html_404_page": (1, None, "web page"),
    "bad_inf_overflow": (125, "Hips", "1e400"),
    "bad_last_frame_truncated": (159, None, "17 of 60"),
    "bad_missing_space_slimevr": (120, "Hips", "two numbers"),
    "bad_nan_values": (125, "Hips", "nan"),
    "bad_negative_frame_time": (119, None, "positive"),
    "bad_no_motion_section": (116, None, "MOTION"),
    "bad_rokoko_one_extra_line": (118, None, "Frames: 40"),
    "bad_text_in_data": (123, "Hips", "not a number"),
    "bad_unbalanced_braces": (None, "Hips", "never closed"),
    "bad_unknown_channel": (5, "Hips", "Wrotation"),
    "bad_utf16": (1, None, "UTF-16"),
    "bad_zero_frame_time": (119, None, "positive"),
    "bad_zero_frames": (118, None, "0 frames"),
    "odd_two_roots": (117, "Hips2", "two figures"),
}


@pytest.fixture(autouse=True)
def no_hang():
    """Some readers never come back from these files.

    Here that is an error and not a wait (of CPU time).
    """
    if not hasattr(signal, "SIGPROF"):
        yield
        return
    signal.signal(signal.SIGPROF, lambda *_: pytest.fail("the reader hangs"))
    signal.setitimer(signal.ITIMER_PROF, 30)
    yield
    signal.setitimer(signal.ITIMER_PROF, 0)


def test_every_broken_file_is_known(real_data):
    folder = real_data / "bvh_odd_and_broken"
    assert {path.stem for path in folder.glob("bad_*.bvh")} == {
        name for name in REAL if name.startswith("bad_")
    }


@pytest.mark.parametrize("name", REAL)
def test_broken_file_is_refused_at_once(real_data, name):
    line, joint, words = REAL[name]
    with pytest.raises(BvhError) as caught:
        read_bvh(real_data / "bvh_odd_and_broken" / f"{name}.bvh")
    error = caught.value
    assert words in str(error) and f"{name}.bvh" in str(error)
    assert (line is None or error.line == line) and (joint is None or error.joint.startswith(joint))


def refused(tmp_path: Path, text: str | bytes) -> BvhError:
    path = tmp_path / "broken.bvh"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(BvhError) as caught:
        read_bvh(path)
    return caught.value


@pytest.mark.parametrize(
    ("change", "line", "joint", "words"),
    [
        (lambda s: s.replace("OFFSET 3 -40 0", "OFFSET 3 -40"), 8, "Left Leg", "3 numbers"),
        (lambda s: s.replace("OFFSET 3 -40 0", "OFFSET 3 x 0"), 8, "Left Leg", "not a number"),
        (lambda s: s.replace("    OFFSET 3 -40 0\n", ""), 6, "Left Leg", "no OFFSET"),
        (
            lambda s: s.replace("    CHANNELS 2 Yrotation Xrotation\n", ""),
            15,
            "Chest",
            "CHANNELS 0",
        ),
        (lambda s: s.replace("2 Yrotation X", "2 Xrotation X"), 18, "Chest", "twice"),
        (lambda s: s.replace("JOINT Chest", "JOINT"), 15, "Hips", "without a name"),
        (lambda s: s.replace("JOINT Chest", "BONE Chest"), 15, "Hips", "not understood"),
        (lambda s: s.replace("ROOT Hips\n{", "ROOT Hips\n"), 4, None, "outside the braces"),
        (lambda s: s.replace("MOTION", "}\nMOTION"), 21, None, "no matching '{'"),
        (lambda s: s.replace("Frames: 3", "Frames: many"), 22, None, "number of frames"),
        (
            lambda s: s.replace("Frames: 3", "Frames: 1000000000"),
            22,
            None,
            "1,000,000,000 frames, and 432,000 at most are read",
        ),
        (
            lambda s: s.replace("JOINT Chest", "JOINT " + "C" * 100_000),
            15,
            None,
            "a name of 100,000 letters",
        ),
        (lambda s: s.replace("Frames: 3\n", ""), 22, None, "'Frames:'"),
        (lambda s: s.replace("Frame Time: 0.04", "Frame Time: 1"), 23, None, "fps="),
        (lambda s: s.replace("Frame Time: 0.04", "Frame Time: soon"), 23, None, "not a number"),
        (lambda s: s.replace("0 0.5\n", "0.5\n"), 26, None, "10 of 11"),
        (lambda s: s.replace("10 20 30 -5", "10 20 30"), 26, None, "begins on line 25"),
        (lambda s: s.replace("10 20 30 -5", "10 20 1_0 -5"), 25, "Hips", "not a number"),
        (lambda s: s.replace("1e1", "infinity"), 25, "Left Leg", "not finite"),
        (lambda s: s.replace("HIERARCHY", "HIERARCHIE"), 1, None, "starts with HIERARCHY"),
        (lambda s: s[: s.index("Frames")], 22, None, "expected 'Frames:'"),
        (lambda s: s.replace("Frames: 3", "Frames: \u00b2"), 22, None, "number of frames"),
        (lambda s: s.replace("Frames: 3", "Frames: " + "3" * 5000), 22, None, "number of frames"),
        (lambda s: s.replace("LS 2 Y", "LS \u00b2 Y"), 18, "Chest", "CHANNELS says"),
        (lambda s: s.replace("OFFSET 0 30 -1", "OFFSET 0 1e308 -1"), 17, "Chest", "1e308"),
        (lambda s: s.replace("OFFSET 0 30 -1", "OFFSET 0 -1e7 -1"), 17, "Chest", "no angle"),
        (lambda s: s.replace("1e1", "1e200"), 25, "Left Leg", "no angle"),
        (lambda s: s.replace("1e1", "-1000001"), 25, "Left Leg", "no angle"),
        (lambda s: s.replace("1e1", "1" * 5000), 25, "Left Leg", "not finite"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, change, line, joint, words):
    text = change(SMALL)
    assert text != SMALL
    error = refused(tmp_path, text)
    assert (error.line, words in str(error)) == (line, True), str(error)
    assert joint is None or error.joint.startswith(joint)
    assert len(str(error)) < 500


def test_a_kilometre_away_is_read(tmp_path):
    path = tmp_path / "far.bvh"
    path.write_text(SMALL.replace("1e1", "-1000000"))
    assert read_bvh(path).frames.min() == -1e6


def test_enormous_files_are_refused_before_they_fill_the_memory(tmp_path):
    lines = refused(tmp_path, SMALL.encode() + b"\n" * 40_000_000)
    assert "40,000,0" in str(lines) and "lines" in str(lines)
    assert "lines" in str(refused(tmp_path, SMALL.encode() + b"\r" * 40_000_000))
    line = refused(tmp_path, SMALL.replace("Frames: 3", "Frames: 4").encode() + b"0 " * 20_000_000)
    assert line.line == 27 and "its own line" in str(line)


def test_nothing_can_move(tmp_path):
    still = (
        "HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\nCHANNELS 0\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n"
    )
    assert "channels" in str(refused(tmp_path, still))


def test_foreign_content_never_hangs(tmp_path):
    for content in (
        b"\0" * 3_000_000,
        b"<html>" * 300_000,
        b"HIERARCHY\n" + b"{" * 500_000,
        b" \n" * 900_000,
        b"1 2 " * 9,
    ):
        refused(tmp_path, content)
    assert "braces" not in str(refused(tmp_path, b"HIERARCHY\n" + b"JOINT a {" * 9000))


def test_random_damage_is_read_or_refused(tmp_path):
    rng = np.random.default_rng(7)
    scraps = [
        "{",
        "}",
        "JOINT a",
        "ROOT b",
        "End Site",
        "OFFSET",
        "CHANNELS 3",
        "MOTION",
        "nan",
        "\n",
        "-",
        "",
        "é",
        "0 1",
    ]
    outcomes = set()
    for _ in range(400):
        text = SMALL
        for _ in range(rng.integers(1, 4)):
            at = int(rng.integers(len(text)))
            text = (
                text[:at]
                + scraps[rng.integers(len(scraps))]
                + text[at + int(rng.integers(0, 20)) :]
            )
        path = tmp_path / "damaged.bvh"
        path.write_text(text)
        try:
            outcomes.add(bool(np.isfinite(read_bvh(path).world_positions()).all()))
        except BvhError as error:
            outcomes.add(error.path.endswith("damaged.bvh") and len(str(error)) > 30)
    assert outcomes == {True}


def test_a_missing_file_is_a_missing_file(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_bvh(tmp_path / "nowhere.bvh")


def test_a_folder_is_no_file_and_a_tilde_is_home(tmp_path, monkeypatch):
    with pytest.raises(BvhError, match="this is a folder; give one of the .bvh files in it"):
        read_bvh(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    with pytest.raises(BvhError, match="x.bvh: the file is empty"):
        (tmp_path / "x.bvh").touch()
        read_bvh("~/x.bvh")


def test_a_joint_at_the_end_of_another_needs_its_braces(tmp_path):
    joint = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT a\n}\n"
    lost = "{\nOFFSET 0 1 0\nCHANNELS 0\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n\n"
    error = refused(tmp_path, joint + lost)
    assert error.line == 7 and error.joint.startswith("a") and "'{' is missing" in str(error)
