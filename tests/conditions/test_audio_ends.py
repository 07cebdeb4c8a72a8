"""Sounds are heard to their end, whatever their header says, in every encoding of libsndfile."""

import warnings

import numpy as np
import pytest
import soundfile

from motiondiff_edu.conditions.audio_files import AudioError, finished_wav, read_audio

# the sounds of `reports`, and their seconds
REPORTED = {
    "22_vbr_no_xing.mp3": 60.0,
    "23_two_mp3_joined.mp3": 80.0,
    "25_vbr_false_cut_off.mp3": 41.0,
    "26_cbr_cover_false_cut_off.mp3": 40.0,
    "27_gsm.wav": 6.0,
    "28_unfinished_header.wav": 6.0,
}
ENCODINGS = [
    (kind, encoding)
    for kind in soundfile.available_formats()
    for encoding in soundfile.available_subtypes(kind)
    if kind not in ("RAW", "SD2")  # without a header; with a second file
]


@pytest.mark.parametrize("name", REPORTED)
def test_no_second_of_a_reported_sound_is_lost_and_nothing_false_is_said(real_data, name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        heard = len(read_audio(real_data / "reports" / name)) / 16_000
    assert REPORTED[name] - 0.05 <= heard <= REPORTED[name] + 0.15


@pytest.mark.parametrize("kind, encoding", ENCODINGS, ids=map("-".join, ENCODINGS))
def test_every_encoding_is_read_to_its_end_or_refused_in_our_words(tmp_path, kind, encoding):
    t = np.arange(3 * 8000) / 8000
    sound = 0.3 * np.sin(2 * np.pi * 300 * t)
    path = tmp_path / f"sound.{kind.lower()}"
    try:
        soundfile.write(path, sound, 8000, format=kind, subtype=encoding)
    except (soundfile.LibsndfileError, RuntimeError, ValueError):
        pytest.skip("libsndfile cannot write it")
    try:
        heard = read_audio(path)
    except AudioError as refused:
        assert "sound." in str(refused)
        return
    assert len(heard) == pytest.approx(3 * 16_000, abs=3_200)
    # some encodings end with a click
    assert np.abs(heard[:46_000].numpy()).max() == pytest.approx(0.3, abs=0.12)


def test_a_wav_that_was_never_finished_is_finished(tmp_path):
    path = tmp_path / "stopped.wav"
    soundfile.write(path, 0.2 * np.sin(np.arange(32_000) / 9), 16_000)
    whole = path.read_bytes()
    at = whole.find(b"data")
    stopped = whole[:4] + bytes(4) + whole[8 : at + 4] + bytes(4) + whole[at + 8 :]
    path.write_bytes(stopped)
    assert len(read_audio(path)) == 32_000
    assert finished_wav(stopped) == whole and finished_wav(whole) == b""
    assert finished_wav(b"") == finished_wav(b"RIFF" + bytes(40)) == b""
