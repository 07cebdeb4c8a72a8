"""Each word of the glossary is linked once, at its first use in the notebook that explains it."""

import re

import notebook_cells
import pytest

ENTRY = re.compile(r"^### (.+)\n\n(.+?) \[(\d\d)\]\(\.\./notebooks/(.+?\.ipynb)\)$", re.M)
LINK = re.compile(r"\[[^\]]+\]\(\.\./docs/GLOSSARY\.md#([^)]+)\)")


@pytest.fixture(scope="module")
def entries(root):
    """{word: number of its notebook}."""
    text = (root / "docs" / "GLOSSARY.md").read_text("utf-8")
    found = {word: number for word, _, number, _ in ENTRY.findall(text)}
    assert len(found) == text.count("\n### ") > 30
    return found


@pytest.fixture(scope="module")
def texts():
    """{number: the markdown of a notebook}."""
    return {
        path.name[:2]: "\n\n".join(
            cell["source"] for cell in notebook_cells.markdown(notebook_cells.read(path))
        )
        for path in notebook_cells.sources()
    }


def anchor(word: str) -> str:
    return re.sub(r"[^\w\- ]", "", word.lower()).replace(" ", "-")


def test_the_entries_are_in_order_and_different(entries):
    words = list(entries)
    assert words == sorted(words, key=str.lower)
    assert len(set(map(anchor, words))) == len(words)


def test_each_word_is_linked_once_in_the_notebook_that_explains_it(entries, texts):
    wanted = {anchor(word): [number] for word, number in entries.items()}
    linked: dict[str, list[str]] = {}
    for number, text in texts.items():
        for name in LINK.findall(text):
            linked.setdefault(name, []).append(number)
    assert linked == wanted


def test_before_its_link_a_notebook_does_not_use_the_word(entries, texts):
    for word, number in entries.items():
        before = texts[number].split(f"](../docs/GLOSSARY.md#{anchor(word)})", 1)[0]
        # without headings, tables, formulas, code, and lines of the opening that only list
        plain = re.sub(
            r"(?m)^[#|][^\n]*$|^\*\*New here:[^\n]*$|^\*\*It needs[^\n]*$|^\d\. \(\d\d\)[^\n]*$"
            r"|`[^`\n]+`|\$[^$\n]+\$|\[[^\]]*$",
            "",
            before,
        )
        assert not re.search(rf"(?<![\w-]){re.escape(word)}(?![\w-])", plain), (word, number)
