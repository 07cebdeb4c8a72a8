"""Sliders for a function that draws a figure: each change draws the figure again."""

import ipywidgets

from ..viz.style import as_html
from . import states
from .controls import steering
from .live import TURN
from .still import with_still


class Explored(ipywidgets.VBox):
    """A figure with its controls. Where pages are made, it also has a few states as HTML."""

    still = ""

    def _repr_mimebundle_(self, **kwargs):
        still = {"text/html": self.still} if self.still else {}
        return with_still(super()._repr_mimebundle_(**kwargs), still)


def explore(draw, **start) -> Explored:
    """Show draw(**values) with a control for each argument, and a button that resets them all.

        explore(draw, s=(1, 100, 50), name=["linear", "cosine"], noise=True)
    (low, high, start) gives a slider, a list gives choices, True or False gives a tick box. `draw`
    returns a matplotlib Figure, whose label becomes the picture's alternative text. Errors in
    `draw` are raised.
    Raises ValueError for an argument of another kind.
    """
    picture = ipywidgets.HTML()

    def refresh(**values):
        with TURN:  # pyplot has one current figure
            picture.value = as_html(draw(**values), dpi=90)

    controls = steering(refresh, **start)
    box = Explored([controls, picture])
    if states.making_pages():
        values = {name: _values(control) for name, control in controls.controls.items()}
        box.still = states.as_page(lambda at: as_html(draw(**at), dpi=80), values, controls.first)
    return box


def _values(control: ipywidgets.Widget) -> list:
    """The values that a control can have; of a slider nine, and the one it has."""
    if isinstance(control, ipywidgets.Checkbox):
        return [False, True]
    if isinstance(control, ipywidgets.Dropdown):
        return list(control.options)
    whole = isinstance(control, ipywidgets.IntSlider)
    steps = [control.min + (control.max - control.min) * i / 8 for i in range(9)]
    return sorted({control.value, *(round(x) if whole else round(x, 3) for x in steps)})
