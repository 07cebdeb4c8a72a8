"""The player for everybody: by keyboard, in the dark, calm, enlarged, and in words."""

import re

import numpy as np
import pytest
from browser import ANOTHER_FRAME, SPOKEN, drawn, open_page, shown, until
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


def test_while_it_plays_a_screen_reader_is_not_told_every_frame(browser, page_of):
    with open_page(browser, reduced_motion="no-preference") as page:
        page.goto(page_of[0])
        drawn(page.locator("canvas"))
        page.evaluate(SPOKEN)
        frame = shown(page)
        page.wait_for_function(
            f"Math.abs(document.querySelector('.mde-player').dataset.frame - {frame}) > 8"
        )
        assert page.evaluate("spoken") == []


def test_on_a_screen_with_finer_pixels_it_is_drawn_finer(browser, page_of):
    with open_page(browser, reduced_motion="reduce") as page:
        page.goto(page_of[0])
        canvas = page.locator("canvas")
        drawn(canvas)
        size = {"width": 1000, "height": 620, "mobile": False}
        session = page.context.new_cdp_session(page)
        for ratio, scheme in ((2, "dark"), (3, "light")):
            finer = size | {"deviceScaleFactor": ratio}
            session.send("Emulation.setDeviceMetricsOverride", finer)
            # an emulated screen does not have the queries asked again; this does
            page.emulate_media(color_scheme=scheme)
            until(canvas, f"(c) => c.width === Math.round({ratio} * c.clientWidth)")


# what JupyterLab does where its dark theme is chosen: the colours, then a mark on the body
DARK = """() => {
  const colours = { "--jp-layout-color0": "#111111", "--jp-ui-font-color1": "rgba(255,255,255,.87)",
    "--jp-border-color2": "#616161", "--jp-brand-color1": "#2196f3" };
  for (const [name, value] of Object.entries(colours))
    document.documentElement.style.setProperty(name, value);
  document.body.dataset.jpThemeLight = "false";
}"""
# how many pixels of the canvas have a colour, but for rounding
OF_COLOUR = """(c, colour) => {
  const d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
  let n = 0;
  for (let i = 0; i < d.length; i += 4) if (colour.every((v, k) => Math.abs(d[i + k] - v) < 3)) n++;
  return n;
}"""
KEYS = """() => [...document.querySelectorAll(".mde-key i")]
  .map((dot) => getComputedStyle(dot).backgroundColor)"""
LIMBS = {
    "light": ([0, 114, 178], [213, 94, 0]),  # left and right, as in js/dom.js
    "dark": ([58, 160, 220], [240, 128, 40]),
}


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_words_have_contrast_and_limbs_the_colours_of_the_theme(browser, page_of, theme):
    with open_page(browser, reduced_motion="reduce") as page:
        page.goto(page_of[0])
        canvas = page.locator("canvas")
        drawn(canvas)
        page.keyboard.press("Tab")
        page.keyboard.press("End")  # generated: not drawn paler
        if theme == "dark":
            page.evaluate(DARK)
            page.evaluate(ANOTHER_FRAME)
        keys = [f"rgb({r}, {g}, {b})" for r, g, b in LIMBS[theme]]
        assert page.evaluate(KEYS) == keys
        for name, limbs in LIMBS.items():  # the limbs behind are paler
            pixels = sum(canvas.evaluate(OF_COLOUR, colour) for colour in limbs)
            assert pixels > 100 if name == theme else pixels < 20, (name, pixels)
        texts = page.evaluate(TEXTS)
        assert len(texts) >= 4
        papers = {"light": "rgb(255, 255, 255)", "dark": "rgb(17, 17, 17)"}
        assert papers[theme] in {paper for *_, paper in texts}
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
