"""Which verb, or word about a verb, a word stands for: by its forms, its synonyms, or misspelled.

Notebook: 16
"""

from collections.abc import Sequence
from difflib import get_close_matches

from .idioms import FILLERS, HEADS, LIGHT, LIMBS, NUMBERS, PACES, SIDES, WAYS
from .text import base_forms, synonyms

SYNONYMS_SAY = {"get up": "rise", "step back": "back", "move back": "back"}


def head_of(token: str, following: Sequence[str], notes: list[str]) -> str:
    """The verb that a word names, or ""."""
    if token in ("has", "have", "had") and not {*following} & {
        *LIMBS,
        *SIDES,
        "the",
        "his",
        "her",
        "their",
    }:
        return ""
    if (
        token not in HEADS
        and token in FILLERS
        or token in WAYS
        or token in PACES
        or token in SIDES
        or token in NUMBERS
    ):
        return ""
    known = HEADS.get(token) or next(
        (HEADS[form] for form in base_forms(token) if form in HEADS), ""
    )
    if known:
        return known
    for form in (token, *base_forms(token)):
        other = synonyms().get(form, "")
        verb = SYNONYMS_SAY.get(other) or HEADS.get(other, "")
        if verb:
            notes.append(f"{token!r} is read as {other!r}")
            return verb
    if len(token) > 3:
        near = misspelled(token, spelled())
        if near:
            notes.append(f"{token!r} is read as {near!r}")
            return HEADS.get(near) or HEADS[next(f for f in base_forms(near) if f in HEADS)]
    return ""


# words like those of acts that are no slips of them
OTHERS = frozenset(
    "waist crutches movie say says saying sing sings singing sign signs signing paint paints"
    " painting painted push pushing pass passing want wanting willing string strings setting"
    " settings suit fits sick stray tuning rating leaking storing hint hints writing splitting"
    " stating heads black there tree seen first hope able aide site shown passed pushed"
    " listing parsing exists exist careful either sometime handy literally straw".split()
)


def spelled() -> list[str]:
    """The verbs in the forms in which they are written."""
    found = []
    for word in HEADS:
        stem = word.removesuffix("e")
        ending = "es" if word.endswith(("s", "x", "ch", "sh")) else "s"
        found += [word, word + ending, stem + "ing", stem + word[-1] + "ing", stem + "ed"]
    return found


def meant(token: str) -> str:
    """The word that a word about an act stands for, if it is misspelled; else ""."""
    if len(token) < 4:
        return ""
    words = [
        word for word in (*SIDES, *WAYS, *PACES, *NUMBERS, *LIMBS, "times", "down") if len(word) > 3
    ]
    return misspelled(token, words)


def misspelled(token: str, words: Sequence[str]) -> str:
    """Which of these a word is meant to be: one with swapped letters, or a near one; or ""."""
    if token in OTHERS:
        return ""
    swapped = [word for word in words if sorted(word) == sorted(token)]
    near = swapped or get_close_matches(token, words, 1, 0.84)
    return near[0] if near and near[0][0] == token[0] else ""


def is_light(token: str) -> bool:
    """Whether a word is a verb that says nothing by itself, as in "does a jump"."""
    return token in LIGHT or any(form in LIGHT for form in base_forms(token))
