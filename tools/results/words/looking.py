"""What is seen in pictures of generated motions, beside what the recogniser says.

`python -m tools.results.words.looking FOLDER` draws motions of the shipped mover as sheets, without
their captions. Whoever looks at each sheet writes what is performed, in order, into
`looked_at.json`: {"clips": {"17": [["walk", "", 1], ["raise", "left", 2]], ...}}, with the weights
that were looked at, and by whom; "again" has some of the clips, looked at by somebody else.
`looked_at_measures` compares. Sides and counts are as in
`metrics.texts`: what is not counted has the count 1, and a side is "left", "right", "both" or "".
Source: Cohen's kappa (1960), by scikit-learn
"""

import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from sklearn.metrics import cohen_kappa_score

from motiondiff_edu._files import replacing
from motiondiff_edu.beyond import timeline
from motiondiff_edu.metrics.texts import COUNTED, UPLEGS, Recognised, actions
from motiondiff_edu.motion.dance_frame import heading
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.motion.skeleton import HIPS
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.viz import body

from ..walks.parts import weights_digest
from ..walks.scores import Measure, measure_of
from .rows import performed
from .trials import UNSEEN, Positions, unseen

LOOKED_AT = Path(__file__).with_name("looked_at.json")
CLIPS = 100
SEED = UNSEEN + 3
STEPS = 25  # of DDIM: as they were looked at
A_ROW, EVERY = 20, 2  # poses in a row of a sheet; frames from one to the next
SIZE = (150, 230)  # of a pose, in points of the picture
VERBS = tuple(verb for verb in timeline.VERBS if verb != "stand")

Seen = tuple[str, str, int]  # verb, side, count


def motions(mover: Mover) -> list[Positions]:
    """The motions that are looked at."""
    return performed(mover, steps=STEPS)(unseen(CLIPS, seed=SEED), 0)


def sheet(positions: Positions, title: str) -> Figure:
    """Ten poses a second in rows of two seconds, and the path from above, which begins at a dot.

    Arrows on the path say where the hips face, once a second.
    """
    poses = positions[::EVERY]
    rows = -(-len(poses) // A_ROW)
    fig = Figure(figsize=(17.5, 0.4 + 1.25 * rows), layout="constrained")
    left, right = fig.subplots(1, 2, width_ratios=(A_ROW * SIZE[0], 450), squeeze=True)
    for k, pose in enumerate(poses):
        corner = np.array([k % A_ROW * SIZE[0], k // A_ROW * SIZE[1]])
        camera = body.Camera(focal=2.3).at(*pose[HIPS, [0, 2]])
        shapes = [(polygon, "#D5D9DF") for polygon in body.shadow_polygons(pose, camera, SIZE)]
        shapes += [(one, colour) for one, colour, _ in body.body_polygons(pose, camera, SIZE)]
        left.add_collection(
            PolyCollection([one + corner for one, _ in shapes], facecolors=[c for _, c in shapes])
        )
        if k % A_ROW % 10 == 0:
            left.text(*(corner + 12), f"{k * EVERY / FPS:.0f} s", fontsize=7)
    left.set(xlim=(0, A_ROW * SIZE[0]), ylim=(rows * SIZE[1], 0), aspect="equal", title=title)
    path = positions[:, HIPS][:, [0, 2]]
    right.plot(*path.T, color=body.PATH_COLOUR)
    right.plot(*path[:1].T, "o", color=body.PATH_COLOUR)
    left_hip, right_hip = (positions[:: int(FPS), joint] for joint in UPLEGS)
    facing = heading(left_hip - right_hip)
    right.quiver(*path[:: int(FPS)].T, np.sin(facing), np.cos(facing), angles="xy", width=0.008)
    middle = path.mean(0)
    half = max(1.0, np.abs(path - middle).max() + 0.2)
    right.set(xlim=(middle[0] + half, middle[0] - half), ylim=(middle[1] - half, middle[1] + half))
    right.set(aspect="equal", title="path (m), arrows: facing")
    left.set_axis_off()
    return fig


def as_seen(found: Sequence[Recognised]) -> list[Seen]:
    """What the recogniser says, as it is written down for a sheet."""
    return [(one.verb, one.side, one.count if one.verb in COUNTED else 1) for one in found]


def looked_at_measures(mover: Mover, digest: str) -> list[Measure]:
    """Cohen's kappa of eyes and rules: of verbs, of sides, and of counts.

    Verbs: is it there, for every clip and verb. Sides and counts: of the verbs that both found, and
    that have a side or are counted. `twice_kappa`: of two that looked at the same clips.
    There is nothing to compare, and so no measure, if other weights were looked at.
    """
    record = json.loads(LOOKED_AT.read_text())
    if record["weights"] != digest:
        return []
    eyes = [[tuple(one) for one in seen] for _, seen in sorted_clips(record["clips"])]
    rules = [as_seen(actions(one)) for one in motions(mover)]
    found = [*kappas(eyes, rules), *share_the_same(eyes, rules)]
    if again := record.get("again"):
        others = [[tuple(one) for one in seen] for seen in again.values()]
        same = [eyes[int(number)] for number in again]
        found.append(replace(kappas(same, others)[0], name="twice_kappa"))
    return found


def sorted_clips(clips: dict[str, list]) -> list[tuple[int, list]]:
    """Clips by number. Raises ValueError if one is missing."""
    found = sorted((int(number), seen) for number, seen in clips.items())
    if [number for number, _ in found] != list(range(len(found))):
        raise ValueError("looked_at.json: the clips must be numbered 0, 1, 2 ... without a gap")
    return found


def kappas(eyes: Sequence[list[Seen]], rules: Sequence[list[Seen]]) -> list[Measure]:
    """The kappas, each with an interval over clips."""
    clips = np.arange(len(eyes))
    there = np.array([[verbs_of(one) for one in each] for each in (eyes, rules)])
    both = [matched(a, b) for a, b in zip(eyes, rules, strict=True)]
    judged = {1: lambda one: one[1] != "", 2: lambda one: one[0] in COUNTED}

    def of_verbs(chosen: np.ndarray) -> float:
        return kappa(*there[:, chosen].reshape(2, -1))

    def of(which: int, chosen: np.ndarray) -> float:
        pairs = [(a[which], b[which]) for k in chosen for a, b in both[k] if judged[which](a)]
        return kappa(*zip(*pairs, strict=True)) if pairs else np.nan

    return [
        measure_of("kappa", "kappa", of_verbs, clips),
        measure_of("side_kappa", "kappa", partial(of, 1), clips),
        measure_of("count_kappa", "kappa", partial(of, 2), clips),
    ]


def verbs_of(seen: list[Seen]) -> list[bool]:
    """For each verb whether it is there."""
    return [any(verb == one for one, _, _ in seen) for verb in VERBS]


def kappa(first: Sequence, second: Sequence) -> float:
    """Cohen's kappa of two lists of labels; NaN where there is only one label."""
    both = [[str(label) for label in one] for one in (first, second)]
    return float(cohen_kappa_score(*both)) if len({*both[0], *both[1]}) > 1 else np.nan


def matched(eyes: list[Seen], rules: list[Seen]) -> list[tuple[Seen, Seen]]:
    """Pairs of the same verb, in the order in which both have it."""
    return [
        pair
        for verb in VERBS
        for pair in zip(*([s for s in one if s[0] == verb] for one in (eyes, rules)), strict=False)
    ]


def share_the_same(eyes: Sequence[list[Seen]], rules: Sequence[list[Seen]]) -> list[Measure]:
    """The share of clips for which both lists agree in everything, order included."""
    same = np.array([a == b for a, b in zip(eyes, rules, strict=True)])
    return [measure_of("all_the_same", "share", np.mean, same)]


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    weights = checkpoints.available()["mover"]
    for k, positions in enumerate(motions(checkpoints.load(weights))):
        with replacing(folder / f"{k:03d}.png") as aside:
            sheet(positions, f"clip {k}").savefig(aside, dpi=90, format="png")
    print(f"{CLIPS} sheets in {folder}, of the weights {weights_digest(weights)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
