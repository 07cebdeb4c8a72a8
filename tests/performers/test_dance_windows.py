"""Windows of dance and music: the same seconds, mirrored whole; and what losses need of them."""

import numpy as np
import pytest
import torch
from synthetic_dance import material, windows

from motiondiff_edu.kinematic_loss import kinematic_parts
from motiondiff_edu.motion.dance_frame import body_of, to_positions
from motiondiff_edu.motion.motion import Motion, MotionError, MotionWarning
from motiondiff_edu.motion.planting import find_contacts
from motiondiff_edu.motion.skeleton import JOINTS, MIRROR, TOES
from motiondiff_edu.performers.dance_windows import DanceWindows, mel_frames, toes_moved


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


def test_motions_are_taken_with_their_own_contacts_or_those_that_are_found():
    dances, contacts, mels = material()
    ours = [Motion(x, contacts=c) for x, c in zip(dances, contacts, strict=True)]
    for made, wanted in zip(
        everything(DanceWindows.of_motions(ours, mels, 40)),
        everything(DanceWindows.of(dances, contacts, mels, 40)),
        strict=True,
    ):
        assert torch.equal(made, wanted)
    bare = DanceWindows.of_motions([Motion(x) for x in dances], mels, 40)
    found = [find_contacts(x[:, list(TOES)], 20.0) for x in dances]
    assert torch.equal(bare.contacts, torch.from_numpy(np.concatenate(found)))
    silent = DanceWindows.of_motions(ours, n=40)
    assert silent.mel.shape[1] == 0 and torch.equal(silent.dances, bare.dances)
    with pytest.raises(MotionError, match=r"30 frames/s: pass motion.resampled\(20\)"):
        DanceWindows.of_motions([Motion(dances[0], fps=30)], mels[:1], 40)


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


def test_wrong_inputs():
    dances, contacts, mels = material()
    with pytest.raises(ValueError, match="each dance needs its"):
        DanceWindows.of(dances, contacts, mels[:1], 40)
    with pytest.raises(ValueError, match="dance 1 has .* frames but contacts for"):
        DanceWindows.of(dances, [contacts[0], contacts[1][:-10]], mels, 40)
    with pytest.raises(ValueError, match="no dance has 400 frames"):
        DanceWindows.of(dances, contacts, mels, 400)


def test_dances_that_are_too_short_are_counted_and_left_out():
    dances, contacts, mels = material()
    whole = DanceWindows.of(dances, contacts, mels, 40)
    with pytest.warns(MotionWarning, match="1 of 3 dances are left out.* 40 frames, 2 s"):
        made = DanceWindows.of(
            [*dances, dances[0][:39]], [*contacts, contacts[0][:39]], [*mels, mels[0].clone()], 40
        )
    assert len(made) == len(whole)


def seeded() -> torch.Generator:
    return torch.Generator().manual_seed(0)


def test_parts_are_in_metres_after_the_scaler_is_undone():
    made = windows()
    body = body_of(made.motion_scaler)
    truth, _, stands = made.take(torch.arange(3))
    parts = kinematic_parts(truth, truth, body, stands)
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
    parts = kinematic_parts(made.motion_scaler.transform(longer), truth, body, stands)
    assert (
        0 < parts["skeleton"].max() < 2 * 0.02**2 * 40 / 39 / 20 * 1.1
    )  # two bones of twenty, +-2 cm at most
    assert parts["asymmetry"].max() > 1e-3


def test_how_far_toes_move_is_the_mean_square_of_their_coordinates_changes():
    made = windows()
    positions = to_positions(made.motion_scaler.inverse(everything(made)[0]))
    moved = positions[:, 1:, list(TOES)] - positions[:, :-1, list(TOES)]
    assert toes_moved(made) == pytest.approx(moved.square().mean().item(), rel=1e-4)
