"""The pages in Chromium without a network: nothing raw, nothing asked for, menus that work."""

import json
from pathlib import Path

import pytest
from browser import open_page

from motiondiff_edu.viz.noise import lines
from motiondiff_edu.widgets.explore import explore
from tools.pages import raw
from tools.pages.__main__ import pages

ROOT = Path(__file__).parents[2]
BUILT = ROOT / "build" / "pages"  # by `make pages`; without it, some pages without outputs
SOME = ("index", "04_where_the_loss_comes_from", "13_kinematic_losses", "docs/GLOSSARY")
FOUND = [*BUILT.glob("*.html"), *BUILT.glob("docs/*.html")]
NAMES = sorted(one.relative_to(BUILT).with_suffix("").as_posix() for one in FOUND) or SOME


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the built pages, or of those of the notebooks as they are."""
    if FOUND:
        return BUILT
    folder = tmp_path_factory.mktemp("site")
    pages(ROOT / "notebooks", folder)
    return folder


@pytest.mark.parametrize("name", NAMES)
def test_a_page_of_the_course_is_alive_offline(browser, site, name):
    with open_page(browser) as page:
        page.goto((site / f"{name}.html").resolve().as_uri())
        text, told = page.evaluate(raw.VISIBLE)
        assert len(text) > 200
        assert raw.raw_formulas(text) == []
        assert raw.raw_widgets(text, told) == []
        assert page.problems == [] and page.asked == []


def test_states_of_a_figure_can_be_chosen(browser, tmp_path, monkeypatch):
    monkeypatch.setenv("MOTIONDIFF_PAGES", "1")
    box = explore(
        lambda s, name: lines([0, 1], {"a": [s, s]}, f"{name} at {s}", ("x", "y")),
        s=(1, 9, 5),
        name=["linear", "cosine"],
    )
    still = box._repr_mimebundle_()
    still = (still[0] if isinstance(still, tuple) else still)["text/html"]
    output = {"output_type": "display_data", "data": {"text/html": still}}
    told = [{"cell_type": "markdown", "source": "# 01 A\n\nQ"}]
    told += [{"cell_type": "code", "source": "explore()", "outputs": [output]}]
    (tmp_path / "01_a.ipynb").write_text(json.dumps({"cells": told}))
    first = pages(tmp_path, tmp_path / "site")[0]
    with open_page(browser) as page:
        page.goto(first.resolve().as_uri())
        caption = page.locator(".states figcaption:visible")
        assert caption.inner_text() == "linear at 5"
        page.locator(".states select").nth(1).select_option("cosine")
        page.locator(".states select").nth(0).select_option("9")
        assert caption.inner_text() == "cosine at 9"
        assert page.problems == []
