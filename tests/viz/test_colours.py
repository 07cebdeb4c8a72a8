"""Pictures tell left from right, and curve from curve, to people who do not see all colours."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image
from seeing import BLIND, apart, as_seen, contrast, lab
from synthetic_walk import walk

from motiondiff_edu.viz import curves
from motiondiff_edu.viz.style import DASHES, OKABE_ITO
from motiondiff_edu.widgets.player import Player

CLEAR = 15  # a distance that nobody has to look for; 2.3 is just noticed


def test_the_measures_of_colour_are_the_published_ones():
    red = np.eye(3)[0]
    white = np.ones(3)
    grey = np.full(3, 119 / 255)
    np.testing.assert_allclose(lab(red), [53.24, 80.09, 67.20], atol=0.02)
    np.testing.assert_allclose(lab(white), [100, 0, 0], atol=0.02)
    assert contrast(white, np.zeros(3)) == pytest.approx(21)
    assert contrast(white, grey) == pytest.approx(4.48, abs=0.01)
    for kind in BLIND:  # grey is grey to everybody
        np.testing.assert_allclose(as_seen(grey, kind), grey, atol=2e-3)
    red_green = (np.array([0.8, 0.3, 0.2]), np.array([0.5, 0.5, 0.1]))
    seen = [as_seen(c, "deuteranopia") for c in red_green]
    assert apart(*seen) < 0.4 * apart(*red_green)


def pixels_like(picture: Image.Image, colour: str) -> np.ndarray:
    """The median colour of the pixels that are nearest to a named colour."""
    wanted = np.array(to_rgb(colour))
    rgb = np.asarray(picture.convert("RGB")).reshape(-1, 3) / 255
    near = np.linalg.norm(rgb - wanted, axis=1) < 0.12
    assert near.sum() > 100, f"{colour} is not in the picture"
    return np.median(rgb[near], axis=0)


@pytest.mark.parametrize("kind", BLIND)
def test_left_and_right_limbs_of_a_figure_are_told_apart(kind):
    poster = Player(walk(frames=30)[0]).poster()
    left, right = (pixels_like(poster, OKABE_ITO[k]) for k in (0, 1))
    assert apart(as_seen(left, kind), as_seen(right, kind)) > CLEAR


@pytest.mark.parametrize("kind", BLIND)
def test_curves_differ_in_colour_or_in_dashes(kind):
    lines = {f"line {k}": (np.arange(9), 1.0 + k + np.zeros(9)) for k in range(7)}
    fig = curves.loss_curves(lines)
    drawn = fig.axes[0].lines
    for (a, one), (b, other) in combinations(enumerate(drawn), 2):
        colours = one.get_color(), other.get_color()
        seen = apart(*(as_seen(np.array(to_rgb(c)), kind) for c in colours))
        assert seen > CLEAR or DASHES[a] != DASHES[b], (a, b, seen)


@pytest.mark.parametrize("kind", BLIND)
def test_the_first_three_colours_need_no_dashes(kind):
    for one, other in combinations([np.array(to_rgb(c)) for c in OKABE_ITO[:3]], 2):
        assert apart(as_seen(one, kind), as_seen(other, kind)) > CLEAR


def test_lines_are_seen_on_white():
    for colour in OKABE_ITO[:4]:
        assert contrast(np.array(to_rgb(colour)), np.ones(3)) >= 3, colour
