"""Windows of dance and music: the same seconds, mirrored whole, and the loss on them."""

import math

import numpy as np
import pytest
import torch
from synthetic_dance import material, windows

from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.kinematic_loss import KinematicWeights
from motiondiff_edu.mofusion import MoFusion, MoFusionConfig
from motiondiff_edu.motion.dance_frame import to_positions
from motiondiff_edu.motion.skeleton import BONES, JOINTS, MIRROR, TOES
from motiondiff_edu.performers.dance_windows import (
    PAIRS,
    DanceWindows,
    dance_loss,
    kinematic_parts,
    mel_frames,
    toes_moved,
)

NONE = KinematicWeights(skeleton=0.0, asymmetry=0.0, motion=0.0, slide=0.0, over_time="constant")


def everything(made: DanceWindows) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    return made.take(torch.arange(len(made)))


def test_two_dances_to_one_song_share_its_music():
    dances, contacts, mels = material()
    both = DanceWindows.of(
        [dances[0], dances[0][::-1].copy(), dances[1]],
        [contacts[0], contacts[0], contacts[1]],
        [mels[0], mels[0], mels[1]],
        40,
    )
    assert len(both.mel) == len(mels[0]) + len(mels[1]) and len(both) == 2 * (6 + 6 + 4)
    _, mel, _ = everything(both)
    alone = DanceWindows.of(dances, contacts, mels, 40)
    torch.testing.assert_close(mel[12:], everything(alone)[1])
    assert torch.equal(mel[:12], mel[12:24])


def test_music_and_motion_of_a_window_are_of_the_same_seconds():
    made = windows()
    # 120 frames: starts 0, 16, ... 80; 90 frames: 0, 16, 32, 48; each mirrored as well
    motion, mel, _ = everything(made)
    assert motion.shape == (2 * (6 + 4), 40, 63) and mel_frames(40) == 63 and len(made) == 20
    seconds = made.mel_scaler.inverse(mel)[..., 0]
    wanted = [0.8 * k for k in range(6)] + [100 + 0.8 * k for k in range(4)]
    torch.testing.assert_close(seconds[::2, 0], torch.tensor(wanted), atol=1e-3, rtol=0)
    torch.testing.assert_close(seconds[1::2, 0], seconds[::2, 0])
    torch.testing.assert_close(made.mel_times, torch.arange(63) / 31.25)
    torch.testing.assert_close(
        seconds - seconds[:, :1], made.mel_times.expand(20, -1), atol=1e-3, rtol=0
    )


def test_a_long_dance_hears_all_of_its_music():
    """258.4 s are 8075 hops of 32 ms, and the frame at the start.

    5168 / 20 * 31.25 falls short of it by rounding.
    """
    assert mel_frames(5168) == 8076 and mel_frames(1) == 2 and mel_frames(16) == 26


def test_every_second_window_is_a_mirrored_one():
    made = windows()
    standard, _, contacts = everything(made)
    motion = made.motion_scaler.inverse(standard).unflatten(-1, (21, 3))
    flip = torch.tensor([-1.0, 1.0, 1.0])
    torch.testing.assert_close(
        motion[1::2], motion[::2][..., MIRROR, :] * flip, atol=2e-5, rtol=1e-4
    )
    assert torch.equal(contacts[1::2], contacts[::2].flip(-1))


def test_windows_start_at_the_origin_and_are_standardised():
    made = windows()
    motion, _, _ = everything(made)
    metres = made.motion_scaler.inverse(motion)
    assert metres[:, 0, [0, 2]].abs().max() < 1e-5
    moved = motion.reshape(-1, 63)
    torch.testing.assert_close(moved.mean(0), torch.zeros(63), atol=1e-3, rtol=0)
    torch.testing.assert_close(moved.std(0), torch.ones(63), atol=2e-2, rtol=0)


def test_draws_come_from_the_generator_and_belong_together():
    made = windows()
    first = made.draw(7, torch.Generator().manual_seed(3))
    again = made.draw(7, torch.Generator().manual_seed(3))
    assert all(torch.equal(a, b) for a, b in zip(first, again, strict=True))
    motion, mel, stands = first
    assert motion.shape == (7, 40, 63) and mel.shape == (7, 63, 5) and stands.shape == (7, 40, 2)
    for k in range(7):
        row = next(i for i in range(len(made)) if torch.equal(everything(made)[0][i], motion[k]))
        assert torch.equal(everything(made)[1][row], mel[k]) and torch.equal(
            everything(made)[2][row], stands[k]
        )


def test_shaken_music_differs_in_level_and_balance_alone():
    made = windows()
    still = made.draw(400, seeded())
    shaken = made.draw(400, seeded(), shake=0.3)
    assert torch.equal(still[0], shaken[0]) and torch.equal(still[2], shaken[2])
    change = shaken[1] - still[1]
    torch.testing.assert_close(
        change, change[:, :1].expand_as(change), atol=1e-5, rtol=0
    )  # the same at all times
    level = change[:, 0].mean(-1)
    tilt = (change[:, 0, -1] - change[:, 0, 0]) / 2
    line = level[:, None] + tilt[:, None] * torch.linspace(-1, 1, 5)
    torch.testing.assert_close(change[:, 0], line, atol=1e-5, rtol=0)
    assert level.std().item() == pytest.approx(
        0.3, rel=0.15
    ) and tilt.std().item() == pytest.approx(0.3, rel=0.15)
    model, schedule = tiny(), cosine_schedule(20)
    losses = [
        dance_loss(made, schedule, batch=9, shake=s)(model, seeded()).item() for s in (0.0, 0.3)
    ]
    assert losses[0] != losses[1]


def test_wrong_inputs():
    dances, contacts, mels = material()
    with pytest.raises(ValueError, match="each needs its own"):
        DanceWindows.of(dances, contacts, mels[:1], 40)
    with pytest.raises(ValueError, match="dance 1 has .* frames, and contacts for"):
        DanceWindows.of(dances, [contacts[0], contacts[1][:-10]], mels, 40)
    with pytest.raises(ValueError, match="no dance has 400 frames"):
        DanceWindows.of(dances, contacts, mels, 400)


def test_pairs_of_bones_are_left_and_right():
    for left, right in PAIRS:
        (a, b), (c, d) = BONES[left], BONES[right]
        assert JOINTS[b].replace("Left", "Right") == JOINTS[d] and MIRROR[a] in (c, a)
    assert len(PAIRS) == 8


def seeded() -> torch.Generator:
    return torch.Generator().manual_seed(0)


def tiny(target: str = "x0", skip: bool = False) -> MoFusion:
    torch.manual_seed(0)
    return MoFusion(
        MoFusionConfig(
            C=5, S=20, widths=(16, 24), heads=2, music_layers=1, target=target, skip=skip
        )
    )


def test_the_loss_of_a_network_that_says_zero():
    """The network is new: its last layer apart it changes nothing.

    With zeros there it says 0, and x0 has power 1.
    """
    model, made = tiny(), windows()
    torch.nn.init.zeros_(model.out.weight)
    torch.nn.init.zeros_(model.out.bias)
    loss = dance_loss(made, cosine_schedule(20), batch=64)(model, torch.Generator().manual_seed(0))
    drawn = made.draw(64, seeded())[0]
    assert loss.item() == pytest.approx(drawn.square().mean().item(), rel=1e-4)


def test_kinematic_losses_add_to_it_by_their_weights():
    made = windows()
    schedule = cosine_schedule(20)
    model = tiny()
    plain = dance_loss(made, schedule, batch=9)(model, torch.Generator().manual_seed(0)).item()

    def extra(**change) -> float:
        weights = KinematicWeights(**{**NONE.__dict__, **change})
        return (
            dance_loss(made, schedule, weights, batch=9)(
                model, torch.Generator().manual_seed(0)
            ).item()
            - plain
        )

    assert extra() == pytest.approx(0, abs=1e-6)
    assert (
        extra(skeleton=10.0) == pytest.approx(2 * extra(skeleton=5.0), rel=1e-3)
        and extra(skeleton=10.0) > 0
    )
    assert extra(motion=1.0) == pytest.approx(
        plain, rel=1e-4
    )  # the target is x0: L_m is the data term once more
    assert extra(motion=1.0, over_time="none") == pytest.approx(0, abs=1e-6)
    assert 0 < extra(motion=1.0, over_time="alpha_bar") < plain
    whole = extra(asymmetry=1.0) + extra(slide=1.0)
    assert extra(asymmetry=1.0, slide=1.0) == pytest.approx(whole, rel=1e-3) and whole > 0


def test_parts_are_in_metres_after_the_scaler_is_undone():
    made = windows()
    truth, _, stands = made.take(torch.arange(3))
    parts = kinematic_parts(truth, truth, stands, made.motion_scaler)
    assert (
        parts["skeleton"].max() < 1e-9
        and parts["asymmetry"].max() < 1e-4
        and parts["motion"].max() == 0
    )
    assert parts["slide"].max() < 1e-3  # planted toes stand within a millimetre
    longer = made.motion_scaler.inverse(truth)
    shin = 3 + 3 * (JOINTS.index("LeftFoot") - 1)
    half = torch.arange(40) < 20
    longer[:, half, shin + 1] -= 0.04  # the left ankle 4 cm lower, in half of the frames
    parts = kinematic_parts(made.motion_scaler.transform(longer), truth, stands, made.motion_scaler)
    assert (
        0 < parts["skeleton"].max() < 2 * 0.02**2 * 40 / 39 / 20 * 1.1
    )  # two bones of twenty, +-2 cm at most
    assert parts["asymmetry"].max() > 1e-3


@pytest.mark.parametrize("target", ["eps", "v", "x0"])
def test_a_network_of_each_target_learns(target):
    made, schedule = windows(), cosine_schedule(20)
    model = tiny(target, target == "eps")
    draw = torch.Generator().manual_seed(0)
    loss_fn = dance_loss(made, schedule, batch=16, high_noise=3.0)
    optimizer = torch.optim.Adam(model.parameters(), lr=3e-3)
    losses = []
    for _ in range(60):
        loss = loss_fn(model, draw)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        losses.append(loss.item())
    assert math.isfinite(losses[-1]) and np.mean(losses[-10:]) < 0.8 * np.mean(losses[:5])


def test_the_toes_changes_in_the_world_weigh_extra():
    """A network that says 0 (standardised: the mean pose) errs by the motion.

    Its toes by all that toes move.
    """
    model, made = tiny(), windows()
    torch.nn.init.zeros_(model.out.weight)
    torch.nn.init.zeros_(model.out.bias)
    both = [
        dance_loss(made, cosine_schedule(20), batch=64, feet=f)(model, seeded()).item()
        for f in (0.0, 2.0)
    ]
    positions = to_positions(made.motion_scaler.inverse(made.draw(64, seeded())[0]))
    moved = positions[:, 1:, list(TOES)] - positions[:, :-1, list(TOES)]
    wanted = 2 * moved.square().mean().item() / toes_moved(made)
    assert both[1] - both[0] == pytest.approx(wanted, rel=1e-3) and wanted == pytest.approx(
        2, rel=0.2
    )


def test_pelvis_and_leg_that_err_alike_cost_no_feet():
    """A pelvis that drifts takes the toes along, unless the legs err the other way.

    Then the feet stand.
    """
    made, target = windows(), MoFusionConfig(target="x0")
    drift = torch.zeros(4, 40, 63)
    drift[..., 0] = (
        torch.linspace(0, 0.5, 40) / made.motion_scaler.std[0]
    )  # the pelvis, half a metre to the side

    class Errs(torch.nn.Module):
        def __init__(self, toes_too: bool):
            super().__init__()
            self.config = target
            self.toes_too = toes_too
            self.bias = torch.nn.Parameter(torch.zeros(()))

        def listen(self, mel, times):
            return None

        def forward(self, x_s, s, music):
            error = drift.clone()
            if (
                not self.toes_too
            ):  # every joint below stays in the world: minus the drift, about the pelvis
                error[..., 3::3] = (
                    -error[..., :1] * made.motion_scaler.std[0] / made.motion_scaler.std[3::3]
                )
            return made.draw(4, seeded())[0] + error + self.bias

    def cost(toes_too):
        both = [
            dance_loss(made, cosine_schedule(20), batch=4, feet=f)(Errs(toes_too), seeded())
            for f in (0.0, 1.0)
        ]
        return (both[1] - both[0]).item()

    assert cost(False) < 1e-5 < 0.01 < cost(True)


def test_changes_from_frame_to_frame_weigh_extra():
    """A network that says 0 errs by x0: its changes are those of the motion."""
    model, made = tiny(), windows()
    torch.nn.init.zeros_(model.out.weight)
    torch.nn.init.zeros_(model.out.bias)
    both = [
        dance_loss(made, cosine_schedule(20), batch=64, changes=c)(model, seeded()).item()
        for c in (0.0, 3.0)
    ]
    x0 = made.draw(64, seeded())[0]
    assert both[1] - both[0] == pytest.approx(
        3 * (x0[:, 1:] - x0[:, :-1]).square().mean().item(), rel=1e-4
    )
