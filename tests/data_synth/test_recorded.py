"""Recordings: each effect by its formula, and no effect moves a beat."""

import numpy as np
import pytest

from data_synth.music import compose
from data_synth.music.coding import as_mp3, coded, inverse_mdct, mdct
from data_synth.music.effects import (
    Compressor,
    at_rate,
    clipped,
    compressed,
    equalised,
    faded,
    levelled,
    limited,
    loudness,
    saturated,
)
from data_synth.music.hiss import coloured, hum, with_noise
from data_synth.music.recorded import recorded, recorded_song
from data_synth.music.rooms import TAIL, Room, impulse_response, in_room
from data_synth.music.song import SAMPLE_RATE

SECOND = SAMPLE_RATE


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def sine(hertz: float, amplitude: float = 0.5, seconds: float = 2.0) -> np.ndarray:
    return amplitude * np.sin(2 * np.pi * hertz * np.arange(round(seconds * SECOND)) / SECOND)


def clicks(seconds: float = 6.0) -> np.ndarray:
    """Short noises half a second apart, each 20 ms long."""
    y = np.zeros(round(seconds * SECOND))
    burst = rng(1).standard_normal(1600) * np.exp(-np.arange(1600) / 160)
    for at in range(SECOND // 4, len(y) - 1600, SECOND // 2):
        y[at : at + 1600] += 0.2 * burst
    return y


def rise(audio: np.ndarray) -> np.ndarray:
    """How much louder the sound gets every 2 ms (logarithm of the power), where it gets louder."""
    power = (audio[: len(audio) // 32 * 32].reshape(-1, 32) ** 2).mean(1)
    return np.maximum(np.diff(np.log(power + 1e-3 * power.mean())), 0)


def lag(audio: np.ndarray, clean: np.ndarray) -> float:
    """Seconds by which the onsets of `audio` are later than those of `clean`."""
    a, b = rise(audio), rise(clean)
    score = [np.dot(np.roll(a, -k), b) for k in range(-50, 51)]
    return (int(np.argmax(score)) - 50) * 0.002


# ---- nothing moves the beats


EFFECTS = {
    "room": lambda y: in_room(y, Room(1.5, 0.8), rng()),
    "equaliser": lambda y: equalised(y, np.array([100.0, 1000, 6000]), np.array([12.0, -12, 12])),
    "compressor": lambda y: compressed(y, Compressor(-30, 6)),
    "limiter": lambda y: limited(y, 0.05),
    "clipping": lambda y: clipped(y, 0.05),
    "tape": lambda y: saturated(y, 20.0),
    "noise": lambda y: with_noise(y, coloured(len(y), 1.0, rng()), 30.0),
    "hum": lambda y: with_noise(y, hum(len(y), 50.0, rng()), 30.0),
    "fades": lambda y: faded(y, 1.0, 1.0),
    "rate": lambda y: at_rate(y, 2),
    "coding": lambda y: coded(y, 0.5, 6000.0),
}


@pytest.mark.parametrize("name", EFFECTS)
def test_no_effect_moves_an_onset(name):
    clean = clicks()
    heard = EFFECTS[name](clean)
    assert heard.shape == clean.shape and np.isfinite(heard).all()
    assert abs(lag(heard, clean)) <= 0.004
    assert lag(np.roll(heard, 240), clean) == pytest.approx(0.015, abs=0.004)  # it would be seen


@pytest.mark.parametrize("seed", range(12))
def test_a_recording_keeps_the_onsets_and_the_peak_below_one(seed):
    clean = clicks()
    heard = recorded(clean, rng(seed))
    assert heard.dtype == np.float32 and heard.shape == clean.shape
    assert np.isfinite(heard).all() and np.abs(heard).max() <= 1.0
    assert abs(lag(heard, clean)) <= 0.01


def test_recordings_are_reproducible_and_differ():
    clean = clicks(2.0)
    assert np.array_equal(recorded(clean, rng(3)), recorded(clean, rng(3)))
    assert not np.array_equal(recorded(clean, rng(3)), recorded(clean, rng(4)))
    assert np.array_equal(clean, clicks(2.0))  # the input is not written to


def test_silence_stays_silent():
    assert not recorded(np.zeros(SECOND), rng(1)).any()


def test_a_recorded_song_keeps_its_score():
    song = compose(2, seconds=3.0)
    heard = recorded_song(song, seed=1)
    assert np.array_equal(heard.beats, song.beats) and heard.hits is song.hits
    assert not np.array_equal(heard.audio, song.audio)
    assert np.array_equal(heard.audio, recorded_song(song, seed=1).audio)


# ---- rooms


@pytest.mark.parametrize("seconds", [0.4, 1.5])
def test_a_room_decays_by_60_db_in_its_time(seconds):
    response = impulse_response(Room(seconds, 0.5, dull=0.3), rng())
    left = np.cumsum(response[::-1] ** 2)[::-1]  # Schroeder's integral
    t = np.arange(len(left)) / SECOND
    inside = (t > 2 * TAIL) & (t < 0.6 * seconds)
    slope = np.polyfit(t[inside], 10 * np.log10(left[inside]), 1)[0]
    assert -60 / slope == pytest.approx(seconds, rel=0.1)


def test_the_direct_sound_comes_first_and_the_rest_has_the_asked_energy():
    response = impulse_response(Room(0.8, 0.37), rng(2))
    assert response[0] == 1.0 and not response[1 : int(0.0039 * SECOND)].any()
    assert (response[1:] ** 2).sum() == pytest.approx(0.37)
    click = np.zeros(SECOND)
    click[5000] = 1.0
    heard = in_room(click, Room(0.8, 0.37), rng(2))
    assert np.abs(heard[:5000]).max() < 1e-12 and heard[5000] == pytest.approx(1.0)
    np.testing.assert_allclose(heard[5000:], response[: SECOND - 5000], atol=1e-12)


# ---- the desk


@pytest.mark.parametrize(("hertz", "expected"), [(50, 6.0), (200, 6.0), (400, 0.0), (800, -6.0)])
def test_the_equaliser_has_its_gains_and_is_straight_between_octaves(hertz, expected):
    y = sine(hertz)
    heard = equalised(y, np.array([200.0, 800.0]), np.array([6.0, -6.0]))
    middle = slice(SECOND // 2, 3 * SECOND // 2)
    change = 10 * np.log10((heard[middle] ** 2).mean() / (y[middle] ** 2).mean())
    assert change == pytest.approx(expected, abs=0.1)


def test_the_equaliser_is_symmetric_in_time():
    click = np.zeros(SECOND)
    click[SECOND // 2] = 1.0
    heard = equalised(click, np.array([100.0, 1000, 5000]), np.array([-10.0, 5, -20]))
    before, after = heard[1 : SECOND // 2], heard[SECOND // 2 + 1 :]
    np.testing.assert_allclose(after, before[::-1], atol=1e-12)


def test_the_compressor_divides_what_is_above_the_threshold():
    loud = sine(500, 1.0)  # -3 dB
    heard = compressed(loud, Compressor(threshold=-23.0, ratio=4.0))
    level = loudness(heard[SECOND:])
    assert level == pytest.approx(-23.0 + (-3.01 + 23.0) / 4, abs=0.1)
    quiet = sine(500, 0.05)
    np.testing.assert_array_equal(compressed(quiet, Compressor(-23.0, 4.0)), quiet)


def test_the_compressor_lets_go_in_its_release_time():
    y = np.concatenate([sine(500, 1.0, 1.0), sine(500, 0.1, 1.0)])  # -3 dB, then -23 dB
    heard = compressed(y, Compressor(-43.0, 1e9, attack=0.005, release=0.2))
    after = SECOND + round(0.2 * SECOND)
    gain = loudness(heard[after - 160 : after + 160]) - loudness(y[after - 160 : after + 160])
    assert gain == pytest.approx(-20 - 20 / np.e, abs=0.3)  # the level fell to 1/e of its way


def test_the_limiter_holds_its_ceiling_and_leaves_quiet_sound():
    y = 0.1 * rng().standard_normal(SECOND)
    y[8000] = 1.0
    heard = limited(y, 0.5)
    assert np.abs(heard).max() <= 0.5 and heard[8000] == pytest.approx(0.5)
    far = np.abs(np.arange(SECOND) - 8000) > 0.01 * SECOND
    np.testing.assert_array_equal(heard[far], y[far])
    ratio = heard / y  # turned down smoothly, not cut off: the gain changes little between samples
    assert np.abs(np.diff(ratio)).max() < 0.02


def test_clipping_and_tape():
    y = np.array([-0.9, -0.2, 0.0, 0.2, 0.9])
    np.testing.assert_array_equal(clipped(y, 0.5), [-0.5, -0.2, 0.0, 0.2, 0.5])
    np.testing.assert_allclose(saturated(y, 2.0), np.tanh(2 * y) / 2)
    assert saturated(np.array([1e-3]), 2.0)[0] == pytest.approx(1e-3, rel=1e-4)


def test_fades_are_sines_and_leave_the_middle():
    heard = faded(np.ones(4 * SECOND), 1.0, 2.0)
    assert heard[0] == 0.0 and heard[-1] == 0.0
    assert heard[SECOND // 2] == pytest.approx(np.sqrt(0.5), abs=1e-3)
    assert heard[3 * SECOND] == pytest.approx(np.sqrt(0.5), abs=1e-3)
    np.testing.assert_allclose(heard[SECOND : 2 * SECOND - 1], 1.0)
    np.testing.assert_array_equal(faded(np.ones(99), 0, 0), np.ones(99))


def test_levels():
    y = sine(300, 0.01)
    assert loudness(levelled(y, -20.0)) == pytest.approx(-20.0, abs=1e-6)
    assert np.abs(levelled(y, 0.0)).max() == pytest.approx(0.99)
    assert not levelled(np.zeros(9), -20.0).any()


def test_a_low_sample_rate_removes_high_frequencies_alone():
    low, high = sine(1000), sine(6000)
    middle = slice(SECOND // 2, 3 * SECOND // 2)
    np.testing.assert_allclose(at_rate(low, 2)[middle], low[middle], atol=0.01)
    assert np.abs(at_rate(high, 2)[middle]).max() < 0.01


# ---- noise


@pytest.mark.parametrize("slope", [0.0, 1.0, 2.0])
def test_the_power_of_noise_falls_with_its_slope(slope):
    noise = coloured(8 * SECOND, slope, rng())
    assert np.mean(noise**2) == pytest.approx(1.0)
    power = np.abs(np.fft.rfft(noise)) ** 2
    hertz = np.fft.rfftfreq(len(noise), 1 / SECOND)
    octaves = [power[(hertz >= f) & (hertz < 2 * f)].mean() for f in (100, 200, 400, 800, 1600)]
    assert np.diff(np.log2(octaves)).mean() == pytest.approx(-slope, abs=0.1)


def test_hum_has_multiples_of_its_frequency_alone():
    power = np.abs(np.fft.rfft(hum(4 * SECOND, 50.0, rng()))) ** 2
    lines = 4 * 50 * np.arange(1, 7)
    assert power[lines].sum() == pytest.approx(power.sum(), rel=1e-9)
    assert power[lines].min() > 1e-4 * power.max()


def test_noise_is_as_far_below_the_sound_as_asked():
    y = sine(440, 0.3)
    added = with_noise(y, coloured(len(y), 1.0, rng()), 20.0) - y
    assert loudness(y) - loudness(added) == pytest.approx(20.0, abs=1e-6)


# ---- lossy coding


@pytest.mark.parametrize("n", [1, 575, 576, 577, 5000])
def test_blocks_give_the_sound_back(n):
    y = rng().standard_normal(n)
    spectrum = mdct(y)
    np.testing.assert_allclose(inverse_mdct(spectrum, n), y, atol=1e-12)
    assert (spectrum**2).sum() == pytest.approx((y**2).sum())


def test_a_sine_is_in_its_line():
    power = (mdct(sine(2000)) ** 2)[5:-5].mean(0)
    assert abs(int(power.argmax()) - 2000 / 8000 * 576) <= 1


def test_coding_errs_by_its_step_and_drops_what_is_too_high():
    y = rng().standard_normal(2 * SECOND)
    error = coded(y, 0.3, 8000.0) - y
    assert np.mean(error**2) == pytest.approx(0.3**2 / 12, rel=0.1)  # of even rounding
    finer = coded(y, 0.03, 8000.0) - y
    assert np.mean(finer**2) == pytest.approx(0.03**2 / 12, rel=0.1)
    assert np.abs(coded(sine(7000), 0.1, 5000.0)[2000:-2000]).max() < 1e-3


@pytest.mark.slow
def test_a_real_encoder_keeps_the_onsets_too():
    clean = clicks()
    try:
        heard = as_mp3(clean)
    except Exception as error:  # this libsndfile was built without an MP3 encoder
        pytest.skip(str(error))
    assert heard.shape == clean.shape and abs(lag(heard, clean)) <= 0.006
