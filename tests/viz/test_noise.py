"""The pictures of noise.

They show what they are given, close themselves, and say in words what to see.
"""

import matplotlib.pyplot as plt
import numpy as np
import torch

from motiondiff_edu.viz import noise as viz

X = np.linspace(-2, 2, 31)


def figures():
    bell, rng = np.exp(-(X**2)), np.random.default_rng(0)
    yield viz.lines(
        X, {"a": X, "b": X**2}, "caption", ("x", "y"), marks={"level": 1.0}, ylim=(-1, 4)
    )
    yield viz.noised_curve(X, X, -X, 7, 0.6, name="toe")
    yield viz.noise_ladder(X, X, {1: X, 9: -X}, "caption", name="toe")
    yield viz.densities(X, {"p": bell, "q": bell / 2}, "caption", points={"x0": 0.3})
    yield viz.histograms({"one": rng.normal(size=50)}, X, bell, "caption")
    yield viz.paths(range(5, -1, -1), torch.randn(6, 80), torch.tensor(X), bell, bell, "caption")
    yield viz.one_moment(X, bell, rng.normal(size=50), rng.normal(size=50), 3, "caption")
    yield viz.bound(torch.tensor([0.1, -2.0, 1.0, 0.5]), -0.5, "caption")
    yield viz.maps(X, {"ddim": X, "ddpm": -X}, "caption")


def test_every_figure_shows_itself_once_with_its_words_below():
    for figure in figures():
        shown = figure._repr_mimebundle_()[0]["text/html"]
        words = figure.get_label()
        assert words and f">{words}</figcaption>" in shown and f'alt="{words}"' in shown
    assert not plt.get_fignums()


def test_lines_show_the_numbers_they_were_given():
    axis = viz.lines(X, {"a": X, "b": X**2}, "caption", ("x", "y")).axes[0]
    np.testing.assert_allclose(axis.lines[1].get_ydata(), X**2)
    assert [text.get_text() for text in axis.get_legend().get_texts()] == ["a", "b"]
    assert (axis.get_xlabel(), axis.get_ylabel()) == ("x", "y")


def test_the_bounds_running_sum_ends_at_the_sum_of_all_terms():
    terms = torch.tensor([0.1, -2.0, 1.0, 0.5])
    axis = viz.bound(terms, -0.5, "caption").axes[1]
    assert abs(axis.lines[0].get_ydata()[-1] - terms.sum().item()) < 1e-6
    assert axis.lines[0].get_ydata()[0] == terms[0]
