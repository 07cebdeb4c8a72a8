"""A button that says what it is doing, and cannot be pressed again while it does it."""

import time
from collections.abc import Callable

import ipywidgets

from .live import TURN

# seconds: who presses again sooner cannot have seen the answer, for it takes the eye and the hand
# longer (simple reaction times are about 0.25 s)
UNSEEN = 0.2


class Action(ipywidgets.HBox):
    """A button; a press calls `act()`, whose answer stands beside it.

    `beside`: further controls, between the button and the answer.
    `doing`: what it says meanwhile. Errors of `act` are said there, and raised. Clicks that came
    while it acted, or while the kernel was busy, are not acted on one after the other.
    Notebook: 00
    """

    def __init__(
        self,
        description: str,
        act: Callable[[], str],
        doing: str,
        beside: tuple[ipywidgets.Widget, ...] = (),
    ):
        self.act = act
        self.doing = doing
        self.button = ipywidgets.Button(description=description, button_style="primary")
        self.said = ipywidgets.Label()
        self._answered: float | None = None  # when, by time.monotonic
        self.button.on_click(self._clicked)
        super().__init__([self.button, *beside, self.said])
        self.layout.flex_flow = "row wrap"

    def _clicked(self, _) -> None:
        with TURN:
            if self._answered is None or time.monotonic() - self._answered >= UNSEEN:
                self.press()

    def press(self) -> None:
        """Act once, as a press of the button does."""
        with TURN:
            self.button.disabled = True
            self.said.value = self.doing
            try:
                self.said.value = self.act()
            except BaseException as error:
                interrupted = isinstance(error, KeyboardInterrupt)
                self.said.value = "stopped" if interrupted else f"{type(error).__name__}: {error}"
                raise
            finally:
                self.button.disabled = False
                self._answered = time.monotonic()
