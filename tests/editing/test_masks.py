"""Masks over frames and joints: what they give, and what they refuse."""

import pytest

from motiondiff_edu.editing.masks import (
    body_part,
    gap,
    keyframes,
    keyframes_of,
    known_frames,
    seed,
)


def test_masks():
    assert seed(200).sum() == 40 * 21 and keyframes(100, 30).any(-1).nonzero()[0].tolist() == [
        0,
        30,
        60,
        90,
        99,
    ]
    assert (~gap(100, 20, 15).any(-1)).nonzero()[0].tolist() == list(range(20, 35))
    both = body_part(5, "upper body").sum() + body_part(5, "lower body").sum()
    assert both == 5 * (21 + 1) and body_part(5, "trajectory").sum() == 5  # the pelvis is in each


def test_keyframes_are_where_they_are_asked_for():
    assert keyframes_of(50, at=[30, 7, 30]).any(-1).nonzero()[0].tolist() == [0, 7, 30, 49]
    assert keyframes_of(50, at=[]).any(-1).nonzero()[0].tolist() == [0, 49]
    for wrong in (50, -1, 3.5):
        with pytest.raises(ValueError, match=f"keyframe at {wrong}: .* 0 to 49"):
            keyframes_of(50, at=[4, wrong])


def test_masks_refuse_what_is_not_there():
    with pytest.raises(IndexError, match="frame 40"):
        known_frames(40, [40])
    with pytest.raises(ValueError, match="gap of 30"):
        gap(40, 20, 30)
    with pytest.raises(KeyError, match="lower body"):
        body_part(40, "tail")
