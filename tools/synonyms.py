"""Candidates for the table of synonyms, motiondiff_edu/conditions/synonyms.json, from WordNet 3.0.

    python tools/synonyms.py --wordnet /usr/share/wordnet > candidates.txt

Each line is a word, the known word it may be read as, and a cost: links up and down between their
meanings, and how rare the meanings are. The lines are then read over by hand, and the good ones are
kept in the table; this tool does not write it. WordNet is in Debian's package wordnet-base.
"""

import argparse
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

from data_synth.actions.captions import WORDINGS, base
from motiondiff_edu.conditions.text import PASSED_OVER

MOST = 3.0  # of the cost
LINK, RARE = 1.0, 0.5  # the cost of a link, and of each place of a meaning after the first
UP, DOWN = "@", "~"  # WordNet's marks of more general and of more special meanings
ADVERBS = ("slowly", "quickly", "backwards", "forward", "ahead", "twice", "once")


def meanings(folder: Path, kind: str) -> tuple[dict[str, list[str]], dict[str, dict]]:
    """Of each word its meanings, the usual ones first; of each meaning its words and links."""
    index = {}
    for line in _lines(folder / f"index.{kind}"):
        word, _, count, links, *rest = line.split()
        index[word] = rest[int(links) + 2 :][: int(count)]
    found = {}
    for line in _lines(folder / f"data.{kind}"):
        place, _, _, size, *rest = line.split("|")[0].split()
        n = int(size, 16)
        words = [word.split("(")[0].lower() for word in rest[: 2 * n : 2]]
        pointers = rest[2 * n + 1 : 2 * n + 1 + 4 * int(rest[2 * n])]
        links = [
            (mark, other)
            for mark, other, part, _ in zip(*[iter(pointers)] * 4, strict=True)
            if part == {"verb": "v", "adv": "r"}[kind]
        ]
        found[place] = {"words": words, "links": links}
    return index, found


def _lines(path: Path) -> Iterator[str]:
    for line in path.read_text(encoding="latin-1").splitlines():
        if not line.startswith("  "):  # the licence
            yield line


def candidates(folder: Path, kind: str, known: list[str]) -> dict[str, tuple[float, str]]:
    """For each unknown word, the nearest known one and the cost."""
    index, found = meanings(folder, kind)
    best: dict[str, tuple[float, str]] = {}
    for word in known:
        reached: dict[str, float] = {}
        for place, meaning in enumerate(index.get(word, [])):
            spread(found, meaning, RARE * place, reached)
        for meaning, cost in reached.items():
            for other in found[meaning]["words"]:
                rare = RARE * index[other].index(meaning) if meaning in index.get(other, ()) else 0
                if "_" in other or other in known or cost + rare > MOST:
                    continue
                best[other] = min(best.get(other, (9.0, "")), (cost + rare, word))
    return best


def spread(found: dict, meaning: str, cost: float, reached: dict[str, float]) -> None:
    """The meanings that can be reached by links up and down, each with its least cost."""
    if cost > MOST or cost >= reached.get(meaning, 9.0):
        return
    reached[meaning] = cost
    for mark, other in found[meaning]["links"]:
        if mark in (UP, DOWN):
            spread(found, other, cost + LINK, reached)


def known_verbs() -> list[str]:
    """The base forms of the verbs of the captions; held-out ones are not among them."""
    firsts = {base(one.third) for choices in WORDINGS.values() for one in choices[:-1]}
    return sorted(firsts)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--wordnet", type=Path, default=Path("/usr/share/wordnet"))
    folder = parser.parse_args().wordnet
    by_word = defaultdict(list)
    for kind, known in (("verb", known_verbs()), ("adv", list(ADVERBS))):
        for word, (cost, other) in candidates(folder, kind, known).items():
            if word not in PASSED_OVER:
                by_word[other].append((cost, word))
    for other, words in sorted(by_word.items()):
        for cost, word in sorted(words):
            print(f"{word}\t{other}\t{cost:g}")


if __name__ == "__main__":
    main()
