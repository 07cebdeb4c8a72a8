"""Controls for the arguments of a function, with a button that resets them all at once."""

from collections.abc import Callable

import ipywidgets

from .live import TURN

WIDTH = "290px"  # of a slider; with less, its track is too short to be set


class Controls(ipywidgets.HBox):
    """A control for each argument of `act`, which is called with all values at each change.

    (low, high, start) gives a slider, a list gives choices, True or False gives a tick box. A row
    that is too narrow goes on in the next one. Changes that come while `act` is at work are one:
    it is called once more, with the values of then.
    Raises ValueError for an argument of another kind.
    """

    def __init__(self, act: Callable[..., object], start: dict):
        self.act = act
        self.controls = {name: _control(name, value) for name, value in start.items()}
        self.first = self.values()
        self.quiet = False
        self._changes = 0
        reset = ipywidgets.Button(description="Reset", tooltip="reset all values")
        reset.on_click(self._back)
        for control in self.controls.values():
            control.observe(self._changed, names="value")
        super().__init__([*self.controls.values(), reset])
        self.layout.flex_flow = "row wrap"

    def values(self) -> dict:
        """The value of each argument now."""
        return {name: control.value for name, control in self.controls.items()}

    def _changed(self, _=None) -> None:
        if self.quiet:
            return
        self._changes += 1
        number = self._changes
        with TURN:
            if number == self._changes:  # else a later change waits, and acts for this one too
                self.act(**self.values())

    def _back(self, _) -> None:
        self.quiet = True  # one call for all, not one for each
        try:
            for name, control in self.controls.items():
                control.value = self.first[name]
        finally:
            self.quiet = False
        self._changed()


def steering(act: Callable[..., object], **start) -> Controls:
    """Call act(**values) now, and whenever one of its controls is moved.

        display(steering(steer, forward=(-0.5, 3.0, 1.2), yaw=(-2.0, 2.0, 0.0)), player)
    Raises ValueError as `Controls` does.  Notebook: 01, 07
    """
    controls = Controls(act, start)
    with TURN:
        act(**controls.values())
    return controls


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
    if not low <= begin <= high:
        raise ValueError(f"{name} cannot start at {begin}: the slider goes from {low} to {high}")
    whole = all(isinstance(number, int) for number in value)
    kind = ipywidgets.IntSlider if whole else ipywidgets.FloatSlider
    extra = {} if whole else {"step": (high - low) / 50}
    slider = kind(
        value=begin, min=low, max=high, description=name, continuous_update=False, **extra
    )
    slider.layout.min_width = WIDTH
    return slider
