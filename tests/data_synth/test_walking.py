"""Synthetic walks: same seed, same bytes.

Feet that stay, knees that bend one way, several right continuations.
"""

import numpy as np
import pytest

from data_synth.walking import continuations, dataset, random_control, walk
from data_synth.walking.controls import KINDS
from data_synth.walking.footsteps import TOE_AHEAD
from data_synth.walking.gait_cycles import analyse
from data_synth.walking.styles import STYLES, draw_style, person
from data_synth.walking.write import main
from motiondiff_edu.metrics.distributions import spread
from motiondiff_edu.motion.augment import mirror
from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.root_frame import root_path, to_root_frame
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, BONES, TOES

ALL_KINDS = tuple(KINDS)


PAIRS = [(kind, style) for kind in ALL_KINDS for style in STYLES]


@pytest.fixture(scope="module")
def given():
    """One control for every kind and style, 9 s each."""
    return [
        random_control(9.0, np.random.default_rng([k, 5]), kind)
        for k, (kind, _) in enumerate(PAIRS)
    ]


@pytest.fixture(scope="module")
def clips(given):
    """One walk of every kind and style.

    It gets a copy of its control, so that the given one stays as it was.
    """
    return [walk(given[k].copy(), k, style) for k, (_, style) in enumerate(PAIRS)]


@pytest.fixture(scope="module")
def past():
    return walk(random_control(4.0, np.random.default_rng(3), "straight"), 21, "neutral")


def bone_vectors(poses):
    return poses[:, [b for _, b in BONES]] - poses[:, [a for a, _ in BONES]]


def test_same_seed_same_bytes():
    first, again = dataset(3, 5.0, 8), dataset(3, 5.0, 8)
    assert [c.poses.tobytes() for c in first] == [c.poses.tobytes() for c in again]
    assert all(
        np.array_equal(a.control, b.control) and a.source == b.source
        for a, b in zip(first, again, strict=True)
    )
    assert dataset(1, 5.0, 9)[0].poses.tobytes() != first[0].poses.tobytes()


def test_a_longer_dataset_begins_with_the_shorter_one():
    assert dataset(4, 3.0, 8)[1].poses.tobytes() == dataset(2, 3.0, 8)[1].poses.tobytes()


def test_bones_are_constant(clips):
    for clip in clips:
        lengths = np.linalg.norm(bone_vectors(clip.poses), axis=-1)
        assert np.abs(lengths - BONE_LENGTHS).max() < 1e-9


def test_planted_feet_do_not_slide(clips):
    worst, planted = 0.0, 0
    for clip in clips:
        toes = clip.world()[:, TOES]
        both = clip.contacts[1:] & clip.contacts[:-1]
        worst = max(worst, float(np.linalg.norm(np.diff(toes, axis=0), axis=-1)[both].max()))
        planted += both.sum()
    assert worst < 1e-3 and planted > 5000


def test_contacts_are_true(clips):
    """A planted toe lies on the floor.

    A toe that lies still on the floor for three frames is planted.
    """
    for clip in clips:
        toes = clip.world()[:, TOES]
        assert np.abs(toes[clip.contacts][:, 1]).max() < 1e-3
        still = np.linalg.norm(np.diff(toes, axis=0), axis=-1) < 1e-6
        certain = still[:-1] & still[1:]
        assert clip.contacts[1:-1][certain].mean() > 0.999


def test_feet_stay_above_the_floor(clips):
    assert min(clip.poses[..., 1].min() for clip in clips) > -0.005


def test_knees_never_bend_backwards_nor_lock(clips):
    for clip in clips:
        for hip, knee, ankle in ((1, 2, 3), (5, 6, 7)):
            thigh = clip.poses[:, knee] - clip.poses[:, hip]
            shank = clip.poses[:, ankle] - clip.poses[:, knee]
            sagittal = np.cross(thigh, shank)[
                :, 0
            ]  # seen from the left, the shank trails the thigh: positive
            cos = (
                (thigh * shank).sum(-1)
                / np.linalg.norm(thigh, axis=-1)
                / np.linalg.norm(shank, axis=-1)
            )
            bend = np.degrees(np.arccos(np.clip(cos, -1, 1)))
            assert sagittal.min() > 0 and 10 < bend.min() and bend.max() < 140


def test_the_root_is_the_commanded_path_exactly(clips, given):
    for clip, wanted in zip(clips[::7], given[::7], strict=True):
        assert np.array_equal(clip.control, wanted) and len(wanted) == len(clip.poses)
        root, heading = root_path(clip.control)
        poses, control = to_root_frame(clip.world(), root, heading)
        assert np.abs(poses - clip.poses).max() < 1e-9
        assert np.abs(control[:-1] - clip.control[:-1]).max() < 1e-9


def test_the_pelvis_stays_over_the_root(clips):
    assert max(np.abs(clip.poses[:, 0, [0, 2]]).max() for clip in clips) < 0.2


def test_speeds_and_turns_are_covered():
    rng = np.random.default_rng(6)
    many = np.concatenate(
        [random_control(20.0, rng, kind) for kind in ALL_KINDS for _ in range(12)]
    )
    low, high = many.min(0), many.max(0)
    assert low[0] < -0.4 and high[0] > 2.8 and high[0] <= 3.05
    assert low[1] < -0.5 and high[1] > 0.5
    assert (
        np.degrees(low[2]) < -110
        and np.degrees(high[2]) > 110
        and np.abs(many[:, 2]).max() <= np.radians(120) + 1e-9
    )
    assert (np.abs(many).max(1) < 0.02).mean() > 0.01  # standing still


def test_controls_are_as_smooth_as_a_root_path():
    for kind in ALL_KINDS:
        control = random_control(20.0, np.random.default_rng(7), kind)
        assert (
            np.abs(np.diff(control[:, 0])).max() * 20 < 3.5
            and np.abs(np.diff(control[:, 2])).max() * 20 < 8
        )


def test_running_flies_and_walking_does_not():
    def airborne(speed):
        return (
            walk(np.tile([speed, 0.0, 0.0], (150, 1)), 2, "neutral").poses[:, TOES, 1].min(1) > 0.02
        ).mean()

    assert airborne(1.4) == 0 and airborne(2.9) > 0.1


def test_standing_stands():
    clip = walk(np.zeros((90, 3)), 5, "neutral")
    assert clip.contacts.all() and np.ptp(clip.poses[:, 0], axis=0).max() < 0.12
    assert np.ptp(clip.poses[:, 0], axis=0).max() > 1e-3  # but nobody is a statue


def test_start_and_stop():
    control = np.zeros((200, 3))
    control[50:120, 0] = 1.2
    clip = walk(control, 3, "neutral")
    assert (
        clip.contacts[20:50].all()
        and not clip.contacts[60:115].all(1).all()
        and clip.contacts[165:].all()
    )
    assert np.abs(clip.poses[-1, TOES, 2] - TOE_AHEAD).max() < 0.16  # both feet came along


def test_either_foot_may_go_first():
    control = np.zeros((60, 3))
    control[30:, 0] = 1.0
    first = [
        int(walk(control, seed, "neutral").contacts[30:].argmin(0).argmin()) for seed in range(12)
    ]
    assert 2 <= sum(first) <= 10


def test_cycles_vary_and_sides_differ():
    clip = walk(np.tile([1.2, 0.0, 0.0], (400, 1)), 9, "neutral")
    walk_ = analyse(clip.world())
    strikes = [np.flatnonzero(~walk_.down[:-1, s] & walk_.down[1:, s]) for s in (0, 1)]
    landed = [clip.world()[strikes[s] + 3, TOES[s]][:, [0, 2]] for s in (0, 1)]
    strides = [np.linalg.norm(np.diff(p, axis=0), axis=-1) for p in landed]
    assert all(0.005 < s.std() < 0.12 for s in strides)
    steps = np.sort(np.concatenate(strikes))
    assert np.diff(steps).std() > 0
    side = [np.median(clip.poses[:, hand, 2]) for hand in (15, 19)]
    assert abs(side[0] - side[1]) > 1e-4


def test_styles_differ_and_persons_of_one_style_too():
    control = np.tile([1.0, 0.0, 0.0], (160, 1))
    neck = {s: walk(control, 4, s).poses[:, 11].mean(0) for s in STYLES}
    assert (
        neck["old"][2] > neck["neutral"][2] + 0.05 and neck["crouch"][1] < neck["neutral"][1] - 0.08
    )
    a, b = (person(STYLES["neutral"], np.random.default_rng(k)) for k in (0, 1))
    assert a != b and a.name == b.name == "neutral"


def test_a_pose_depends_on_the_past_control_only(past):
    """What comes later cannot be known by who holds the control: it must not show before."""
    later = past.control.copy()
    later[50:] = [0.2, 0.1, 1.0]
    other = walk(later, 21, "neutral")
    assert np.array_equal(other.poses[:51], past.poses[:51])
    assert not np.array_equal(other.poses[51:], past.poses[51:])


def test_continuations_are_continuous(past):
    held = np.tile(past.control[-1], (40, 1))
    for clip in continuations(past.cut(60, 80), held, 4, 11):
        joined = np.concatenate([past.poses, clip.poses])
        speed = np.diff(joined, axis=0)
        usual = np.abs(np.diff(speed, axis=0)).max((1, 2))
        assert (
            len(clip) == 40
            and usual[76:82].max() < 1.5 * np.abs(np.diff(past.poses, 2, axis=0)).max()
        )
        assert np.array_equal(clip.control, held)


def test_continuations_spread_from_one_past(past):
    clips = continuations(past, np.tile(past.control[-1], (100, 1)), 16, 11)
    poses = np.stack([c.poses for c in clips])
    apart = np.sqrt(((poses - poses.mean(0)) ** 2).sum(-1).mean((0, 2)))
    assert apart[0] < 0.004 and apart[60:].mean() > 0.02 and 0.015 < spread(poses) < 0.15
    again = continuations(past, np.tile(past.control[-1], (100, 1)), 16, 11)
    assert all(np.array_equal(a.poses, b.poses) for a, b in zip(clips, again, strict=True))


def test_a_continuation_can_be_continued(past):
    held = np.tile(past.control[-1], (25, 1))
    second = continuations(past, held, 2, 1)[1]
    third = continuations(second, held, 1, 2)[0]
    joined = np.concatenate([second.poses, third.poses])
    assert (
        np.abs(np.diff(joined, 2, axis=0))[22:27].max()
        < 1.5 * np.abs(np.diff(second.poses, 2, axis=0)).max()
    )


def test_foreign_pasts_are_refused(past):
    from dataclasses import replace

    with pytest.raises(ValueError, match="was not made by"):
        continuations(replace(past, info={}), past.control[:5], 2, 0)
    with pytest.raises(ValueError, match="mirrored"):
        continuations(mirror(past), past.control[:5], 2, 0)


@pytest.mark.parametrize(
    ("control", "words"),
    [
        (np.zeros((7, 2)), "shape|Type-check"),  # the tests check shapes before the function does
        (np.full((7, 3), np.nan), "frame 0"),
        (np.tile([9.0, 0.0, 0.0], (7, 1)), "at most 4.5"),
    ],
)
def test_bad_controls_say_what_is_wrong(control, words):
    with pytest.raises((ValueError, TypeError), match=words):
        walk(control, 0)


def test_unknown_names_list_the_known_ones():
    with pytest.raises(ValueError, match="neutral"):
        draw_style("moonwalk", np.random.default_rng(0))
    with pytest.raises(ValueError, match="sidestep"):
        random_control(3.0, np.random.default_rng(0), "moonwalk")


def test_command_line_writes_bvh_and_npz(tmp_path, capsys):
    main(["--out", str(tmp_path), "--clips", "2", "--seconds", "3", "--style", "old"])
    assert "2 walks" in capsys.readouterr().out
    with np.load(tmp_path / "walk_001.npz", allow_pickle=False) as data:
        assert (
            data["poses"].shape == (60, 21, 3)
            and str(data["style"]) == "old"
            and data["contacts"].shape == (60, 2)
        )
    assert len(read_bvh(tmp_path / "walk_000.bvh").frames) == 60
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        f"walk_00{k}.{e}" for k in (0, 1) for e in ("bvh", "npz")
    ]
