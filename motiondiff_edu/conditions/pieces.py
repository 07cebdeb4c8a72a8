"""A piece of a sentence without "then" and "while", read word by word.

A verb takes the words about it that stand after it, and those before it that lead to it. Words that
say nothing about a movement are passed over; what is left is named.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from .acts import KINDS, ONE, Act
from .heads import Head, acts_of, number_of, say_of, take
from .idioms import (
    ADDRESSED,
    FILLERS,
    HEADS,
    LIMBS,
    NUMBERS,
    PACES,
    SIDES,
    THINGS,
    TOWARDS,
    WAYS,
    WHOSE,
)
from .text import base_forms
from .verbs import head_of, is_light, meant


def acts_in(text: str, notes: list[str]) -> list[tuple[Head, Act]]:
    """The acts of a piece, in their order; what there is to say of it is added to `notes`."""
    piece = Piece(re.findall(r"[a-z]+(?:[-'][a-z]*)*|\d+|,", text), notes)
    for k, token in enumerate(piece.tokens):
        any(way(k, token) for way in (piece.held, piece.joint, piece.verb, piece.again, piece.word))
    piece.give_back()
    for one, later in reversed(list(pairwise(piece.heads))):  # "jab, jab with the left"
        if one.verb == later.verb and later.joined == ",":
            one.side = one.side or later.side
    acts = [act for head in piece.heads for act in acts_of(head, notes)]
    piece.name_unknown()
    return acts


@dataclass
class Piece:
    """A piece while it is read; each way to take a word says whether it did.

    before   what was said since the last verb, of a verb to come
    joined   "and" or "," if one stands between the last act and the next word
    unknown  words that are not understood, and `subject` those of who does it
    """

    tokens: list[str]
    notes: list[str]
    heads: list[Head] = field(default_factory=list)
    before: Head = field(default_factory=lambda: Head("", ""))
    joined: str = ""
    unknown: list[str] = field(default_factory=list)
    subject: list[str] = field(default_factory=list)

    def begin(self, head: Head) -> bool:
        """Take a verb; what comes next is said of it."""
        self.heads.append(head)
        self.before, self.joined = Head("", ""), ""
        return True

    def held(self, k: int, token: str) -> bool:
        """An arm that is held up ("hold-left"), or how long something takes."""
        if token == "so-long":
            self.notes.append("how long an act takes is left out: `seconds` is for all of them")
            return True
        if not token.startswith("hold-"):
            return False
        self.give_back()
        one = token.removeprefix("hold-")
        side = one if one in ONE else "both" if one else "right"
        return self.begin(Head("hold", token, "ing", side, ways=["up"], limbs=["arm"]))

    def joint(self, k: int, token: str) -> bool:
        """A comma or "and"."""
        if token not in (",", "and"):
            return False
        self.joined = "," if "," in (token, self.joined) else "and"
        self.give_back()
        if not self.heads:
            self.subject = []  # "juggles and walks": what comes before "and" was no subject
        self.before = Head("", "")
        return True

    def verb(self, k: int, token: str) -> bool:
        """A verb, or the last one named again."""
        verb = head_of(token, self.tokens[k + 1 : k + 2], self.notes)
        if not verb or token in THINGS and self.tokens[max(k - 1, 0)] in ("a", "the"):
            return False  # "picks up a box"
        if self.heads and named_again(verb, self.heads[-1], self.tokens[:k], self.joined):
            say_of(self.heads[-1], self.before)
            self.before = Head("", "")
            return True
        participle = token.endswith("ing") and self.joined != "and"
        head = Head(verb, token, "ing" if participle else self.joined)
        if plural(self.tokens, k) or goes_on(verb, self.tokens, k):
            head.count, head.vague = 2, True
        say_of(head, self.before)
        return self.begin(head)

    def again(self, k: int, token: str) -> bool:
        """The last verb on its next side: "punches left, right, left", "lifts an arm, waves it"."""
        row = k > 0 and self.tokens[k - 1] in ONE  # "left right left"
        if not self.heads or not (self.joined or row or token == "it"):
            return False
        last = self.heads[-1]
        if token == "it" and last.verb == "wave" and len(self.heads) > 1:
            last.side = last.side or self.heads[-2].side
            return True
        if token in ONE and not leads(self.tokens, k) and next_side(last):
            times = self.before.count or last.count
            return self.begin(replace(last, side=token, joined=self.joined, count=times))
        if last.count and self.joined and number_of(token):
            return take(self.before, token, self.tokens, k)  # "twice left, once right"
        return False

    def word(self, k: int, token: str) -> bool:
        """A word about an act, one that says nothing, or one that is not understood."""
        target = self.before if leads(self.tokens, k) or not self.heads else self.heads[-1]
        if take(target, token, self.tokens, k) or token in FILLERS or is_light(token):
            return True
        near = meant(token)
        if near:
            self.notes.append(f"{token!r} is read as {near!r}")
            return take(target, near, self.tokens, k)
        if not addressed(self.tokens, k, self.heads):
            self.unknown.append(token)
            does = any(is_light(one) for one in self.tokens[:k])  # "does a roundhouse kick"
            if not (self.heads or does or token.endswith("ing") or token == "i-mean"):
                self.subject.append(token)
        return True

    def give_back(self) -> None:
        """Words that no verb came after belong to the verb before them."""
        more = self.before
        up = bool(more.limbs) and "up" in more.ways
        if up and not self.heads:  # "arms up"
            self.heads.append(replace(more, verb="hold"))
        elif up and KINDS.get(self.heads[-1].verb, KINDS["walk"]).part != "arms":
            self.heads.append(replace(more, verb="hold", joined="ing"))
        elif self.heads:
            say_of(self.heads[-1], more)
        self.before = Head("", "")

    def name_unknown(self) -> None:
        """Say which words are not understood; what stands before the first verb is who does it."""
        # "a knight bows", and not "karate kick"
        does = bool(self.heads) and self.heads[0].word.endswith(("s", "ing", "ed"))
        who = self.subject if does or self.heads and self.tokens[0] in WHOSE else []
        words = [word for word in self.unknown if word not in who]
        if words:
            left = "not understood, and left out" if self.heads else "not understood"
            named = [repr(word.replace("-", " ")) for word in dict.fromkeys(words)]
            self.notes.append(f"{left}: {', '.join(named)}")


def next_side(head: Head) -> bool:
    """Whether a verb that has its side already is done again with the next one that is named."""
    sideways = head.verb == "walk" and "aside" in head.ways
    return head.side in ONE and (sideways or head.verb in KINDS and KINDS[head.verb].sides == ONE)


def plural(tokens: Sequence[str], k: int) -> bool:
    """Whether a verb is a noun in the plural: "does squats", "quick punches"."""
    before = list(tokens[:k])
    quick = bool(before) and before[-1] in PACES and not before[-1].endswith("ly")
    while before and before[-1] in (*SIDES, *PACES, "some"):
        before.pop()
    return tokens[k].endswith("s") and (quick or bool(before) and is_light(before[-1]))


def goes_on(verb: str, tokens: Sequence[str], k: int) -> bool:
    """Whether somebody is at something that is done several times: "is jumping"."""
    during = tokens[max(k - 1, 0)] in ("is", "are", "was", "were", "be", "been")
    return verb in ("jump", "punch") and tokens[k].endswith("ing") and during


def named_again(verb: str, last: Head, before: Sequence[str], joined: str) -> bool:
    """Whether a word names the act of the last verb: "greets her with a wave", "goes two steps"."""
    while before and before[-1] in (*SIDES, *PACES, *WAYS, "very"):
        before = before[:-1]
    if last.verb == verb in ("turn", "wave") and not joined:  # "turns around to face him"
        return True
    if last.verb == verb == "walk":
        return bool(before) and (
            before[-1] in ("a", "one") or before[-1] in NUMBERS or before[-1].isdigit()
        )
    return last.verb == verb and tuple(before[-2:]) in (("with", "a"), ("in", "a"))


def addressed(tokens: Sequence[str], k: int, heads: Sequence[Head]) -> bool:
    """Whether a word says at whom somebody waves, bows, claps or points."""
    if not heads or heads[-1].verb not in ADDRESSED:
        return False
    before = list(tokens[:k])
    while before and before[-1] in WHOSE:
        before.pop()
    return bool(before) and before[-1] in TOWARDS


def leads(tokens: Sequence[str], k: int) -> bool:
    """Whether a word belongs to a verb after it: nothing but such words lie between."""
    for token in tokens[k + 1 :]:
        if token.startswith("hold-") or token in ("and", ",", "with", "to", "the", "of"):
            return False
        if (
            token in SIDES
            or token in NUMBERS
            or token in PACES
            or token.isdigit()
            or token in ("a", "an", "very", "times", "quick")
        ):
            continue
        if token in WAYS or token in LIMBS:
            return False
        return bool(HEADS.get(token) or any(form in HEADS for form in base_forms(token)))
    return False
