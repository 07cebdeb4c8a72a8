"""Control along paths, checked by integrating it back to a path."""

import itertools

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from motiondiff_edu.conditions.drawn_path import PRESETS, path_to_control, preset, round_path
from motiondiff_edu.motion.root_frame import root_path


def apart(control: np.ndarray, points: np.ndarray) -> tuple[float, float]:
    """How far the walked way and the drawn line lie apart at the worst place, in metres.

    In both directions.
    """
    walked, _ = root_path(control, (float(points[0, 0]), float(points[0, 1]), 0.0))
    gaps = cdist(walked, round_path(points, 0.0))
    return gaps.min(1).max(), gaps.min(0).max()


@pytest.mark.parametrize("speed", [0.5, 1.2, 3.0])
@pytest.mark.parametrize("name", PRESETS)
def test_presets_integrate_back_to_their_path(name, speed):
    points, stops = preset(name)
    control = path_to_control(points, speed, stops=stops)
    off, missed = apart(control, points)
    assert off < 0.03
    assert missed < 0.03 + speed / 40  # half the way between two frames
    walked, _ = root_path(control)
    assert np.linalg.norm(walked[-1] - points[-1]) < 1e-3


@pytest.mark.parametrize(
    "points",
    [
        [[0, 0], [0, 2], [2, 2]],  # a corner
        [[0, 0], [3, 0]],  # sets out to the left
        [[0, 0], [0, -3]],  # sets out backwards
        [[0, 0], [0, 2], [0, 0]],  # there and back
        [[5, -7], [5, -5], [4, -3]],  # starts elsewhere
    ],
)
def test_awkward_paths_stay_within_centimetres_and_within_limits(points):
    control = path_to_control(np.array(points, dtype=float), 1.2)
    off, missed = apart(control, np.array(points, dtype=float))
    assert off < 0.06 and missed < 0.11
    assert len(control) < 180
    assert np.abs(control[:, 2]).max() <= 1.8 + 1e-9
    assert np.hypot(control[:, 0], control[:, 1]).max() <= 1.2 + 1e-9


@pytest.mark.parametrize("presses", [2, 3, 4])
def test_paths_of_arrow_keys_take_seconds(presses):
    """At a sharp turn the figure rests; two rests can be a centimetre apart."""
    keys = np.array([[-0.5, 0.0], [0.5, 0.0], [0.0, 0.5], [0.0, -0.5]])
    for chosen in itertools.product(range(4), repeat=presses):
        points = np.concatenate([[[0.0, 0.0]], np.cumsum(keys[list(chosen)], 0)])
        assert len(path_to_control(points, 1.2)) < 400, chosen


def test_from_rest_to_rest_it_starts_and_stops():
    points = np.array([[0.0, 0.0], [0.0, 2.0]])
    control = path_to_control(points, 1.2, stops=[1.0, 1.01], pause=1.0)
    alone = path_to_control(points, 1.2, stops=[1.0], pause=1.0)
    assert 15 <= len(control) - len(alone) <= 30, "a second more, and the centimetre"


def test_at_a_stop_at_the_end_it_rests_there():
    points = np.array([[0.0, 0.0], [0.0, 2.0]])
    plain, rests = (path_to_control(points, 1.2, stops=stops, pause=2.0) for stops in ([], [2.0]))
    assert 38 <= len(rests) - len(plain) <= 42 and np.abs(rests[-38:]).max() < 1e-6


def test_a_hand_drawn_line_becomes_a_smooth_walk():
    rng = np.random.default_rng(5)
    z = np.linspace(0, 6, 90)
    points = np.stack([0.5 * np.sin(z), z], -1) + rng.normal(0, 0.01, (90, 2))
    points -= points[0]
    control = path_to_control(points, 1.3)
    assert apart(control, points)[0] < 0.06
    assert np.abs(np.diff(control[:, 0])).max() * 20 < 3 and np.abs(control[:, 2]).max() <= 1.8


def test_walk_starts_and_ends_at_rest_and_takes_the_time_it_must():
    control = path_to_control(np.array([[0.0, 0.0], [0.0, 6.0]]), 1.2)
    assert control[0, 0] < 0.1 and control[-1, 0] < 0.1
    assert np.isclose(control[:, 0].max(), 1.2, atol=1e-6)
    assert abs(len(control) / 20 - (6 / 1.2 + 1.2 / 1.2)) < 0.1  # v/a more than at constant speed


@pytest.mark.parametrize("fps", [20, 60])
def test_stops_are_stops(fps):
    control = path_to_control(
        np.array([[0.0, 0.0], [0.0, 6.0]]), 1.0, fps=fps, stops=[2.0, 4.0], pause=1.5
    )
    still = control[:, 0] < 1e-9
    path = np.concatenate([[0], np.cumsum(control[:-1, 0])]) / fps
    for where in (2.0, 4.0):
        there = still & (np.abs(path - where) < 0.02)
        assert abs(there.sum() / fps - 1.5) <= 2 / fps
    assert still.sum() / fps < 3.3


@pytest.mark.parametrize(
    "points, speed, message",
    [
        ([[0, 0], [0, 1]], 0.0, "speed must lie in"),
        ([[0, 0], [0, 1]], 9.0, "speed must lie in"),
        ([[0, 0]], 1.0, "at least two points"),
        ([[1, 1], [1, 1]], 1.0, "at least two points"),
        ([[0, 0], [0, np.nan]], 1.0, "point 1 of the path is not finite"),
    ],
)
def test_impossible_paths_are_explained(points, speed, message):
    with pytest.raises(ValueError, match=message):
        path_to_control(np.array(points, dtype=float), speed)


def test_unknown_preset_names_the_known_ones():
    with pytest.raises(KeyError, match="figure eight"):
        preset("moonwalk")
