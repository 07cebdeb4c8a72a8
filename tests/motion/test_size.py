"""The size of a figure, and figures of other sizes that walk and are edited."""

import numpy as np
import pytest

import motiondiff_edu as md
from data_synth.walking import walk
from motiondiff_edu.motion.skeleton import joint_index
from motiondiff_edu.performers.continuation import leg_size, resize_motion


@pytest.fixture(scope="module")
def walked() -> md.Motion:
    return md.Motion.of_clip(walk(np.tile([1.2, 0.0, 0.3], (80, 1)), seed=3), (1.0, 2.0, 0.5))


def test_the_size_is_that_of_the_legs(walked):
    assert leg_size(walked.positions) == 1.0
    assert leg_size(0.7 * walked.positions) == pytest.approx(0.7, abs=1e-3)
    short = walked.positions.copy()
    short[:, joint_index("Head")] += [0.0, 0.5, 0.0]
    assert leg_size(short) == 1.0
    holes = 0.7 * walked.positions
    holes[5:9] = np.nan
    assert leg_size(holes) == pytest.approx(0.7, abs=1e-3)
    assert leg_size(np.full((3, 21, 3), np.nan)) == 1.0


def test_a_resized_motion_has_its_path_and_its_contacts(walked):
    small = resize_motion(walked, 0.7)
    np.testing.assert_allclose(small.root, walked.root * [0.7, 0.7, 1.0])
    np.testing.assert_allclose(small.control, walked.control * [0.7, 0.7, 1.0], atol=1e-9)
    assert np.array_equal(small.contacts, walked.contacts) and small.fps == walked.fps


@pytest.mark.parametrize("size", [0.7, 1.3])
def test_a_child_walks_as_the_figure_of_the_course_does(walked, size):
    """As fast as it was asked to, with its feet on the floor."""
    control = md.joystick([(2, 1.0, 0, 0.2)])
    of_course = md.load("walker").walk(walked, control / [size, size, 1.0], progress=False)
    own = md.load("walker").walk(resize_motion(walked, size), control, progress=False)
    np.testing.assert_allclose(own.positions, size * of_course.positions, atol=1e-3)
    assert np.abs(own.positions[..., 1].min(1)).max() < 0.02
    way = np.linalg.norm(np.diff(own.positions[:, 0, [0, 2]], axis=0), axis=1).sum()
    assert way == pytest.approx(2.0, abs=0.25)


def test_a_child_is_edited_as_the_figure_of_the_course_is(walked):
    made = [
        md.edit(one, "walks forward while clapping", progress=False)
        for one in (walked, resize_motion(walked, 0.7))
    ]
    lowest = [one.positions[..., 1].min(1).mean() for one in made]
    assert lowest[1] < 0.7 * lowest[0] + 0.01
    assert leg_size(made[1].positions) == pytest.approx(0.7, abs=0.01)
