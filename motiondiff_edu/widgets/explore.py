"""Sliders for a function that draws a figure: each change draws the figure again."""

import ipywidgets

from ..viz.style import as_html
from . import states
from .turn import TURN


class Explored(ipywidgets.VBox):
    """A figure with its controls. Where pages are made, it also has a few states as HTML."""

    still = ""

    def _repr_mimebundle_(self, **kwargs):
        live = super()._repr_mimebundle_(**kwargs)
        bundle, metadata = live if isinstance(live, tuple) else (live or {}, {})
        return {**bundle, **({"text/html": self.still} if self.still else {})}, metadata


def explore(draw, **start) -> Explored:
    """Show draw(**values) with a control for each argument, and a button that resets them all.

        explore(draw, s=(1, 100, 50), name=["linear", "cosine"], noise=True)
    (low, high, start) gives a slider, a list gives choices, True or False gives a tick box. `draw`
    returns a matplotlib Figure, whose label becomes the picture's alternative text. Errors in
    `draw` are raised.
    Raises ValueError for an argument of another kind.
    """
    controls = {name: _control(name, value) for name, value in start.items()}
    first = {name: control.value for name, control in controls.items()}
    picture = ipywidgets.HTML()
    reset = ipywidgets.Button(description="Reset", tooltip="reset all values")

    def refresh(_=None):
        with TURN:  # pyplot has one current figure
            picture.value = as_html(
                draw(**{name: control.value for name, control in controls.items()}), dpi=90
            )

    def back(_):
        for name, control in controls.items():
            control.value = first[name]

    for control in controls.values():
        control.observe(refresh, names="value")
    reset.on_click(back)
    refresh()
    box = Explored([ipywidgets.HBox([*controls.values(), reset]), picture])
    if states.making_pages():
        values = {name: _values(control) for name, control in controls.items()}
        box.still = states.as_page(lambda at: as_html(draw(**at), dpi=80), values, first)
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


def _control(name: str, value) -> ipywidgets.Widget:
    if isinstance(value, bool):
        return ipywidgets.Checkbox(value=value, description=name)
    if isinstance(value, list):
        return ipywidgets.Dropdown(options=value, value=value[0], description=name)
    if not (isinstance(value, tuple) and len(value) == 3):
        raise ValueError(
            f"{name} takes (low, high, start), a list of choices, or True or False; not {value!r}"
        )
    low, high, begin = value
    kind = ipywidgets.IntSlider if isinstance(begin, int) else ipywidgets.FloatSlider
    extra = {} if isinstance(begin, int) else {"step": (high - low) / 50}
    return kind(value=begin, min=low, max=high, description=name, continuous_update=False, **extra)
