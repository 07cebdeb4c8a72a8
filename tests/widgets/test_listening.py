"""Attention and silenced hits over the waveform: packed in Python, drawn in a browser, and as a
figure."""

from dataclasses import replace

import numpy as np
import pytest
from browser import open_page, player_page, until
from click_track import RATE, clicks, jumping
from synthetic_walk import walk

from motiondiff_edu.viz.over_time import edges_of
from motiondiff_edu.viz.sound import levels_over_sound
from motiondiff_edu.viz.style import caption
from motiondiff_edu.widgets.listening import Listening, pack_levels
from motiondiff_edu.widgets.player import Look, Player, Soundtrack

T, SECONDS = 86, 4.3
BEATS = np.arange(0.4, SECONDS, 0.5)
TIMES = (np.arange(43) + 0.5) * 0.1  # a token every 0.1 s


def softmax(scores):
    weights = np.exp(scores - scores.max(1, keepdims=True))
    return weights / weights.sum(1, keepdims=True)


@pytest.fixture(scope="module")
def maps():
    """Of 86 frames one that looks at token (frame // 2), of 11 rows one that looks at token 42 - 4
    row."""
    now, back = (np.zeros((rows, 43)) for rows in (T, 11))
    now[np.arange(T), np.arange(T) // 2] = 30
    back[np.arange(11), 42 - 4 * np.arange(11)] = 30
    return {"fine": softmax(now), "coarse": softmax(back)}


@pytest.fixture(scope="module")
def moved():
    return 0.3 * np.exp(-((np.arange(T) / 20 - 2.4) ** 2))


@pytest.fixture(scope="module")
def listening(maps, moved):
    audio = clicks(BEATS, SECONDS)
    heard = Listening(maps, TIMES, moved=moved, hit=1.9)
    track = Soundtrack(audio, BEATS, BEATS[::4], listening=heard, sample_rate=RATE)
    return Player(jumping(T, [30]), audio=track, look=Look(autoplay=False))


# ---- packed


def test_packed_weights_are_within_one_part_in_510_of_the_rows_largest():
    weights = softmax(np.random.default_rng(0).normal(0, 2, (7, 13)))
    (level,) = pack_levels(weights, np.arange(13.0))
    assert (
        np.abs(level.weights() - weights) <= weights.max(1, keepdims=True) * (1 / 510 + 1e-9)
    ).all()
    assert level.full == pytest.approx(weights.max())
    assert pack_levels(weights, np.arange(13.0), scale="frame")[0].full is None


def test_a_column_reaches_halfway_to_its_neighbours():
    np.testing.assert_allclose(edges_of(np.array([1.0, 2.0, 4.0])), [0.5, 1.5, 3.0, 5.0])
    np.testing.assert_allclose(edges_of(np.array([2.0])), [1.5, 2.5])


def test_the_record_says_how_the_bytes_are_to_be_read(listening, maps, moved):
    record = listening.music
    codes = np.frombuffer(listening.strips, np.uint8)
    assert [(level["name"], level["rows"], level["edges"]) for level in record["levels"]] == [
        ("fine", T, 0),
        ("coarse", 11, 0),
    ]
    assert len(codes) == 2 * record["peaks"] + (T + 11) * 43
    fine = codes[2 * record["peaks"] :][: T * 43].reshape(T, 43)
    assert (fine.argmax(1) == np.arange(T) // 2).all() and (fine.max(1) == 255).all()
    assert record["moved"]["hits"] == [1.9] and record["moved"]["top"] == pytest.approx(
        moved.max(), abs=1e-4
    )
    assert "attention of fine, coarse as colour" in listening.description
    assert "how far the figure moves without a hit, up to 0.30 m" in listening.description


@pytest.mark.parametrize(
    "wrong, message",
    [
        (
            dict(attention=np.full((5, 4), 0.5), token_times=np.arange(4.0)),
            "row 0 sums to 2, not 1",
        ),
        (
            dict(attention=np.full((2, 5, 4), 0.25), token_times=np.arange(4.0)),
            r"not \(2, 5, 4\); for several heads",
        ),
        (
            dict(attention=np.full((5, 4), np.nan), token_times=np.arange(4.0)),
            "weights must be finite and not negative",
        ),
        (dict(attention=np.eye(4) * 2 - 0.25, token_times=np.arange(4.0)), "apply softmax"),
        (
            dict(attention=np.eye(4), token_times=np.arange(5.0)),
            r"one for each of the 4 columns, not shape \(5,\)",
        ),
        (dict(attention=np.eye(4), token_times=[0, 2, 1, 3]), "token_times must be increasing"),
        (dict(attention=np.eye(4)), r"token_times must be increasing seconds.* not shape \(0,\)"),
        (
            dict(attention={"a": np.eye(4)}, token_times={"b": np.arange(4)}),
            "no times for 'a'; it has b",
        ),
        (dict(attention={}), "attention is empty"),
        (
            dict(attention=np.eye(4), token_times=np.arange(4), scale="row"),
            'scale must be "map" or "frame"',
        ),
        (
            dict(moved=np.zeros(9)),
            r"one finite distance in metres per frame, \(86,\), not shape \(9,\)",
        ),
        (dict(moved=-np.ones(T)), "`moved` must be one finite distance"),
        (dict(moved=np.zeros(T), hit=-1.0), "`hit` must be increasing times"),
        (dict(audio=None, attention=np.eye(4), token_times=np.arange(4)), "pass `audio` too"),
    ],
)
def test_what_is_no_attention_is_explained(wrong, message):
    audio = clicks(BEATS, SECONDS)
    with pytest.raises(ValueError, match=message):
        track = Soundtrack(
            wrong.pop("audio", audio), listening=Listening(**wrong), sample_rate=RATE
        )
        Player(jumping(T, [30]), audio=track)


def test_show_replaces_what_is_given_and_an_error_changes_nothing(maps, moved):
    heard = Listening(maps, TIMES)
    track = Soundtrack(clicks(BEATS, SECONDS), listening=heard, sample_rate=RATE)
    one = Player(jumping(T, [30]), audio=track)
    before = one.music
    doubled = replace(heard, attention=2 * maps["fine"])
    with pytest.raises(ValueError, match="row 0 sums"):
        one.show(jumping(T, [40]), audio=replace(track, listening=doubled))
    assert one.music == before
    one.show(jumping(T, [40]))
    assert one.music == before
    silenced = replace(heard, moved=moved, hit=[1.9, 2.9])
    one.show(jumping(T, [40]), audio=replace(track, listening=silenced))
    assert one.music["moved"]["hits"] == [1.9, 2.9] and len(one.music["levels"]) == 2
    unread = replace(silenced, attention=None)
    one.show(jumping(T, [40]), audio=replace(track, listening=unread))
    assert one.music["levels"] == [] and one.music["moved"] is not None


# ---- drawn

# per column of the lane: how purple the waveform's rows are, how green those of the curve
COLOURS = """() => {
  const c = document.querySelector(".mde-lane");
  const d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
  const purple = [], green = [];
  for (let x = 0; x < c.width; x++) {
    let p = 0, g = 0;
    for (let y = 0; y < c.height; y++) {
      const [r, v, b] = [0, 1, 2].map((k) => d[4 * (y * c.width + x) + k]);
      if (r > v + 40 && b > v + 20) p++;
      if (v > r + 30) g++;
    }
    purple.push(p); green.push(g);
  }
  return [purple, green];
}"""


def seconds_at(column, width):
    """The time of a column of pixels; the lane has a margin of 8."""
    return (np.asarray(column) + 0.5 - 8) / (width - 16) * SECONDS


def test_the_row_of_the_present_frame_is_coloured_where_it_looks(browser, listening, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, listening))
        for level, looks_at in (
            ("fine", lambda f: TIMES[f // 2]),
            ("coarse", lambda f: TIMES[42 - 4 * (f * 11 // T)]),
        ):
            page.get_by_label("Level of the attention").select_option(level)
            for frame in (9, 52, 80):
                page.evaluate(f"model.set('frame', {frame})")
                purple = np.array(page.evaluate(COLOURS)[0])
                found = seconds_at(np.flatnonzero(purple > 20), len(purple))
                assert abs(found.mean() - looks_at(frame)) < 0.05 and np.ptp(found) < 0.12, (
                    level,
                    frame,
                )
                assert (
                    f"most at {looks_at(frame):.2f} s"
                    in page.locator(".mde-lane + .mde-row output").inner_text()
                )
        assert page.problems == []


def test_the_curve_of_what_moved_peaks_where_it_does(browser, listening, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, listening))
        green = np.array(page.evaluate(COLOURS)[1])
        peak = seconds_at(np.flatnonzero(green > 0.97 * green.max()), len(green)).mean()
        assert abs(peak - 2.425) < 0.1  # the middle of the frame at 2.4 s
        page.evaluate("model.set('frame', 48)")
        assert "moved 0.30 m" in page.locator(".mde-lane + .mde-row output").inner_text()


def test_a_click_in_the_lane_goes_there_and_playing_goes_on(browser, listening, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, listening))
        box = page.locator(".mde-lane").bounding_box()
        x = 8 + 3.03 / SECONDS * (box["width"] - 16)
        page.mouse.click(box["x"] + x, box["y"] + 40)
        assert page.locator(".mde-player").get_attribute("data-frame") == "60"
        assert page.evaluate("document.querySelector('audio').currentTime") == pytest.approx(
            3.0, abs=1e-3
        )
        lane = page.locator(".mde-lane")
        told = ("min", "max", "now", "text")
        assert [lane.get_attribute(f"aria-value{name}") for name in told] == [
            "0", "4.30", "3.00", "3.00 of 4.30 seconds, beat 6 of 8",
        ]  # fmt: skip
        page.keyboard.press("ArrowLeft")  # the lane has the focus
        assert (
            page.locator(".mde-player").get_attribute("data-frame") == "59"
            and page.evaluate("leaked") == 0
        )
        page.get_by_role("button", name="Play").click()
        page.mouse.click(box["x"] + 8 + 1.03 / SECONDS * (box["width"] - 16), box["y"] + 40)
        page.wait_for_function("document.querySelector('.mde-player').dataset.frame < 40")
        page.wait_for_function("document.querySelector('.mde-player').dataset.frame > 24")
        assert page.locator(".mde-player").get_attribute("data-playing") == "true"


TEXTS = """() => {  // boxes of all labels written on the lane
  const boxes = [], write = CanvasRenderingContext2D.prototype.fillText;
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
    const wide = this.measureText(text).width;
    if (this.canvas.className === "mde-lane") boxes.push([text, x, y - 12, x + wide, y + 2]);
    return write.call(this, text, x, y);
  };
  model.set("frame", 12);
  CanvasRenderingContext2D.prototype.fillText = write;
  return boxes;
}"""


@pytest.mark.parametrize("width", [320, 360, 768, 1280, 1920])
def test_labels_neither_overlap_nor_leave_the_lane(browser, listening, tmp_path, width):
    with open_page(browser, viewport={"width": width, "height": 700}) as page:
        page.goto(player_page(tmp_path, listening))
        boxes = page.evaluate(TEXTS)
        inside = page.locator(".mde-lane").bounding_box()["width"]
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert len(boxes) >= 4
    for i, (text, left, top, right, foot) in enumerate(boxes):
        assert left >= 0 and right <= inside, text
        for other, left2, top2, right2, foot2 in boxes[:i]:
            assert right <= left2 or right2 <= left or foot <= top2 or foot2 <= top, (text, other)


def test_exported_it_shows_the_same_and_the_poster_has_the_lane(browser, listening, maps, tmp_path):
    html = listening._repr_mimebundle_()[0]["text/html"]
    (tmp_path / "export.html").write_text(f"<!doctype html><body>{html}", "utf-8")
    with open_page(browser) as page:
        page.goto((tmp_path / "export.html").as_uri())
        lane = page.frame_locator("iframe").locator(".mde-lane")
        until(lane, f"() => Math.max(...({COLOURS})()[0]) > 20")
        assert page.problems == [] and page.asked == []
    pixels = np.asarray(listening.poster().convert("RGB")).astype(int)
    assert (
        (pixels[..., 0] > pixels[..., 1] + 40) & (pixels[..., 2] > pixels[..., 1] + 20)
    ).sum() > 500
    assert len(html) < 300_000


# ---- as a figure


def test_the_figure_has_map_waveform_and_beats_on_one_axis_of_time(maps):
    audio = clicks(BEATS, SECONDS)
    fig = levels_over_sound(audio, RATE, {"fine": maps["fine"]}, TIMES, BEATS, SECONDS, "words")
    wave, axis = fig.axes[:2]
    (mesh,) = [c for c in axis.collections if c.get_array() is not None]
    np.testing.assert_allclose(np.asarray(mesh.get_array()).reshape(T, 43), maps["fine"])
    corners = mesh.get_coordinates()
    np.testing.assert_allclose(corners[0, :, 0], np.arange(44) * 0.1, atol=1e-9)
    np.testing.assert_allclose(corners[:, 0, 1], np.linspace(0, SECONDS, T + 1))
    for panel in (wave, axis):
        upright = [line.get_xdata()[0] for line in panel.lines if list(line.get_ydata()) == [0, 1]]
        np.testing.assert_allclose(sorted(upright), BEATS[BEATS < SECONDS])
    assert wave.get_xlim() == axis.get_xlim() == (0, SECONDS) and caption(fig) == "words"


def test_without_attention_the_lane_has_only_the_waveform(browser, tmp_path):
    plain = Player(
        walk(frames=37)[0],
        audio=Soundtrack(clicks([0.5], 1.85), sample_rate=RATE),
        look=Look(autoplay=False),
    )
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, plain))
        assert page.locator(".mde-lane").bounding_box()["height"] < 100
        assert not page.get_by_label("Level of the attention").is_visible()
        assert max(page.evaluate(COLOURS)[0]) == 0
