"""Clips, their windows, and a split that does not leak."""

from dataclasses import replace

import jaxtyping
import numpy as np
import pytest

from motiondiff_edu.motion.augment import mirror, reverse_time
from motiondiff_edu.motion.clip import Clip, slice_clips, split_by_source


def clip_of(frames, source="a", seed=0, contacts=True):
    rng = np.random.default_rng(seed)
    planted = rng.random((frames, 2)) < 0.5 if contacts else None
    return Clip(
        rng.normal(size=(frames, 21, 3)),
        rng.normal(size=(frames, 3)),
        contacts=planted,
        source=source,
    )


def test_slices_are_four_seconds_with_half_overlap():
    clip = clip_of(247)
    pieces = slice_clips([clip])
    assert [len(piece) for piece in pieces] == [
        80
    ] * 5  # starts 0, 40, 80, 120, 160; the last 7 frames are left out
    for k, piece in enumerate(pieces):
        assert np.array_equal(piece.poses, clip.poses[40 * k : 40 * k + 80])
        assert np.array_equal(piece.control, clip.control[40 * k : 40 * k + 80])
        assert np.array_equal(piece.contacts, clip.contacts[40 * k : 40 * k + 80])
        assert piece.source == clip.source


@pytest.mark.parametrize("frames, count", [(79, 0), (80, 1), (119, 1), (120, 2)])
def test_a_rest_that_is_too_short_is_left_out(frames, count):
    assert len(slice_clips([clip_of(frames)])) == count


def test_no_overlap_and_an_impossible_one():
    assert [p.poses[0, 0, 0] for p in slice_clips([clip_of(50)], seconds=1.0, overlap=0.0)] == [
        clip_of(50).poses[k, 0, 0] for k in (0, 20)
    ]
    with pytest.raises(ValueError, match=r"\[0, 1\)"):
        slice_clips([clip_of(90)], overlap=1.0)


@pytest.mark.parametrize("seed", range(4))
def test_no_source_stands_on_two_sides(seed):
    """A property of any data set.

    Slices of one recording share frames, so they must share a side.
    """
    rng = np.random.default_rng(seed)
    sources = [f"take {k}" for k in range(int(rng.integers(5, 12)))]
    clips = [
        clip_of(int(rng.integers(80, 260)), source, seed=k) for k, source in enumerate(sources)
    ]
    pieces = slice_clips(clips)
    rng.shuffle(pieces)
    groups = split_by_source(pieces, (0.6, 0.3, 0.1), rng)
    found = [{clip.source for clip in group} for group in groups]
    assert not (found[0] & found[1] or found[0] & found[2] or found[1] & found[2])
    assert sum(map(len, groups)) == len(pieces)  # none lost, none twice
    frames = [{row.tobytes() for clip in group for row in clip.poses} for group in groups]
    assert not (frames[0] & frames[1] or frames[0] & frames[2])  # and so no frame is shared either


def test_a_split_that_leaves_a_group_empty_says_which():
    clips = [clip_of(5, f"s{k}", k) for k in range(3)]
    with pytest.raises(ValueError, match="3 sources leave group 2 without one"):
        split_by_source(clips, (0.8, 0.1, 0.1), np.random.default_rng(0))
    with pytest.raises(ValueError, match="clip 1 has no source"):
        split_by_source([clips[0], clip_of(5, "", 1)], (0.5, 0.5), np.random.default_rng(0))


def test_split_is_by_shares_of_the_sources_and_follows_its_generator():
    clips = [clip_of(5, f"s{k}", k) for k in range(10)]
    train, test = split_by_source(clips, (0.8, 0.2), np.random.default_rng(1))
    assert (len(train), len(test)) == (8, 2)
    again = split_by_source(clips, (0.8, 0.2), np.random.default_rng(1))[1]
    other = [
        split_by_source(clips, (0.8, 0.2), np.random.default_rng(seed))[1] for seed in range(2, 6)
    ]
    assert [c.source for c in again] == [c.source for c in test]
    assert any([c.source for c in o] != [c.source for c in test] for o in other)
    with pytest.raises(ValueError, match="sum to 1"):
        split_by_source(clips, (0.8, 0.3), np.random.default_rng(1))


def test_features_are_the_poses_flat():
    clip = clip_of(6)
    features = clip.features()
    assert features.shape == (6, 63) and features.dtype == np.float32
    assert features[4, 3 * 5 + 2] == np.float32(clip.poses[4, 5, 2])


def test_columns_of_ones_own_move_nobody():
    clip = clip_of(9)
    more = replace(clip, control=np.hstack([clip.control, np.full((9, 2), 7.0)]))
    assert np.array_equal(more.world((1.0, 2.0, 0.3)), clip.world((1.0, 2.0, 0.3)))
    for change in (mirror, reverse_time):
        with pytest.raises(ValueError, match="'a' has 5 columns of control.*then add your own"):
            change(more)


def test_poses_and_control_must_be_as_long(monkeypatch):
    monkeypatch.setattr(
        jaxtyping.config, "jaxtyping_disable", True
    )  # as in a notebook, where no shape is checked
    with pytest.raises(ValueError, match="'b': 7 poses but 6 rows of control"):
        Clip(np.zeros((7, 21, 3)), np.zeros((6, 3)), source="b")
