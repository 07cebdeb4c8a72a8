"""What is asked of every motion: each fault is named, and what is right is let pass."""

import numpy as np
import pytest

from data_synth.actions import Act, Phrase, act_out
from data_synth.dancing import dance
from data_synth.music import songs
from data_synth.walking import walk
from motiondiff_edu.motion.questions import answers, collapsed, on_the_floor
from motiondiff_edu.motion.skeleton import joint_index

RIGHT_HAND = joint_index("RightHand")


@pytest.fixture(scope="module")
def motions() -> dict[str, np.ndarray]:
    (song,) = songs(1, 4, 8.0, genre="pop")
    squats = (Phrase(Act("squat", count=2)),)
    return {
        "a walk": walk(np.tile([1.1, 0.0, 0.2], (100, 1)), seed=3).world(),
        "a run": walk(np.tile([2.8, 0.0, 0.0], (100, 1)), seed=4).world(),
        "a dance": dance(song, 5).positions[:140],
        "squats": act_out(squats, 5.0, 2).positions,
    }


def asked(points: np.ndarray, fps: float = 20.0) -> str:
    return " | ".join(answers(points, fps))


def test_what_is_right_passes(motions):
    for name, points in motions.items():
        assert asked(points) == "", name
        assert not collapsed(points).any()
    assert on_the_floor(motions["a walk"], 20.0) > 0.8


def test_faults_are_named(motions):
    points = motions["a walk"]
    turn = np.array([[1, 0, 0], [0, 0.77, -0.64], [0, 0.64, 0.77]])
    assert "leans by 4" in asked(points @ turn.T)
    crossed = points.copy()
    crossed[:, 13:17], crossed[:, 17:21] = points[:, 17:21], points[:, 13:17]
    assert "left and right of the arms" in asked(crossed)
    lost = points.copy()
    lost[30:32, RIGHT_HAND] += [0.5, 0.2, 0.0]
    assert "changes its length in 2 of 100 frames (1.5 to 1.6 s)" in asked(lost)
    held = points.copy()
    held[20:60, RIGHT_HAND] = held[20, RIGHT_HAND]
    assert "RightHand stays where it is from 1.0 to" in asked(held)
    assert "no path of its own" in asked(points - points[:, :1] * [1, 0, 1])
    rising = points + np.linspace(0, 0.4, 100)[:, None, None] * [0, 1, 0]
    assert "the floor rises by" in asked(rising) and "40 cm" in asked(rising)


@pytest.mark.parametrize("name", ["a walk", "a run", "a dance"])
@pytest.mark.parametrize("times, told", [(5.0, "too fast"), (0.2, "too slowly")])
def test_a_wrong_rate_is_told_by_the_limbs(motions, name, times, told):
    assert told in asked(motions[name], 20.0 * times)
    assert "too slowly" in asked(motions["squats"], 4.0)


def test_who_stands_still_has_no_pace_and_no_path(motions):
    still = np.repeat(motions["a walk"][:1], 60, 0)
    assert asked(still) == ""
    assert asked(still, 120.0) == ""


def test_who_jumps_does_not_float(motions):
    jumps = act_out((Phrase(Act("jump", count=4)),), 6.0, 3).positions
    assert asked(jumps) == ""
