"""A button that says what it is doing, and cannot be pressed again while it does it."""

from collections.abc import Callable

import ipywidgets


class Action(ipywidgets.HBox):
    """A button; a press calls `act()`, whose answer stands beside it.

    `beside`: further controls, between the button and the answer.
    `doing`: what it says meanwhile. Errors of `act` are said there, and raised.
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
        self.button.on_click(self.press)
        super().__init__([self.button, *beside, self.said])
        self.layout.flex_flow = "row wrap"

    def press(self, _=None) -> None:
        """Act once, as a press of the button does."""
        self.button.disabled = True
        self.said.value = self.doing
        try:
            self.said.value = self.act()
        except Exception as error:
            self.said.value = f"{type(error).__name__}: {error}"
            raise
        finally:
            self.button.disabled = False
