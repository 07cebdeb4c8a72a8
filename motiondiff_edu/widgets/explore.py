"""Sliders for a function that draws a figure: each change draws the figure again."""

import ipywidgets

from ..viz.style import as_html
from .turn import TURN


def explore(draw, **start) -> ipywidgets.VBox:
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
    return ipywidgets.VBox([ipywidgets.HBox([*controls.values(), reset]), picture])


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
