"""Acts on the way: walking, running, backwards, aside, turning and standing.

They are walks of `data_synth.walking` under a control that the words decide.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import gaussian_filter1d

from motiondiff_edu.motion.root_frame import FPS, root_path, to_world
from motiondiff_edu.motion.skeleton import HEELS, TOES

from ..dancing.performance import Toe
from ..noise import white
from ..walking.body import body
from ..walking.footsteps import TOE_AHEAD, Place
from ..walking.styles import STYLES, Style, person
from ..walking.walks import WARM_UP
from .acts import VERBS, Act

SPEEDS = {  # m/s: ahead or, for "aside", to a side
    "walk": {"slowly": 0.65, "": 1.15, "quickly": 1.75},
    "run": {"": 2.5, "quickly": 3.0},
    "back": {"slowly": -0.25, "": -0.48},
    "aside": {"slowly": 0.28, "": 0.5},
}
SHARES = {"neutral": 0.5, "brisk": 0.2, "tired": 0.12, "old": 0.08, "strut": 0.1}  # of styles
TURNS = {"": 90.0, "around": 180.0}  # degrees
TURNING, SLOWEST_TURN = 1.75, 0.8  # rad/s
RISE = (2.6, 1.6, 6.0)  # m/s^2 ahead and aside, rad/s^2
SMOOTH = 0.12  # seconds
SLOW, APART = 0.4, 0.4  # m/s and metres between the toes, where a walk has come to rest
TAIL = 4.5  # seconds without control, within which a walk comes to rest


@dataclass(frozen=True, eq=False)
class Piece:
    """A motion in the world, with its contacts."""

    positions: Float[np.ndarray, "T 21 3"]
    contacts: Bool[np.ndarray, "T 2"]

    def __len__(self) -> int:
        return len(self.positions)


@dataclass(frozen=True)
class Standing:
    """Where a figure stands on both feet: the toes (x, z, direction), left then right."""

    toes: tuple[Toe, Toe]

    @property
    def ankles(self) -> list[Place]:
        """The flat ankles: x, z, direction."""
        return [(x - TOE_AHEAD * np.sin(d), z - TOE_AHEAD * np.cos(d), d) for x, z, d in self.toes]

    @property
    def root(self) -> tuple[float, float, float]:
        """x, z and heading between the feet."""
        (ax, az, a), (bx, bz, b) = self.ankles
        heading = float(np.arctan2(np.sin(a) + np.sin(b), np.cos(a) + np.cos(b)))
        return (ax + bx) / 2, (az + bz) / 2, heading


def walker_of(rng: np.random.Generator) -> Style:
    """A person who does nothing with arms and head but walk."""
    name = str(rng.choice(list(SHARES), p=list(SHARES.values())))
    return replace(person(STYLES[name], rng), behaviours=0.0)


Goal = tuple[float, float, float]  # m/s ahead, m/s left, rad/s
STILL: Goal = (0.0, 0.0, 0.0)


def targets(act: Act, uneven: float, seconds: float) -> list[tuple[Goal, float]]:
    """The commanded velocities of an act, and how long each lasts.

    A turn has its angle, however long it has; if it has very long, the figure stands after it.
    """
    sign = -1.0 if act.side == "right" else 1.0
    if act.verb == "turn":
        angle = np.radians(TURNS[act.direction])
        rate = float(np.clip(angle / seconds, SLOWEST_TURN, TURNING))
        turning = float(angle / rate)
        rest = [(STILL, seconds - turning)] if seconds > turning else []
        return [((0.0, 0.0, sign * rate), turning), *rest]
    if act.verb == "stand":
        return [(STILL, seconds)]
    speed = SPEEDS[act.verb][act.speed] * uneven
    return [((0.0, sign * speed, 0.0) if act.verb == "aside" else (speed, 0.0, 0.0), seconds)]


def least_seconds(act: Act) -> float:
    """How long an act on the way lasts at least; a turn needs the time of its angle."""
    if act.verb == "turn":
        return float(np.radians(TURNS[act.direction]) / TURNING)
    return VERBS[act.verb].period


def control_of(
    goals: list[tuple[Goal, float]], from_rest: bool, to_rest: bool
) -> Float[np.ndarray, "T 3"]:
    """The control of goals that last some seconds each, ramped and smoothed.

    `to_rest`: TAIL seconds without control follow.
    """
    rows = [np.repeat([goal], round(seconds * FPS), 0) for goal, seconds in goals]
    still = np.zeros((round(TAIL * FPS), 3))
    wanted = np.concatenate([*rows, still]) if to_rest else np.concatenate(rows)
    before = np.zeros(3) if from_rest else wanted[0]
    out = np.empty_like(wanted)
    step = np.array(RISE) / FPS
    for t, goal in enumerate(wanted):
        before = before + np.clip(goal - before, -step, step)
        out[t] = before
    if from_rest:
        out = np.concatenate([np.zeros((2, 3)), out])[: len(out)]
    return gaussian_filter1d(out, SMOOTH * FPS, axis=0, mode="nearest")


def walked(
    control: Float[np.ndarray, "T 3"],
    start: tuple[float, float, float] | Standing,
    style: Style,
    seed: int,
    phase: float,
) -> Piece:
    """A walk in the world: on the way from a place (x, z, heading), or from standing feet."""
    standing = start if isinstance(start, Standing) else None
    warm = 0 if standing else WARM_UP
    led = np.concatenate([np.repeat(control[:1], warm, 0), control])
    at = start.root if isinstance(start, Standing) else start
    places = standing.ankles if standing else None
    root_xz, heading = root_path(led, at)
    poses, contacts = body(led, root_xz, heading, white(seed, len(led)), style, phase, FPS, places)
    world = to_world(poses, led, at)[warm:]
    shift = np.array([at[0] - root_xz[warm, 0], 0.0, at[1] - root_xz[warm, 1]])
    return Piece(world + shift, contacts[warm:])


def settled(piece: Piece, least: int) -> int:
    """The first frame from `least` on at which both feet stand, not far apart, and the body slows.

    Whoever walks on would now close the feet, for a second and more; who acts on the spot need not.
    Raises ValueError when there is none.
    """
    both = np.asarray(piece.contacts.all(1))[:-1]
    speed = np.linalg.norm(np.diff(piece.positions[:, 0][:, [0, 2]], axis=0), axis=-1) * FPS
    toes = piece.positions[:-1, list(TOES)]
    near = np.linalg.norm(toes[:, 0] - toes[:, 1], axis=-1) < APART
    rests = both & (speed < SLOW)
    for fit in (rests & near, rests):
        found = np.flatnonzero(fit[least:])
        if len(found):
            return least + int(found[0])
    raise ValueError(f"the walk does not come to rest within {len(piece) / FPS:.1f} s")


def standing_at(piece: Piece, t: int) -> Standing:
    """Where the feet stand at frame t: from ankle and toe joints."""
    toes = []
    for ankle, toe in zip(HEELS, TOES, strict=True):
        ahead = piece.positions[t, toe] - piece.positions[t, ankle]
        x, _, z = piece.positions[t, toe]
        toes.append((float(x), float(z), float(np.arctan2(ahead[0], ahead[2]))))
    left, right = toes
    return Standing((left, right))
