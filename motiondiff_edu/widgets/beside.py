"""Widgets side by side. Where no kernel runs, those that can show themselves without one do."""

import ipywidgets

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
        live = super()._repr_mimebundle_(**kwargs)
        bundle, metadata = live if isinstance(live, tuple) else (live or {}, {})
        parts = "".join(f"<div>{part}</div>" for part in stills(self))
        return {**bundle, **({"text/html": parts} if parts else {})}, metadata


def stills(box: ipywidgets.Box) -> list[str]:
    """The HTML of all widgets in a box, and in the boxes in it, that have any."""
    found = []
    for child in box.children:
        made = child._repr_mimebundle_()
        bundle = made[0] if isinstance(made, tuple) else made or {}
        if "text/html" in bundle:
            found.append(bundle["text/html"])
        elif isinstance(child, ipywidgets.Box):
            found += stills(child)
    return found
