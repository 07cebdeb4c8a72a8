"""The code blocks of the pages in docs, for the tests that run them."""

import re


def fences(root, page: str) -> list[tuple[str, str]]:
    """Every block of a page in order: its language ("" for none), and its text."""
    text = (root / page).read_text(encoding="utf-8")
    return re.findall(r"^```(\w*)\n(.*?)^```$", text, re.M | re.S)


def blocks(root, page: str, language: str) -> list[str]:
    """The blocks of a page in one language; "" for those without."""
    return [code for kind, code in fences(root, page) if kind == language]
