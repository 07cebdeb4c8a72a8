"""Widgets side by side. Where no kernel runs, those that can show themselves without one do."""

import ipywidgets

from .still import split, with_still

NARROWEST = "1 1 440px"  # equal shares of the row, from so many pixels on


class Beside(ipywidgets.HBox):
    """A row of widgets; what has no room goes on in the next row.  Notebook: 00"""

    def __init__(self, *widgets: ipywidgets.Widget):
        super().__init__(list(widgets))
        self.layout.flex_flow = "row wrap"
        self.layout.align_items = "flex-start"
        for widget in widgets:
            widget.layout.flex = NARROWEST

    def _repr_mimebundle_(self, **kwargs):
        parts = "".join(f"<div>{part}</div>" for part in stills(self))
        still = {"text/html": parts} if parts else {}
        return with_still(super()._repr_mimebundle_(**kwargs), still)


def stills(box: ipywidgets.Box) -> list[str]:
    """The HTML of all widgets in a box, and in the boxes in it, that have any."""
    found = []
    for child in box.children:
        bundle, _ = split(child._repr_mimebundle_())
        if "text/html" in bundle:
            found.append(bundle["text/html"])
        elif isinstance(child, ipywidgets.Box):
            found += stills(child)
    return found
