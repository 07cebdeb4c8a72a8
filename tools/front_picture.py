"""The README's moving picture, docs/front.webp: the course's own widgets at work in Chromium.

    python tools/front_picture.py [--frames FOLDER]

Three panels: a path is drawn on the path pad, and the shipped walker walks it; the shipped dancer
dances to a composed song; keyframes are pinned in the editor, one is changed, and the shipped
in-betweener makes the frames between. Each picture is a screenshot of the widget's page. `--frames`
writes every tenth picture as a PNG too, for looking at.
"""

import argparse
import io
import shutil
import sys
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests" / "helpers"))  # how the tests open a widget's page

from browser import bare_page, open_page, start_browser  # noqa: E402
from editor_page import open_editor, settled  # noqa: E402

import motiondiff_edu as md  # noqa: E402
from data_synth.music import compose  # noqa: E402
from data_synth.walking import walk  # noqa: E402
from motiondiff_edu._files import replacing  # noqa: E402
from motiondiff_edu.conditions.control import constant_control  # noqa: E402
from motiondiff_edu.editing.inbetween import inbetween  # noqa: E402
from motiondiff_edu.motion.skeleton import joint_index  # noqa: E402
from motiondiff_edu.widgets.editor import Editor  # noqa: E402
from motiondiff_edu.widgets.path import MODULE as PATH_MODULE  # noqa: E402
from motiondiff_edu.widgets.path import PathPad  # noqa: E402
from motiondiff_edu.widgets.player import Look, Player, Soundtrack  # noqa: E402

OUT = ROOT / "docs" / "front.webp"
FPS, PICTURES = 20, 120  # of the loop, and of the motions
FIRST = 60  # the loop starts here, where all three panels show a figure moving
WIDTHS, HEIGHT = (300, 270, 378), 412
CAPTION, GAP = 30, 6
CAPTIONS = (
    "Draw a path: the walker follows it",
    "Add a song: the dancer dances",
    "Pin poses: the editor fills the gaps",
)
DRAWING = 26  # pictures while the path is drawn
QUALITY = 70
HELD = 4  # pictures of one step in the editor
PLAIN = "body { margin: 0 !important } canvas { outline: none !important } "


def screenshot(page, width: int) -> Image.Image:
    """The page's upper left part, as large as a panel."""
    clip = {"x": 0, "y": 0, "width": width, "height": HEIGHT}
    return Image.open(io.BytesIO(page.screenshot(clip=clip))).convert("RGB")


def path_panel(browser, folder: Path) -> Iterator[Image.Image]:
    """A path drawn with the mouse on the path pad, then the walker that walks it."""
    pad = PathPad(points=np.zeros((0, 2)), speed=1.4, height=HEIGHT)
    names = ("line", "stops", "speed", "seconds", "preset", "presets", "height")
    address = bare_page(folder, PATH_MODULE, {name: getattr(pad, name) for name in names}, [])
    with open_page(browser, viewport={"width": WIDTHS[0], "height": HEIGHT}) as page:
        page.goto(address)
        page.add_style_tag(content=PLAIN + ".mde-pad { padding: 0 } .mde-pad-row { display: none }")
        page.wait_for_timeout(300)
        yield from draw_path(page)
        pad.points = page.evaluate("saved.at(-1).line")
    standing = md.Motion.of_clip(walk(constant_control(seconds=2), seed=1, style="neutral"))
    more = md.load("walker").walk(standing, pad.control()[:PICTURES], seed=0, steps=None)
    way = more.root[:, :2]  # the commanded one
    player = Player(more.positions, path=way, look=Look(autoplay=False))
    yield from played(browser, folder, player, WIDTHS[0])


def draw_path(page) -> Iterator[Image.Image]:
    """Pictures of the path pad while the mouse draws an S on it."""
    along = np.linspace(0, 1, 4 * DRAWING)
    x = WIDTHS[0] / 2 + 62 * np.sin(2 * np.pi * along)
    y = HEIGHT * (0.71 - 0.6 * along)
    page.mouse.move(x[0], y[0])
    page.mouse.down()
    for k, point in enumerate(zip(x, y, strict=True)):
        page.mouse.move(*point)
        if k % 4 == 3:
            yield screenshot(page, WIDTHS[0])
    page.mouse.up()


def dance_panel(browser, folder: Path) -> Iterator[Image.Image]:
    """The shipped dancer and the song it dances to, with its beats."""
    seconds = PICTURES / FPS
    song = compose(2_025, "house", seconds=seconds)
    dance = md.load("dancer").dance(song.audio, sample_rate=song.sample_rate, seed=3)
    beats = song.beats[song.beats < dance.seconds]
    player = Player(
        dance.positions,
        audio=Soundtrack(dance.audio, beats, sample_rate=dance.sample_rate),
        look=Look(autoplay=False),
    )
    yield from played(browser, folder, player, WIDTHS[1])


def played(browser, folder: Path, player: Player, width: int) -> Iterator[Image.Image]:
    """Pictures of a player, without its rows of buttons; the last frame stays."""
    address = player.save_html(folder / "player.html").as_uri()
    with open_page(browser, viewport={"width": width, "height": HEIGHT}) as page:
        page.goto(address)
        page.add_style_tag(content=PLAIN + ".mde-row { display: none !important }")
        page.wait_for_timeout(300)
        last = player.scene["figures"][0]["frames"] - 1
        for k in range(PICTURES):
            show = "(t) => { const s = document.querySelector('input[type=range]'); s.value = t; "
            page.evaluate(show + "s.dispatchEvent(new Event('input')); }", min(k, last))
            yield screenshot(page, width)


def editor_panel(browser, folder: Path) -> Iterator[Image.Image]:
    """The editor: three frames are pinned, a hand is moved, in-betweens are made and played."""
    network = md.load("inbetweener")
    motion = walk(constant_control(1.0, seconds=4), seed=5).world()
    editor = Editor(motion, partial(inbetween, network))
    with open_page(browser, viewport={"width": WIDTHS[2], "height": 900}) as page:
        open_editor(page, folder, editor)
        page.add_style_tag(
            content=PLAIN + ".mde-player { padding: 0 } .mde-editor .mde-row label, .mde-told, "
            ".mde-key:has(i) { display: none !important } .mde-row { flex-wrap: nowrap !important }"
            ".mde-count { min-width: 0 !important; white-space: nowrap } "
            ".mde-editor canvas:not(.mde-timeline) { height: 258px !important }"
        )
        page.wait_for_timeout(300)
        shot = partial(screenshot, page, WIDTHS[2])
        yield from pin_and_move(page, editor, shot)
        page.get_by_role("button", name="Generate").click()
        settled(page)
        if editor.error:  # the page alone would show it, where this picture hides it
            raise editor.error
        for t in range(len(motion)):
            page.evaluate("(t) => take({ frame: t })", t)
            yield shot()


def pin_and_move(page, editor: Editor, shot) -> Iterator[Image.Image]:
    """Pictures of the edit: the first, a middle and the last frame pinned, the right hand moved."""
    canvas = page.locator(".mde-editor canvas:not(.mde-timeline)")
    hand = joint_index("RightHand")
    for frame in (0, 40, len(editor.edit) - 1):
        page.evaluate("(t) => take({ frame: t })", frame)
        yield from [shot()] * HELD
        canvas.press("Enter")
        settled(page)
        yield from [shot()] * HELD
        if frame != 40:
            continue
        page.evaluate(
            "(j) => { const s = document.querySelector('select'); s.value = j;"
            " s.dispatchEvent(new Event('change')); }",
            str(hand),
        )
        for _ in range(12):
            canvas.press("Shift+ArrowUp")
            settled(page)
            yield from [shot()] * 2
        canvas.press("Escape")


def panel(pictures: Iterator[Image.Image]) -> list[Image.Image]:
    """As many pictures as the loop has: further ones are dropped, the last one is held."""
    made = [picture for picture, _ in zip(pictures, range(PICTURES), strict=False)]
    return made + [made[-1]] * (PICTURES - len(made))


def side_by_side(panels: list[list[Image.Image]], k: int) -> Image.Image:
    """Picture k of the loop, a caption over each panel."""
    size = (sum(WIDTHS) + 2 * GAP, CAPTION + HEIGHT)
    whole, left = Image.new("RGB", size, "#ffffff"), 0
    pen = ImageDraw.Draw(whole)
    for pictures, words, width in zip(panels, CAPTIONS, WIDTHS, strict=True):
        pen.text((left + 4, 5), words, fill="#1f2933", font=ImageFont.load_default(17))
        whole.paste(pictures[k], (left, CAPTION))
        left += width + GAP
    return whole


def save(loop: list[Image.Image], path: Path) -> None:
    """Write an endless animated WebP: a third of a GIF's size, in all its colours."""
    with replacing(path) as aside:
        loop[0].save(
            aside,
            "WEBP",
            save_all=True,
            append_images=loop[1:],
            duration=1000 // FPS,
            loop=0,
            quality=QUALITY,
            method=6,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=Path, help="a folder for every tenth picture, as PNG")
    chosen = parser.parse_args()
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if chromium is None:
        sys.exit("this picture is taken in Chromium: install it (Debian: apt-get install chromium)")
    with start_browser(chromium) as browser, tempfile.TemporaryDirectory() as folder:
        makers = (path_panel, dance_panel, editor_panel)
        panels = [panel(maker(browser, Path(folder))) for maker in makers]
    loop = [side_by_side(panels, (FIRST + k) % PICTURES) for k in range(PICTURES)]
    save(loop, OUT)
    print(f"written: {OUT} ({OUT.stat().st_size / 1e6:.2f} MB, {len(loop)} pictures)")
    if chosen.frames:
        chosen.frames.mkdir(parents=True, exist_ok=True)
        for k in range(0, PICTURES, 10):
            loop[k].save(chosen.frames / f"{k:02d}.png")


if __name__ == "__main__":
    main()
