"""What widgets with a kernel share: one callback at a time, and what Reset goes back to."""

import threading

import anywidget
import traitlets

# Jupyter may answer two messages of a page in two threads of the kernel (its "subshells"): a
# widget's first message in the main thread, the next in another, before the first is done. So a
# callback that generates, draws or changes what is on show holds TURN, and the next one waits. It
# then acts on the values of that moment, not on those of its message. All widgets have the same
# one, for they share the networks.
TURN = threading.RLock()


class Starting(anywidget.AnyWidget):
    """A widget whose `start` has the values of the traits KEPT that Python set last, for Reset.

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
