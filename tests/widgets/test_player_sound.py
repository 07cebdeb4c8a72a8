"""Sound in the player: the sound is the clock, live and exported; and what Python says of sounds
that do not fit."""

import io
import re
import sys
import warnings
import wave
from pathlib import Path

import numpy as np
import pytest
import soundfile
import torch
from browser import ANOTHER_FRAME, open_page, player_page, shown
from click_track import RATE, clicks, jumping
from synthetic_walk import walk

from motiondiff_edu.viz import style
from motiondiff_edu.widgets import module, sound
from motiondiff_edu.widgets.player import MODULE, Look, Player, Soundtrack

JUMPS = [22, 47, 71]  # frames; the clicks are at k/20 s


@pytest.fixture(scope="module")
def player():
    audio = clicks(np.array(JUMPS) / 20, 4.6)
    track = Soundtrack(audio, beats=np.array(JUMPS) / 20, sample_rate=RATE)
    return Player(jumping(92, JUMPS), audio=track, look=Look(follow=False))


HEARD = "document.querySelector('audio').currentTime"


# ---- in the browser

# in every animation frame: the sound's time as it begins, the picture as it ends
WATCH = """async (seconds) => {
  const root = document.querySelector(".mde-player"), sound = root.querySelector("audio");
  const rows = [];
  const small = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  while (sound.currentTime < seconds && rows.length < 1500) {
    const heard = await new Promise((done) => requestAnimationFrame(() => done(sound.currentTime)));
    small.drawImage(root.querySelector("canvas"), 0, 0, 48, 24);
    // the upper half: the body, no trail
    const dark = small.getImageData(0, 0, 48, 12).data.map((v) => 255 - v);
    let left = 0, right = 0;
    if (rows.length && heard < rows.at(-1)[0]) break; // it began again before it was seen to end
    for (let i = 0; i < dark.length; i += 4) {
      if (i / 4 % 48 < 24) left += dark[i]; else right += dark[i];
    }
    rows.push([heard, left > right ? "left" : "right", Number(root.dataset.frame)]);
  }
  return rows;
}"""


def test_a_planted_beat_lands_on_its_click(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        page.get_by_role("button", name="Play").click()
        rows = page.evaluate(WATCH, 4.4)
        assert page.problems == []
    heard = np.array([row[0] for row in rows])
    # a frame may be painted within a frame's time
    clear = np.abs(heard[:, None] - np.array(JUMPS) / 20).min(1) > 0.05
    wanted = np.array(["left", "right"])[(np.array(JUMPS) / 20 <= heard[:, None]).sum(1) % 2]
    wrong = [
        t
        for t, row, want, sure in zip(heard, rows, wanted, clear, strict=True)
        if sure and row[1] != want
    ]
    assert clear.sum() > 30 and {row[1] for row in rows} == {"left", "right"}
    assert len(wrong) <= 0.02 * clear.sum(), f"the figure stood elsewhere at {wrong[:5]} s"
    assert [row[2] for row in rows] == sorted(row[2] for row in rows)


DECODED = """async () => {
  const bytes = model.get("sound"), start = bytes.byteOffset;
  const file = bytes.buffer.slice(start, start + bytes.byteLength);
  const heard = await new OfflineAudioContext(1, 16000, 16000).decodeAudioData(file);
  return Array.from(heard.getChannelData(0));
}"""


@pytest.mark.parametrize("codec", ["ogg", "flac", "wav"])
def test_the_browser_decodes_every_click_where_it_was_put(browser, tmp_path, codec):
    audio = clicks(np.array(JUMPS) / 20, 4.6)
    with open_page(browser) as page:
        coded = Player(jumping(92, JUMPS), audio=Soundtrack(audio, codec=codec, sample_rate=RATE))
        page.goto(player_page(tmp_path, coded))
        heard = np.array(page.evaluate(DECODED))
    assert abs(len(heard) - len(audio)) < 0.01 * RATE
    shift = np.correlate(heard, audio, "full").argmax() - (len(audio) - 1)
    assert abs(shift) <= 0.001 * RATE and np.abs(heard).max() > 0.5


LOWEST = """(goal) => new Promise((done) => {  // the lowest frame shown until one above the goal is
  let low = Infinity;
  const look = () => {
    const frame = Number(document.querySelector(".mde-player").dataset.frame);
    low = Math.min(low, frame);
    if (frame > goal) done(low); else requestAnimationFrame(look);
  };
  look();
})"""


def test_keys_slider_and_python_seek_the_sound_and_it_goes_on_from_there(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        canvas = page.locator("canvas").first
        canvas.focus()
        for key, frame in {"ArrowUp": 10, "ArrowRight": 11, "End": 91, "Home": 0}.items():
            page.keyboard.press(key)
            assert shown(page) == frame and page.evaluate(HEARD) == pytest.approx(
                frame / 20, abs=1e-3
            )
        page.locator("input[type=range]").fill("64")
        assert shown(page) == 64 and page.evaluate(HEARD) == pytest.approx(3.2, abs=1e-3)
        page.evaluate("model.set('frame', 37)")
        assert page.evaluate(HEARD) == pytest.approx(1.85, abs=1e-3)
        canvas.focus()
        page.keyboard.press(" ")
        assert page.evaluate(LOWEST, 40) >= 37
        page.keyboard.press(" ")
        page.wait_for_function(
            "document.querySelector('audio').paused && !document.querySelector('audio').seeking"
        )
        frame, heard = shown(page), page.evaluate(HEARD)
        assert frame / 20 - 1e-3 <= heard <= (frame + 1) / 20, "at rest they agree"
        for _ in range(4):
            page.evaluate(ANOTHER_FRAME)
        assert (shown(page), page.evaluate(HEARD)) == (frame, heard)
        assert page.evaluate("[saved.at(-1).frame, saved.at(-1).playing, leaked]") == [
            frame,
            False,
            0,
        ]


def test_sound_and_picture_begin_again_together(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        page.locator("input[type=range]").fill("84")
        page.get_by_role("button", name="Play").click()
        page.wait_for_function(
            f"document.querySelector('.mde-player').dataset.frame < 20 && {HEARD} < 1"
        )
        page.wait_for_function(
            f"document.querySelector('.mde-player').dataset.frame > 4 && {HEARD} > 0.2"
        )
        assert page.evaluate("document.querySelector('.mde-player').dataset.playing") == "true"


def test_speed_keeps_the_pitch_and_mute_is_a_button_and_a_key(browser, player, tmp_path):
    sounding = (
        "(() => { const a = document.querySelector('audio'); "
        "return [a.playbackRate, a.preservesPitch, a.muted]; })()"
    )
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        page.get_by_label("Speed").select_option("2")
        page.get_by_role("button", name="Mute").click()
        assert page.evaluate(sounding) == [2, True, True]
        page.locator("canvas").first.focus()
        page.keyboard.press("m")
        assert page.evaluate(sounding) == [2, True, False]
        page.get_by_role("button", name="Play").click()
        rows = page.evaluate(WATCH, 3.0)
        apart = [abs(frame - 20 * heard) for heard, _, frame in rows]
        assert np.median(apart) < 2.5  # at twice the speed a frame lasts 25 ms
        page.get_by_role("button", name="Reset").click()
        assert page.evaluate(sounding)[0] == 1 and page.evaluate(HEARD) == 0


def test_without_a_click_it_waits_and_says_so(browser, tmp_path):
    waiting = Player(
        walk(frames=43)[0],
        audio=Soundtrack(clicks([1.0], 2.15), sample_rate=RATE),
        look=Look(autoplay=True),
    )
    with open_page(browser, reduced_motion="no-preference") as page:
        page.goto(player_page(tmp_path, waiting))
        page.get_by_text("browsers start sound only after a click").wait_for()
        assert page.evaluate("[model.get('playing'), document.querySelector('audio').paused]") == [
            False,
            True,
        ]
        page.get_by_role("button", name="Play").click()
        page.wait_for_function(
            f"{HEARD} > 0.3 && document.querySelector('.mde-player').dataset.frame > 5"
        )
        assert page.get_by_text("browsers start sound").count() == 0


def test_before_a_room_it_moves_without_a_click_and_is_heard_after_one(
    browser, tmp_path, monkeypatch
):
    monkeypatch.setattr(style, "PROJECTED", True)
    moving = Player(walk(frames=43)[0], audio=Soundtrack(clicks([1.0], 2.15), sample_rate=RATE))
    with open_page(browser, reduced_motion="no-preference") as page:
        page.goto(player_page(tmp_path, moving))
        page.wait_for_function("document.querySelector('.mde-player').dataset.frame > 5")
        assert page.evaluate("document.querySelector('audio').muted")
        page.get_by_role("button", name="Mute").click()
        assert page.evaluate("[document.querySelector('audio').muted, model.get('playing')]") == [
            False,
            True,
        ]
        page.wait_for_function(f"{HEARD} > 0.3")


VIEWS = """() => [...document.querySelectorAll(".mde-player")].map((root) => ({
  frame: Number(root.dataset.frame), playing: root.dataset.playing,
  heard: !root.querySelector("audio").paused }))"""


def test_of_two_views_of_one_player_one_sounds_and_the_other_follows(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        page.evaluate("""() => { another(); window.changes = 0;
            model.on("change:playing", () => { changes++; }); }""")
        play = page.get_by_role("button", name="Play")
        stop = page.get_by_role("button", name="Pause")
        for pressed, other in ((0, 1), (1, 0)):  # what sounds is the view that was pressed
            page.evaluate("changes = 0")
            play.nth(pressed).click()
            page.wait_for_function(f"({VIEWS})().every((view) => view.frame > 12)")
            views = page.evaluate(VIEWS)
            assert [view["playing"] for view in views] == ["true", "true"]
            assert views[pressed]["heard"] and not views[other]["heard"]
            assert abs(views[0]["frame"] - views[1]["frame"]) <= 8
            assert page.evaluate("changes") == 1
            stop.nth(other).click()
            views = page.evaluate(VIEWS)
            assert [view["playing"] for view in views] == ["false", "false"]
            assert views[0]["frame"] == views[1]["frame"] and page.evaluate("changes") == 2
            page.wait_for_function(f"!({VIEWS})().some((view) => view.heard)")
            page.locator("canvas").first.focus()
            page.keyboard.press("Home")
        play.nth(0).click()
        page.evaluate(
            "document.dispatchEvent(new CustomEvent('mde-sound', { detail: { scene: {} } }))"
        )  # another player
        assert [view["playing"] for view in page.evaluate(VIEWS)] == ["false", "false"]
        play.nth(0).click()
        page.wait_for_function(f"({VIEWS})()[0].heard")
        page.evaluate("cleanup()")  # who followed it sounds now
        page.wait_for_function(f"({VIEWS})()[0].heard && ({VIEWS})()[0].playing === 'true'")
        assert page.problems == []


def test_what_is_stopped_at_once_does_not_start_again(browser, player, tmp_path):
    """The page tells that a sound has begun when it may have been stopped already."""
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        page.get_by_role("button", name="Play").click()
        page.get_by_role("button", name="Pause").click()
        page.evaluate("""() => {
            const play = document.querySelector(".mde-play");
            window.begun = 0;
            document.querySelector("audio").addEventListener("play", () => { begun++; });
            play.click();
            play.click();
        }""")
        page.wait_for_function("begun === 1")
        page.wait_for_timeout(100)
        assert [view["playing"] for view in page.evaluate(VIEWS)] == ["false"]
        assert not page.evaluate(VIEWS)[0]["heard"] and page.problems == []


def test_a_sound_is_not_started_unasked(browser, player, tmp_path):
    with open_page(browser, reduced_motion="no-preference") as page:
        page.goto(player_page(tmp_path, player))
        assert page.locator(".mde-player").get_attribute("data-playing") == "false"
        assert page.get_by_text("browsers start sound").count() == 0


def test_exported_html_sounds_in_its_sandbox_offline(browser, player, tmp_path):
    path = tmp_path / "export.html"
    path.write_text(f"<!doctype html><body>{player._repr_mimebundle_()[0]['text/html']}", "utf-8")
    with open_page(browser) as page:
        page.goto(path.as_uri())
        inside = page.frame_locator("iframe")
        inside.get_by_role("button", name="Play").click()
        page.frames[1].wait_for_function(
            "document.querySelector('.mde-player').dataset.frame >= 30"
            " && document.querySelector('audio').currentTime > 1.3"
            " && !document.querySelector('audio').paused"
        )
        assert inside.locator("audio").evaluate("a => a.duration") == pytest.approx(4.6, abs=0.01)
        assert page.problems == [] and page.asked == []


def test_where_the_sound_cannot_be_played_the_figure_still_moves(browser, player, tmp_path):
    broken = Player(walk(frames=43)[0], audio=Soundtrack(clicks([1.0], 2.15), sample_rate=RATE))
    broken.sound = b"OggS, or so it says"
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, broken))
        page.get_by_role("button", name="Play").click()
        page.get_by_text("No sound: this browser cannot play audio/ogg").wait_for()
        page.wait_for_function("document.querySelector('.mde-player').dataset.frame > 8")
        assert page.locator(".mde-player").get_attribute("data-playing") == "true"


def test_another_dance_brings_its_sound_and_none_takes_it_away(browser, player, tmp_path):
    other = Player(walk(frames=31)[0], audio=Soundtrack(clicks([0.5], 1.55), sample_rate=RATE))
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        first = page.evaluate("document.querySelector('audio').src")
        page.evaluate(
            """([sound, strips, music, scene]) => {
              for (const [name, value] of [["sound", sound], ["strips", strips]])
                model.set(name, new DataView(Uint8Array.from(value).buffer));
              model.set("music", music); model.set("scene", scene); }""",
            [list(other.sound), list(other.strips), other.music, player.scene | {"edition": 2}],
        )
        assert page.evaluate("document.querySelector('audio').src") != first
        page.wait_for_function("Math.abs(document.querySelector('audio').duration - 1.55) < 0.01")
        page.evaluate(
            "model.set('music', {}); model.set('scene', { ...model.get('scene'), edition: 3 })"
        )
        assert page.evaluate(
            "['audio', '.mde-lane'].map((s) => document.querySelectorAll(s).length)"
        ) == [0, 0]
        page.get_by_role("button", name="Play").click()
        page.wait_for_function("document.querySelector('.mde-player').dataset.frame > 3")
        page.evaluate("cleanup()")
        assert page.evaluate("listening()") == 0 and page.problems == []


# ---- in Python


def test_without_a_sound_nothing_of_it_is_there():
    player = Player(walk(frames=37)[0])
    assert (player.sound, player.strips, player.music) == (b"", b"", {})
    assert player.scene["autoplay"] is True and "Music" not in player.description


def test_the_record_holds_times_and_a_waveform(player):
    assert player.music["beats"] == [1.1, 2.35, 3.55] and player.music["downbeats"] == []
    assert player.music["seconds"] == pytest.approx(4.6) and player.music["mime"] == "audio/ogg"
    wave_shape = np.frombuffer(player.strips, np.int8).reshape(-1, 2)
    loud = np.flatnonzero(np.abs(wave_shape.astype(int)).max(1) > 60) / len(wave_shape) * 4.6
    assert all(np.abs(loud - t).min() < 0.01 for t in (1.1, 2.35, 3.55)) and len(loud) < 12
    assert "Music: 4.6 s" in player.description and "3 beats marked" in player.description
    assert (player.scene["autoplay"], player.scene["muted"]) == (False, False)


def test_before_a_room_the_buttons_are_seen_below_the_figure(browser, tmp_path, monkeypatch):
    monkeypatch.setattr(style, "PROJECTED", True)
    tall = Player(
        walk(frames=43)[0],
        audio=Soundtrack(clicks([1.0], 2.15), sample_rate=RATE),
        look=Look(height=900),
    )
    with open_page(browser) as page:
        page.set_viewport_size({"width": 1060, "height": 720})
        page.goto(player_page(tmp_path, tall))
        page.wait_for_function("document.querySelector('.mde-player').dataset.frame >= 0")
        box = page.locator(".mde-player").bounding_box()
    assert 340 < box["height"] <= 555  # JupyterLab's bars and the cell's own line take 165 of 720


def test_before_a_room_only_what_has_a_sound_is_muted(monkeypatch):
    monkeypatch.setattr(style, "PROJECTED", True)
    motion, sounds = walk(frames=37)[0], Soundtrack(clicks([0.5], 1.85), sample_rate=RATE)
    silent, sounding = Player(motion).scene, Player(motion, audio=sounds).scene
    waiting = Player(motion, audio=sounds, look=Look(autoplay=False)).scene
    assert (silent["autoplay"], silent["muted"]) == (True, False)
    assert (sounding["autoplay"], sounding["muted"]) == (True, True)
    assert (waiting["autoplay"], waiting["muted"]) == (False, False)


def test_ten_seconds_are_a_small_page():
    noisy = np.random.default_rng(0).normal(0, 0.1, 10 * RATE) + clicks(np.arange(0.5, 10, 0.5), 10)
    track = Soundtrack(noisy, sample_rate=RATE)
    silent, sounding = (Player(walk(frames=200)[0], audio=audio) for audio in (None, track))
    assert len(sounding.page()) - len(silent.page()) < 90_000


def test_a_sound_is_cut_or_filled_up_to_the_motion_and_that_is_said():
    motion = walk(frames=37)[0]  # 1.85 s
    with pytest.warns(
        UserWarning, match="the sound lasts 1.00 s, the motion 1.85 s: the last 0.85 s are silent"
    ):
        Player(motion, audio=Soundtrack(clicks([0.5], 1.0), codec="wav", sample_rate=RATE))
    with pytest.warns(
        UserWarning, match="the sound lasts 3.00 s, the motion 1.85 s: the rest is cut off"
    ):
        track = Soundtrack(clicks([0.5], 3.0), beats=[0.5, 2.5], codec="wav", sample_rate=RATE)
        player = Player(motion, audio=track)
    with wave.open(io.BytesIO(player.sound)) as file:
        assert file.getnframes() == round(1.85 * RATE)
    assert player.music["beats"] == [0.5]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Player(motion, audio=Soundtrack(clicks([0.5], 1.87), sample_rate=RATE))


@pytest.mark.parametrize(
    "audio, message",
    [
        (np.zeros((2, 500)), r"audio has shape \(2, 500\); pass one channel \(N,\)"),
        (np.zeros(0), "audio has no samples"),
        (np.zeros(500, np.int16), "audio is int16; pass floats"),
        (np.array([0, np.nan, np.nan, 0]), r"not finite at sample 1 \(0.00 s\); 2 samples in all"),
    ],
)
def test_samples_that_are_no_sound_are_explained(audio, message):
    with pytest.raises(ValueError, match=message):
        Player(walk(frames=37)[0], audio=Soundtrack(audio, sample_rate=RATE))


@pytest.mark.parametrize(
    "audio, message",
    [
        (b"no sound at all", "these 15 bytes are not a WAV, FLAC, Ogg or MP3 file"),
        (
            np.zeros(500),
            r"the samples need their rate, in Hz: pass Soundtrack\(audio, sample_rate=",
        ),
        (torch.zeros(500), "the samples need their rate"),
        ("song.ogg", r"name of a file, or an open file: pass its bytes, Path\(name\).read_bytes"),
        (Path("song.ogg"), "name of a file, or an open file"),
        (io.BytesIO(b"RIFF"), "name of a file, or an open file"),
    ],
)
def test_sounds_that_are_none_are_explained(audio, message):
    with pytest.raises(ValueError, match=message):
        sound.as_sound(audio)
    if not isinstance(audio, Path | io.BytesIO):  # types that the annotations refuse
        with pytest.raises(ValueError, match=message):
            Player(walk(frames=37)[0], audio=audio)


def test_other_wrong_arguments_are_explained_and_leave_the_player_as_it_was():
    audio, motion = clicks([0.5], 1.85), walk(frames=37)[0]
    for wrong, message in [
        (
            dict(sample_rate=200),
            "sample_rate must be a whole number from 8000 to 96000 Hz, not 200",
        ),
        (dict(codec="aac"), "codec must be one of ogg, flac, wav, not 'aac'"),
        (dict(beats=[1.0, 0.5]), "`beats` must be increasing times in seconds"),
        (dict(downbeats=[[0.5]]), "`downbeats` must be increasing times"),
        (dict(beats=[0.5, np.nan]), "`beats` must be increasing times"),
    ]:
        with pytest.raises(ValueError, match=message):
            Player(motion, audio=Soundtrack(audio, **{"sample_rate": RATE} | wrong))
    with pytest.raises(ValueError, match="pass `audio` too"):
        Player(motion, audio=Soundtrack(None, beats=[0.5]))
    player = Player(motion, audio=Soundtrack(audio, sample_rate=RATE))
    before = player.scene, player.sound
    with pytest.raises(ValueError, match="no samples"):
        player.show(motion[:9], audio=Soundtrack(np.zeros(0), sample_rate=RATE))
    assert (player.scene, player.sound) == before and player.poster().width == 960


@pytest.mark.parametrize(
    "form, rate", [("WAV", 16_000), ("FLAC", 22_050), ("MP3", 44_100), ("OGG", 32_000)]
)
def test_bytes_of_any_file_are_the_same_sound_whatever_their_rate(form, rate):
    file, audio = io.BytesIO(), clicks([0.5, 1.2], 1.85, rate)
    soundfile.write(file, np.stack([audio, audio], 1), rate, format=form)
    made = sound.as_sound(file.getvalue(), seconds=1.85)
    assert (made.sample_rate, made.mime) == (rate, "audio/ogg") and made.seconds == pytest.approx(
        1.85, abs=1e-3
    )
    back, at = soundfile.read(io.BytesIO(made.data))
    assert at in sound.OPUS_RATES and len(back) == pytest.approx(1.85 * at, abs=2)
    onsets = [
        np.abs(back[round((t - 0.1) * at) : round((t + 0.1) * at)]).argmax() / at - 0.1
        for t in (0.5, 1.2)
    ]
    assert np.abs(onsets).max() < 0.004


def test_a_loud_sound_is_scaled_and_not_clipped():
    audio = 3 * clicks([0.5], 1.85)
    data = sound.as_sound(audio, RATE, codec="flac")
    np.testing.assert_allclose(data.samples, audio / np.abs(audio).max(), atol=1e-6)


def test_without_soundfile_a_wav_file_is_written(monkeypatch):
    monkeypatch.setitem(sys.modules, "soundfile", None)
    audio = clicks([0.25], 0.5)
    made = sound.as_sound(audio, RATE)
    assert made.mime == "audio/wav"
    with wave.open(io.BytesIO(made.data)) as file:
        got = np.frombuffer(file.readframes(RATE), "<i2") / 32767
        assert (file.getframerate(), file.getnchannels()) == (RATE, 1)
    np.testing.assert_allclose(got, audio, atol=1 / 32767)


def test_without_the_codec_the_wav_file_has_the_sound_s_own_rate(monkeypatch):
    """What was resampled for the codec must not be written with the rate from before."""

    def refuses(*arguments, **options):
        raise ValueError("Unknown subtype: 'OPUS'")

    monkeypatch.setattr(soundfile, "SoundFile", refuses)
    data, mime = sound.encode(np.zeros(44_100, np.float32), 44_100)
    with wave.open(io.BytesIO(data)) as file:
        assert mime == "audio/wav" and (file.getframerate(), file.getnframes()) == (44_100, 44_100)


def test_a_rate_may_be_a_float_that_is_whole():
    assert sound.as_sound(np.zeros(8000, np.float32), 16_000.0).mime == "audio/ogg"


def test_a_long_sound_can_be_written():
    minute = np.random.default_rng(1).normal(0, 0.1, RATE * 80).astype(np.float32)
    data, mime = sound.encode(minute, RATE)
    assert mime == "audio/ogg" and soundfile.info(io.BytesIO(data)).duration == pytest.approx(
        80, abs=0.05
    )


def test_an_mp4_has_the_sound(tmp_path):
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")
    player = Player(walk(frames=11)[0], audio=Soundtrack(clicks([0.25], 0.55), sample_rate=RATE))
    told = next(imageio_ffmpeg.read_frames(str(player.save_mp4(tmp_path / "walk.mp4", (64, 64)))))
    assert told["audio_codec"] == "aac" and told["duration"] == pytest.approx(0.55, abs=0.06)
    assert not [path for path in tmp_path.iterdir() if path.name != "walk.mp4"]


def test_the_same_scene_with_another_motion_is_told_to_the_page():
    first = walk(frames=37, speed=1.0)[0]
    second = walk(frames=37, speed=1.001)[0]
    player = Player(first)
    heard = []
    player.observe(lambda change: heard.append(change["new"]), "scene")
    player.show(second)
    assert len(heard) == 1 and heard[0]["description"] == Player(first).scene["description"]


def test_the_parts_of_the_module_fit_together():
    exported = {}
    for name in dict.fromkeys((*module.PARTS, *module.EDITOR, *module.BENCH, *module.PATH)):
        text = (module.FOLDER / f"{name}.js").read_text("utf-8")
        for names, source in re.findall(
            r'^import \{([^}]*)\} from "\./(\w+)\.js";$', text, re.MULTILINE
        ):
            assert set(re.findall(r"\w+", names)) <= exported[source], (
                f"{name}.js takes from {source}.js what is not there"
            )
        names = re.findall(r"^export (?:function|const) (\w+)", text, re.MULTILINE)
        exported[name] = set(names)
    assert {path.stem for path in module.FOLDER.glob("*.js")} == {
        *module.PARTS,
        *module.EDITOR,
        *module.BENCH,
        *module.PATH,
    }
    assert (
        "\nimport " not in MODULE
        and Player._esm is not None
        and str(Player(walk(frames=3)[0])._esm) == MODULE
    )
    assert re.findall(r"^export (?:default|function (\w+))", MODULE, re.MULTILINE) == [
        "mount",
        "staticModel",
        "",
    ]
