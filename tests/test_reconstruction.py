"""Walking there and back fills holes and leaves what is known untouched.

The walker knows the way, and then it stops.
"""

from types import SimpleNamespace

import numpy as np
import pytest
import torch

from data_synth.walking import random_control, walk
from motiondiff_edu.motion.augment import reverse_time
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.reconstruction import (
    Rollout,
    Stop,
    reconstruct,
    reconstruct_steps,
    reverse_control,
)
from motiondiff_edu.rollout import generate

T_H, D = 6, 8


class Turning:
    """A walker that turns pairs of numbers by the control's first column: right, and reversible.

    Then some noise.
    """

    def __init__(self, noise: float = 0.0):
        self.config = SimpleNamespace(T_h=T_H, T_p=2, D=D, C=3)
        self.pose_scaler = Scaler(torch.full((D,), 0.3), torch.full((D,), 2.0))
        self.control_scaler, self.noise = Scaler.nothing(3), noise

    def window_sampler(self, steps=None):
        def sample(past, control, generator):
            pairs = torch.view_as_complex(
                (past[:, -1] * 2 + 0.3).reshape(len(past), D // 2, 2).contiguous()
            )
            new = []
            for k in range(2):
                angle = control[:, T_H - 1 + k, 0]
                pairs = pairs * torch.exp(1j * angle)[:, None]
                made = torch.view_as_real(pairs).flatten(1)
                new.append(
                    (made + self.noise * torch.randn(made.shape, generator=generator) - 0.3) / 2
                )
            return torch.stack(new, 1)

        return sample


def material(B: int = 3):
    draw = torch.Generator().manual_seed(0)
    control = torch.rand(B, 2 * T_H, 3, generator=draw)
    pose = torch.randn(B, D // 2, dtype=torch.complex64, generator=draw)
    rows = []
    for t in range(2 * T_H):
        rows.append(torch.view_as_real(pose).flatten(1))
        pose = pose * torch.exp(1j * control[:, t, 0])[:, None]
    return torch.stack(rows, 1)[:, :T_H], control


def seeded():
    return torch.Generator().manual_seed(1)


def there_and_back(noise: float = 0.0, keep: int | None = None):
    return Rollout(Turning(noise), seeded(), keep=keep)


def test_reversed_control_is_that_of_the_reversed_clip():
    clip = walk(random_control(3.0, np.random.default_rng(0), "turn"), 0)
    ours = reverse_control(torch.from_numpy(clip.control))
    np.testing.assert_allclose(ours, reverse_time(clip).control)


def test_missing_frames_are_found_by_a_walker_that_knows_the_way():
    past, control = material()
    known = torch.ones(past.shape, dtype=torch.bool)
    known[:, 1:4] = False
    holes = past.masked_fill(~known, float("nan"))
    done = list(reconstruct_steps(there_and_back(), holes, known, control))
    torch.testing.assert_close(done[-1].past, past, atol=1e-4, rtol=1e-4)
    assert torch.equal(done[-1].past[known], past[known])
    assert (
        len(done) == 2 and (done[-1].change < 1e-3).all()
    )  # found at once; the second round moves nothing


def test_a_first_guess_is_where_the_way_begins():
    past, control = material()
    known = torch.ones(past.shape, dtype=torch.bool)
    known[:, -1] = (
        False  # the frame from which the walk goes on: nothing can make up for a wrong one
    )
    once, guess = Stop(rounds=1), past + 0.0
    from_mean = reconstruct(there_and_back(), past, known, control, stop=once)
    from_truth = reconstruct(there_and_back(), past, known, control, guess=guess, stop=once)
    assert (from_truth - past).abs().max() < 1e-3 < 0.1 < (from_mean - past).abs().max()


def test_a_reversal_without_the_sign_fails():
    past, control = material()
    known = torch.ones(past.shape, dtype=torch.bool)
    known[:, 1:4] = False
    straight = reconstruct(there_and_back(), past, known, control)
    assert (straight - past).abs().max() < 1e-3
    from motiondiff_edu import reconstruction

    before = reconstruction.reverse_control
    try:
        reconstruction.reverse_control = lambda c: c.flip(-2)  # what the paper says
        wrong = reconstruct(there_and_back(), past, known, control)
    finally:
        reconstruction.reverse_control = before
    assert (wrong - past).abs().max() > 0.3


def test_it_stops_when_told_though_a_sampler_spreads():
    past, control = material()
    known = torch.ones(past.shape, dtype=torch.bool)
    known[:, :, 3:] = False
    done = list(reconstruct_steps(there_and_back(0.1), past, known, control, stop=Stop(4)))
    assert [d.number for d in done] == [1, 2, 3, 4] and torch.isfinite(done[-1].past).all()
    again = list(reconstruct_steps(there_and_back(0.1), past, known, control, stop=Stop(4)))
    assert torch.equal(done[-1].past, again[-1].past)


def test_one_sample_at_rest_does_not_end_the_others():
    past, control = material(2)
    known = torch.ones(past.shape, dtype=torch.bool)
    known[1, 2:4] = False  # of sample 0 nothing is missing
    found = list(reconstruct_steps(there_and_back(0.5), past, known, control, stop=Stop(3)))
    assert len(found) == 3 and found[0].change[0] == 0 < found[0].change[1]


def test_what_corrects_a_past_is_in_it_and_in_its_change():
    past, control = material()
    known = torch.ones(past.shape, dtype=torch.bool)
    known[:, 1:3] = False

    def raised(filled, mask, ahead):
        assert torch.equal(mask, known) and ahead.shape == past.shape
        return filled + 1.0 * ~mask

    once = {"guess": past, "stop": Stop(rounds=1)}  # a walker that knows the way changes nothing
    (plain,), (corrected,) = (
        list(reconstruct_steps(there_and_back(), past, known, control, correct=s, **once))
        for s in (None, raised)
    )
    torch.testing.assert_close(corrected.past, plain.past + 1.0 * ~known)
    torch.testing.assert_close(corrected.change, torch.ones(3), atol=1e-4, rtol=0)
    assert plain.change.max() < 1e-4


def test_the_way_back_is_told_everything_turned_round_and_how_many_poses_to_keep():
    past, control = material()
    known = torch.ones(past.shape, dtype=torch.bool)
    known[:, 4:] = False  # unlike itself turned round
    told = {}

    def way(rollout, ahead, rows, given, seen):
        told.update(rollout=rollout, ahead=ahead, rows=rows, given=given, seen=seen)
        return given

    once = {"guess": past, "way_back": way, "stop": Stop(rounds=1)}
    for keep, kept in ((1, 1), (None, 2)):  # all of a window, if nothing else is said
        rollout = there_and_back(keep=keep)
        reconstruct(rollout, past, known, control, **once)
        assert torch.equal(told["given"], past.flip(1)) and torch.equal(told["seen"], known.flip(1))
        assert torch.equal(told["rows"], reverse_control(control)) and told["rollout"] is rollout
        like = {"hold": False, "generator": seeded(), "steps": 10, "keep": kept}
        walked = generate(Turning(), past, control, **like)
        torch.testing.assert_close(told["ahead"], walked.flip(1))


def test_nothing_missing_is_returned_as_it_is():
    past, control = material()
    known = torch.ones(past.shape, dtype=torch.bool)
    done = list(reconstruct_steps(there_and_back(), past, known, control))
    assert len(done) == 1 and torch.equal(done[0].past, past) and (done[0].change == 0).all()


def columns(x, D):
    return x[..., :1].repeat(1, 1, D)


MISTAKES = {
    "a row too few": (
        {"control": lambda x: x[:, :-1]},
        r"control is \(3, 11, 3\); give \(3, 12, 3\)",
    ),
    "control of another batch": (
        {"control": lambda x: x[:2]},
        r"control is \(2, 12, 3\); give \(3, 12, 3\)",
    ),
    "a mask of joints": (
        {"known": lambda x: columns(x, 3)},
        r"known is torch.bool \(3, 6, 3\); give bool, \(3, 6, 8\)",
    ),
    "a mask of float": ({"known": lambda x: x.float()}, r"known is torch.float32 .*; give bool"),
    "columns missing": (
        {"past": lambda x: columns(x, 7), "known": lambda x: columns(x, 7)},
        r"takes \(B, 6, 8\)",
    ),
    "a past too long": ({"past": lambda x: torch.cat([x, x], 1)}, r"past is \(3, 12, 8\)"),
    "nothing known": (
        {"known": lambda x: x & (torch.arange(3) != 1)[:, None, None]},
        "sample 1 has no known entry",
    ),
    "a hole that is marked as known": (
        {"past": lambda x: x.masked_fill(torch.arange(8) == 2, float("nan"))},
        r"past\[0, 0, 2\] is marked as known, but is NaN",
    ),
    "no rounds": ({"stop": lambda x: Stop(rounds=0)}, "rounds = 0: give 1 at least"),
}


@pytest.mark.parametrize("what", MISTAKES)
def test_wrong_inputs(what):
    past, control = material()
    given = {
        "past": past,
        "known": torch.ones(past.shape, dtype=torch.bool),
        "control": control,
        "stop": Stop(),
    }
    changes, words = MISTAKES[what]
    given |= {name: change(given[name]) for name, change in changes.items()}
    with pytest.raises(ValueError, match=words) as caught:
        reconstruct(there_and_back(), **given)
    assert ("control" in changes) == (
        "control" in str(caught.value)
    )  # what is right is not spoken of


def test_arrays_of_numpy_are_taken():
    past, control = material()
    known = torch.ones(past.shape, dtype=torch.bool)
    known[:, 1:4] = False
    ours = reconstruct(there_and_back(), past.numpy(), known.numpy(), control.numpy())
    assert torch.equal(ours, reconstruct(there_and_back(), past, known, control))


def test_a_single_row_of_control_cannot_be_reversed():
    with pytest.raises(ValueError, match=r"\(3, 1, 3\) has one row in time; a way back takes 2"):
        reverse_control(material()[1][:, :1])
