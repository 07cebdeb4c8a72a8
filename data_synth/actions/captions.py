"""Captions: several wordings of one sentence, and the same with left and right exchanged.

    a person walks forward while waving with the left hand, then kicks twice with the right foot

Wordings differ in the verb, the place of the adverbs, the subject, and the order of the phrases.
One wording of every verb is held out: it never occurs unless it is asked for.
Each choice has a name and depends on it and a number alone. So two sentences that differ in one
thing have captions that differ in this alone, if they are worded by the same number.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from zlib import crc32

import numpy as np

from .acts import OTHER_SIDE, VERBS, Act, Phrase, Sentence


@dataclass(frozen=True)
class Wording:
    """A verb in the third person and as a gerund, with what follows it.

    `{side}`, `{hand}` and `{limb}` stand for the words of the act: left, the left hand, the left
    arm; or both, both hands, both arms.
    """

    third: str
    gerund: str
    tail: str = ""


_w = Wording


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
        _w("sits", "sitting", "down"),
        _w("sits", "sitting", "down on a chair"),
        _w("takes", "taking", "a seat"),
        _w("sits", "sitting"),
        _w("settles", "settling", "on a chair"),
    ),
    ("rise", ""): (
        _w("gets", "getting", "up"),
        _w("stands", "standing", "up"),
        _w("gets", "getting", "up from the chair"),
        _w("stands", "standing", "up from a chair"),
        _w("rises", "rising"),
    ),
    ("bow", ""): (
        _w("bows", "bowing"),
        _w("takes", "taking", "a bow"),
        _w("bends", "bending", "forward"),
        _w("leans", "leaning", "the body forward"),
        _w("stoops", "stooping"),
    ),
    ("wave", ""): (
        _w("waves", "waving", "with {hand}"),
        _w("waves", "waving", "{hand}"),
        _w("waves", "waving", "{limb}"),
        _w("greets", "greeting", "with {hand}"),
        _w("signals", "signalling", "with {hand}"),
    ),
    ("raise", ""): (
        _w("raises", "raising", "{limb}"),
        _w("lifts", "lifting", "{limb}"),
        _w("puts", "putting", "{limb} up"),
        _w("reaches", "reaching", "up with {limb}"),
        _w("stretches", "stretching", "{limb} upwards"),
    ),
    ("hold", ""): (
        _w("holds", "holding", "{limb} up"),
        _w("keeps", "keeping", "{limb} raised"),
        _w("holds", "holding", "{limb} in the air"),
        _w("keeps", "keeping", "{limb} up"),
        _w("has", "having", "{limb} overhead"),
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
    2: ("twice", "two times", "2 times"),
    3: ("three times", "3 times"),
    4: ("four times", "4 times"),
}
ADVERBS = {
    "slowly": ("slowly", "at a slow pace", "at a gentle pace"),
    "quickly": ("quickly", "fast", "at a quick pace"),
}
HELD = ("with {limb} raised", "with {limb} up", "with {limb} in the air")
ONE_WORD = ("slowly", "quickly")  # adverbs that may stand before the verb


@dataclass(frozen=True)
class Choices:
    """Choices by name: each depends on its name and the number, whatever else is chosen."""

    number: int

    def share(self, name: str) -> float:
        """A number from 0 up to 1."""
        return np.random.default_rng([self.number, crc32(name.encode())]).random()

    def one(self, name: str, options: Sequence[str]) -> str:
        """One of the options."""
        return options[int(self.share(name) * len(options))]


def caption(sentence: Sentence, rng: np.random.Generator, held_out: bool = False) -> str:
    """A random wording of the sentence; with `held_out`, by verbs that no other caption uses."""
    return worded_by(sentence, int(rng.integers(2**31)), held_out)


def worded_by(sentence: Sentence, number: int, held_out: bool = False) -> str:
    """The wording with this number."""
    chosen = Choices(number)
    parts = [_phrase(phrase, chosen, held_out) for phrase in sentence]
    return f"{chosen.one('subject', SUBJECTS)} {_in_order(parts, chosen)}".strip()


def act_words(act: Act, chosen: Choices, held_out: bool) -> tuple[str, str]:
    """An act in the third person, and as a gerund, with its adverbs."""
    choices = WORDINGS[act.verb, act.direction]
    taken = int(chosen.share(act.verb) * (len(choices) - 1))
    wording = choices[-1 if held_out else taken]
    times = chosen.one(f"{act.verb} times", TIMES[act.count]) if VERBS[act.verb].most > 1 else ""
    speed = chosen.one(f"{act.verb} speed", ADVERBS[act.speed]) if act.speed else ""
    limb = "both arms" if act.side == "both" else f"the {act.side} arm"
    hand = "both hands" if act.side == "both" else f"the {act.side} hand"
    before = ""
    if speed in ONE_WORD and chosen.share(f"{act.verb} before") < 0.4:
        before, speed = speed, ""
    place = chosen.share(f"{act.verb} place")
    forms = []
    for verb in (wording.third, wording.gerund):
        tail = wording.tail.format(side=act.side, limb=limb, hand=hand)
        after = [tail, times, speed]
        if times and speed and place < 0.5:
            after = [tail, speed, times]
        if times and tail.startswith("with ") and place > 0.6:
            after = [times, tail, speed]
        forms.append(" ".join(word for word in (before, verb, *after) if word))
    return forms[0], forms[1]


def _phrase(phrase: Phrase, chosen: Choices, held_out: bool) -> tuple[str, str]:
    """What happens at one time, in both forms."""
    words = [act_words(act, chosen, held_out) for act in phrase.acts]
    if len(words) == 1:
        return words[0]
    first, second = words if chosen.share("which first") < 0.7 else words[::-1]
    if phrase.arms is not None and phrase.arms.verb == "hold" and not held_out:
        arms = phrase.arms
        limb = "both arms" if arms.side == "both" else f"the {arms.side} arm"
        held = chosen.one("held", (*HELD, ""))
        if held:
            third, gerund = (f"{form} {held.format(limb=limb)}" for form in words[0])
            return third, gerund
    third = f"{first[0]} while {second[1]}"
    if chosen.share("at once") < 0.3:
        third = f"{first[0]} and at the same time {second[0]}"
    return third, f"{first[1]} while {second[1]}"


def _in_order(parts: list[tuple[str, str]], chosen: Choices) -> str:
    """Phrases in a row, in one of several orders of words."""
    if len(parts) == 1:
        return parts[0][0]
    thirds = [third for third, _ in parts]
    if len(parts) == 2:
        form = int(4 * chosen.share("order"))
        if form == 2:
            return f"{thirds[1]} after {parts[0][1]}"
        if form == 3:
            return f"first {thirds[0]}, then {thirds[1]}"
        return f"{thirds[0]}{(', then ', ' and then ')[form]}{thirds[1]}"
    text = thirds[0]
    for k, third in enumerate(thirds[1:]):
        text += chosen.one(f"join {k}", (", then ", " and then ", ", after that ")) + third
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
            texts += [one.third, one.gerund, base(one.third)]
            texts.append(one.tail.format(side="", limb="", hand="hands"))
    return {word for text in texts for word in words_of(text)}


def base(third: str) -> str:
    """The base form of a verb in the third person: walk of walks, punch of punches."""
    return third[:-2] if third.endswith(("ches", "shes", "oes")) else third.removesuffix("s")


def words_of(text: str) -> list[str]:
    """The words and numbers of a text, in lower case."""
    return re.findall(r"[a-z]+|\d+", text.lower())
