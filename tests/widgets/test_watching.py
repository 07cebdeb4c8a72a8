"""A training that is watched goes on as one that is not, and shows what it has reached."""

import pytest
from synthetic_walk import walk

from motiondiff_edu.training import TrainStep
from motiondiff_edu.widgets import watching
from motiondiff_edu.widgets.player import Player


class Place:
    """A place in a notebook: what stood there, one thing after the other."""

    def __init__(self, first):
        self.stood = [first]

    def update(self, what):
        self.stood.append(what)


@pytest.fixture
def places(monkeypatch):
    made = []

    def display(what, display_id):
        made.append(Place(what))
        return made[-1]

    monkeypatch.setattr(watching, "display", display)
    return made


def reports(n, first=1):
    return [TrainStep(step=k, loss=1.0 / k, grad_norm=1.0, lr=0.1) for k in range(first, n + 1)]


def seconds(values):
    clock = iter(values)
    return lambda: next(clock)


def figure(frames=7):
    return walk(frames=frames)[0]


def test_the_reports_come_through_unchanged_and_in_order(places):
    steps = reports(5)
    assert list(watching.watch_training(steps, 5, figure, clock=seconds(range(100)))) == steps


def test_a_figure_is_made_at_the_start_every_few_seconds_and_at_the_end(places):
    asked = []

    def moving():
        asked.append(len(asked))
        return figure(7 + len(asked))

    clock = seconds([0, 3, 5, 5, 6, 8, 9.5, 9.5, 10, 11])  # it is drawn at 5 and at 9.5 seconds
    list(watching.watch_training(reports(7), 7, moving, every=4.0, clock=clock))
    player, curve = places
    assert len(asked) == 4  # untrained, after 2 steps, after 5 steps, at the end
    assert isinstance(player.stood[0], Player) and player.stood[-1] is player.stood[0]
    assert player.stood[0].scene["figures"][0]["frames"] == 11
    assert player.stood[0].scene["figures"][0]["label"] == "after 7 steps"
    assert [len(fig.axes[0].lines[-1].get_xdata()) for fig in curve.stood] == [2, 5, 7]


def test_slow_pictures_take_a_tenth_of_the_time_at_most(places):
    asked = []
    moving = lambda: asked.append(1) or figure()  # noqa: E731
    # drawn from 4 s to 14 s, so not before 104 s again
    clock = seconds([0, 4, 14, 20, 60, 103, 104, 114, 120])
    list(watching.watch_training(reports(6), 6, moving, every=4.0, clock=clock))
    assert len(asked) == 4  # untrained, at 4 s, at 104 s, at the end


def test_the_training_waits_for_nothing_between_two_pictures(places):
    asked = []
    moving = lambda: asked.append(1) or figure()  # noqa: E731
    list(watching.watch_training(reports(50), 50, moving, every=4.0, clock=lambda: 0.0))
    assert len(asked) == 2


def test_a_run_that_goes_on_counts_its_steps_from_there(places):
    list(watching.watch_training(reports(9, first=5), 9, figure, clock=lambda: 0.0))
    assert list(places[1].stood[-1].axes[0].lines[-1].get_xdata()) == [4, 5, 6, 7, 8]


def test_nothing_to_train_leaves_the_untrained_figure(places):
    assert not list(watching.watch_training([], 0, figure))
    assert len(places) == 1 and "untrained" in places[0].stood[0].description


def test_outside_of_a_notebook_it_goes_on_without_pictures():
    assert len(list(watching.watch_training(reports(3), 3, figure, every=0.0))) == 3
