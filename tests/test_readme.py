"""The README's example does what it says."""

import re

import pytest

from data_synth.walking import walk
from motiondiff_edu.checkpoints import available
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.motion.bvh_write import write_bvh
from motiondiff_edu.motion.retarget import load_clip


@pytest.mark.skipif("walker" not in available(), reason="no walker is shipped: run make pretrained")
def test_a_recording_goes_on_as_the_readme_has_it(root, tmp_path, monkeypatch):
    (code,) = re.findall(r"^```python\n(.*?)^```", (root / "README.md").read_text(encoding="utf-8"), re.M | re.S)
    code = code.replace("seed=0)", "seed=0, steps=5)")  # quicker, and nothing else
    write_bvh(tmp_path / "my_walk.bvh", walk(constant_control(1.0, seconds=3), seed=5).world())
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "README.md", "exec"), {})
    made = load_clip(tmp_path / "continued.bvh")
    assert len(made) == 7 * 20 and made.control[20:50, 0].mean() == pytest.approx(1.2, abs=0.1)
    assert made.control[80:120, 2].mean() == pytest.approx(0.6, abs=0.1)
