"""The player for everybody: by keyboard, in the dark, calm, enlarged, and in words."""

import re

import numpy as np
import pytest
from browser import drawn, open_page, shown
from seeing import contrast
from synthetic_walk import walk

from motiondiff_edu.widgets.player import Look, Player

pytestmark = pytest.mark.browser
NAMES = """() => [...document.querySelectorAll("button, input, select, canvas")].map((e) => ({
  tag: e.tagName, words: (e.getAttribute("aria-label") || e.labels?.[0]?.innerText ||
    e.innerText || e.title || "").trim(), stop: e.tabIndex >= 0 }))"""
TEXTS = """() => [...document.querySelectorAll(
  ".mde-player button, .mde-player label, .mde-player span")]
  .filter((e) => e.innerText?.trim() && e.offsetParent).map((e) => {
    let below = e;
    while (below && getComputedStyle(below).backgroundColor === "rgba(0, 0, 0, 0)")
      below = below.parentElement;
    return [e.innerText.trim(), getComputedStyle(e).color,
      below ? getComputedStyle(below).backgroundColor : "rgb(255, 255, 255)"];
  })"""


@pytest.fixture(scope="module")
def page_of(tmp_path_factory):
    positions, contacts = walk(frames=53, turn=0.3)
    look = Look(autoplay=True)
    player = Player(positions, contacts=contacts, past=10, labels="walker", look=look)
    path = tmp_path_factory.mktemp("page") / "walk.html"
    return player.save_html(path).as_uri(), player.description


def test_all_controls_have_a_name_and_are_reached_by_tab(browser, page_of):
    with open_page(browser) as page:
        page.goto(page_of[0])
        controls = page.evaluate(NAMES)
        assert len(controls) >= 6
        assert [c for c in controls if not c["words"]] == []
        stops = [c["words"] for c in controls if c["stop"]]
        reached = set()
        for _ in range(2 * len(stops)):
            page.keyboard.press("Tab")
            reached.add(page.evaluate("document.activeElement.tagName"))
        assert {"BUTTON", "INPUT", "SELECT", "CANVAS"} <= reached


def test_the_figure_says_in_words_what_is_seen(browser, page_of):
    with open_page(browser) as page:
        page.goto(page_of[0])
        assert page_of[1] in page.locator("canvas").first.get_attribute("aria-label")


def test_who_asks_for_less_motion_gets_a_figure_that_waits(browser, page_of):
    with open_page(browser, reduced_motion="reduce") as page:
        page.goto(page_of[0])
        drawn(page.locator("canvas"))
        page.wait_for_timeout(400)
        assert shown(page) == 0
        page.locator("canvas").focus()
        page.keyboard.press(" ")
        page.wait_for_function("Number(document.querySelector('.mde-player').dataset.frame) > 2")


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_words_have_contrast(browser, page_of, theme):
    with open_page(browser, color_scheme=theme) as page:
        page.goto(page_of[0])
        drawn(page.locator("canvas"))
        texts = page.evaluate(TEXTS)
        assert len(texts) >= 4
        for words, ink, paper in texts:
            colours = [np.array(re.findall(r"[\d.]+", c)[:3], float) / 255 for c in (ink, paper)]
            assert contrast(*colours) >= 4.5, (words, ink, paper)


def test_at_200_per_cent_nothing_lies_outside(browser, page_of):
    # 1280 x 720 at 200 % is a page of 640 x 360
    with open_page(browser, viewport={"width": 640, "height": 360}) as page:
        page.goto(page_of[0])
        drawn(page.locator("canvas"))
        assert page.evaluate("document.documentElement.scrollWidth") <= 640
        for control in page.locator(".mde-player button, .mde-player select").all():
            box = control.bounding_box()
            assert box["x"] >= 0 and box["x"] + box["width"] <= 640, control.inner_text()
