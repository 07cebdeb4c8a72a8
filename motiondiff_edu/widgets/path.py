"""The path pad: draw the path of a walk on the floor, by mouse or keyboard, or choose a ready one.

Arrows add half a metre, Backspace removes it, C clears, R resets.  Notebook: 00
"""

import base64
import html
import io
from collections.abc import Callable

import numpy as np
import traitlets
from jaxtyping import Float
from numpy.typing import ArrayLike

from ..conditions import drawn_path
from ..viz.skeleton import top_view
from . import module
from .live import Starting
from .still import with_still

MODULE = module.es_module(module.PATH)


class PathPad(Starting):
    """A floor seen from above, in metres; the figure starts at the origin, facing up (z).

    Its left (x) is to the left.

    points   the path (n, 2) [x, z]; it can be read and set
    speed    m/s; it can be read and set
    stops    metres along the path; they can be read and set
    `control()` returns the control that follows the path. `on_change(f)` calls f(pad) after each
    change.   Notebook: 00
    """

    _esm = MODULE
    KEPT = ("line", "stops", "speed", "preset")
    line = traitlets.List().tag(sync=True)
    stops = traitlets.List(traitlets.Float()).tag(sync=True)
    speed = traitlets.Float(1.2, min=0.3, max=3.0).tag(sync=True)
    seconds = traitlets.Float(0.0).tag(sync=True)  # duration of the walk; 0 without a path
    preset = traitlets.Unicode("").tag(sync=True)
    presets = traitlets.List(list(drawn_path.PRESETS)).tag(sync=True)
    height = traitlets.Int(460).tag(sync=True)

    def __init__(
        self,
        points: ArrayLike | None = None,
        speed: float | int = 1.2,
        preset: str = "slalom",
        height: int = 460,
    ):
        super().__init__(speed=float(speed), height=int(height))
        self.on_msg(self._receive)
        if points is None:
            self.preset = preset
        else:
            self.points = points

    def _receive(self, _, content: dict, buffers) -> None:
        if content["do"] == "ping":
            self.send({"do": "heard"})  # else the page says that nobody answers

    @property
    def points(self) -> Float[np.ndarray, "n 2"]:
        """The drawn path, (n, 2) [x, z] in metres; n is 0 without a path."""
        return np.array(self.line, dtype=np.float64).reshape(-1, 2)

    @points.setter
    def points(self, value: ArrayLike) -> None:
        points = np.asarray(value, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
            raise ValueError(
                f"points must be (n, 2) finite numbers [x, z] in metres, not shape {points.shape}"
            )
        with self.hold_trait_notifications():
            self.preset = ""
            self.stops = []
            self.line = points.tolist()

    @traitlets.validate("preset")
    def _known_preset(self, proposal):
        if proposal["value"] and proposal["value"] not in drawn_path.PRESETS:
            raise traitlets.TraitError(
                f"no path is called {proposal['value']!r}; use one of "
                f"{', '.join(drawn_path.PRESETS)}"
            )
        return proposal["value"]

    @traitlets.observe("preset")
    def _take_preset(self, change):
        if change["new"]:
            points, stops = drawn_path.preset(change["new"])
            with self.hold_trait_notifications():
                self.stops, self.line = stops, points.round(4).tolist()

    @traitlets.observe("line", "speed", "stops")
    def _time_it(self, change):
        try:
            self.seconds = len(self.control()) / 20
        except ValueError:  # the path is too short; control() raises the message
            self.seconds = 0.0

    def control(self, fps: float | int = 20.0) -> Float[np.ndarray, "T 3"]:
        """The control that follows the path at the chosen speed, from rest to rest.

        See `path_to_control`.
        """
        return drawn_path.path_to_control(self.points, self.speed, fps, self.stops)

    def on_change(self, callback: Callable[["PathPad"], object]) -> None:
        """Call `callback(pad)` once after each change of path, stops, speed or several of them."""
        last = [(self.line, self.stops, self.speed)]

        def notify(change):
            now = (self.line, self.stops, self.speed)
            if now != last[0]:
                last[0] = now
                callback(self)

        self.observe(notify, names=["line", "stops", "speed"])

    @property
    def description(self) -> str:
        """The alternative text: one sentence about the path."""
        if not self.line:
            return "A floor seen from above, without a path."
        x, z = self.points[-1]
        return (
            f"A path seen from above: {len(self.line)} points, "
            f"from the origin to {z:.1f} m ahead, {x:.1f} m left."
        )

    def _repr_mimebundle_(self, **kwargs):
        buffer = io.BytesIO()
        top_view(self.points).savefig(buffer, format="png", dpi=70)
        png = base64.b64encode(buffer.getvalue()).decode()
        alt = html.escape(self.description, quote=True)
        still = {
            "text/html": f'<img alt="{alt}" src="data:image/png;base64,{png}">',
            "image/png": png,
            "text/plain": self.description,
        }
        return with_still(super()._repr_mimebundle_(**kwargs), still)
