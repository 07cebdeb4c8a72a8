"""Links to headings of pages, as JupyterLab finds them.

A page on a code host writes the anchor of "U-Net" as #u-net, in lower case and without
punctuation. JupyterLab takes the heading as it is, with a hyphen for each space: #U-Net.
"""

import re
from collections.abc import Iterable, Mapping

HEADING = re.compile(r"^#{1,6}\s+(.+?)\s*#*$", re.M)
LINK = re.compile(r"\]\(((?:[\w./-]*/)?([\w-]+\.md)?)#([^)\s]+)\)")


def headings(page: str) -> Iterable[str]:
    """The headings of a Markdown page, as they are read: without marks of code and links."""
    without_code = re.sub(r"^```.*?^```", "", page, flags=re.M | re.S)
    for heading in HEADING.findall(without_code):
        yield re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").replace("*", "")


def on_a_host(heading: str) -> str:
    """The anchor that a code host gives a heading, and that our links are written with."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def in_jupyterlab(heading: str) -> str:
    """The anchor that JupyterLab gives it."""
    return heading.replace(" ", "-")


def for_jupyterlab(text: str, pages: Mapping[str, str], own: str = "") -> str:
    """A text whose links to headings of `pages` ({name: Markdown}) are JupyterLab's.

    `own` is the name of the page itself, for links within it. Other links stay.
    """
    known = {
        name: {on_a_host(one): in_jupyterlab(one) for one in headings(page)}
        for name, page in pages.items()
    }

    def changed(link: re.Match) -> str:
        place, name, anchor = link.groups()
        return f"]({place}#{known.get(name or own, {}).get(anchor, anchor)})"

    return LINK.sub(changed, text)
