"""The sliders under the figures: they call the figure function, reset, and let errors through."""

import pytest

from motiondiff_edu.viz.noise import lines
from motiondiff_edu.widgets.explore import explore


def controls(box):
    return {w.description: w for w in box.children[0].children}


def test_turning_a_knob_draws_again_and_reset_goes_back():
    seen = []

    def draw(s, name, noise):
        seen.append((s, name, noise))
        return lines([0, 1], {"a": [s, s]}, f"at <{s}>", ("x", "y"))

    box = explore(draw, s=(1, 9, 5), name=["linear", "cosine"], noise=True)
    before = box.children[1].value
    controls(box)["s"].value = 7
    controls(box)["name"].value = "cosine"
    assert seen == [(5, "linear", True), (7, "linear", True), (7, "cosine", True)]
    assert box.children[1].value != before and 'alt="at &lt;7&gt;"' in box.children[1].value
    controls(box)["Reset"].click()
    assert seen[3:] == [(5, "linear", True)]  # drawn once, and not once for each control


def test_fractions_get_a_fractional_slider():
    box = explore(lambda u: lines([0, 1], {"a": [u, u]}, "c", ("x", "y")), u=(0.0, 2.0, 0.5))
    controls(box)["u"].value = 1.25
    assert abs(controls(box)["u"].value - 1.25) < 0.021


@pytest.mark.parametrize("value", [(1, 9), 5, "cosine", (1, 2, 3, 4)])
def test_what_is_no_control_is_explained(value):
    with pytest.raises(
        ValueError, match=r"s takes \(low, high, start\), a list of choices, or True or False; not "
    ):
        explore(lambda s: None, s=value)


def test_an_error_in_the_figure_is_not_swallowed():
    box = explore(lambda s: lines([0, 1], {"a": [1 / (s - 3)] * 2}, "c", ("x", "y")), s=(1, 9, 5))
    with pytest.raises(ZeroDivisionError):
        controls(box)["s"].value = 3
