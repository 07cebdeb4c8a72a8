"""Continuations of recordings by the shipped walker: do they jump at the seam, and what follows?

Windows of six seconds from files of several collections: two seconds are given, and the walker goes
on for four as fast as the person went in the last second. Once as `Walker.walk` does it, and once
as the network has it, without the clean-up. The recording's own next four seconds stand beside
them.
"""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from motiondiff_edu import rollout
from motiondiff_edu.metrics.keyframes import seam_over_motion, seam_over_past, seam_step
from motiondiff_edu.metrics.walks import adherence, skating
from motiondiff_edu.motion.cleanup import clean_up
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.root_frame import FPS, control_from_path, to_root_frame
from motiondiff_edu.motion.skeleton import J
from motiondiff_edu.performers.continuation import Start, around_seam
from motiondiff_edu.performers.performer import STEPS, generators
from motiondiff_edu.performers.walker import Walker

from ..walks.scores import Kind, measure_of, measures, root_mean, squared_bone_error
from .windows import SECONDS, RecordedSize, amounts, person_of, recorded, trials

GIVEN = 2.0  # seconds of a window
EARLY = 1.0  # seconds after the seam
JUMP = 0.05  # m in a frame more than beside the seam: a jump that one sees


@dataclass(frozen=True, eq=False)
class Window:
    """Given frames of a recording, what comes next in it, and the control of these frames."""

    source: str
    given: Motion
    next: Float[np.ndarray, "n 21 3"]
    control: Float[np.ndarray, "n 3"]


def windows(size: RecordedSize, range_of_control: dict) -> Iterator[Window]:
    """The beginnings of all windows; the control stays in the range."""
    given, ahead = round(GIVEN * FPS), round((SECONDS - GIVEN) * FPS)
    for source, motion in recorded(trials(), size, SECONDS):
        past = replace(motion[:given], root=None)  # that of the file knows what comes next
        speed = past.control[-round(FPS) :].mean(0)
        speed = speed.clip(range_of_control["low"], range_of_control["high"])
        yield Window(source, past, motion.positions[given:], np.tile(speed, (ahead, 1)))


@dataclass(frozen=True, eq=False)
class Continued:
    """New frames in the world, and the path of the root that was asked for."""

    world: Float[np.ndarray, "n 21 3"]
    path: Float[np.ndarray, "n 3"]


def continued(walker: Walker, window: Window) -> dict[str, Continued]:
    """As `Walker.walk` has it, in the recording's size, and the same without the clean-up."""
    T_h = walker.config.T_h
    start = Start.of(window.given, window.control, T_h)
    past, steer = start.past.reshape(T_h, -1), start.control
    new = rollout.generate(walker, past[None], steer[None], generator=generators(0, 1), steps=STEPS)
    poses, path = new[0].double().numpy().reshape(-1, J, 3), start.path[T_h:]
    whole, known = around_seam(start, poses)
    worlds = {
        "real.": clean_up(whole, FPS, known)[-len(poses) :],
        "real.unblended.": start.in_world(poses),
    }
    path = path * [start.size, start.size, 1.0]
    return {name: Continued(start.size * world, path) for name, world in worlds.items()}


def row_of(window: Window, made: Continued) -> dict[str, float]:
    """What is measured of one continuation."""
    whole = np.concatenate([window.given.positions, made.world])
    seam, early = len(window.given), round(EARLY * FPS)
    poses, _ = to_root_frame(made.world, made.path[:, :2], made.path[:, 2], FPS)
    asked = control_from_path(made.path[:, :2], made.path[:, 2], FPS)
    return {
        "seam": seam_over_motion(whole, seam),
        "past": seam_over_past(whole, seam),
        "step": 100 * seam_step(whole, seam),
        "bone": squared_bone_error(poses[None])[0],
        "skating": skating(poses, asked),
        "early": skating(poses[:early], asked[:early]),
        "adherence": float(adherence(poses[None], asked[None])[0]),
        "depth": 100 * max(0.0, -made.world[..., 1].min()),
    }


def row_of_recording(window: Window) -> dict[str, float]:
    """What can be measured of the recording itself, which was not asked to follow a control."""
    whole = np.concatenate([window.given.positions, window.next])
    seam, early = len(window.given), round(EARLY * FPS)
    steer = np.zeros((len(window.next), 3))
    return {
        "seam": seam_over_motion(whole, seam),
        "past": seam_over_past(whole, seam),
        "step": 100 * seam_step(whole, seam),
        "skating": skating(window.next, steer),
        "early": skating(window.next[:early], steer[:early]),
        "depth": 100 * max(0.0, -window.next[..., 1].min()),
    }


def high(values):
    """The 95th percentile."""
    return np.percentile(values, 95)


KINDS = {
    "seam_over_motion": Kind("ratio", ("seam",), np.median),
    "seam_p95_over_motion": Kind("ratio", ("seam",), high),
    "seam_over_past": Kind("ratio", ("past",), np.median),
    "seam_p95_over_past": Kind("ratio", ("past",), high),
    "seam_step_cm": Kind("cm", ("step",), np.median),
    "seam_step_p95_cm": Kind("cm", ("step",), high),
    "continuation_bone_cm": Kind("cm", ("bone",), root_mean),
    "continuation_skating_mps": Kind("m/s", ("skating",), np.nanmean),
    "continuation_early_skating_mps": Kind("m/s", ("early",), np.nanmean),
    "continuation_adherence_mps": Kind("m/s", ("adherence",), np.nanmean),
    "continuation_floor_cm": Kind("cm", ("depth",), high),
}


def recorded_records(walker: Walker, weights: str, size: RecordedSize, command: str) -> list[dict]:
    """The measures of continuations: `real.` and `real.unblended.`.

    And those of the recordings themselves (`real.recording.`).
    """
    found: dict[str, list] = {}
    sources = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # notes on the files
        for window in windows(size, walker.card["control_range"]):
            sources.append(window.source)
            rows = {one: row_of(window, made) for one, made in continued(walker, window).items()}
            for one, row in (rows | {"real.recording.": row_of_recording(window)}).items():
                found.setdefault(one, []).append(row)
    seeds = {"windows": len(sources)} | amounts(sources) | {"sampling": 0, "steps": STEPS}
    seeds |= {"weights": weights}
    records, persons = [], np.array([person_of(source) for source in sources])
    for prefix, rows in found.items():
        columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
        records += [
            one.as_record(prefix, seeds, command) for one in measures(KINDS, columns, persons)
        ]
    jumped = np.array([row["step"] > 100 * JUMP for row in found["real.unblended."]])
    share = measure_of("blended_share", "share", np.mean, jumped)
    return [*records, share.as_record("real.", seeds, command)]
