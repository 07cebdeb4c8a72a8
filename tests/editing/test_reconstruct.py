"""Reconstruction of a motion of any length: its windows, how they are joined, and its path."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from data_synth.imperfect import ARM
from data_synth.walking import walk
from motiondiff_edu.editing import reconstruct as module
from motiondiff_edu.editing.reconstruct import _once, _windows, path_of, reconstruct
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.motion.dance_frame import Place
from motiondiff_edu.motion.directions import ARMS, UPLEGS
from motiondiff_edu.motion.motion import Motion, MotionError, MotionWarning
from motiondiff_edu.motion.root_frame import estimate_root
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.motion.skeleton import HIPS, J, joint_index
from motiondiff_edu.reconstruction import Rollout

T_H = 10


def mask(frames: int, *holes: tuple[int, int]) -> np.ndarray:
    known = np.ones((frames, 21), bool)
    for first, last in holes:
        known[first:last, 5] = False
    return known


@pytest.mark.parametrize(
    "holes, firsts",
    [
        ([(12, 15)], [7, 12]),  # from half a window before the hole, half a window apart
        ([(0, 3)], [0]),
        ([(38, 40)], [30]),  # the last window ends with the motion
        ([(12, 15), (30, 31)], [7, 12, 25, 30]),
        ([(0, 40)], [0, 5, 10, 15, 20, 25, 30]),
    ],
)
def test_windows_cover_the_holes_and_stay_within_the_motion(holes, firsts):
    known = mask(40, *holes)
    assert _windows(known, T_H).tolist() == firsts
    covered = {frame for first in firsts for frame in range(first, first + T_H)}
    assert set(np.flatnonzero(~known.all(1))) <= covered and max(covered) < 40


def test_where_windows_overlap_the_middle_of_a_window_counts_most(monkeypatch):
    """Two windows, from frames 0 and 5, filled with 1 and with 4; what no window holds stays."""
    seen = []

    def constants(rollout, past, known, control, **options):
        seen.append((past, known, control))
        return torch.stack([torch.full_like(past[0], 1.0), torch.full_like(past[1], 4.0)])

    monkeypatch.setattr(module.reconstruction, "reconstruct", constants)
    walker = SimpleNamespace(config=SimpleNamespace(T_h=T_H), window_sampler=print)
    walker.pose_scaler = walker.control_scaler = Scaler.nothing(2)
    rollout = Rollout(walker, torch.Generator(), 1)
    guess = torch.arange(18.0, dtype=torch.float64)[:, None].expand(-1, 2).contiguous()
    steer = torch.arange(28.0, dtype=torch.float64)[:, None].expand(-1, 3)
    known = torch.zeros(18, 2, dtype=torch.bool)
    made = _once(rollout, guess, known, steer, np.array([0, 5]))
    rise = [1, 2, 3, 4, 5, 5, 4, 3, 2, 1]
    both = [(1 * a + 4 * b) / (a + b) for a, b in zip(rise[5:], rise[:5], strict=True)]
    wanted = [1.0] * 5 + both + [4.0] * 5 + [15.0, 16.0, 17.0]
    assert made[:, 0].tolist() == pytest.approx(wanted) and torch.equal(made[:, 0], made[:, 1])
    past, _, control = seen[0]
    assert past[1, :, 0].tolist() == list(range(5, 15))
    assert control[1, :, 0].tolist() == list(range(5, 25))  # its own rows, and those of the way on


def walking() -> Motion:
    return Motion.of_clip(walk(np.tile([1.1, 0.0, 0.3], (60, 1)), seed=3), (2.0, -1.0, 0.7))


@pytest.mark.parametrize("hidden", [UPLEGS, ARMS])
def test_the_path_needs_hips_or_shoulders(hidden):
    one = walking()
    known = one.known
    known[20:40, list(hidden)] = False
    positions = np.where(known[..., None], one.positions, np.nan)
    place, facing = path_of(positions, known)
    whole, all_facing = path_of(one.positions, one.known)
    np.testing.assert_allclose(place, whole, atol=1e-9)
    assert np.abs(facing - all_facing).max() < 0.15  # hips and shoulders turn a little apart


def test_a_heading_turns_the_short_way_where_hips_and_shoulders_are_lost(monkeypatch):
    """The figure turns over pi, where an angle of arctan2 jumps; at the ends the heading stays."""
    monkeypatch.setattr(module, "smoothed_root", lambda place, facing: (place, facing))
    asked = np.linspace(2.0, 4.5, 60)
    pose = walking().positions[0]
    still = Place.of(pose).enter(pose[None])[0]
    turning = np.stack([Place(np.zeros(3), np.array(one)).leave(still[None])[0] for one in asked])
    known = np.ones((60, J), bool)
    for lost in (slice(0, 5), slice(20, 40), slice(52, 60)):
        known[lost, [*UPLEGS, *ARMS]] = False
    known[lost, HIPS] = True
    _, facing = path_of(turning, known)
    wanted = np.clip(asked, asked[5], asked[51])
    np.testing.assert_allclose(facing - facing[5] + asked[5], wanted, atol=1e-6)


def test_the_path_of_a_whole_motion_is_the_smoothed_root():
    """Without smoothing, pelvis and hips would bring the gait into the control."""
    one = walking()
    place, facing = path_of(one.positions, one.known)
    smooth, smooth_facing = estimate_root(one.positions)
    np.testing.assert_allclose(place, smooth, atol=1e-9)
    np.testing.assert_allclose(facing, smooth_facing, atol=1e-9)
    assert np.abs(place - one.positions[:, HIPS][:, [0, 2]]).max() > 0.005


def without_an_arm() -> tuple[Motion, np.ndarray]:
    """A walk whose right arm is hidden for a second."""
    one = walking()
    known = one.known
    known[20:40, [joint_index(name) for name in ARM]] = False
    return one, known


def standing() -> SimpleNamespace:
    """As much of a walker as `reconstruct` asks for, when its rounds are another's."""
    config = SimpleNamespace(T_h=T_H, T_p=T_H, D=63, C=3)
    scalers = {"pose_scaler": Scaler.nothing(63), "control_scaler": Scaler.nothing(3)}
    return SimpleNamespace(config=config, window_sampler=print, **scalers)


def test_every_round_begins_with_what_the_one_before_found_and_there_are_three(monkeypatch):
    """What a round fills in is the last guess and a metre; the bones are left alone here."""
    one, known = without_an_arm()
    begun = []

    def higher(rollout, guess, mask, steer, firsts):
        begun.append(guess)
        return guess + 1.0

    monkeypatch.setattr(module, "_once", higher)
    monkeypatch.setattr(module, "clean_bones", lambda joints, known, body: joints)
    reconstruct(standing(), one.positions, known, generator=torch.Generator())
    assert len(begun) == 3
    missing = ~torch.from_numpy(known.repeat(3, axis=1))
    for before, after in zip(begun, begun[1:], strict=False):
        torch.testing.assert_close(after[missing], before[missing] + 1.0)
        torch.testing.assert_close(after[~missing], before[~missing])
    begun.clear()
    reconstruct(standing(), one.positions, known, generator=torch.Generator(), rounds=1)
    assert len(begun) == 1


def test_what_is_reconstructed_has_the_bones_of_what_is_given(monkeypatch):
    """The rounds find joints that are centimetres away; the bones of the hidden arm are held."""
    one, known = without_an_arm()
    random = torch.Generator().manual_seed(2)

    def far(rollout, guess, mask, steer, firsts):
        return guess + 0.03 * torch.randn(guess.shape, generator=random, dtype=guess.dtype)

    monkeypatch.setattr(module, "_once", far)
    made = reconstruct(standing(), one.positions, known, generator=torch.Generator())
    assert np.array_equal(made[known], one.positions[known])
    assert not np.allclose(made[~known], one.positions[~known], atol=0.01)
    off = np.abs(bone_lengths(made) - np.median(bone_lengths(one.positions), axis=0))
    assert off.max() < 0.002


def test_the_control_stays_within_the_training_and_a_warning_says_where():
    card = {"control_range": {"low": [-1.0, -1.0, -2.0], "high": [3.0, 1.0, 2.0]}}
    walker = SimpleNamespace(**vars(standing()), card=card)
    control = np.tile([1.0, 0.0, 0.5], (30, 1))
    control[12:15, 2] = [2.2, 9.0, -9.0]
    known = np.ones((30, 21), bool)
    known[10:20, 3] = False
    with pytest.warns(MotionWarning, match="in 2 of the frames .* the first is 13, the figure"):
        limited = module.within_training(walker, control, known)
    np.testing.assert_array_equal(limited[12:15, 2], [2.0, 2.0, -2.0])
    np.testing.assert_array_equal(
        np.delete(limited, slice(12, 15), 0), np.delete(control, slice(12, 15), 0)
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        control[13:15, 2] = 2.3  # a little beyond the range
        module.within_training(walker, control, known)
        known[:] = True  # the figure is fast where nothing is missing
        control[2, 2] = 50.0
        assert module.within_training(walker, control, known)[2, 2] == 2.0
        assert module.within_training(standing(), control, known) is control


def test_what_shows_no_path_is_said():
    one = walking()
    known = one.known
    known[7, HIPS] = False
    with pytest.raises(MotionError, match=r"pelvis \(Hips\) is not known in frame 7 \(1 frames"):
        path_of(one.positions, known)
    known = one.known
    known[:, [UPLEGS[0], ARMS[1]]] = False
    with pytest.raises(MotionError, match="no frame has both hips or both shoulders"):
        path_of(one.positions, known)


def test_known_joints_that_are_unlike_the_training_are_named_if_their_frame_has_holes():
    scaler = Scaler.nothing(63)
    given, known = torch.zeros(40, 63), mask(40, (10, 20))
    given[30, 3 * HIPS + 1] = given[15, 3 * 5] = 100.0  # in a whole frame, and not known
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        module.warn_of_unlike(scaler, given, known)
    given[12, 3 * 7] = 10 * 3**0.5
    with pytest.warns(MotionWarning, match=r"unlike the walker's training .*RightFoot 10.0\)"):
        module.warn_of_unlike(scaler, given, known)


@pytest.mark.parametrize("misses, told", [(0.03, False), (0.4, True)])
def test_the_limb_of_the_other_side_says_whether_a_still_limb_is_as_near(monkeypatch, misses, told):
    """It is hidden, and what the walker makes of it is compared with its mean pose."""
    world = walk(np.tile([1.1, 0.0, 0.0], (60, 1)), seed=2).world()
    known = np.ones((60, J), bool)
    right = [joint_index(f"Right{name}") for name in ("Arm", "ForeArm", "Hand", "HandIndex1")]
    left = [joint_index(f"Left{name}") for name in ("Arm", "ForeArm", "Hand", "HandIndex1")]
    known[20:40, right] = False
    asked = []

    def missed(walker, positions, shown, *, generator):
        asked.append(shown)
        return np.where(shown[..., None], positions, positions + [0, misses, 0])

    monkeypatch.setattr(module, "reconstruct", missed)
    words = module.other_side_in_doubt(standing(), world, known, torch.Generator())
    (shown,) = asked
    assert (~shown).sum() == 20 * 4 and not shown[20:40, left].any() and shown[:20].all()
    assert bool(words) == told and (
        not told or "LeftHandIndex1, which is given, is missed by 40" in words
    )


def test_where_both_sides_are_missing_nothing_can_be_tested():
    world = walk(np.tile([1.1, 0.0, 0.0], (30, 1)), seed=2).world()
    known = np.ones((30, J), bool)
    known[:, [joint_index("LeftHand"), joint_index("RightHand")]] = False
    assert module.other_side_in_doubt(standing(), world, known, torch.Generator()) == ""
    known[:] = True
    known[5] = False  # a whole frame: pelvis and head have no other side
    assert module.other_side_in_doubt(standing(), world, known, torch.Generator()) == ""
