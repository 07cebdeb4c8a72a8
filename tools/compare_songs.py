"""Are synthetic songs like real ones? Statistics of sound, old songs, new songs, recordings.

    python tools/compare_songs.py FOLDER_OF_RECORDINGS [--songs 24]

A table: the 5th, 50th and 95th percentile of each statistic over pieces of 10 s. Then librosa's
beats against the true ones of the new songs: F-measure within 70 ms, and which tempo it followed.
"""

import argparse
from pathlib import Path

import librosa
import numpy as np
import torch
from jaxtyping import Float

from data_synth.music import compose
from data_synth.music.recorded import recorded_song
from data_synth.music.song import SAMPLE_RATE
from data_synth.music.varied import varied_song
from motiondiff_edu.conditions.audio_files import read_audio
from motiondiff_edu.conditions.music import beats_of, log_mel
from motiondiff_edu.metrics.dances import f_measure

SECONDS = 10
SHORTEST = 20  # seconds of a recording: shorter ones are single sounds
SEED = 5000
BANDS = {"low": (0, 250), "mid": (250, 2000), "high": (2000, 8001)}  # Hz
MEL_RANGES = (slice(0, 10), slice(10, 30), slice(30, 55), slice(55, 80))


def spectral(y: Float[np.ndarray, "N"]) -> dict[str, float]:
    """Shape of the spectrum: energies by range, centroid, flatness, share of percussion."""
    loud = np.abs(librosa.stft(y, n_fft=1024))
    power, hertz = loud**2, librosa.fft_frequencies(sr=SAMPLE_RATE, n_fft=1024)
    sounds = loud[:, power.sum(0) > 1e-4 * np.median(power.sum(0)) + 1e-9]
    found = {
        name: power[(hertz >= low) & (hertz < high)].sum() / power.sum()
        for name, (low, high) in BANDS.items()
    }
    harmonic, percussive = librosa.decompose.hpss(loud)
    struck = (percussive**2).sum()
    return found | {
        "centroid, Hz": librosa.feature.spectral_centroid(S=sounds, sr=SAMPLE_RATE).mean(),
        "flatness, log10": np.log10(librosa.feature.spectral_flatness(S=sounds) + 1e-12).mean(),
        "percussive": struck / (struck + (harmonic**2).sum()),
    }


def temporal(y: Float[np.ndarray, "N"]) -> dict[str, float]:
    """Loudness, crest factor, and how well the onsets repeat after a beat of librosa's."""
    onsets = librosa.onset.onset_strength(y=y, sr=SAMPLE_RATE, hop_length=256)
    repeats = librosa.autocorrelate(onsets - onsets.mean())
    beats = librosa.beat.beat_track(onset_envelope=onsets, sr=SAMPLE_RATE, hop_length=256)[1]
    lag = int(np.median(np.diff(beats))) if len(beats) > 2 else 0
    mean = np.sqrt(np.mean(y**2))
    return {
        "level, dB": 20 * np.log10(mean),
        "crest, dB": 20 * np.log10(np.abs(y).max() / mean),
        "onsets' autocorrelation": repeats[lag - 2 : lag + 3].max() / repeats[0] if lag else np.nan,
    }


def of_mel(y: Float[np.ndarray, "N"]) -> dict[str, float]:
    """Means and standard deviations of the log-Mel in four ranges of bands."""
    mel = log_mel(torch.from_numpy(y), SAMPLE_RATE).numpy()
    found = {}
    for bands in MEL_RANGES:
        name = f"Mel {bands.start}-{bands.stop - 1}"
        found |= {f"{name}, mean": mel[:, bands].mean(), f"{name}, sd": mel[:, bands].std(0).mean()}
    return found


def statistics(y: Float[np.ndarray, "N"]) -> dict[str, float]:
    """All statistics of a piece of sound."""
    return spectral(y) | temporal(y) | of_mel(y)


def pieces(folder: Path) -> list[Float[np.ndarray, "N"]]:
    """The recordings of a folder in pieces of 10 s."""
    found, n = [], SECONDS * SAMPLE_RATE
    for path in sorted(folder.glob("*.*")):
        audio = read_audio(path).numpy()
        if len(audio) >= SHORTEST * SAMPLE_RATE:
            found += [audio[k : k + n] for k in range(0, len(audio) - n + 1, n)]
    return found


def spread(rows: list[dict[str, float]], name: str) -> str:
    """5th, 50th and 95th percentile."""
    return " ".join(f"{x:7.2f}" for x in np.nanpercentile([row[name] for row in rows], (5, 50, 95)))


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--songs", type=int, default=24)
    given = parser.parse_args()
    clean = [varied_song(SEED + k, SECONDS) for k in range(given.songs)]
    heard = [recorded_song(song, 1) for song in clean]
    groups = {
        "old": [compose(SEED + k, seconds=SECONDS).audio for k in range(given.songs)],
        "new": [song.audio for song in heard],
        "real": pieces(given.folder),
    }
    rows = {name: [statistics(y) for y in sounds] for name, sounds in groups.items()}
    for name in rows["real"][0]:
        print(f"{name:24s}", " | ".join(f"{kind} {spread(rows[kind], name)}" for kind in rows))
    followed = []
    for song in heard:
        found = beats_of(song.audio, song.sample_rate)
        score = f_measure(found, song.beats)
        ratio = np.median(np.diff(found)) * song.tempo / 60 if len(found) > 2 else np.nan
        followed.append(score)
        print(f"F {score:.2f}, beat / true beat {ratio:.2f}, {song.tempo:.0f} BPM", song.info)
    print(f"mean F {np.mean(followed):.2f}")


if __name__ == "__main__":
    main()
