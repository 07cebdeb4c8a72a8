"""Captions: several wordings of one sentence, and the same with left and right exchanged.

    a person walks forward while waving with the left hand, then kicks twice with the right foot

Wordings differ in the verb, the place of the adverbs, the subject, and the order of the phrases.
One wording of every verb is held out: it never occurs unless it is asked for.
"""

import re
from dataclasses import dataclass

import numpy as np

from .acts import OTHER_SIDE, VERBS, Act, Phrase, Sentence


@dataclass(frozen=True)
class Wording:
    """A verb in the third person and as a gerund, with what follows it.

    `{side}` and `{limb}` stand for the words of the act.
    """

    third: str
    gerund: str
    tail: str = ""


def _w(third: str, gerund: str, tail: str = "") -> Wording:
    return Wording(third, gerund, tail)


# verb and direction -> wordings; the last one is held out
WORDINGS: dict[tuple[str, str], tuple[Wording, ...]] = {
    ("walk", ""): (
        _w("walks", "walking", "forward"),
        _w("walks", "walking", "ahead"),
        _w("strolls", "strolling", "forward"),
        _w("strides", "striding", "ahead"),
        _w("ambles", "ambling", "forward"),
    ),
    ("run", ""): (
        _w("runs", "running", "forward"),
        _w("runs", "running"),
        _w("jogs", "jogging", "ahead"),
        _w("races", "racing", "forward"),
        _w("sprints", "sprinting", "ahead"),
    ),
    ("back", ""): (
        _w("walks", "walking", "backwards"),
        _w("steps", "stepping", "back"),
        _w("goes", "going", "backwards"),
        _w("moves", "moving", "back"),
        _w("retreats", "retreating"),
    ),
    ("aside", ""): (
        _w("steps", "stepping", "to the {side}"),
        _w("sidesteps", "sidestepping", "to the {side}"),
        _w("moves", "moving", "sideways to the {side}"),
        _w("goes", "going", "to the {side} side"),
        _w("shuffles", "shuffling", "to the {side}"),
    ),
    ("turn", ""): (
        _w("turns", "turning", "{side}"),
        _w("turns", "turning", "to the {side}"),
        _w("makes", "making", "a {side} turn"),
        _w("rotates", "rotating", "to the {side}"),
        _w("pivots", "pivoting", "to the {side}"),
    ),
    ("turn", "around"): (
        _w("turns", "turning", "around to the {side}"),
        _w("turns", "turning", "half round over the {side} shoulder"),
        _w("rotates", "rotating", "around to the {side}"),
        _w("makes", "making", "a half turn to the {side}"),
        _w("pivots", "pivoting", "around to the {side}"),
    ),
    ("stand", ""): (
        _w("stands", "standing", "still"),
        _w("stands", "standing"),
        _w("waits", "waiting"),
        _w("stays", "staying", "in place"),
        _w("pauses", "pausing"),
    ),
    ("squat", ""): (
        _w("squats", "squatting"),
        _w("squats", "squatting", "down"),
        _w("squats", "squatting", "low"),
        _w("bends", "bending", "the knees deeply"),
        _w("crouches", "crouching"),
    ),
    ("jump", ""): (
        _w("jumps", "jumping"),
        _w("jumps", "jumping", "up"),
        _w("hops", "hopping", "with both feet"),
        _w("leaps", "leaping", "up"),
        _w("springs", "springing", "up"),
    ),
    ("jump", "forward"): (
        _w("jumps", "jumping", "forward"),
        _w("jumps", "jumping", "ahead"),
        _w("hops", "hopping", "forward with both feet"),
        _w("leaps", "leaping", "forward"),
        _w("springs", "springing", "forward"),
    ),
    ("kick", ""): (
        _w("kicks", "kicking", "with the {side} foot"),
        _w("kicks", "kicking", "with the {side} leg"),
        _w("swings", "swinging", "the {side} foot up in a kick"),
        _w("gives", "giving", "a kick with the {side} leg"),
        _w("strikes", "striking", "out with the {side} foot"),
    ),
    ("sit", ""): (
        _w("sits", "sitting", "down and gets up again"),
        _w("sits", "sitting", "down and stands up"),
        _w("takes", "taking", "a seat and gets up"),
        _w("sits", "sitting", "on a chair and stands up"),
        _w("settles", "settling", "on a chair and rises"),
    ),
    ("bow", ""): (
        _w("bows", "bowing"),
        _w("takes", "taking", "a bow"),
        _w("bends", "bending", "forward"),
        _w("leans", "leaning", "the body forward"),
        _w("stoops", "stooping"),
    ),
    ("wave", ""): (
        _w("waves", "waving", "with the {side} hand"),
        _w("waves", "waving", "the {side} hand"),
        _w("waves", "waving", "the {side} arm"),
        _w("greets", "greeting", "with the {side} hand"),
        _w("signals", "signalling", "with the {side} hand"),
    ),
    ("raise", ""): (
        _w("raises", "raising", "{limb}"),
        _w("lifts", "lifting", "{limb}"),
        _w("puts", "putting", "{limb} up"),
        _w("reaches", "reaching", "up with {limb}"),
        _w("stretches", "stretching", "{limb} upwards"),
    ),
    ("punch", ""): (
        _w("punches", "punching", "with the {side} hand"),
        _w("punches", "punching", "with the {side} fist"),
        _w("throws", "throwing", "a punch with the {side} hand"),
        _w("hits", "hitting", "the air with the {side} fist"),
        _w("jabs", "jabbing", "with the {side} hand"),
    ),
    ("clap", ""): (
        _w("claps", "clapping"),
        _w("claps", "clapping", "the hands"),
        _w("claps", "clapping", "both hands together"),
        _w("brings", "bringing", "the hands together in a clap"),
        _w("applauds", "applauding"),
    ),
    ("point", "forward"): (
        _w("points", "pointing", "forward with the {side} hand"),
        _w("points", "pointing", "ahead with the {side} arm"),
        _w("shows", "showing", "ahead with the {side} hand"),
        _w("holds", "holding", "the {side} arm out in front"),
        _w("gestures", "gesturing", "ahead with the {side} hand"),
    ),
    ("point", "aside"): (
        _w("points", "pointing", "to the {side}"),
        _w("points", "pointing", "sideways with the {side} arm"),
        _w("shows", "showing", "to the side with the {side} hand"),
        _w("holds", "holding", "the {side} arm out to the side"),
        _w("gestures", "gesturing", "to the side with the {side} hand"),
    ),
}
SUBJECTS = ("a person", "someone", "a figure", "the person", "a man", "a woman", "")
TIMES = {
    1: ("", "", "", "once", "one time"),
    2: ("twice", "two times"),
    3: ("three times", "3 times"),
    4: ("four times", "4 times"),
}
ADVERBS = {
    "slowly": ("slowly", "at a slow pace", "without hurry"),
    "quickly": ("quickly", "fast", "at a quick pace"),
}
ONE_WORD = ("slowly", "quickly")  # adverbs that may stand before the verb


def caption(sentence: Sentence, rng: np.random.Generator, held_out: bool = False) -> str:
    """One wording of the sentence; with `held_out`, by verbs that no other caption uses."""
    subject = str(rng.choice(SUBJECTS))
    parts = [_phrase(phrase, rng, held_out) for phrase in sentence]
    return f"{subject} {_in_order(parts, rng)}".strip()


def act_words(act: Act, rng: np.random.Generator, held_out: bool) -> tuple[str, str]:
    """An act in the third person, and as a gerund, with its adverbs."""
    choices = WORDINGS[act.verb, act.direction]
    wording = choices[-1] if held_out else choices[int(rng.integers(len(choices) - 1))]
    limb = "both arms" if act.side == "both" else f"the {act.side} arm"
    tail = wording.tail.format(side=act.side, limb=limb)
    times = str(rng.choice(TIMES[act.count])) if VERBS[act.verb].most > 1 else ""
    speed = str(rng.choice(ADVERBS[act.speed])) if act.speed else ""
    before = ""
    if speed in ONE_WORD and rng.random() < 0.4:
        before, speed = speed, ""
    after = [tail, times, speed]
    if times and speed and rng.random() < 0.5:
        after = [tail, speed, times]
    if times and tail.startswith("with ") and rng.random() < 0.4:
        after = [times, tail, speed]
    third, gerund = (
        " ".join(word for word in (before, verb, *after) if word)
        for verb in (wording.third, wording.gerund)
    )
    return third, gerund


def _phrase(phrase: Phrase, rng: np.random.Generator, held_out: bool) -> tuple[str, str]:
    """What happens at one time, in both forms."""
    words = [act_words(act, rng, held_out) for act in phrase.acts]
    if len(words) == 1:
        return words[0]
    first, second = words if rng.random() < 0.7 else words[::-1]
    third = f"{first[0]} while {second[1]}"
    if rng.random() < 0.3:
        third = f"{first[0]} and at the same time {second[0]}"
    return third, f"{first[1]} while {second[1]}"


def _in_order(parts: list[tuple[str, str]], rng: np.random.Generator) -> str:
    """Phrases in a row, in one of several orders of words."""
    if len(parts) == 1:
        return parts[0][0]
    thirds = [third for third, _ in parts]
    if len(parts) == 2:
        form = int(rng.integers(4))
        if form == 2:
            return f"{thirds[1]} after {parts[0][1]}"
        if form == 3:
            return f"first {thirds[0]}, then {thirds[1]}"
        return f"{thirds[0]}{(', then ', ' and then ')[form]}{thirds[1]}"
    then = [str(rng.choice([", then ", " and then ", ", after that "])) for _ in parts[1:]]
    text = thirds[0]
    for join, third in zip(then, thirds[1:], strict=True):
        text += join + third
    return text


def exchanged(text: str) -> str:
    """The words left and right exchanged."""
    return re.sub(r"\b(left|right)\b", lambda found: OTHER_SIDE[found[0]], text)


def vocabulary(held_out: bool = False) -> set[str]:
    """All words of the captions, in lower case; with `held_out` also those of held-out verbs."""
    texts = [*SUBJECTS, *sum(TIMES.values(), ()), *sum(ADVERBS.values(), ())]
    texts.append(
        "left right both arms the arm while at the same time first then and after that get knee"
    )
    for choices in WORDINGS.values():
        for one in choices if held_out else choices[:-1]:
            texts += [one.third, one.gerund, base(one.third), one.tail.format(side="", limb="")]
    return {word for text in texts for word in words_of(text)}


def base(third: str) -> str:
    """The base form of a verb in the third person: walk of walks, punch of punches."""
    return third[:-2] if third.endswith(("ches", "shes", "oes")) else third.removesuffix("s")


def words_of(text: str) -> list[str]:
    """The words and numbers of a text, in lower case."""
    return re.findall(r"[a-z]+|\d+", text.lower())
