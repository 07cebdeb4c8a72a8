"""The clock that a sound is.

What it tells from one picture to the next, of readings that stutter, jump and start anew.

Page's clock and sound are scripted: how fast the machine is plays no part.
"""

import numpy as np
import pytest
from browser import open_page

from motiondiff_edu.widgets import module

SCRIPTED = """([polls, rate]) => {
  // at every picture: the page's time (s), the sound's, where it is sent first
  let now = 0;
  const performance = { now: () => 1000 * now };
  const audio = { currentTime: 0, paused: true, seeking: false, play() { this.paused = false; } };
  CLOCK
  const clock = soundClock(audio);
  clock.rate(rate); clock.start();
  return polls.map(([time, reading, seek]) => {
    now = time;
    if (seek !== null) clock.seek(seek);
    audio.currentTime = reading;
    return clock.now();
  });
}"""
TIMES = 5 + np.arange(150) / 60  # of the pictures, on the page's clock


@pytest.fixture(scope="module")
def told(browser):
    """told(times, readings, rate, seeks): what the clock tells at each time."""
    text = (module.FOLDER / "clock.js").read_text("utf-8").replace("export function", "function")

    def run(times, readings, rate=1.0, seeks=()):
        seeks = dict(seeks)
        polls = [
            [float(t), float(r), seeks.get(i)]
            for i, (t, r) in enumerate(zip(times, readings, strict=True))
        ]
        return np.array(page.evaluate(SCRIPTED.replace("CLOCK", text), [polls, rate]))

    with open_page(browser) as page:
        yield run


def played(times: np.ndarray, rests=()) -> np.ndarray:
    """Seconds of sound played since the first time, without the `rests`.

    A rest is (begin, length) on the page's clock.
    """
    return (
        times
        - times[0]
        - sum((np.clip(times - begin, 0, length) for begin, length in rests), 0 * times)
    )


def in_steps(sound: np.ndarray, step: float) -> np.ndarray:
    """The sound's time as it is told in steps: late by up to one of them."""
    return sound if step == 0 else np.floor(sound / step + 1e-9) * step


@pytest.mark.parametrize("rest", [0.1, 0.2, 0.29, 0.5])
@pytest.mark.parametrize("first", [0.004, 0.03])
def test_a_sound_that_rests_right_after_its_start_takes_nothing_back(told, rest, first):
    sound = played(TIMES, [(5.0, 0.4), (5.4 + first, rest)])
    tells = told(TIMES, sound)
    assert (np.diff(tells) >= 0).all()
    assert np.abs(tells - sound).max() < 0.061, "it ran on where there was no sound"
    np.testing.assert_allclose(tells[-30:], sound[-30:], atol=1e-3)


@pytest.mark.parametrize("rate", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("step", [0.0, 0.01, 0.1, 0.2])
def test_where_the_sound_stutters_the_clock_waits_for_it(told, step, rate):
    rng = np.random.default_rng(0)
    times = 5 + np.cumsum(rng.uniform(0.01, 0.05, 300))  # pictures come when they can
    begins = np.arange(5.5, times[-1], 0.9)
    sound = rate * played(times, np.stack([begins, rng.uniform(0.02, 0.28 - step, len(begins))], 1))
    tells = told(times, in_steps(sound, rate * step), rate)
    assert (np.diff(tells) >= 0).all(), "it stepped back"
    assert np.abs(tells - sound).max() < 0.061 + 2 * rate * step
    assert np.abs(tells - sound).mean() < 0.022 * (1 + rate)  # a whole frame lasts 0.05 s


def test_between_coarse_readings_the_clock_runs_on_and_a_stall_stops_it(told):
    sound = np.minimum(played(TIMES), 1.9)
    tells = told(TIMES, in_steps(sound, 0.2))
    going = (sound > 0.5) & (sound < 1.85)
    assert np.abs(tells - sound)[going].max() < 0.02  # the readings alone are late by up to 0.2 s
    assert (np.diff(tells[going]) > 0).all()
    assert tells[-1] == pytest.approx(1.8), "it stands where the sound was last read"


def test_the_loop_and_jumps_are_taken_at_once(told):
    sound = 3 + played(TIMES)
    sound[40:] -= 3.5  # the loop
    sound[70:] += 1.7  # by a media key, forwards
    sound[90:] -= 0.1  # and a little back
    np.testing.assert_allclose(told(TIMES, sound), sound, atol=1e-9)


def test_a_seek_is_taken_at_once_however_little_it_goes_back(told):
    sound = 0.5 + played(TIMES)
    sound[50:] -= 0.03
    np.testing.assert_allclose(told(TIMES, sound, seeks={50: sound[50]}), sound, atol=1e-9)
