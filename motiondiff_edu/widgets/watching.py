"""A training that one watches: its loss, and what the network can do by now.

    for report in watch_training(training.train_steps(...), steps, moving):
        losses.append(report.loss)

Notebook: 05, 07
"""

import time
from collections.abc import Callable, Iterable, Iterator

from IPython.display import display

from ..training import TrainStep
from ..viz.curves import loss_curves
from .player import Figures, Look, Player

SMALL = Look(height=300)
SMOOTH = 30  # steps of the running mean
SHARE = 9  # a picture is waited for nine times as long as it took: at most a tenth of the time


def watch_training(
    reports: Iterable[TrainStep],
    steps: int,
    moving: Callable[[], Figures],
    *,
    every: float = 4.0,
    past: int | None = None,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[TrainStep]:
    """Yield the reports; show a figure and the loss: at first, every few seconds, and at the end.

    `steps`: the number of the last one.
    `moving()`: what the network in training moves, as `Player` takes it. Training waits for it.
    `every`: seconds of training from one picture to the next; longer where pictures are slow.
    `past`: frames of it that were given.
    """
    shown = _PlayerAndCurve(steps, moving(), past)
    losses = []
    drawn, took = clock(), 0.0
    for report in reports:
        losses.append(report.loss)
        yield report
        now = clock()
        if now - drawn >= max(every, SHARE * took) and report.step < steps:
            shown.now(moving(), losses, report.step)
            drawn = clock()
            took = drawn - now
    if losses:
        shown.now(moving(), losses, report.step)
        shown.for_good()


class _PlayerAndCurve:
    """The player and, below it, the curve; each is replaced where it stands."""

    def __init__(self, steps: int, figures: Figures, past: int | None):
        self.steps = steps
        self.player = Player(figures, past=past, labels=self._label(0), look=SMALL)
        self.places = [display(self.player, display_id=True)]

    def _label(self, step: int) -> str:
        return f"untrained (of {self.steps:,} steps)" if not step else f"after {step:,} steps"

    def now(self, figures: Figures, losses: list[float], step: int) -> None:
        self.player.show(figures, labels=self._label(step))
        first = step - len(losses)
        fig = loss_curves({"loss": (range(first, step), losses)}, smooth=SMOOTH)
        if len(self.places) == 1:
            self.places.append(display(fig, display_id=True))
        else:
            _replace(self.places[1], fig)

    def for_good(self) -> None:
        """Leave the last figure in the notebook, and not the first, where nothing runs."""
        _replace(self.places[0], self.player)


def _replace(place, what) -> None:
    if place is not None:  # there is none outside of a notebook
        place.update(what)
