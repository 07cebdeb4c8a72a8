"""Which actions a motion shows, read off by rules, without a network; and what a sentence asks for.

Peaks are counted, sides are told by hands and feet, and travel by the smoothed path of the pelvis.
So a motion can be compared with its sentence where a learnt score is blind: to sides, counts and
order. The rules were fixed before any network was trained on sentences.
Notebook: 17
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import scipy
from jaxtyping import Bool, Float

from ..motion.cleanup import runs
from ..motion.dance_frame import heading
from ..motion.root_frame import FPS
from ..motion.skeleton import BONE_LENGTHS, HIPS, TOES, joint_index
from .bodies import bone_lengths

# ---- actions -------------------------------------------------------------------------------------
SIDES = ("left", "right")
UPLEGS, SHOULDERS, HANDS = (
    tuple(joint_index(f"{side}{name}") for side in ("Left", "Right"))
    for name in ("UpLeg", "Arm", "Hand")
)
SPINE, NECK = joint_index("Spine1"), joint_index("Neck1")
STRANGE = 0.03  # metres: with a larger RMS error of its bones, a motion shows no body


@dataclass(frozen=True)
class Recognised:
    """One action: what it is, and from when to when (seconds).

    `side` is "left", "right", "both" or ""; `direction` "forward", "aside", "around" or "".
    """

    verb: str
    side: str
    count: int
    direction: str
    first: float
    last: float


@dataclass(frozen=True, eq=False)
class Signals:
    """What the rules look at, for every frame; all in metres, seconds, radians.

    `ahead`, `left`, `turning`: the velocity of the pelvis in the frame of the figure, smoothed.
    `hands` (T, 2, 3): from the shoulder to the wrist; to the own side, up, ahead of the chest.
    """

    fps: float
    ahead: Float[np.ndarray, "T"]
    left: Float[np.ndarray, "T"]
    turning: Float[np.ndarray, "T"]
    heading: Float[np.ndarray, "T"]
    pelvis: Float[np.ndarray, "T"]  # height over the floor
    back: Float[np.ndarray, "T"]  # of the pelvis behind the feet
    lean: Float[np.ndarray, "T"]  # of the trunk
    toes: Float[np.ndarray, "T 2"]  # heights
    feet_ahead: Float[np.ndarray, "T 2"]  # of the toes before the pelvis
    hands: Float[np.ndarray, "T 2 3"]
    reach: Float[np.ndarray, "T 2"]  # from shoulder to wrist
    apart: Float[np.ndarray, "T"]  # of the wrists


def actions(positions: Float[np.ndarray, "T 21 3"], fps: float = FPS) -> list[Recognised]:
    """All actions of a motion (metres, world), in the order of their beginnings.

    Standing still is no action. A motion whose bones are not those of the course's figure shows no
    body, and so no action.
    """
    if len(positions) < fps or not np.isfinite(positions).all() or not has_a_body(positions):
        return []
    seen = signals(positions, fps)
    spot = on_the_spot(seen)
    found = [*spot, *on_the_way(seen, spot), *of_the_arms(seen, spot)]
    return sorted(found, key=lambda one: one.first)


def has_a_body(positions: Float[np.ndarray, "T 21 3"]) -> bool:
    """Whether the bones have about the lengths of the course's figure."""
    error = bone_lengths(positions) - BONE_LENGTHS
    return float(np.sqrt(np.mean(error**2))) < STRANGE


def signals(positions: Float[np.ndarray, "T 21 3"], fps: float = FPS) -> Signals:
    """The curves that the rules look at."""

    def smooth(x: np.ndarray, seconds: float) -> np.ndarray:
        return scipy.ndimage.gaussian_filter1d(x, seconds * fps, axis=0, mode="nearest")

    hips = positions[:, UPLEGS[0]] - positions[:, UPLEGS[1]]
    chest = positions[:, SHOULDERS[0]] - positions[:, SHOULDERS[1]]
    facing = np.unwrap(heading(smooth(hips + 0.5 * chest, 0.1)))
    slow = smooth(facing, 0.25)
    path = smooth(positions[:, HIPS][:, [0, 2]], 0.25)
    speed = np.gradient(path, 1 / fps, axis=0)
    ahead = np.stack([np.sin(slow), np.cos(slow)], -1)
    aside = np.stack([np.cos(slow), -np.sin(slow)], -1)
    floor = np.percentile(positions[:, list(TOES), 1], 5)
    toes = smooth(positions[:, list(TOES)], 0.04)
    pelvis = smooth(positions[:, HIPS], 0.06)
    trunk = smooth(positions[:, NECK] - positions[:, HIPS], 0.06)
    forward = np.stack([np.sin(facing), 0 * facing, np.cos(facing)], -1)
    middle = toes.mean(1) - pelvis
    wide = smooth(chest, 0.1)
    wide /= np.linalg.norm(wide, axis=-1, keepdims=True)
    up = smooth(positions[:, NECK] - positions[:, SPINE], 0.06)
    up /= np.linalg.norm(up, axis=-1, keepdims=True)
    front = np.cross(wide, up)
    arms = smooth(positions[:, list(HANDS)] - positions[:, list(SHOULDERS)], 0.04)
    own = np.stack([wide, -wide], 1)
    return Signals(
        fps,
        (speed * ahead).sum(-1),
        (speed * aside).sum(-1),
        np.gradient(slow, 1 / fps),
        facing,
        pelvis[:, 1] - floor,
        (middle * forward).sum(-1),
        np.arctan2(np.linalg.norm(trunk[:, [0, 2]], axis=-1), trunk[:, 1])
        * np.sign((trunk * forward).sum(-1)),
        toes[..., 1] - floor,
        ((toes - pelvis[:, None]) * forward[:, None]).sum(-1),
        np.stack(
            [(arms * own).sum(-1), (arms * up[:, None]).sum(-1), (arms * front[:, None]).sum(-1)],
            -1,
        ),
        np.linalg.norm(arms, axis=-1),
        np.linalg.norm(smooth(positions[:, HANDS[0]] - positions[:, HANDS[1]], 0.04), axis=-1),
    )


# ---- acts of the legs on the spot ----------------------------------------------------------------
LONGEST = {  # seconds from one time of a counted act to the next, at most
    "squat": 2.4,
    "jump": 1.5,
    "kick": 2.4,
    "bow": 3.0,
    "raise": 2.8,
    "punch": 1.6,
    "clap": 1.3,
}
SITS = 0.27  # m: behind its feet, a low pelvis sits; otherwise the figure squats
UPRIGHT = 0.86  # m: as high as this, a pelvis is that of somebody who stands
BESIDE_A_SEAT = 0.5  # seconds before it sits down, and after it gets up
HELD = 1.15  # seconds: for as long an arm is up that is held, and not only raised
UNEVEN = 1.5  # times as long as the shortest, a gap between two times ends a run of them


def on_the_spot(s: Signals) -> list[Recognised]:
    """Squats, jumps, kicks, sitting down, getting up, and bows."""
    slow = scipy.ndimage.maximum_filter1d(np.hypot(s.ahead, s.left), round(s.fps)) < 1.5  # m/s
    found = []
    found += on_a_seat(s)
    low = peaks(-s.pelvis, -0.74, 0.12, s.fps, half=2.6)
    found += repeated_acts("squat", "", {t: x for t, x in low.items() if s.back[t] <= SITS}, s.fps)
    off = peaks(np.minimum(s.toes.min(1), s.pelvis - 0.98), 0.05, 0.04, s.fps)
    for jumps in repeated_acts("jump", "", {t: x for t, x in off.items() if slow[t]}, s.fps):
        first, last = (round(x * s.fps) for x in (jumps.first, jumps.last))
        gone = s.ahead[first : last + 1].sum() / s.fps
        ahead = gone > 0.16 * jumps.count
        found.append(replace(jumps, direction="forward" if ahead else ""))
    for k, side in enumerate(SIDES):
        high = peaks(s.toes[:, k], 0.3, 0.2, s.fps)
        ahead = {t: x for t, x in high.items() if s.feet_ahead[t, k] > 0.3 and slow[t]}
        found += repeated_acts("kick", side, ahead, s.fps)
    bent = peaks(s.lean, np.radians(31.0), np.radians(14.0), s.fps)
    found += repeated_acts("bow", "", {t: x for t, x in bent.items() if s.pelvis[t] > 0.85}, s.fps)
    return found


def on_a_seat(s: Signals) -> list[Recognised]:
    """Sitting down and getting up: who is low behind the feet for a while sits.

    A figure that sits at first does not sit down, and one that sits at last does not get up.
    """
    found = []
    for first, last in runs_over_gaps((s.pelvis < 0.74) & (s.back > SITS), 0.3 * s.fps):
        if last - first < 0.3 * s.fps:
            continue
        above = np.flatnonzero(s.pelvis > UPRIGHT)
        for verb, beside in (("sit", above[above < first][-1:]), ("rise", above[above >= last])):
            if len(beside):
                ends = sorted((int(beside[0]), first if verb == "sit" else last))
                found.append(Recognised(verb, "", 1, "", ends[0] / s.fps, ends[1] / s.fps))
    return found


def peaks(
    curve: Float[np.ndarray, "T"], least: float, rise: float, fps: float, half: float = 0.8
) -> dict[int, tuple[float, float]]:
    """Maxima of at least `least` that rise by `rise` over what is beside them.

    The frame of each, and where it begins and ends, in seconds, at most `half` away.
    """
    edge = np.concatenate([[curve.min()], curve, [curve.min()]])  # a maximum may be the last frame
    at, _ = scipy.signal.find_peaks(
        edge, height=least, prominence=rise, distance=max(1, round(0.25 * fps))
    )
    begin, end = scipy.signal.peak_widths(edge, at, rel_height=0.9)[2:]
    middle = at[:, None] - 1
    ends = np.stack([begin, end], -1) - 1
    times = np.clip(ends, middle - half * fps, middle + half * fps) / fps
    times = np.clip(times, 0, len(curve) / fps)
    return {int(t) - 1: tuple(pair) for t, pair in zip(at, times.tolist(), strict=True)}


def repeated_acts(
    verb: str, side: str, at: dict[int, tuple[float, float]], fps: float
) -> list[Recognised]:
    """Runs of times of one act: those that follow one another evenly, and soon."""
    found: list[list[int]] = []
    for t in at:
        if found:
            gaps = np.diff([*found[-1], t]) / fps
            if gaps[-1] <= LONGEST[verb] and gaps[-1] <= UNEVEN * gaps.min():
                found[-1].append(t)
                continue
        found.append([t])
    return [Recognised(verb, side, len(r), "", at[r[0]][0], at[r[-1]][1]) for r in found]


# ---- acts of the legs on the way -----------------------------------------------------------------
def on_the_way(s: Signals, spot: list[Recognised]) -> list[Recognised]:
    """Walking, running, going backwards or aside, and turning."""
    state = np.full(len(s.ahead), "", dtype="<U12")
    travels = np.abs(s.left) > np.abs(s.ahead)
    state[s.ahead > 0.36] = "walk"
    state[s.ahead > 2.05] = "run"
    state[(s.ahead < -0.15) & ~travels] = "back"
    state[(s.left > 0.16) & travels] = "aside left"
    state[(s.left < -0.16) & travels] = "aside right"
    turns = (np.abs(s.turning) > 0.6) & (s.ahead < 1.9)
    state[turns & (s.turning > 0)] = "turn left"
    state[turns & (s.turning < 0)] = "turn right"
    state[frames_with(spot, s)] = ""
    for one in spot:
        if one.verb in ("sit", "rise"):  # which move the pelvis to and fro
            around = (one.first - BESIDE_A_SEAT) * s.fps, (one.last + BESIDE_A_SEAT) * s.fps
            state[max(0, round(around[0])) : round(around[1])] = ""
    found = []
    for word in ("walk", "run", "back", "aside left", "aside right", "turn left", "turn right"):
        verb, _, side = word.partition(" ")
        for first, last in runs_over_gaps(state == word, 0.3 * s.fps):
            seconds = (last - first) / s.fps
            if verb == "turn":
                beside = slice(max(0, first - round(0.3 * s.fps)), last + round(0.3 * s.fps))
                angle = np.ptp(s.heading[beside])
                if angle < np.radians(45.0):
                    continue
                direction = "around" if angle > np.radians(135.0) else ""
            elif seconds < 0.8:
                continue
            else:
                direction = ""
            found.append(Recognised(verb, side, 1, direction, first / s.fps, last / s.fps))
    return without_passages(found)


def frames_with(acts: list[Recognised], s: Signals) -> Bool[np.ndarray, "T"]:
    """The frames of these acts."""
    mask = np.zeros(len(s.ahead), bool)
    for one in acts:
        mask[round(one.first * s.fps) : round(one.last * s.fps) + 1] = True
    return mask


def runs_over_gaps(mask: Bool[np.ndarray, "T"], gap: float) -> list[tuple[int, int]]:
    """Runs of True, where gaps of up to `gap` frames count as True."""
    found: list[tuple[int, int]] = []
    for first, last in runs(mask).tolist():
        if found and first - found[-1][1] <= gap:
            first = found.pop()[0]
        found.append((first, last))
    return found


def without_passages(found: list[Recognised]) -> list[Recognised]:
    """Without the short walks within which a figure begins or ends to run."""
    running = [one for one in found if one.verb == "run"]

    def passage(one: Recognised) -> bool:
        near = any(one.last > run.first - 0.2 and one.first < run.last + 0.2 for run in running)
        return one.verb == "walk" and near and one.last - one.first < 1.3

    return [one for one in found if not passage(one)]


# ---- acts of the arms ----------------------------------------------------------------------------
def of_the_arms(s: Signals, spot: list[Recognised]) -> list[Recognised]:
    """Waving, raising, holding up, punching, clapping and pointing.

    Jumps, kicks and bows have movements of the arms of their own; nothing but an arm that is held
    up is looked for there.
    """
    free = np.ones(len(s.ahead), bool)
    for one in spot:
        if one.verb in ("jump", "kick", "bow"):
            free[max(0, round((one.first - 0.2) * s.fps)) : round((one.last + 0.4) * s.fps)] = False
    busy = frames_with([one for one in spot if one.verb in ("squat", "sit", "rise")], s)
    out, up, front = np.moveaxis(s.hands, -1, 0)
    found = []
    rising = np.gradient(up, 1 / s.fps, axis=0)
    forth = np.gradient(front, 1 / s.fps, axis=0)
    alike = np.abs(forth[:, 0] - forth[:, 1]) < 0.8  # m/s: the arms of a runner are not
    near = peaks(-s.apart, -0.22, 0.2, s.fps)
    near = {t: x for t, x in near.items() if front[t].min() > 0.27 and free[t] and alike[t]}
    found += repeated_acts("clap", "", near, s.fps)
    claps = frames_with(found, s)
    level = (s.reach > 0.44) & (np.abs(up) < 0.34)
    raised = held_up(up > 0.38, s.fps)
    found += raised
    held_by = [frames_with([one for one in raised if one.side in (side, "both")], s)
               for side in SIDES]  # fmt: skip
    high = [
        {t: x for t, x in peaks(up[:, k], 0.38, 0.2, s.fps).items() if free[t] and not own[t]}
        for k, own in enumerate(held_by)
    ]
    both = {t: x for t, x in high[0].items() if any(abs(t - u) < 0.3 * s.fps for u in high[1])}
    paired = [u for u in high[1] if any(abs(t - u) < 0.3 * s.fps for t in both)]
    found += repeated_acts("raise", "both", both, s.fps)
    for k, side in enumerate(SIDES):
        alone = {t: x for t, x in high[k].items() if t not in (*both, *paired)}
        found += repeated_acts("raise", side, alone, s.fps)
        other = 1 - k
        shows = free & (s.reach[:, k] > 0.47) & (np.abs(up[:, k]) < 0.24) & ~claps
        for direction, ahead in (("forward", front), ("aside", out)):
            alone = shows & (ahead[:, k] > 0.4) & ~(level[:, other] & (ahead[:, other] > 0.3))
            for first, last in runs_over_gaps(alone, 0.2 * s.fps):
                # who squats or sits holds the arms ahead for a moment
                least = 1.25 if busy[first:last].any() else 0.75
                if last - first >= least * s.fps:
                    times = first / s.fps, last / s.fps
                    found.append(Recognised("point", side, 1, direction, *times))
        held = [one for one in found if one.verb == "point" and one.side == side]
        swings = peaks(front[:, other], 0.3, 0.1, s.fps)  # of the other arm, beside it
        reach_back = round(0.8 * s.fps)
        hits = {
            t: x
            for t, x in peaks(front[:, k], 0.40, 0.15, s.fps).items()
            if free[t]
            and not claps[t]
            and not any(abs(t - u) < 0.3 * s.fps for u in swings)
            and abs(up[t, k]) < 0.3
            and abs(rising[t, k]) < 0.8
            and s.reach[max(0, t - reach_back) : t + reach_back, k].min() < 0.45
            and not any(one.first - 0.2 < t / s.fps < one.last + 0.2 for one in held)
        }
        found += repeated_acts("punch", side, hits, s.fps)
    return [*found, *of_both_sides(waves(s, 0, free), waves(s, 1, free))]


def held_up(high: Bool[np.ndarray, "T 2"], fps: float) -> list[Recognised]:
    """Arms that stay up."""
    each = [
        [
            Recognised("hold", side, 1, "", first / fps, last / fps)
            for first, last in runs_over_gaps(high[:, k], 0.1 * fps)
            if last - first >= HELD * fps
        ]
        for k, side in enumerate(SIDES)
    ]
    return of_both_sides(*each)


def of_both_sides(left: list[Recognised], right: list[Recognised]) -> list[Recognised]:
    """The acts of two arms; two of which most is at one time are one act of both."""
    found = []
    for one in left:
        for other in right:
            first, last = max(one.first, other.first), min(one.last, other.last)
            if last - first > 0.5 * max(one.last - one.first, other.last - other.first):
                right = [x for x in right if x != other]
                times = min(one.first, other.first), max(one.last, other.last)
                one = Recognised(one.verb, "both", one.count, one.direction, *times)
                break
        found.append(one)
    return [*found, *right]


def waves(s: Signals, k: int, free: Bool[np.ndarray, "T"]) -> list[Recognised]:
    """A hand beside the head with the elbow bent, that swings out and in."""
    out, up, _ = np.moveaxis(s.hands[:, k], -1, 0)
    beside = free & (up > 0.08) & (out > 0.1) & (s.reach[:, k] < 0.46)
    found = []
    for first, last in runs_over_gaps(beside, 0.25 * s.fps):
        swing = np.diff(out[first:last])
        changes = int((np.diff(np.sign(swing)) != 0).sum())
        if last - first >= 0.8 * s.fps and changes >= 2 and np.ptp(out[first:last]) > 0.05:
            found.append(Recognised("wave", SIDES[k], 1, "", first / s.fps, last / s.fps))
    return found


COUNTED = frozenset(("squat", "jump", "kick", "bow", "raise", "punch", "clap"))
DIRECTED = frozenset(("turn", "jump", "point"))  # around, forward, to the side, or none


@dataclass(frozen=True)
class Asked:
    """One act of a sentence; standing is not asked for, because it is no action."""

    verb: str
    side: str = ""
    count: int = 1
    direction: str = ""


Phrases = Sequence[Sequence[Asked]]


@dataclass(frozen=True)
class Agreement:
    """The shares of one motion that are right, from 0 to 1; NaN where nothing can be right.

    action     acts found, over the acts asked for or the recognised ones, whichever are more
    side       of the acts found that have a side: with this side
    count      of the acts found that are counted: exactly so often
    order      of the pairs of acts in different phrases, both found: in the order of the phrases
    direction  of the turns, jumps and pointing arms found: around or not, forward, to the side
    whole      1 if all of that is right and nothing else is shown, otherwise 0
    """

    action: float
    side: float
    count: float
    order: float
    direction: float
    whole: float


KINDS = tuple(one.name for one in fields(Agreement))


def agreement(phrases: Phrases, found: Sequence[Recognised]) -> Agreement:
    """Match each act of a sentence with one recognised action; the same side and count go first.

    Who sits gets up before anything else, so getting up need not be asked for. A jump without a
    direction may go ahead.
    """
    if not any(act.verb == "rise" for phrase in phrases for act in phrase):
        found = [one for one in found if one.verb != "rise"]
    matched, _ = _matched(phrases, found)
    most = max(sum(len(phrase) for phrase in phrases), len(found))
    middles = [(k, (one.first + one.last) / 2) for k, _, one in matched]
    shares = (
        len(matched) / most if most else np.nan,
        _share([one.side == act.side for _, act, one in matched if act.side]),
        _share([one.count == act.count for _, act, one in matched if act.verb in COUNTED]),
        _share([a < b for i, a in middles for j, b in middles if i < j]),
        _share(
            [
                one.direction == act.direction
                for _, act, one in matched
                if act.verb in DIRECTED and (act.verb, act.direction) != ("jump", "")
            ]
        ),
    )
    return Agreement(*shares, float(all(share == 1 or np.isnan(share) for share in shares)))


def shortfalls(phrases: Phrases, found: Sequence[Recognised]) -> list[str]:
    """What is asked for and not to be seen, in words; nothing where all is.

    Acts, their sides and counts, their directions, and the order of the phrases. Standing is no
    action, and a count of 0 says nothing. A jump without a direction may go anywhere, and an arm
    that is raised once may stay up.
    """
    asked = [[act for act in phrase if act.verb != "stand"] for phrase in phrases]
    matched, more = _matched(asked, found)
    shown = [act for _, act, _ in matched]
    words = []
    for phrase in asked:
        for act in phrase:
            if act in shown:
                shown.remove(act)
                continue
            held = [one for one in more if one.verb == "hold" and act.side in ("", one.side)]
            if act.verb == "raise" and act.count <= 1 and held:
                more = [one for one in more if one is not held[0]]
                continue
            words.append(f"{told(act)} is not to be seen")
    for _, act, one in matched:
        if act.side and one.side != act.side:
            words.append(f"{told(act)} is to be seen on the {one.side} side")
        elif act.verb in COUNTED and act.count and one.count != act.count:
            words.append(f"{told(act)} is to be seen {one.count} times, and not {act.count}")
        elif act.verb in DIRECTED and one.direction != act.direction != "":
            words.append(f"{told(act)} is to be seen in another direction")
    middles = [(k, act, (one.first + one.last) / 2) for k, act, one in matched]
    words += [
        f"{told(late)} comes before {told(early)}"
        for i, early, a in middles
        for j, late, b in middles
        if i < j and a > b
    ]
    return words


def told(act: Asked) -> str:
    """An act in a message: its verb, and its side."""
    names = {"back": "walk backwards", "aside": "step aside", "hold": "arm up", "rise": "get up"}
    name = names.get(act.verb, act.verb)
    return f"{name!r} ({act.side})" if act.side else f"{name!r}"


def _matched(
    phrases: Phrases, found: Sequence[Recognised]
) -> tuple[list[tuple[int, Asked, Recognised]], list[Recognised]]:
    """The acts that are shown, as (phrase, asked, recognised), and what else is recognised."""
    acts = [(k, act) for k, phrase in enumerate(phrases) for act in phrase]
    left = list(found)
    matched = []
    for k, act in sorted(acts, key=lambda pair: -_specific(pair[1], found)):
        same = [one for one in left if one.verb == act.verb]
        if same:
            best = max(same, key=lambda one: (one.side == act.side, one.count == act.count))
            left.remove(best)
            matched.append((k, act, best))
    return matched, left


def _specific(act: Asked, found: Sequence[Recognised]) -> int:
    """How well the best recognised action fits: acts that fit exactly choose first."""
    same = [one for one in found if one.verb == act.verb]
    return max(((one.side == act.side) + (one.count == act.count) for one in same), default=-1)


def _share(right: list[bool]) -> float:
    return float(np.mean(right)) if right else np.nan


def rows_of(
    sentences: Sequence[Phrases], found: Sequence[Sequence[Recognised]]
) -> dict[str, Float[np.ndarray, "N"]]:
    """The agreement of many motions, an array for each kind."""
    every = [agreement(phrases, one) for phrases, one in zip(sentences, found, strict=True)]
    return {kind: np.array([getattr(one, kind) for one in every]) for kind in KINDS}


def confusion(
    sentences: Sequence[Phrases], found: Sequence[Sequence[Recognised]]
) -> dict[tuple[str, str], int]:
    """How often an asked side was recognised as which, of acts with one side, by (asked, found).

    "both": it is shown on the asked side and on the other one, too. "none": it is not shown.
    """
    table: Counter[tuple[str, str]] = Counter()
    for phrases, recognised in zip(sentences, found, strict=True):
        matched, more = _matched(phrases, recognised)
        asked = [act for phrase in phrases for act in phrase if act.side in SIDES]
        for _, act, one in matched:
            if act.side in SIDES:
                asked.remove(act)
                shown = {one.side, *(other.side for other in more if other.verb == act.verb)} - {""}
                both = "both" in shown or len(shown) > 1
                table[act.side, "both" if both else next(iter(shown), "none")] += 1
        table.update((act.side, "none") for act in asked)
    return dict(table)
