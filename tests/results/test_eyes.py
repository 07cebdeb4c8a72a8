"""An eye judges what comes after the given frames, and only where a measure has a meaning."""

import numpy as np
import pytest

from data_synth.walking import dataset
from motiondiff_edu.metrics import bodies
from motiondiff_edu.motion.motion import Motion
from tools.results import eyes


@pytest.fixture(scope="module")
def walk() -> Motion:
    (clip,) = dataset(1, 5.0, seed=3)
    return Motion.of_clip(clip)


def test_a_mean_is_over_the_motions_that_a_measure_can_judge(walk):
    def height(positions):
        if positions.max() > 100:
            raise ValueError("no stride")
        return positions[..., 1].max()

    low, high = walk.positions, 1.5 * walk.positions
    kinds = {"height": ("m", height), "never": ("m", lambda x: height(x + 1000))}
    (found,) = eyes.told("walks.x", kinds, [low, high, low + 1000])
    assert (found.name, found.unit) == ("walks.x.height", "m")
    assert found.value == pytest.approx(1.25 * low[..., 1].max())


def test_what_is_judged_is_what_the_walker_put_after_the_given_frames(walk):
    class Repeats:
        def walk(self, given, control, progress):
            still = np.repeat(given.positions[-1:], len(control), axis=0)
            return Motion(np.concatenate([given.positions, still]))

    (made,) = eyes.walked_on(Repeats(), [(walk[:30], walk.to_clip().control[30:])])
    assert len(made) == len(walk) - 30 and bodies.still_share(made) == 1


def test_records_say_of_which_weights_they_are(monkeypatch):
    found = eyes.told("walks.data", eyes.WALKS, [np.zeros((40, 21, 3))])
    monkeypatch.setattr(eyes, "recordings", lambda walker, size: found)
    made = {one["name"]: one for one in eyes.recorded_records(("walker", "abc"), eyes.QUICK, "c")}
    one = made["eye.walks.data.still_share"]
    assert one["value"] == 1 and one["seeds"]["weights"] == ["abc"]
