"""The main job on real input.

A recorded song is danced to, and the dance neither freezes nor flies apart.
"""

import numpy as np
import pytest

from motiondiff_edu.metrics.bodies import bone_rmse, repeat_score
from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.pretrained.checkpoints import available, load

SECONDS = 12


def speed(dance: np.ndarray) -> np.ndarray:
    """Mean over joints in m/s, from each frame to the next."""
    return 20 * np.linalg.norm(np.diff(dance, axis=0), axis=-1).mean(-1)


@pytest.mark.skipif("dancer" not in available(), reason="no dancer is shipped: run make pretrained")
@pytest.mark.parametrize("song", ["vibe_ace", "nutcracker"])
def test_a_recorded_song_is_danced_to_by_a_body_that_moves_throughout(song, real_data, tmp_path):
    file = real_data / "audio" / f"{song}.ogg"
    made = load("dancer").dance(file, seconds=SECONDS, seed=1)
    dance = made.positions
    assert dance.shape == (SECONDS * 20, 21, 3) and len(made.audio) == SECONDS * 16_000

    assert bone_rmse(dance) < 2  # cm: a body
    by_second = speed(dance)[: SECONDS * 20 - 20].reshape(-1, 20).mean(1)
    assert by_second.min() > 0.08  # m/s: no second of it is frozen (a person who stands: 0.02)
    assert (
        0.25 < speed(dance).mean() < 1.2 and speed(dance).max() < 6
    )  # m/s: of dancing, not of shaking
    assert (
        -0.1 < dance[..., 1].min() and 0.7 < dance[:, 0, 1].mean() < 1.1
    )  # metres: on the floor, and upright
    assert np.abs(dance[:, 0, [0, 2]]).max() < 4  # metres: it does not wander off
    assert repeat_score(dance) < 0.98  # no loop

    other = load("dancer").dance(file, seconds=SECONDS, seed=2).positions
    assert np.abs(other - dance).mean() > 0.05  # metres: another seed, another dance
    report = write_bvh(tmp_path / "dance.bvh", dance)
    assert (
        read_bvh(tmp_path / "dance.bvh").world_positions().shape[0]
        == len(report.positions)
        == SECONDS * 20
    )
