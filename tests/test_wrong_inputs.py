"""What somebody may hand over by mistake, and what they are told.

No broadcast, no NaN, in this course's words.
"""

import math
import os
import subprocess
import sys
import warnings

import numpy as np
import pytest
import torch

from data_synth.mixtures import gaussian
from data_synth.walking import walk
from data_synth.walking.write import main as write_walks
from motiondiff_edu import bound, ddpm, exact, prediction
from motiondiff_edu.conditions.control import joystick
from motiondiff_edu.metrics.walks import adherence
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.motion.clip import slice_clips, split_by_source
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.rollout import generate

SCHEDULE = ddpm.linear_schedule(20, 1e-3, 0.5)
X = torch.zeros(2, 3)
CLIP = walk(np.zeros((11, 3)), seed=0)
RNG = np.random.default_rng(0)
SMALL = MoDiffConfig(T_h=4, T_p=3, S=6, width=16, heads=2, hidden=24)
PLAIN = Scaler(torch.zeros(63), torch.ones(63)), Scaler(torch.zeros(3), torch.ones(3))


def ddim(**options):
    return lambda: list(ddpm.ddim_steps(lambda x, s: x, X, SCHEDULE, **options))


MISTAKES = {
    "steps that rise": (ddim(steps=[5, 10, 20]), "steps must decrease and be within 20 to 1"),
    "no steps": (ddim(steps=[]), "steps must decrease"),
    "a step 0": (ddim(steps=[20, 0]), "steps must decrease"),
    "a step beyond S": (ddim(steps=[21, 3]), "steps must decrease"),
    "eta beyond DDPM": (ddim(steps=4, eta=2.0), "eta must be between 0"),
    "a step back from clean data": (
        lambda: ddpm.p_sample(X, 0, X, SCHEDULE, X),
        "s = 0: steps must be 1 to 20 here",
    ),
    "a posterior of clean data": (
        lambda: ddpm.q_posterior(X, X, 0, SCHEDULE),
        "steps must be 1 to 20",
    ),
    "noise of clean data": (
        lambda: prediction.eps_from_x0(X, 0, X, SCHEDULE),
        "s = 0: steps must be 1 to 20",
    ),
    "noise of clean data in a batch": (
        lambda: prediction.to_eps(X, X, torch.tensor([0, 1]), SCHEDULE, "x0"),
        "s = 0: steps must be 1 to 20",
    ),
    "a mean of data around clean data": (
        lambda: exact.dataset_mean(X, X, torch.tensor([4, 0]), SCHEDULE),
        "s = 0: steps must be 1 to 20",
    ),
    "the exact noise of clean data": (
        lambda: exact.exact_denoiser(gaussian(), SCHEDULE)(X[:, :1], torch.tensor([0, 7])),
        "s = 0: steps must be 1 to 20",
    ),
    "one step with two betas": (
        lambda: ddpm.linear_schedule(1),
        "one step has one beta, not 0.0001 and 0.1",
    ),
    "one step of DDPM": (lambda: ddpm.rescaled_ddpm_schedule(1), "1 steps are too few"),
    "twenty steps of DDPM": (lambda: ddpm.rescaled_ddpm_schedule(20), "20 steps are too few"),
    "the last step as a KL": (
        lambda: bound.step_kl(X, X, 1, X, SCHEDULE),
        "s = 1: steps must be 2 to 20",
    ),
    "pieces without a frame": (
        lambda: slice_clips([CLIP], seconds=0),
        "pieces of 0 s have no frame",
    ),
    "pieces of negative length": (
        lambda: slice_clips([CLIP], seconds=-1),
        "pieces of -1 s have no frame",
    ),
    "a negative share": (
        lambda: split_by_source([CLIP], [1.5, -0.5], RNG),
        "0 or more and sum to 1",
    ),
    "no data to scale": (lambda: Scaler.fit(torch.zeros(0, 3)), "there are no rows"),
    "one frame": (lambda: adherence(CLIP.poses[:1], CLIP.control[:1]), "needs two frames"),
    "no segments": (lambda: joystick([]), "turning\\), not \\[\\]"),
    "a short segment": (lambda: joystick([(1, 2)]), "four finite numbers"),
    "a segment of NaN": (lambda: joystick([(1, math.nan, 0, 0)]), "four finite numbers"),
    "an odd width": (lambda: MoDiffConfig(width=7, heads=7), "width = 7 must be even"),
    "a schedule of another length": (
        lambda: Walker(MoDiff(SMALL), SCHEDULE, *PLAIN),
        "has 20 steps, the network 6",
    ),
    "heads that do not fit": (lambda: MoDiffConfig(width=16, heads=3), "a multiple of 3 heads"),
}


@pytest.mark.parametrize("what", MISTAKES)
def test_it_is_refused_in_words(what):
    call, words = MISTAKES[what]
    with pytest.raises((ValueError, IndexError), match=words):
        call()


@pytest.mark.parametrize("s", [-1, 21])
def test_a_step_that_is_not_there(s):
    with pytest.raises(IndexError, match=f"s = {s}: steps must be 0 to 20 here; 0 is clean"):
        ddpm.q_sample(X, s, SCHEDULE, X)


@pytest.mark.parametrize("steps, named", [([3, -1], -1), ([21, 20], 21), ([-4, 30], -4)])
def test_steps_of_a_batch_are_checked_as_one_is(steps, named):
    """A tensor's -1 would read the last entry, and say nothing."""
    with pytest.raises(IndexError, match=f"s = {named}: steps must be 0 to 20 here"):
        ddpm.q_sample(X, torch.tensor(steps), SCHEDULE, X)


def test_a_batch_with_clean_data_has_no_step_back():
    s = torch.tensor([7, 0])
    for call in (ddpm.q_posterior, ddpm.p_mean):
        order = (X, s, X) if call is ddpm.p_mean else (X, X, s)
        with pytest.raises(IndexError, match="s = 0: steps must be 1 to 20 here"):
            call(*order, SCHEDULE)


@pytest.mark.parametrize("fps", [math.inf, 1, 2000])
def test_a_rate_that_no_reader_takes_for_one_is_not_written(tmp_path, fps):
    with pytest.raises(ValueError, match="fps must be 2 to 1000"):
        write_bvh(tmp_path / "x.bvh", CLIP.world(), fps)
    assert not list(tmp_path.iterdir())


SHAPES = {  # in a process of its own: here the tests' own check of shapes would speak first
    "write_bvh('x.bvh', np.zeros((5, 63)))": (
        "positions must be (T, 21, 3), world positions in metres; these are (5, 63)."
    ),
    "write_bvh('x.bvh', np.zeros((5, 20, 3)))": "these are (5, 20, 3)",
    "to_world(np.zeros((5, 21, 3)), np.zeros((1, 3)))": "5 poses but 1 rows of control",
}


@pytest.mark.parametrize("call", SHAPES)
def test_shapes_that_would_broadcast_are_told_apart(call, tmp_path, root):
    code = f"""
import numpy as np
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.motion.root_frame import to_world
{call}
"""
    environment = os.environ | {"PYTHONPATH": str(root)}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 1 and SHAPES[call] in done.stderr and not list(tmp_path.iterdir())


@pytest.mark.parametrize("arguments", [["--clips", "-1"], ["--seconds", "0.01"]])
def test_no_walks_are_no_success(tmp_path, arguments, capsys):
    with pytest.raises(SystemExit) as stopped:
        write_walks(["--out", str(tmp_path), *arguments])
    assert stopped.value.code == 2 and "at least one clip" in capsys.readouterr().err


def test_a_control_beyond_the_training_data_is_named():
    seen = {"control_range": {"low": [-0.5, -0.6, -2.0], "high": [3.0, 0.6, 2.0]}}
    walker = Walker(MoDiff(SMALL).eval(), ddpm.linear_schedule(6, 0.2, 0.95), *PLAIN, seen)
    past, control = torch.zeros(4, 63), torch.zeros(7, 3)
    control[5, 2] = -4.5  # half of the range, from -2 to 2, is 2
    with pytest.raises(
        ValueError,
        match=r"half its width: a turning rate of -4.5 in frame 2 .* \(training: -2 to 2\)",
    ):
        generate(walker, past, control)
    control[5, 2] = -3.9
    with pytest.warns(UserWarning, match="a turning rate of -3.9 in frame 2"):
        generate(walker, past, control)
    control[5, 2] = -2.5  # a tenth of the range, from -2 to 2, is 0.4
    with pytest.warns(UserWarning, match="a turning rate of -2.5 in frame 2"):
        generate(walker, past, control)
    control[5, 2] = -2.3
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        generate(walker, past, control)
