"""Does the gate of every motion see faults, and only faults? (`motion.formats.joints`)

looked.gate_recall          planted faults of middle strength that are mended or told, mean of kinds
looked.gate_false_alarms    clips without a fault of which something is told all the same
looked.gate.KIND.{weak, middle, strong}   of one kind

Four-second windows of recordings, as their files have them but without a calibration pose, and as
many seconds of synthetic walks, dances and acts. Twelve kinds of faults are planted in each second
clip. A fault that changes nothing is none: a path that is lost, or in another unit, is planted
where there is one, and a joint is held where it would have moved.
"""

import warnings
from collections.abc import Callable, Iterator

import numpy as np
from jaxtyping import Float

from data_synth.actions import clips
from data_synth.dancing import dances
from data_synth.walking import dataset
from motiondiff_edu.motion.directions import complete
from motiondiff_edu.motion.formats.bvh import BvhError, read_bvh
from motiondiff_edu.motion.formats.dialects import guess_mapping
from motiondiff_edu.motion.formats.joints import mended_joints
from motiondiff_edu.motion.kinematics import rot_x, rot_z
from motiondiff_edu.motion.motion import Motion, MotionError
from motiondiff_edu.motion.normalise import pick, to_metres, whole_take
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, HIPS, MIRROR, OFFSETS, PARENTS
from motiondiff_edu.motion.upright import rotate_y_up, which_way_up

from .recordings.windows import trials
from .walks.scores import Measure, measure_of

Points = Float[np.ndarray, "T 21 3"]
Clip = tuple[Points, float]  # and frames a second
Plant = Callable[[Points, float, int, np.random.Generator], Clip]
SECONDS = 4.0
EACH = 14  # windows of a file
SYNTHETIC = 200  # clips
STRENGTHS = ("weak", "middle", "strong")
LIMBS = [3, 7, 14, 15, 18, 19, 12]  # ankles, elbows, wrists, head
LEAST_PATH, LEAST_HELD = 0.5, 0.15  # metres: less is no fault


# ---- faults --------------------------------------------------------------------------------------
def tilted(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """By 20, 45 or 90 degrees, to any side."""
    turn = (rot_x if rng.random() < 0.5 else rot_z)(np.radians((20, 45, 90)[k]))
    return p @ (turn if rng.random() < 0.5 else turn.T), fps


def upside_down(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """Turned about x, about z, or mirrored at the floor."""
    return p * ((1, -1, -1), (-1, -1, 1), (1, -1, 1))[k], fps


def other_unit(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """In feet, inches or centimetres."""
    return p * (3.281, 39.37, 100)[k], fps


def sides_exchanged(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """Of the arms, of all names, or as in a mirror."""
    if k == 0:
        crossed = p.copy()
        crossed[:, 13:17], crossed[:, 17:21] = p[:, 17:21], p[:, 13:17]
        return crossed, fps
    return (p[:, MIRROR] if k == 1 else p * (-1, 1, 1)), fps


def scaled_path(factors: tuple[float, ...], of: tuple[int, int, int]) -> Plant:
    """The path times a factor; `of`: which of its axes."""

    def plant(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
        return p + (factors[k] - 1) * (p[:, :1] - p[:1, :1]) * of, fps

    return plant


def drifting(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """Upwards, by 5, 20 or 50 cm in all."""
    rise = np.linspace(0, (0.05, 0.2, 0.5)[k], len(p))
    return p + rise[:, None, None] * (0, 1, 0), fps


def spike(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """A joint 15 cm, 50 cm or 1.5 m off, for one to three frames."""
    off = rng.standard_normal(3)
    first, frames = int(rng.integers(3, len(p) - 4)), int(rng.integers(1, 4))
    made = p.copy()
    made[first : first + frames, rng.choice(LIMBS)] += (
        (0.15, 0.5, 1.5)[k] * off / np.linalg.norm(off)
    )
    return made, fps


def held(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """A joint that stays in its place for half a second, 1.5 or 3."""
    frames = min(round((0.5, 1.5, 3.0)[k] * fps), len(p) - 1)
    made = p
    for _ in range(8):
        first, joint = int(rng.integers(0, len(p) - frames)), int(rng.choice(LIMBS))
        made = p.copy()
        made[first : first + frames, joint] = p[first, joint]
        if np.abs(made - p).max() > LEAST_HELD:
            break
    return made, fps


def other_rate(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """2, 4 or 8 times too many frames a second, or too few."""
    return p, fps * (2.0, 4.0, 8.0)[k] ** rng.choice([-1.0, 1.0])


def calibration(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """A T-pose for half a second, 2 or 4, and a cut."""
    pose = np.zeros((21, 3))
    for joint in range(1, 21):
        bone = np.array(OFFSETS[joint], float)
        bone /= np.linalg.norm(bone)
        if joint in (14, 15, 16, 18, 19, 20):
            bone = np.array([1.0 if joint < 17 else -1.0, 0, 0])
        pose[joint] = pose[PARENTS[joint]] + BONE_LENGTHS[joint - 1] * bone
    pose += p[0, HIPS] * (1, 0, 1) + (0.5, -pose[:, 1].min(), 0.3)
    frames = round((0.5, 2.0, 4.0)[k] * fps)
    return np.concatenate([np.repeat(pose[None], frames, 0), p]), fps


def collapsing(p: Points, fps: float, k: int, rng: np.random.Generator) -> Clip:
    """A heap of joints in the last frame, the last 5 or 20."""
    n = (1, 5, 20)[k]
    made = p.copy()
    made[-n:] = p[-n - 1, HIPS] * (1, 0, 1) + 0.02 * rng.standard_normal((n, 21, 3))
    return made, fps


FAULTS: dict[str, Plant] = {
    "tilted": tilted,
    "upside_down": upside_down,
    "other_unit": other_unit,
    "sides_exchanged": sides_exchanged,
    "path_in_another_unit": scaled_path((2.54, 10.0, 100.0), (1, 1, 1)),
    "path_lost": scaled_path((0.5, 0.1, 0.0), (1, 0, 1)),
    "drifting": drifting,
    "spike": spike,
    "held_joint": held,
    "other_rate": other_rate,
    "calibration_pose": calibration,
    "collapse": collapsing,
}
ON_A_PATH = ("path_in_another_unit", "path_lost")


# ---- clips ---------------------------------------------------------------------------------------
def recorded() -> Iterator[Clip]:
    """Windows of the joints of BVH files as they are, in metres, y up."""
    for path in trials():
        if path.suffix != ".bvh":
            continue
        try:
            bvh = read_bvh(path)
            names = guess_mapping(bvh)
        except BvhError:  # damaged on purpose, or no human
            continue
        points, rest = pick(bvh.world_positions(), bvh, names), bvh.rest_positions()[None]
        up = which_way_up(points, bvh.fps, pick(rest, bvh, names)[0]).axis
        points, _ = to_metres(rotate_y_up(points, up))
        n = round(SECONDS * bvh.fps)
        for first in list(range(0, max(1, len(points) - n + 1), n))[:EACH]:
            window = complete(points[first : first + n])
            begin, end, _ = whole_take(window, bvh.fps)
            if end - begin > 1.5 * bvh.fps:
                yield window[begin:end], bvh.fps


def synthetic(count: int) -> Iterator[Clip]:
    """Walks, dances and acts of six seconds."""
    for walk in dataset(count * 7 // 20, 6.0, 5):
        yield walk.world(), walk.fps
    for _, made in dances(max(1, count * 3 // 50), 5):
        for first in range(0, len(made) - 119, 120):
            yield made.positions[first : first + 120], made.fps
    for one in clips(count * 7 // 20, 5, seconds=6.0):
        yield one.acted.positions, one.acted.fps


def told(clip: Clip) -> bool:
    """Whether the gate says anything of a clip."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return bool(mended_joints(Motion(*clip), "clip").notes)
    except MotionError:
        return True


def gate_records(command: str, quick: bool) -> list[dict]:
    """All records."""
    every = [*recorded(), *synthetic(SYNTHETIC)]
    every = every[:: 20 if quick else 1]
    alarms = np.array([told(clip) for clip in every], float)
    found: list[Measure] = [measure_of("gate_false_alarms", "share", np.mean, alarms)]
    middles = []
    for kind, plant in FAULTS.items():
        for k, strength in enumerate(STRENGTHS):
            rng = np.random.default_rng([len(kind), k])
            seen = []
            for points, fps in every[::2]:
                way = np.linalg.norm(np.ptp(points[:, HIPS][:, [0, 2]], axis=0))
                if kind not in ON_A_PATH or way > LEAST_PATH:
                    seen.append(float(told(plant(points, fps, k, rng))))
            found.append(measure_of(f"gate.{kind}.{strength}", "share", np.mean, np.array(seen)))
            middles += [found[-1].value] if strength == "middle" else []
    found.append(measure_of("gate_recall", "share", np.mean, np.array(middles)))
    about = {"clips": len(every)}
    return [one.as_record("looked.", about, command) for one in found]
