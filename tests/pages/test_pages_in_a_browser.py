"""The pages in Chromium without a network: nothing raw, nothing asked for, menus that work."""

import json
from pathlib import Path

import pytest
from browser import open_page

from motiondiff_edu.viz.noise import lines
from motiondiff_edu.widgets.explore import explore
from tools.pages import raw
from tools.pages.__main__ import pages

SITE = Path(__file__).parents[2] / "build" / "pages"
BUILT = sorted(SITE.glob("*.html")) + sorted((SITE / "docs").glob("*.html"))
NONE = [pytest.param(None, marks=pytest.mark.skip(reason="no pages here: run `make pages`"))]


@pytest.mark.parametrize("path", BUILT or NONE, ids=lambda path: path.stem if path else "none")
def test_a_page_of_the_course_is_alive_offline(browser, path):
    with open_page(browser) as page:
        page.goto(path.resolve().as_uri())
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
