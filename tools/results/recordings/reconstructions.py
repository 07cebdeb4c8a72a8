"""Reconstructions of recordings: a limb is missing for a second, and the walker draws it.

Three seconds of each recording, a limb's joints missing in the middle second, once an arm and once
a leg. `md.reconstruct` is compared with straight lines. The walker was trained on synthetic walks
alone, so walks and all other motions stand apart. Intervals are over persons.
"""

import warnings
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

import motiondiff_edu as md
from data_synth.imperfect import ARM, LEG
from motiondiff_edu.baselines.interpolation import linear
from motiondiff_edu.editing.reconstruct import path_of, reconstruct
from motiondiff_edu.metrics.keyframes import unknown_error
from motiondiff_edu.motion.root_frame import FPS, to_root_frame, to_world
from motiondiff_edu.motion.skeleton import MIRROR, J, joint_index
from motiondiff_edu.performers.performer import generators
from motiondiff_edu.performers.walker import Walker

from ..walks.scores import Measure, measure_of
from .inbetweens import WALKS
from .windows import RecordedSize, amounts, person_of, recorded, trials

LIMBS = {"arm": ARM, "leg": LEG}
SECONDS = 3  # of a window
FIRST, LAST = 1, 2  # the limb is missing between these seconds


def limb_missing(limb: tuple[str, ...]) -> Bool[np.ndarray, "T 21"]:
    """The mask of a window: the limb's joints are unknown in its middle second."""
    known = np.ones((round(SECONDS * FPS), J), bool)
    joints = [joint_index(name) for name in limb]
    known[round(FIRST * FPS) : round(LAST * FPS), joints] = False
    return known


def pieces(size: RecordedSize) -> Iterator[tuple[str, Float[np.ndarray, "T 21 3"]]]:
    """Three seconds from the middle of each recording that is as long; and its name."""
    frames = round(SECONDS * FPS)
    for source, motion in recorded(trials(), RecordedSize(size.files, each=1), SECONDS):
        first = (len(motion) - frames) // 2
        yield source, motion.positions[first : first + frames]


def row_of(walker: Walker, truth: Float[np.ndarray, "T 21 3"]) -> dict[str, float]:
    """Errors (cm) of the reconstruction and of straight lines, for each limb."""
    row = {}
    for name, limb in LIMBS.items():
        known = limb_missing(limb)
        (draw,) = generators(0, 1)
        for who, made in (
            ("walker", reconstruct(walker, truth, known, generator=draw)),
            ("lines", linear(truth, known)),
        ):
            row[f"{name}.{who}"] = 100 * float(unknown_error(made[None], truth[None], known)[0])
    return row


def measures_of(rows: list[dict[str, float]], sources: list[str]) -> list[Measure]:
    """Errors over those of straight lines, the median over recordings: walks, and all others."""
    walks = np.array([source.startswith(WALKS) for source in sources])
    persons = np.array([person_of(source) for source in sources])
    found = []
    for limb in LIMBS:
        over = np.array([row[f"{limb}.walker"] / row[f"{limb}.lines"] for row in rows])
        for kind, some in (("walks", walks), ("others", ~walks)):
            name = f"reconstruction_{limb}_{kind}_over_lines"
            chosen = np.where(some, over, np.nan)
            found.append(measure_of(name, "ratio", np.nanmedian, chosen, groups=persons))
    return found


def still_arm(truth: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 21 3"]:
    """The motion with the mean pose of its left arm, mirrored, as its right arm."""
    place, facing = path_of(truth, np.ones(truth.shape[:2], bool))
    poses, control = to_root_frame(truth, place, facing)
    arm = [joint_index(name) for name in ARM]
    poses[:, arm] = (poses[:, MIRROR[arm]] * (-1, 1, 1)).mean(0)
    return to_world(poses, control, (*place[0].tolist(), float(facing[0])))


def arm_rows(size: RecordedSize) -> list[tuple[bool, bool]]:
    """For each recording: is the drawn arm worse than a still one, and is anything said?"""
    rows, arm = [], [joint_index(name) for name in ARM]
    for _, motion in recorded(trials(), replace(size, each=1)):
        known = motion.all_but(list(ARM))
        made = md.reconstruct(motion, known, progress=False)
        errors = [
            np.linalg.norm((one - motion.positions)[:, arm], axis=-1).mean()
            for one in (made.positions, still_arm(motion.positions))
        ]
        rows.append((bool(errors[0] > errors[1]), bool(made.notes)))
    return rows


def reconstruction_records(
    walker: Walker, weights: str, size: RecordedSize, command: str
) -> list[dict]:
    """The measures of all recordings (`real.reconstruction_*`)."""
    rows, sources = [], []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # notes on the files, and on motion unlike walks
        for source, truth in pieces(size):
            sources.append(source)
            rows.append(row_of(walker, truth))
        worse, said = np.array(arm_rows(size)).T
    seeds = amounts(sources) | {"sampling": 0, "weights": weights}
    arms = [
        measure_of("worse_than_still", "share", np.mean, worse.astype(float)),
        measure_of("worse_than_still_unsaid", "share", np.mean, (worse & ~said).astype(float)),
    ]
    return [
        *(one.as_record("real.", seeds, command) for one in measures_of(rows, sources)),
        *(one.as_record("reconstruct.", seeds | {"files": len(worse)}, command) for one in arms),
    ]
