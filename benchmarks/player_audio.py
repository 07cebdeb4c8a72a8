"""The offset between picture and sound while the player plays.

It is measured in a real Chromium, with everything that the player can show.

At random moments the sound's clock t and the painted frame k are read; their distance is that of t
from the frame's interval [k/20, (k+1)/20), zero inside. A run's number is the 95th percentile of
its distances. The sizes of the exported page with and without sound are recorded beside it. Run:
python benchmarks/player_audio.py [--runs 5] [--seconds 8] [--out
benchmarks/results/player_audio.json]
"""

import argparse
import shutil
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, sync_playwright
from records import record, show, write_records

sys.path.insert(0, str(Path(__file__).parents[1]))  # data_synth, beside this folder

from data_synth.walking import walk  # noqa: E402
from motiondiff_edu.conditions.control import constant_control  # noqa: E402
from motiondiff_edu.motion.root_frame import to_world  # noqa: E402
from motiondiff_edu.widgets.listening import Listening  # noqa: E402
from motiondiff_edu.widgets.player import Player, Soundtrack  # noqa: E402

COMMAND = "python -m benchmarks player"
FPS = 20
RATE = 16_000
BEAT = 0.5
SAMPLE = """async (seconds) => {
  const root = document.querySelector(".mde-player"), sound = root.querySelector("audio");
 const rows = [];
  const end = performance.now() + 1000 * seconds;
  while (performance.now() < end) {
    rows.push([sound.currentTime, Number(root.dataset.frame)]);
    await new Promise((done) => setTimeout(done, 10 * Math.random()));
  }
  return rows;
}"""


def click_track(seconds: float) -> np.ndarray:
    """A click on every beat."""
    samples = np.zeros(round(seconds * RATE))
    n = np.arange(round(0.04 * RATE))
    click = 0.8 * np.exp(-n / RATE / 0.01) * np.sin(2 * np.pi * 1000 * n / RATE)
    for beat in np.arange(0, seconds - 0.05, BEAT):
        samples[round(beat * RATE) :][: len(n)] += click
    return samples


def attention(rows: int, seconds: float, tokens: int) -> tuple[np.ndarray, np.ndarray]:
    """An artificial attention map around the present, and the tokens' times."""
    times = (np.arange(tokens) + 0.5) * seconds / tokens
    now = (np.arange(rows) + 0.5) * seconds / rows
    weights = np.exp(-((now[:, None] - times) ** 2))
    return weights / weights.sum(1, keepdims=True), times


def players(seconds: float) -> dict[str, Player]:
    """The same walk silent, with sound, and with all that the music lane can show."""
    clip = walk(constant_control(1.0, 0.0, 0.4, seconds=seconds + 1), seed=1, style="neutral")
    frames = round(seconds * FPS)
    positions = to_world(clip.poses, clip.control)[:frames]
    audio, beats = click_track(seconds), np.arange(0, seconds, BEAT)
    weights, times = attention(frames, seconds, 125)
    heard = Listening(weights, times, moved=0.2 * weights.max(1), hit=2.0)
    track = Soundtrack(audio, beats, beats[::4], sample_rate=RATE)
    return {
        "silent": Player(positions),
        "sound": Player(positions, audio=track),
        "listening": Player(positions, audio=replace(track, listening=heard)),
    }


def offsets_ms(browser: Browser, page_path: Path, seconds: float) -> np.ndarray:
    """Distances of the sound's clock from the painted frame's interval, after a click on Play."""
    page = browser.new_page(viewport={"width": 1280, "height": 720})
    page.goto(page_path.as_uri())
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("document.querySelector('audio').currentTime > 0")
    t, frame = np.array(page.evaluate(SAMPLE, seconds)).T
    page.close()
    if np.ptp(t) < 0.8 * seconds:
        raise RuntimeError(
            f"the sound went on by {np.ptp(t):.1f} s in {seconds} s, so it did not play"
        )
    return 1000 * np.maximum(0, np.maximum(frame / FPS - t, t - (frame + 1) / FPS))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=8)
    parser.add_argument("--out", default="benchmarks/results/player_audio.json")
    args = parser.parse_args()
    names = ("chromium", "chromium-browser", "google-chrome")
    chromium = next(filter(None, map(shutil.which, names)), None)
    if chromium is None:
        sys.exit("no Chromium found: install it (Debian: apt-get install chromium)")
    shown, runs = players(args.seconds + 2), []
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", "--disable-gpu"]
        )
        saved = shown["listening"].save_html(Path(folder) / "listening.html")
        for _ in range(args.runs):
            runs.append(offsets_ms(browser, saved, args.seconds))
        browser.close()
    late = [np.percentile(run, 95) for run in runs]
    records = [record("player.audio_offset_ms", late, unit="ms", command=COMMAND)]
    records.append(
        record(
            "player.audio_offset_max_ms", [run.max() for run in runs], unit="ms", command=COMMAND
        )
    )
    for name, player in shown.items():
        size = len(player.page().encode()) / 1000
        records.append(record(f"player.page_{name}_kb", [size], unit="kB, 10 s", command=COMMAND))
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
