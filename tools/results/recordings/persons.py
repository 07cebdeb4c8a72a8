"""Does a continuation of a recording stay that person's, and is there more than one of it?

One window of each file. For the style all pasts are continued under the same control, so that it
does not give the person away. For the diversity each is continued several times as fast as the
person went, beside pasts of synthetic walks.
"""

import warnings
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from data_synth.walking import drawn_walk
from motiondiff_edu import rollout
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.metrics.distributions import spread
from motiondiff_edu.metrics.walks import gait_style, style_kept
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.motion.skeleton import J
from motiondiff_edu.performers.continuation import Start
from motiondiff_edu.performers.performer import STEPS, generators
from motiondiff_edu.performers.walker import Walker

from ..walks.scores import Measure, measure_of, ratio
from ..walks.trials import UNSEEN
from .continuations import GIVEN, Window, windows
from .windows import SECONDS, RecordedSize, person_of

DRAWS = 5  # continuations of each past, for the diversity
SPEED = 0.9  # m/s, straight on, for the style
LATE = 2.0  # seconds at the end whose style counts


def continuations(
    walker: Walker, starts: Sequence[Start], draws: int
) -> Float[np.ndarray, "N draws n 21 3"]:
    """New frames in the root frame (metres), `draws` of each start; all have the same length."""
    T_h = walker.config.T_h
    past = np.repeat(np.stack([one.past.reshape(T_h, -1) for one in starts]), draws, 0)
    control = np.repeat(np.stack([one.control for one in starts]), draws, 0)
    noise = generators(0, len(past))
    new = rollout.generate(walker, past, control, generator=noise, steps=STEPS)
    return new.double().numpy().reshape(len(starts), draws, -1, J, 3)


def measures_of_persons(walker: Walker, found: Sequence[Window]) -> list[Measure]:
    """`style_kept`, with an interval over persons, and `continuation_diversity_over_synthetic`."""
    T_h, ahead = walker.config.T_h, SECONDS - GIVEN
    same = [Start.of(one.given, constant_control(SPEED, seconds=ahead), T_h) for one in found]
    late = round(LATE * FPS)
    made = [
        gait_style(start.size * start.in_world(new[0])[-late:])
        for start, new in zip(same, continuations(walker, same, 1), strict=True)
    ]
    pasts = [gait_style(one.given.positions) for one in found]
    persons = [person_of(one.source) for one in found]
    kept = style_kept(np.stack(pasts), np.stack(made), persons)
    own = [Start.of(one.given, one.control, T_h) for one in found]
    walks = [
        Motion.of_clip(drawn_walk(SECONDS, np.random.default_rng([UNSEEN, k])))
        for k in range(len(found))
    ]
    given = round(GIVEN * FPS)
    synthetic = [Start.of(one[:given], one.control[given:], T_h) for one in walks]
    spreads = [spread(continuations(walker, starts, DRAWS)) for starts in (own, synthetic)]
    return [
        measure_of("style_kept", "share", np.mean, kept, groups=np.array(persons)),
        measure_of("continuation_diversity_over_synthetic", "ratio", ratio, *spreads),
    ]


def person_records(walker: Walker, weights: str, size: RecordedSize, command: str) -> list[dict]:
    """The records of `measures_of_persons` (`real.`), for a window of each file."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # notes on the files
        found = list(windows(replace(size, each=1), walker.card["control_range"]))
    seeds = {"windows": len(found), "sampling": 0, "steps": STEPS, "weights": weights}
    return [one.as_record("real.", seeds, command) for one in measures_of_persons(walker, found)]
