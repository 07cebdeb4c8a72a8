"""What Reset goes back to: what Python gave, not what the page made of it."""

import anywidget
import traitlets


class Starting(anywidget.AnyWidget):
    """A widget whose `start` has the values of the traits KEPT that Python set last.

    The page cannot remember them: a view can be closed, and another made, at any time.
    """

    KEPT: tuple[str, ...] = ()
    start = traitlets.Dict().tag(sync=True)
    _told = False  # whether the page is setting traits

    def set_state(self, sync_data: dict) -> None:
        """Take what the page says."""
        self._told = True
        try:
            super().set_state(sync_data)
        finally:
            self._told = False

    @traitlets.observe(traitlets.All)
    def _remember(self, change) -> None:
        if change["name"] in self.KEPT and not self._told:
            self.start = self.start | {change["name"]: change["new"]}
