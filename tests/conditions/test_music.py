"""What the network hears.

Against librosa, the MATLAB reference, closed forms, and beats that others found.
"""

import librosa
import numpy as np
import pytest
import torch
from scipy.io import loadmat

from motiondiff_edu.conditions import audio_files, music
from motiondiff_edu.conditions.music import SAMPLE_RATE, beats_of, frame_times, log_mel
from motiondiff_edu.metrics.dances import f_measure

FRAMING = {"sr": SAMPLE_RATE, "n_fft": music.N_FFT, "hop_length": 512}


def their_log_mel(audio):
    mel = librosa.feature.melspectrogram(y=audio, n_mels=80, fmin=0, fmax=8000, **FRAMING)
    return np.log(np.maximum(mel, music.FLOOR)).swapaxes(-1, -2)


def loudness(seconds: float, f: float = 440.0, seed: int = 0):
    """A tone that swells, over noise."""
    t = np.arange(int(seconds * SAMPLE_RATE)) / SAMPLE_RATE
    noise = np.random.default_rng(seed).normal(0, 0.01, len(t))
    return (0.5 * np.sin(2 * np.pi * f * t) * np.sin(np.pi * t) ** 2 + noise).astype(np.float32)


def drums(times, seconds: float, kind: str = "noise", seed: int = 0):
    """A hit at each of `times`, over a little noise.

    Noise, a tone or a bass drum, with a sharp start.
    """
    rng, t = np.random.default_rng(seed), np.arange(1280) / SAMPLE_RATE
    hit = {
        "noise": 0.3 * rng.normal(size=1280) * np.exp(-t / 0.02),
        "tone": np.sin(2 * np.pi * 1000 * t) * np.exp(-t / 0.02),
        "kick": np.sin(2 * np.pi * (50 * t + 3 * (1 - np.exp(-t / 0.03)))) * np.exp(-t / 0.04),
    }[kind]
    audio = rng.normal(0, 1e-4, int(seconds * SAMPLE_RATE))
    for start in (np.asarray(times) * SAMPLE_RATE).round().astype(int):
        audio[start : start + 1280] += hit[: len(audio) - start]
    return audio


def offset(wanted, found) -> float:
    """Median of (found - nearest wanted), seconds."""
    gaps = np.asarray(found)[:, None] - np.asarray(wanted)
    return float(np.median(gaps[np.arange(len(gaps)), np.abs(gaps).argmin(1)]))


@pytest.mark.parametrize(
    "rate, n_fft, bands, low, high", [(16000, 1024, 80, 0, 8000), (22050, 2048, 24, 512, 11025)]
)
def test_filters_are_librosas(rate, n_fft, bands, low, high):
    theirs = librosa.filters.mel(
        sr=rate, n_fft=n_fft, n_mels=bands, fmin=low, fmax=high, dtype=np.float64
    )
    np.testing.assert_allclose(
        music.mel_filters(rate, n_fft, bands, low, high).numpy(), theirs, atol=1e-12
    )


def test_filters_are_those_of_the_matlab_reference(real_data):
    given = loadmat(real_data / "oracle/librosa/feature-melfb-001.mat")["wts"]
    ours = music.mel_filters(8000, 256, 20, 0, 2000)
    np.testing.assert_allclose(ours.numpy(), given[:, :129], atol=1e-6)
    assert float(ours.sum()) == pytest.approx(0.639343, abs=1e-5) and float(
        ours.max()
    ) == pytest.approx(0.012421, abs=1e-6)
    bare = loadmat(real_data / "oracle/librosa/feature-melfbnorm-002.mat")
    edges = torch.tensor(bare["frqs"][0])
    height_one = ours * (edges[2:] - edges[:-2])[:, None] / 2
    np.testing.assert_allclose(height_one.numpy(), bare["wts"][:, :129], atol=1e-6)


def test_the_mel_scale_at_known_places():
    hz = torch.tensor([0.0, 440.0, 1000 / 3, 1000.0, 6400.0], dtype=torch.float64)
    mel = torch.tensor(
        [0.0, 6.6, 5.0, 15.0, 42.0], dtype=torch.float64
    )  # 6.4 times 1000 Hz is 27 steps up
    torch.testing.assert_close(music.hz_to_mel(hz), mel)
    torch.testing.assert_close(music.mel_to_hz(mel), hz)


def test_each_triangle_has_area_one():
    area = music.mel_filters(16000, 65536, 80, 0, 8000).sum(1) * 16000 / 65536
    torch.testing.assert_close(area, torch.ones(80, dtype=torch.float64), atol=1e-3, rtol=0)


@pytest.mark.parametrize(
    "arguments", [(16000, 1024, 80, 0, 9000), (16000, 1024, 80, 500, 400), (16000, 64, 80, 0, 8000)]
)
def test_bands_that_cannot_be_are_refused(arguments):
    with pytest.raises(ValueError, match="must ascend within|too many for n_fft"):
        music.mel_filters(*arguments)


@pytest.mark.filterwarnings(
    "ignore:n_fft=1024 is too large"
)  # librosa's word on less than one window
@pytest.mark.parametrize(
    "n", [1, 511, 512, 16000, 23457, 255 * 512, 256 * 512 - 1, 256 * 512, 600 * 512 + 7]
)
def test_log_mel_is_librosas(n):
    audio = loudness(1 + n / SAMPLE_RATE)[:n]
    ours = log_mel(torch.from_numpy(audio), 16_000)
    assert ours.shape == (1 + n // 512, 80) and ours.dtype == torch.float32
    np.testing.assert_allclose(ours.numpy(), their_log_mel(audio), atol=1e-4)


def test_a_batch_longer_than_one_piece_is_as_one_by_one():
    audio = np.stack([loudness(10.0, f) for f in (200, 900)])
    both = log_mel(torch.from_numpy(audio), 16_000)
    assert both.shape == (2, 313, 80)
    for one, sound in zip(both, audio, strict=True):
        torch.testing.assert_close(one, log_mel(torch.from_numpy(sound), 16_000), atol=1e-5, rtol=0)


def test_batches_precision_and_arrays():
    audio = np.stack([[loudness(0.7, f, seed) for f in (200, 900, 3000)] for seed in (1, 2)])
    ours = log_mel(audio, 16_000)
    assert ours.shape == (2, 3, 22, 80)
    np.testing.assert_allclose(ours.numpy(), their_log_mel(audio), atol=1e-4)
    double = log_mel(torch.from_numpy(audio[1, 2]).double(), 16_000)
    assert double.dtype == torch.float64
    torch.testing.assert_close(double.float(), ours[1, 2], atol=1e-4, rtol=0)


def test_silence_is_the_floor_and_a_full_sine_is_what_a_hand_finds():
    assert torch.equal(log_mel(torch.zeros(3000), 16_000), torch.full((6, 80), 1e-5).log())
    # the bin of 1000 Hz: a sine there gives half the window's sum, 256, and half of that to either
    # side
    k = 64
    sine = torch.sin(2 * torch.pi * k / 1024 * torch.arange(16000, dtype=torch.float64))
    spectrum = torch.zeros(513, dtype=torch.float64)
    spectrum[k - 1 : k + 2] = torch.tensor([128.0, 256.0, 128.0]) ** 2
    by_hand = (music.mel_filters() @ spectrum).clamp(min=1e-5).log()
    torch.testing.assert_close(log_mel(sine, 16_000)[10], by_hand, atol=1e-4, rtol=0)
    assert 7 < float(by_hand.max()) < 8


def test_ten_times_as_loud_is_the_same_shift_everywhere():
    audio = torch.from_numpy(loudness(1.0)).double()
    torch.testing.assert_close(
        log_mel(10 * audio, 16_000) - log_mel(audio, 16_000),
        torch.full((32, 80), np.log(100.0)).double(),
    )


def test_a_click_lies_in_the_frame_of_its_time_and_between_two_frames_it_is_heard_by_both():
    for sample, frames in ((512 * 9, [9]), (512 * 9 + 256, [9, 10])):
        click = torch.zeros(16000)
        click[sample] = 1.0
        power = log_mel(click, 16_000).exp().sum(1)
        assert sorted(power.topk(len(frames)).indices.tolist()) == frames
        assert np.allclose(frame_times(32)[frames].mean(), sample / SAMPLE_RATE)
        loudest = float(
            music.mel_filters().sum()
        )  # a click's spectrum is flat, as high as the window above it
        assert float(power.max()) == pytest.approx(
            loudest if len(frames) == 1 else loudest / 4, rel=1e-3
        )


def test_gradients_pass_also_after_a_first_call_without():
    music._tools.cache_clear()
    with torch.inference_mode():
        log_mel(torch.rand(2000), 16_000)
    audio = torch.rand(2000, requires_grad=True)
    log_mel(audio, 16_000).sum().backward()
    assert float(audio.grad.abs().sum()) > 0


@pytest.mark.parametrize("audio", [torch.zeros(0), torch.zeros(2, 0)])
def test_no_samples_are_refused(audio):
    with pytest.raises(ValueError, match="float samples"):
        log_mel(audio, 16_000)


@pytest.mark.parametrize("features", [log_mel, beats_of])
def test_sound_at_another_rate_is_refused(features):
    with pytest.raises(ValueError, match=r"at 22050 Hz, and this needs 16000 Hz: .*samples_of"):
        features(torch.zeros(22_050), 22_050)
    with pytest.raises(TypeError, match="sample_rate"):
        features(torch.zeros(22_050))


def test_ten_seconds_are_313_frames_not_320():
    mel = log_mel(torch.zeros(160_000), 16_000)
    assert len(mel) == 313
    times = frame_times(313)
    assert times[-1] == 312 * 512 / 16000 and torch.allclose(
        times.diff(), torch.tensor(0.032, dtype=torch.float64)
    )


@pytest.mark.parametrize("kind", ["noise", "tone", "kick"])
@pytest.mark.parametrize("bpm", [91, 120, 133.3])
def test_the_trackers_lag_is_what_is_taken_out(bpm, kind):
    beats = np.arange(0.337, 24.5, 60 / bpm)
    audio = drums(beats, 25, kind)
    raw = beats_of(audio, 16_000, lag=0)
    assert 0.01 < offset(beats, raw) < 0.021
    found = beats_of(audio, 16_000)
    np.testing.assert_allclose(found, np.maximum(raw - 0.02, 0))
    assert (
        f_measure(found, beats, window=0.04) > 0.9
    )  # it may invent one before the first, and miss the last


def test_beats_of_composed_songs_are_those_of_the_score():
    from data_synth.music import compose

    composed = [
        compose(3, genre, seconds=24) for genre in ("house", "hiphop", "pop", "latin", "waltz")
    ]
    found = [beats_of(song.audio, 16_000, lag=0) for song in composed]
    right = [k for k in range(5) if f_measure(found[k], composed[k].beats) > 0.9]
    assert len(right) >= 4, "the tracker may follow the off-beat in one"
    assert all(0.015 < offset(composed[k].beats, found[k]) < 0.035 for k in right)


def test_beats_of_nothing_are_none():
    assert beats_of(torch.zeros(64_000), 16_000).shape == (0,)


@pytest.mark.parametrize("song, at_least", [("vibe_ace", 0.95), ("nutcracker", 0.9)])
def test_real_songs_have_the_beats_another_tracker_found(real_data, song, at_least):
    others = np.loadtxt(real_data / f"audio_beats_machine/{song}.essentia_multifeature.beats")
    found = beats_of(audio_files.read_audio(real_data / f"audio/{song}.ogg"), 16_000)
    assert f_measure(found, others) >= at_least and abs(offset(others, found)) < 0.015
    assert np.median(np.diff(found)) == pytest.approx(np.median(np.diff(others)), rel=0.01)


def test_speech_is_heard_like_music(real_data):
    speech = audio_files.read_audio(real_data / "audio/speech_libri1.ogg")
    mel = log_mel(speech, 16_000)
    np.testing.assert_allclose(mel.numpy(), their_log_mel(speech.numpy()), atol=1e-4)
    low, high = mel[:, 2:25].mean(), mel[:, 70:].mean()
    assert low > high + 2, "a voice is low"
