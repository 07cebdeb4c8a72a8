"""Sound files: every kind that can be read gives the same sound.

What cannot be danced to is refused in words.
"""

import math
import shutil
import warnings

import numpy as np
import pytest
import soundfile
import torch
from bursts import clicks
from scipy.signal import firwin, resample_poly

from motiondiff_edu.conditions import audio_files
from motiondiff_edu.conditions.audio_files import AudioError, read_audio, resample, samples_of
from motiondiff_edu.conditions.music import log_mel

# what becomes of each file of the real data's audio_formats_and_broken: seconds, or words of the
# refusal; words warned
SHORT = r"has only 0.\d\d s of sound; at least 1 s"
FILES = {
    "brahms_10s.flac": (10.0, None),
    "brahms_10s.mp3": (10.0, None),
    "brahms_10s_24bit.wav": (10.0, None),
    "corrupt_middle.ogg": (45.032, "damaged: 0.81 s are missing from its middle"),
    "cpython_pluck-pcm16.wav": (SHORT, None),
    "cpython_pluck-pcm24.aiff": (SHORT, None),
    "cpython_pluck-pcm8.wav": (SHORT, None),
    "cpython_pluck-ulaw.au": (SHORT, None),
    "dc_offset_half.wav": (
        "is silent from start to end",
        None,
    ),  # a constant, and no sound on top of it
    "empty_0samples.wav": ("has no sound at all", None),
    "ogg_named.wav": (20.985, "its last page is missing"),
    "scipy_test-44100Hz-be-1ch-4bytes.wav": (SHORT, None),
    "scipy_test-44100Hz-le-1ch-4bytes-early-eof-no-data.wav": (
        "cannot be read as a sound file.*No 'data' chunk",
        None,
    ),
    "scipy_test-44100Hz-le-1ch-4bytes-early-eof.wav": (
        "0.01 s of sound and is cut off.*promises 0.10 s",
        None,
    ),
    "scipy_test-44100Hz-le-1ch-4bytes-incomplete-chunk.wav": (
        "cannot be read as a sound file",
        None,
    ),
    "scipy_test-48000Hz-2ch-64bit-float-le-wavex.wav": (SHORT, None),
    "scipy_test-8000Hz-le-2ch-1byteu.wav": (SHORT, None),
    "scipy_test-8000Hz-le-3ch-5S-24bit.wav": (SHORT, None),
    "silence_5s.wav": ("is silent from start to end", None),
    "text_named.wav": ("is text, not sound; it begins with 'this is not", None),
    "trumpet_90bpm_44k_stereo_pcm16.wav": (5.333, None),
    "trumpet_90bpm_8bit_u8.wav": (5.333, None),
    "trumpet_90bpm_float32.wav": (5.333, None),
    "truncated_half.ogg": (20.985, "its last page is missing"),
    "very_short_100samples.wav": (SHORT, None),
    "wav_header_says_more_than_there_is.wav": (
        "has only 0.45 s of sound and is cut off.*promises 10.00 s",
        None,
    ),
}
KINDS = [
    ("wav", "PCM_16"),
    ("wav", "PCM_24"),
    ("wav", "FLOAT"),
    ("flac", "PCM_16"),
    ("ogg", "VORBIS"),
    ("aiff", "PCM_16"),
    ("mp3", "MPEG_LAYER_III"),
    ("au", "ULAW"),
]


def chord(rate: int = 22050, seconds: float = 2.3) -> np.ndarray:
    """Three tones whose sum stays below 0.6, the same whatever the rate."""
    t = np.arange(int(rate * seconds)) / rate
    return sum(0.2 * np.sin(2 * np.pi * f * t + f) for f in (220.0, 1234.5, 3000.0))


@pytest.mark.parametrize("name", FILES)
def test_each_real_file_is_read_or_refused_as_it_should_be(real_data, name):
    wanted, warned = FILES[name]
    path = real_data / "audio_formats_and_broken" / name
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        if isinstance(wanted, str):
            with pytest.raises(AudioError, match=wanted) as caught:
                read_audio(path)
            assert name in str(caught.value)
        else:
            audio = read_audio(path)
            assert (
                len(audio) == pytest.approx(wanted * 16000, abs=10)
                and abs(float(audio.mean())) < 1e-4
            )
            assert 0.05 < float(audio.std()) < 0.2
    assert [warned in str(one.message) for one in told] == ([True] if warned else [])


def test_the_table_has_every_file(real_data):
    assert {path.name for path in (real_data / "audio_formats_and_broken").iterdir()} == set(FILES)


def test_one_recording_in_many_formats_is_one_sound(real_data):
    folder = real_data / "audio_formats_and_broken"
    flac, wav, mp3 = (
        read_audio(folder / f"brahms_10s{end}") for end in (".flac", "_24bit.wav", ".mp3")
    )
    assert float((flac - wav).abs().max()) < 1e-4
    audible = log_mel(flac, 16_000)[:, :50] > -4
    assert (
        float(
            (log_mel(mp3, 16_000)[:, :50] - log_mel(flac, 16_000)[:, :50])[audible].abs().median()
        )
        < 0.1
    )


@pytest.mark.parametrize("rate", [8000, 11025, 16000, 22050, 44100, 48000])
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: " ".join(kind))
def test_every_kind_and_rate_gives_the_same_sound(tmp_path, kind, rate):
    path, tones = tmp_path / f"chord.{kind[0]}", chord(rate)
    soundfile.write(path, tones, rate, subtype=kind[1])
    audio = read_audio(path)
    assert audio.dtype == torch.float32 and abs(len(audio) - len(tones) * 16000 / rate) <= 0.5
    error = np.abs(audio.numpy()[2000:-2000] - chord(16000)[: len(audio)][2000:-2000]).max()
    assert error < (0.06 if kind[0] in ("mp3", "ogg", "au") else 2e-4)


def test_a_sound_above_the_new_limit_does_not_come_back_as_another():
    t = np.arange(44100 * 2) / 44100
    for hz, left in (
        (8600, 1e-4),
        (10_000, 1e-4),
        (15_500, 1e-4),
    ):  # 15.5 kHz would come back as a clear 500 Hz
        assert np.abs(resample(np.sin(2 * np.pi * hz * t), 44100)[1000:-1000]).max() < left


def test_resampled_music_is_what_a_long_windowed_sinc_makes_of_it(real_data):
    song, rate = soundfile.read(real_data / "audio/vibe_ace.ogg", frames=22050 * 8, dtype="float32")
    cut = max(up := 16000 // math.gcd(16000, rate), down := rate // math.gcd(16000, rate))
    taps = firwin(64 * cut + 1, 0.96 / cut, window=("kaiser", 8.6)).astype(song.dtype)
    theirs = resample_poly(song, up, down, window=taps)
    ours = resample(song, rate)
    assert 0 <= len(theirs) - len(ours) <= 1
    difference = (log_mel(ours, 16_000) - log_mel(theirs[: len(ours)], 16_000))[4:-4]
    assert float(difference[:, :77].abs().max()) < 0.02 and float(difference.abs().median()) < 1e-3


def test_stereo_is_averaged_and_opposite_channels_do_not_cancel(tmp_path):
    left, right = chord(16000), 0.5 * chord(16000)[::-1]
    soundfile.write(tmp_path / "two.wav", np.stack([left, right], 1), 16000, subtype="FLOAT")
    np.testing.assert_allclose(read_audio(tmp_path / "two.wav"), (left + right) / 2, atol=1e-3)
    soundfile.write(tmp_path / "against.wav", np.stack([left, -left], 1), 16000, subtype="FLOAT")
    np.testing.assert_allclose(read_audio(tmp_path / "against.wav"), left, atol=1e-3)


def test_a_constant_offset_goes_and_clipping_is_no_obstacle(tmp_path):
    soundfile.write(tmp_path / "offset.wav", 0.3 + chord(16000), 16000, subtype="FLOAT")
    np.testing.assert_allclose(read_audio(tmp_path / "offset.wav"), chord(16000), atol=2e-3)
    soundfile.write(tmp_path / "loud.wav", 9 * chord(16000), 16000)
    assert 0.9 < float(read_audio(tmp_path / "loud.wav").abs().max()) <= 1.01


def written(folder, name: str, samples, rate: int = 16000, **options):
    soundfile.write(folder / name, samples, rate, **options)
    return folder / name


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda d: d / "gone.wav", "gone.wav does not exist; check the spelling"),
        (lambda d: d, "is a folder; give the name of a sound file"),
        (
            lambda d: written(d, "none.wav", np.zeros(0)),
            "none.wav has no sound at all; at least 1 s",
        ),
        (
            lambda d: written(d, "none.ogg", np.zeros(0)),
            "none.ogg has no sound at all; at least 1 s",
        ),
        (
            lambda d: written(d, "short.wav", chord(16000)[:15999]),
            "short.wav has only 1.00 s of sound; at least",
        ),
        (
            lambda d: written(d, "still.flac", np.zeros(20_000)),
            "still.flac is silent from start to end",
        ),
        (
            lambda d: written(d, "hum.wav", np.full(20_000, 0.4)),
            "hum.wav is silent from start to end",
        ),
        (
            lambda d: written(d, "nan.wav", with_nan(np.nan), subtype="FLOAT"),
            "nan.wav: 3 .* are NaN .* at 0.500 s",
        ),
        (
            lambda d: written(d, "inf.wav", with_nan(-np.inf), subtype="FLOAT"),
            "inf.wav: 3 .* infinite, .* at 0.5",
        ),
    ],
)
def test_what_cannot_be_danced_to_is_refused_in_words(tmp_path, make, words):
    with pytest.raises(AudioError, match=words):
        read_audio(make(tmp_path))


def with_nan(value: float) -> np.ndarray:
    samples = chord(16000)
    samples[[8000, 8001, 9000]] = value
    return samples


@pytest.mark.parametrize(
    "name, content, words",
    [
        (
            "my $(song).m4a",
            b"\0\0\0\x20ftypM4A \0\0\0\0",
            r"needs ffmpeg. Convert .*: ffmpeg -i '\S*my \$.song..m4a' '\S*my \$.song..wav'",
        ),
        ("clip.wav", b"\x1a\x45\xdf\xa3\x01\0\0\0", "Matroska file .*ffmpeg -i"),
        ("song.aac", b"\xff\xf1\x50\x80\0\0\0\0", "AAC stream, which needs ffmpeg"),
        ("song.wma", b"\x30\x26\xb2\x75\x8e\x66", "Windows Media file .*needs ffmpeg"),
        ("page.mp3", b"<!DOCTYPE html><html>", "is text, not sound; it begins with '<!DOCTYPE"),
        ("nothing.wav", b"", "is an empty file"),
        ("noise.ogg", bytes(range(200, 256)) * 9, "cannot be read as a sound file .*Save it again"),
    ],
)
def test_other_files_are_told_by_their_content(tmp_path, name, content, words):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(AudioError, match=words):
        read_audio(tmp_path / name)


@pytest.mark.parametrize(
    "name, kept, words",
    [
        ("cut.wav", 0.6, "promises 4.00 s"),
        ("cut.aiff", 0.6, "promises 4.00 s"),
        ("cut.flac", 0.7, "damaged|promises"),
        ("cut.ogg", 0.6, "last page is missing"),
        ("cut.mp3", 0.6, "promises 4"),
    ],
)
def test_a_file_that_breaks_off_is_read_as_far_as_it_goes_and_warns(tmp_path, name, kept, words):
    tones = chord(22050, 4.0) + np.random.default_rng(0).normal(0, 0.05, 88200)
    path = written(tmp_path, name, tones, 22050)
    path.write_bytes(path.read_bytes()[: int(kept * path.stat().st_size)])
    with pytest.warns(UserWarning, match=f"{name} .*({words}).* could be read are used"):
        audio = read_audio(path)
    assert 1 < len(audio) / 16000 < 3.9


def test_a_stream_written_before_its_length_was_known_does_not_warn(tmp_path):
    path = written(tmp_path, "stream.wav", chord(16000), 16000)
    content = bytearray(path.read_bytes())
    content[4:8] = content[40:44] = b"\xff" * 4  # what ffmpeg writes into a pipe
    path.write_bytes(content)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(read_audio(path)) == len(chord(16000))


def test_a_header_that_promises_years_does_not_fill_the_memory(tmp_path):
    path = written(tmp_path, "years.flac", chord(22050), 22050)
    content = bytearray(path.read_bytes())
    content[21] |= 0x0F  # with the next four bytes the number of samples
    content[22:26] = b"\xff" * 4
    path.write_bytes(content)
    with pytest.warns(UserWarning, match="years.flac is cut off: its header promises .* are used"):
        assert len(read_audio(path)) == pytest.approx(2.3 * 16000, abs=3000)


def test_of_a_sound_longer_than_an_hour_the_first_hour_is_read(tmp_path, monkeypatch):
    monkeypatch.setattr(audio_files, "MOST", 1.5)
    path = written(tmp_path, "long.flac", chord(22050), 22050)
    with pytest.warns(UserWarning, match="long.flac is longer than an hour; the 1.50 s"):
        audio = read_audio(path)
    whole = chord(16000)[: len(audio)]
    assert len(audio) == 24000 and np.abs(audio.numpy() - whole)[100:-100].max() < 0.01


def test_what_an_encoder_added_is_not_missed(tmp_path):
    path = written(tmp_path, "song.mp3", chord(22050, 4.0), 22050)
    content = path.read_bytes()
    path.write_bytes(content[: -len(content) // 100])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(read_audio(path)) / 16000 == pytest.approx(4, abs=0.15)


def test_samples_in_another_unit_are_refused_in_files_too(tmp_path, monkeypatch):
    path = written(tmp_path, "whole.wav", 32768 * chord(16000), subtype="FLOAT")
    with pytest.raises(AudioError, match="whole.wav: samples must lie between -1 and 1; the one"):
        read_audio(path)
    written(tmp_path, "mine.wav", chord(16000))
    monkeypatch.setenv("HOME", str(tmp_path))
    assert len(read_audio("~/mine.wav"))


def test_a_wrong_name_does_not_matter(tmp_path):
    path = written(tmp_path, "song.flac", chord(22050), 22050)
    shutil.copy(path, tmp_path / "song ü.wav")
    assert torch.equal(read_audio(tmp_path / "song ü.wav"), read_audio(path))


def test_a_sound_is_read_from_its_name_and_from_its_bytes(tmp_path):
    soundfile.write(tmp_path / "song.wav", clicks(1.5, (0.5,)), 16_000, subtype="FLOAT")
    by_name, by_bytes = (
        samples_of(s) for s in (tmp_path / "song.wav", (tmp_path / "song.wav").read_bytes())
    )
    assert torch.equal(by_name, by_bytes) and by_name.numpy() == pytest.approx(
        clicks(1.5, (0.5,)), abs=1e-3
    )
    with pytest.raises(ValueError, match="text, not sound"):
        samples_of(b"these are words, and no music at all")
