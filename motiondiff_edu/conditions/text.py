"""Text: the words of a sentence, as a network knows them, and messages about all others.

    "She strolls ahead, 3 times!"  ->  walk  ahead  3  times     "she" is passed over
                                        *strolls* is read as *walk*

A word is taken in its base form (`lemma`). Other words are read as known ones of about the same
meaning, openly, or refused by name; none becomes numbers in silence.
Notebook: 16
"""

import json
import re
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

MOST_WORDS = 64  # words of a text
MOST_PHRASES = 3  # joined by "then", in the texts of the training
EXAMPLES = (  # for messages
    "walk", "run", "step", "turn", "squat", "jump", "kick", "sit", "bow", "wave", "raise", "punch",
    "clap", "point",
)  # fmt: skip
# words that have no further forms: what looks like one is another word
WITHOUT_FORMS = frozenset(
    "a after again ahead and around at back backwards both down first four front half in left low "
    "on once one out over right same sideways still that the then three to together twice two up "
    "while with".split()
)
NOUNS = frozenset(  # these have a plural alone
    "air arm body chair figure fist foot hand knee leg man person shoulder someone woman".split()
)
IRREGULAR = {
    "feet": "foot",
    "men": "man",
    "women": "woman",
    "people": "person",
    "ran": "run",
    "went": "go",
    "stood": "stand",
    "sat": "sit",
    "took": "take",
    "gave": "give",
    "made": "make",
    "got": "get",
    "threw": "throw",
    "bent": "bend",
    "struck": "strike",
    "swung": "swing",
    "held": "hold",
    "brought": "bring",
    "1": "one",
}
# words of captions that name no act: a text needs another one
NO_ACTS = (
    WITHOUT_FORMS
    | NOUNS
    | frozenset("2 3 4 deeply fast gentle pace place quick round seat slow time".split())
)
_FOOT, _HAND = ("foot", "leg"), ("hand", "arm", "fist")
LIMBS = {  # what an act is done with, and words that name something else
    "kick": ("foot", _HAND),
    **dict.fromkeys(("wave", "punch", "point"), ("hand", _FOOT)),
}
# words that may stand between an act and its limb
BETWEEN = frozenset("with the a left right both out up forward once twice two three time".split())
NUMBERS = frozenset("zero five six seven eight nine ten hundred".split())  # no count of training
# words that say nothing about a movement
PASSED_OVER = frozenset(
    "a an the is are was were be being been does do did has have had will would can could should"
    " it its he she they him her them his hers their theirs i me my we us our you your who that"
    " this these those there here of in on at by for from into onto very really just please now so"
    " some any own little bit quite he's she's someone somebody guy lady boy girl dancer actor"
    " character avatar stickman robot human individual".split()
)


class TextError(ValueError):
    """The text cannot be used; the message names the words, and says what to do."""


@dataclass(frozen=True)
class Read:
    """A text as a network gets it: its words, all known, and notes on how others were read.

    `text` is what was read, for the source of a motion. `asked` are the acts that it asks for
    (`sentences.understand`), if they are known.
    """

    text: str
    words: tuple[str, ...]
    notes: tuple[str, ...] = ()
    asked: tuple[tuple[Any, ...], ...] = ()


@cache
def synonyms() -> Mapping[str, str]:
    """Words and the known words that they are read as: derived from WordNet 3.0, read over by hand.

    `tools/synonyms.py` finds the candidates.
    """
    path = Path(__file__).with_name("synonyms.json")
    return json.loads(path.read_text(encoding="utf-8"))["words"]


def words_of(text: str) -> list[str]:
    """The words and numbers of a text, in lower case; also words of other languages."""
    return re.findall(r"[^\W\d_]+(?:'[a-z]+)?|\d+", text.lower())


def lemma(word: str, known: Container[str]) -> str:
    """The base form of a word, if that is known; otherwise the word itself.

    walks, walking and walked are walk; feet are foot.
    """
    if word in known:
        return word
    return next((form for form in base_forms(word) if form in known), word)


def base_forms(word: str) -> Iterator[str]:
    """What a word may be a form of, by the endings -s, -es, -ing, -ed, -d, -ly.

    Toes are no form of *to*, and armed is none of *arm*.
    """
    if word in IRREGULAR:
        yield IRREGULAR[word]
    if word.endswith(("ies", "ied")):
        yield word[:-3] + "y"
    for ending in ("s", "es", "ing", "ed", "d", "ly"):
        stem = word.removesuffix(ending)
        if stem == word or len(stem) < 2:
            continue
        forms = [stem]
        if ending in ("ing", "ed"):
            forms.append(stem + "e")
            if stem[-1] == stem[-2:-1]:
                forms.append(stem[:-1])
        without = WITHOUT_FORMS if ending in ("s", "es") else WITHOUT_FORMS | NOUNS
        yield from (form for form in forms if form not in without)


def base_vocabulary(words: set[str]) -> tuple[str, ...]:
    """The words that are not forms of others among them, in alphabetical order."""
    return tuple(sorted(word for word in words if not any(f in words for f in base_forms(word))))


def read_words(
    text: str, vocabulary: Sequence[str], others: Mapping[str, str] | None = None
) -> Read:
    """The words of a text that a network with this vocabulary can use.

    Base forms are taken, and words without a meaning for movement are passed over. `others` (by
    default `synonyms()`) has words that are read as known ones; the notes say so.
    Raises TextError for a text without a known word or without an act, for unknown words, and for
    more words than MOST_WORDS.
    """
    if not isinstance(text, str):
        raise TextError(f"the text must be a sentence in quotes, not {type(text).__name__}")
    given = words_of(text)
    if not re.search(r"[a-z\d]", text.lower()):
        what = "is empty" if not text.strip() else "has no English words"
        raise empty(what)
    known, others = frozenset(vocabulary), synonyms() if others is None else others
    found: list[str] = []
    notes: list[str] = []
    unknown: list[str] = []
    for word in given:
        base = lemma(word, known)
        if base in known:
            found.append(base)
            continue
        other = others.get(lemma(word, others), "")
        parts = [lemma(part, known) for part in other.split()]
        if parts and known.issuperset(parts):
            found += parts
            notes.append(f"{word!r} is read as {other!r}")
        elif word not in PASSED_OVER:
            unknown.append(word)
    notes += wrong_limbs(found)
    if unknown:
        raise TextError(_unknown(list(dict.fromkeys(unknown)), vocabulary))
    if (phrases := 1 + found.count("then")) > MOST_PHRASES:
        notes.append(
            f"the text has {phrases} phrases with 'then'; the network learnt up to {MOST_PHRASES}, "
            "and may leave acts out"
        )
    if len(found) > MOST_WORDS:
        raise TextError(f"the text has {len(found)} words; the network reads {MOST_WORDS} at most")
    if not found:
        raise TextError(
            f"{text.strip()!r} says nothing about a movement that the network knows; it knows "
            f"{', '.join(vocabulary[:12])} ..."
        )
    if NO_ACTS.issuperset(found) and not NO_ACTS.issuperset(vocabulary):
        known = _acts(vocabulary)
        raise TextError(f"{text.strip()!r:.80} names no act: say what the figure does{known}")
    return Read(text.strip(), tuple(found), tuple(dict.fromkeys(notes)))


def wrong_limbs(words: Sequence[str]) -> Iterator[str]:
    """What to say of acts whose text names a limb that does not do them; none is changed."""
    verb = ""
    for word in words:
        limb, others = LIMBS.get(verb, ("", ()))
        if word in others:
            yield f"the figure does {verb!r} with a {limb}, not with the {word}"
        verb = word if word in LIMBS else verb if word in BETWEEN else ""


def empty(what: str) -> TextError:
    """The error for a text that says nothing; `what` it is or has, such as "is empty"."""
    return TextError(
        f'the text {what}: say what the figure does, such as "walks forward, then waves with the '
        f'left hand"'
    )


def _acts(vocabulary: Sequence[str]) -> str:
    """Some acts of a vocabulary, as the end of a message; "" if it has none of them."""
    verbs = ", ".join(verb for verb in EXAMPLES if verb in vocabulary)
    return f"; it knows {verbs} and others" if verbs else ""


def _nearest(word: str, vocabulary: Sequence[str]) -> list[str]:
    """Known words that may be meant: of about the same letters; for a number the counts."""
    if word in NUMBERS or word.isdigit():
        return [known for known in ("once", "twice", "three", "four") if known in vocabulary]
    bare = (word.removesuffix(ending) for ending in ("", "s", "ing", "ed"))
    found = (
        near
        for form in bare
        for near in get_close_matches(form, vocabulary, 3, 0.75)
        if near[0] == form[0]
    )
    return list(dict.fromkeys(found))[:3]


def _unknown(words: list[str], vocabulary: Sequence[str]) -> str:
    """The message for words that are not known, with the nearest known ones."""
    told, nothing_near = [], True
    for word in words[:5]:
        near = _nearest(word, vocabulary)
        told.append(f"{word!r}" + (f" (did you mean {' or '.join(near)}?)" if near else ""))
        nothing_near &= not near
    more = f" and {len(words) - 5} more" if len(words) > 5 else ""
    known = _acts(vocabulary) if nothing_near else ""
    return (
        f"the network does not know {', '.join(told)}{more}. It was trained on a small vocabulary: "
        f"say it in other words, or leave it out{known}"
    )
