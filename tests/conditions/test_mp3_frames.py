"""The frames of an MP3, counted: with and without a length in its header, joined, cut, tagged."""

from io import BytesIO

import numpy as np
import pytest
import soundfile

from motiondiff_edu.conditions.audio_files import read_audio
from motiondiff_edu.conditions.mp3_frames import frames_of, has_length_tag, promised, with_length

RATE = 44_100


def tone(seconds: float, rate: int = RATE) -> np.ndarray:
    """A tone that comes and goes, with some noise: an MP3 of it has frames of many sizes."""
    t = np.arange(round(seconds * rate)) / rate
    rng = np.random.default_rng(0)
    return 0.3 * np.sin(2 * np.pi * 440 * t) * (np.sin(t) > 0) + 0.02 * rng.standard_normal(len(t))


def mp3(seconds: float, rate: int = RATE) -> bytes:
    made = BytesIO()
    soundfile.write(made, tone(seconds, rate), rate, format="MP3")
    return made.getvalue()


def sound_alone(raw: bytes) -> bytes:
    """Without the frame that says the length."""
    frames = [one for one in frames_of(raw) if not has_length_tag(raw, one)]
    return b"".join(raw[one.start : one.start + one.length] for one in frames)


@pytest.mark.parametrize("rate", [44_100, 48_000, 22_050, 16_000, 8_000])
@pytest.mark.parametrize("seconds", [1.5, 6.0])
def test_the_frames_cover_the_sound(rate, seconds):
    raw = mp3(seconds, rate)
    frames = list(frames_of(raw))
    assert frames[0].start == 0 and sum(one.length for one in frames) == len(raw)
    whole, samples = with_length(raw)
    # an encoder adds up to three frames, in front and behind
    assert 0 <= samples - seconds * rate <= 4 * frames[0].samples
    assert promised(whole) == samples
    with soundfile.SoundFile(BytesIO(whole)) as file:
        assert abs(file.frames - samples) <= frames[0].samples


@pytest.mark.parametrize("kind", ["no length", "joined", "tags before and between", "as it is"])
def test_a_sound_is_heard_to_its_end(tmp_path, kind):
    one, other = mp3(8.0), mp3(5.0)
    tag = b"ID3\x04\x00\x00" + bytes([0, 0, 8, 0]) + b"\xff\xfb\x90\x00" * 256  # like frames
    made = {
        "no length": (sound_alone(one), 8.0),
        "joined": (one + other, 13.0),
        "tags before and between": (tag + one + tag + other, 13.0),
        "as it is": (one, 8.0),
    }
    raw, seconds = made[kind]
    path = tmp_path / "song.mp3"
    path.write_bytes(raw)
    heard = len(read_audio(path)) / 16_000
    assert seconds - 0.06 <= heard <= seconds + 0.25


def test_one_that_is_cut_off_says_so(tmp_path):
    raw = mp3(8.0)
    path = tmp_path / "half.mp3"
    path.write_bytes(raw[: len(raw) // 2])
    with pytest.warns(UserWarning, match="is cut off: its header promises 8"):
        heard = len(read_audio(path)) / 16_000
    assert 3.0 < heard < 6.0


@pytest.mark.parametrize(
    "raw", [b"", b"\xff", b"\xff\xfb", b"no sound" * 99, b"\xff" * 999, b"ID3"]
)
def test_what_is_no_mp3_has_no_frames(raw):
    assert list(frames_of(raw)) == [] and with_length(raw) == (b"", 0) and promised(raw) == 0
