"""Perform a sentence: acts in a row and at once, by one figure, with the truth of what is when."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from motiondiff_edu.motion.root_frame import FPS

from ..dancing.curves import least_jerk
from ..walking.footsteps import TOE_AHEAD
from . import arms, spot, way
from .acts import FACTORS, UNEVEN, VERBS, Act, Phrase, Sentence, seated
from .join import crossfade
from .way import Piece, Standing

JOIN = 0.4  # seconds of a join
STOPPING = {"run": 1.7, "walk": 1.1}  # seconds that an act on the way needs to come to rest
OTHERS_STOP = 1.0
STAND, STAY = Act("stand"), Act(spot.STAY)
WHILE_IT_LASTS = ("wave", "point", "hold")  # acts of the arms that fill their phrase
SITS = (0.5, 1.4)  # seconds that a figure stays on a chair at least
CARRIED = {"run": 0.26, "walk": 0.14}  # metres that a jump goes on after it
TRIES = 8  # each with more time for the stops


@dataclass(frozen=True)
class Span:
    """When an act happens, in seconds of the clip."""

    first: float
    last: float
    act: Act


@dataclass(frozen=True, eq=False)
class Acted:
    """World positions (metres), true contacts (left, right), and when each act happens."""

    positions: Float[np.ndarray, "T 21 3"]
    contacts: Bool[np.ndarray, "T 2"]
    spans: tuple[Span, ...]
    sentence: Sentence
    seed: int
    fps: float = FPS

    def __len__(self) -> int:
        return len(self.positions)


@dataclass(frozen=True)
class Slot:
    """A phrase with its duration and the periods of its acts, in seconds.

    `otherwise` is what the legs do, if nothing is said of them: they stand, or stay on the chair.
    `wait`: seconds before an act on the spot that is the first of a clip.
    """

    phrase: Phrase
    seconds: float
    legs_period: float = 0.0  # of an act on the spot
    arms_period: float = 0.0
    otherwise: Act = STAND
    wait: float = 0.0

    @property
    def legs(self) -> Act:
        return self.phrase.legs or self.otherwise

    @property
    def kind(self) -> str:
        return "spot" if self.legs == STAY else VERBS[self.legs.verb].kind


Start = tuple[float, float, float]  # x, z (metres) and heading (radians) of a figure on its way


def act_out(sentence: Sentence, seconds: float, seed: int) -> Acted:
    """A clip of `seconds` in which a figure does what the sentence says.

    The same seed gives the same bytes; other seeds give other right motions.
    Raises ValueError for an empty sentence, and for one that does not fit into the clip.
    """
    late = 0.0
    for _ in range(TRIES):
        acted, over = _performed(sentence, seconds, late, seed)
        if over <= 0:
            return acted
        late += max(over, 0.2) + 0.05  # the feet stop at steps, not at any time
    raise ValueError(f"the sentence does not end within the {seconds:g} s of the clip")


def _performed(sentence: Sentence, seconds: float, late: float, seed: int) -> tuple[Acted, float]:
    """The clip, and how many seconds after its end the last act ends.

    `late`: seconds that the stops take beyond what is expected.
    """
    rng = np.random.default_rng([seed, 11])
    sentence_done = with_rises(sentence)
    slots = scheduled(sentence_done, seconds, late, rng)
    style = way.walker_of(rng)
    frames = round(seconds * FPS)
    blocks = _blocks(slots)
    made, at = None, 0
    spans: list[Span] = []
    state: Start | Standing = (0.0, 0.0, 0.0)
    sits = seated(sentence_done)[0]
    for k, block in enumerate(blocks):
        room = frames - at if k == len(blocks) - 1 else None
        if block[0].kind == "way":
            piece, cut, inner = _on_the_way(block, state, style, rng, room, seed + 101 * k)
            if room is None:
                state = way.standing_at(piece, cut)
        else:
            standing = state if isinstance(state, Standing) else _first_stand(style, rng)
            carried = CARRIED.get(blocks[k - 1][-1].legs.verb, 0.0) if k else 0.0
            # none of the feet leaves the floor in a join
            rest = JOIN - spot.on_the_floor(block[0].legs, block[0].legs_period) if k else 0.0
            begins = max(0.05, rest), carried
            piece, cut, inner, state = _on_the_spot(block, standing, room, seed, begins, sits)
        sits = False
        spans += [Span(at / FPS + first, at / FPS + end, act) for first, end, act in inner]
        made = piece if made is None else _joined(made, piece, at)
        at += cut
    assert made is not None  # a sentence has a block
    timed = _arms(slots, spans, rng)
    ends = [span.last for span in spans if VERBS[span.act.verb].kind == "spot"]
    over = max([0.0, *ends, *(one.last for one in timed)]) - seconds
    positions = arms.laid_over(made.positions[:frames], timed, seed)
    spans += [Span(one.first, one.last, one.act) for one in timed]
    spans.sort(key=lambda span: span.first)
    kept = tuple(replace(span, last=min(span.last, seconds)) for span in spans)
    return Acted(positions, made.contacts[:frames], kept, sentence, seed), over


def with_rises(sentence: Sentence) -> Sentence:
    """The sentence in which a seated figure gets up before its legs do something else."""
    made: list[Phrase] = []
    for phrase, sits in zip(sentence, seated(sentence), strict=False):
        if sits and phrase.legs is not None and phrase.legs.verb != "rise":
            made.append(Phrase(Act("rise")))
        made.append(phrase)
    return tuple(made)


def otherwise(sentence: Sentence) -> list[Act]:
    """What the legs do in each phrase, if nothing is said of them."""
    return [STAY if sits else STAND for sits in seated(sentence)]


def stops(sentence: Sentence) -> float:
    """Seconds that the figure needs in all to come to rest before acts on the spot."""
    legs = [
        (phrase.legs or other).verb
        for phrase, other in zip(sentence, otherwise(sentence), strict=False)
    ]
    return sum(
        STOPPING.get(a, OTHERS_STOP)
        for a, b in zip(legs, legs[1:], strict=False)
        if a in VERBS and VERBS[a].kind == "way" and VERBS[b].kind == "spot"
    )


def scheduled(
    sentence: Sentence, seconds: float, late: float, rng: np.random.Generator
) -> list[Slot]:
    """How long each phrase lasts; what is left over goes to the phrases on the way, or before and
    after the acts on the spot.

    Raises ValueError for an empty sentence, and for one that does not fit into the clip.
    """
    if not sentence:
        raise ValueError("a sentence needs a phrase at least")
    others = otherwise(sentence)
    slots = [_slot(phrase, other, rng) for phrase, other in zip(sentence, others, strict=False)]
    left = seconds - sum(slot.seconds for slot in slots) - stops(sentence) - late
    if left < 0:
        raise ValueError(
            f"the sentence needs {seconds - left:.1f} s, and the clip has {seconds:g} s"
        )
    elastic = [k for k, s in enumerate(slots) if s.kind == "way" and s.legs.verb != "turn"]
    if not elastic:
        wait = float(left * rng.uniform(0.05, 0.6))
        if slots[0].kind == "spot":
            return [replace(slots[0], wait=wait), *slots[1:]]
        return [Slot(Phrase(STAND), wait), *slots] if wait > 0.3 else slots
    if others[-1] == STAY:  # who sits at the end sits for a while
        share = float(rng.uniform(0.2, 0.6))
        left *= 1 - share
    if others[0] == STAY:
        wait = float(left * rng.uniform(0.05, 0.4))
        slots[0], left = replace(slots[0], wait=wait), left - wait
    shares = rng.dirichlet(np.full(len(elastic), 3.0))
    for k, share in zip(elastic, shares, strict=True):
        slots[k] = replace(slots[k], seconds=slots[k].seconds + float(left * share))
    return slots


def _slot(phrase: Phrase, other: Act, rng: np.random.Generator) -> Slot:
    """The least duration of a phrase, and the period of its acts."""
    legs = phrase.legs or other
    legs_period = arms_period = need = 0.0
    if legs == STAY:
        pass
    elif VERBS[legs.verb].kind == "spot":
        legs_period = period_of(legs, rng)
        need = legs.count * legs_period
        if legs.verb == "sit":
            need += float(rng.uniform(*SITS))
    else:
        need = way.least_seconds(legs)
    if phrase.arms is not None:
        arms_period = period_of(phrase.arms, rng)
        lasts = phrase.arms.count * arms_period
        if phrase.arms.verb in WHILE_IT_LASTS:
            lasts = max(lasts, VERBS[phrase.arms.verb].period)  # a quick wave is no shorter one
        need = max(need, lasts + arms.FADE)
    return Slot(phrase, need, legs_period, arms_period, other)


def period_of(act: Act, rng: np.random.Generator) -> float:
    """Seconds of one time of an act: by its speed, never by its count."""
    return VERBS[act.verb].period * FACTORS[act.speed] * float(1 + rng.uniform(-UNEVEN, UNEVEN))


def _blocks(slots: list[Slot]) -> list[list[Slot]]:
    """Slots in a row of one kind."""
    blocks: list[list[Slot]] = []
    for slot in slots:
        if blocks and blocks[-1][0].kind == slot.kind:
            blocks[-1].append(slot)
        else:
            blocks.append([slot])
    return blocks


def _first_stand(style, rng: np.random.Generator) -> Standing:
    """Where the feet stand at first: the toes."""
    out = np.radians(style.toe_out)
    half = float(rng.uniform(0.075, 0.11))
    return Standing(((half, TOE_AHEAD, out), (-half, TOE_AHEAD, -out)))


def _on_the_way(block: list[Slot], state, style, rng, room: int | None, seed: int):
    """(piece, frame at which the next block begins, spans within the block)."""
    from_rest = isinstance(state, Standing)
    goals, inner = [], []
    at = 0.0
    for slot in block:
        own = way.targets(slot.legs, float(rng.uniform(0.92, 1.08)), slot.seconds)
        goals += own
        if slot.phrase.legs is not None:
            lasts = own[0][1] if slot.legs.verb == "turn" else slot.seconds
            inner.append((at, at + lasts, slot.legs))
        at += slot.seconds
    if room is not None:  # the last block fills the clip; after a turn the figure stands
        spare = max(0.0, room / FPS - at) + 0.2
        goal = way.STILL if block[-1].legs.verb == "turn" else goals[-1][0]
        goals.append((goal, spare))
    control = way.control_of(goals, from_rest, to_rest=room is None)
    piece = way.walked(control, state, style, seed, float(rng.random()))
    if room is not None:
        return piece, room, inner
    cut = way.settled(piece, round((at - 0.1) * FPS))
    inner = [(first, min(end, cut / FPS), act) for first, end, act in inner]
    return piece, cut, inner


def _on_the_spot(
    block: list[Slot], standing: Standing, room: int | None, seed: int,
    begins: tuple[float, float], sits: bool,
):  # fmt: skip
    """(piece, frame at which the next block begins, spans within it, where the feet stand).

    `begins`: seconds after the block at which the first act begins, and metres that it is carried.
    """
    timed: list[spot.Timed] = []
    at, carried = begins
    for slot in block:
        at += slot.wait
        timed.append(spot.Timed(slot.legs, at, slot.legs_period, 0.0 if timed else carried))
        at = timed[-1].last + max(0.0, slot.seconds - slot.legs.count * slot.legs_period)
    seconds = (room / FPS if room is not None else at) + JOIN + 0.2
    piece, after = spot.acted(timed, standing, seconds, seed, sits)
    inner = [(one.first, one.last, one.act) for one in timed if one.act != STAY]
    return piece, int(np.ceil(at * FPS)), inner, after


def _joined(made: Piece, piece: Piece, at: int) -> Piece:
    """The motion so far until `at`, faded into the next piece, whose frame 0 is frame `at`.

    Both feet stand in frame `at`, and are then those of the next piece.
    """
    n = min(round(JOIN * FPS) + 1, len(made) - at, len(piece))
    share = least_jerk(np.arange(n) / max(n - 1, 1))
    before, after = made.positions[at : at + n], piece.positions[:n]
    mixed = crossfade(before, after, share)
    return Piece(
        np.concatenate([made.positions[:at], mixed, piece.positions[n:]]),
        np.concatenate([made.contacts[:at], piece.contacts]),
    )


def _arms(slots: list[Slot], spans: list[Span], rng) -> list[arms.TimedArms]:
    """The acts of the arms at the times of their phrases."""
    timed, clock = [], 0.0
    legs = iter(spans)
    for slot in slots:
        span = next(legs) if slot.phrase.legs is not None else None
        first = span.first if span else clock + slot.wait
        clock = span.last if span else first + slot.seconds
        if slot.kind == "spot" or slot.legs.verb == "turn":  # a phrase may last longer than its act
            clock = max(clock, first + slot.seconds)
        act = slot.phrase.arms
        if act is None:
            continue
        own = slot.arms_period
        spare = max(0.0, clock - first - act.count * own - arms.FADE)
        begins = first + 0.5 * arms.FADE + spare * float(rng.uniform(0.1, 0.8))
        ends = begins + act.count * own
        if act.verb in WHILE_IT_LASTS:
            begins = first + 0.5 * arms.FADE
            ends = clock - 0.5 * arms.FADE
        timed.append(arms.TimedArms(act, begins, own, ends))
    return timed
