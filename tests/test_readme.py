"""The README's examples do what they say."""

import re

import pytest
import soundfile

from data_synth.music import compose
from data_synth.walking import walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.motion.bvh import read_bvh
from motiondiff_edu.motion.bvh.write import write_bvh
from motiondiff_edu.motion.retarget import load_clip
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.pretrained.checkpoints import available


def examples(root) -> list[str]:
    return re.findall(
        r"^```python\n(.*?)^```", (root / "README.md").read_text(encoding="utf-8"), re.M | re.S
    )


@pytest.mark.skipif("walker" not in available(), reason="no walker is shipped: run make pretrained")
def test_a_recording_goes_on_as_the_readme_has_it(root, tmp_path, monkeypatch):
    code, _, _ = examples(root)
    code = code.replace("seed=0)", "seed=0, steps=5)")  # quicker, and nothing else
    write_bvh(tmp_path / "my_walk.bvh", walk(constant_control(1.0, seconds=3), seed=5).world())
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "README.md", "exec"), {})
    made = load_clip(tmp_path / "continued.bvh")
    assert len(made) == 7 * 20 and made.control[20:50, 0].mean() == pytest.approx(1.2, abs=0.1)
    assert made.control[80:120, 2].mean() == pytest.approx(0.6, abs=0.1)


@pytest.mark.skipif("dancer" not in available(), reason="no dancer is shipped: run make pretrained")
def test_a_song_is_danced_to_as_the_readme_has_it(root, tmp_path, monkeypatch):
    _, code, _ = examples(root)
    song = compose(3, "pop", seconds=6.0)
    soundfile.write(tmp_path / "my_song.ogg", song.audio, 16_000)
    monkeypatch.chdir(tmp_path)
    given = {"checkpoints": checkpoints, "write_bvh": write_bvh}  # imported in the example before
    exec(compile(code.replace("seconds=20)", "seconds=4, steps=3)"), "README.md", "exec"), given)
    assert given["dance"].shape == (80, 21, 3) and len(given["sound"]) == 4 * 16_000
    assert len(read_bvh(tmp_path / "dance.bvh").frames) == 80


@pytest.mark.skipif(
    "unconditional" not in available(), reason="no such network is shipped: run make pretrained"
)
def test_in_betweens_are_made_as_the_readme_has_it(root):
    _, _, code = examples(root)
    given = {
        "checkpoints": checkpoints,
        "clip": walk(constant_control(1.0, seconds=3), seed=5),
    }  # of the first example
    exec(compile(code.replace("samples=3)", "samples=3, steps=3)"), "README.md", "exec"), given)
    assert (
        given["made"].shape == (3, 60, 21, 3)
        and (given["made"][:, 20] == given["motion"][20]).all()
    )
