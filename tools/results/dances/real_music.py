"""Does the shipped dancer hear recorded music? Its dances to recordings, which are few.

A dance is on the beat when its stops fall on beats more often than those of the same dance, moved
in time within the song. The gain is the difference of the two: 0 for a dancer that does not hear.
Nobody has marked the beats of these recordings: they are found by a tracker, another one than
ours where a file beside the recording has its beats.
"""

import os
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from jaxtyping import Float

from motiondiff_edu.conditions.audio_files import read_audio
from motiondiff_edu.conditions.music import SAMPLE_RATE, beats_of, log_mel
from motiondiff_edu.metrics.dances import (
    NoBeatsWarning,
    beat_alignment,
    kinematic_beats,
    shifted_level,
)
from motiondiff_edu.performers.dancer import STEPS, Dancer
from motiondiff_edu.recipes.recordings import VARIABLE

from ..walks.scores import FPS, Measure, measure_of
from .songs import FEWEST, LONGEST, dances_of

MUSIC, BEATS = "audio", "audio_beats_machine"  # folders within the recordings
NO_MUSIC = ("speech_libri1", "robin")  # a voice and a bird, in the same folder
SOUNDS = (".wav", ".flac", ".ogg", ".mp3")
COPY = "_44k_stereo"  # ends the name of a second copy of a recording
PART = LONGEST / FPS  # seconds: longer recordings are danced to in parts, from their beginning


@dataclass(frozen=True)
class MusicSize:
    """The amount of measurement: parts of a recording at most, and dances to each of them."""

    parts: int = 3
    samples: int = 5


FULL, QUICK = MusicSize(), MusicSize(parts=1, samples=2)


@dataclass(frozen=True, eq=False)
class Recording:
    """A recording of music, 16 kHz, and its beats in seconds."""

    name: str
    audio: Float[np.ndarray, "N"]
    beats: Float[np.ndarray, "K"]
    from_file: bool  # whether the beats are those of another tracker, read from a file

    def parts(self, most: int) -> list[tuple[np.ndarray, np.ndarray]]:
        """Sound and beats of spans of PART seconds, or of all of it if it is shorter.

        Spans with fewer than FEWEST beats are left out.
        """
        seconds = min(PART, len(self.audio) / SAMPLE_RATE)
        found = []
        for k in range(min(most, int(len(self.audio) / SAMPLE_RATE / seconds))):
            start = k * seconds
            first, last = round(start * SAMPLE_RATE), round((start + seconds) * SAMPLE_RATE)
            beats = self.beats[(self.beats >= start) & (self.beats < start + seconds)] - start
            if len(beats) >= FEWEST:
                found.append((self.audio[first:last], beats))
        return found


def recordings_of_music(folder: Path) -> list[Recording]:
    """All recordings of music, each once; none where there is no such folder."""
    paths = {
        path.stem: path
        for path in sorted((folder / MUSIC).glob("*"))
        if path.suffix.lower() in SOUNDS and path.stem not in NO_MUSIC
    }
    return [
        recording(path, folder)
        for name, path in paths.items()
        if not (name.endswith(COPY) and name.removesuffix(COPY) in paths)
    ]


def recording(path: Path, folder: Path) -> Recording:
    """One file with its beats: those of a file `NAME.*.beats`, a time in each line, or a tracker's.

    Lines that begin with # are comments.
    """
    audio = read_audio(path).numpy()
    written = sorted((folder / BEATS).glob(f"{path.stem}.*beats"))
    beats = np.loadtxt(written[0], ndmin=1) if written else beats_of(audio, SAMPLE_RATE)
    return Recording(path.stem, audio, beats, bool(written))


def found_recordings() -> list[Recording]:
    """The recordings in the folder that MOTIONDIFF_REAL_DATA names; exits where there are none."""
    folder = Path(os.environ.get(VARIABLE, ""))
    recordings = recordings_of_music(folder) if os.environ.get(VARIABLE) else []
    if not recordings:
        sys.exit(f"{VARIABLE} must name a folder with recordings of music in {MUSIC}")
    return recordings


def gains_of(
    dances: Float[np.ndarray, "R T 21 3"], beats: Float[np.ndarray, "K"]
) -> Float[np.ndarray, "R 2"]:
    """Of each dance to one song: its alignment, and the mean of it after shifts in time.

    NaN for a dance that never slows down.
    """
    seconds = dances.shape[1] / FPS
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NoBeatsWarning)
        for k, dance in enumerate(dances):
            stops = kinematic_beats(dance)
            shifts = np.random.default_rng(k)
            moved = shifted_level(beat_alignment, stops, beats, seconds, shifts)
            found.append((beat_alignment(stops, beats), moved))
    return np.array(found)


def song_rows(dancer: Dancer, song: Recording, size: MusicSize) -> Float[np.ndarray, "R 2"]:
    """`gains_of` of all dances to all parts of one recording."""
    rows = [np.empty((0, 2))]
    for sound, beats in song.parts(size.parts):
        mel = log_mel(torch.from_numpy(sound).float(), SAMPLE_RATE).expand(size.samples, -1, -1)
        frames = int(len(sound) / SAMPLE_RATE * FPS)
        rows.append(gains_of(dances_of(dancer, mel, frames, seed=0), beats))
    return np.concatenate(rows)


def music_measures(rows: dict[str, Float[np.ndarray, "_ 2"]]) -> list[Measure]:
    """Means over songs with intervals over songs; those of one song are over its dances."""
    songs = np.array([np.nanmean(found, axis=0) for found in rows.values()])
    means = [
        measure_of("music_gain", "", lambda own, moved: np.mean(own - moved), *songs.T),
        measure_of("music_alignment", "", np.mean, songs[:, 0]),
        measure_of("music_alignment_shifted", "", np.mean, songs[:, 1]),
    ]
    return means + [
        measure_of(f"music_gain.{name}", "", np.nanmean, found[:, 0] - found[:, 1])
        for name, found in rows.items()
    ]


def music_records(dancer: Dancer, weights: str, size: MusicSize, command: str) -> list[dict]:
    """The records `real.music_*`; how many songs they count stands in their seeds."""
    recordings = found_recordings()
    rows = {song.name: song_rows(dancer, song, size) for song in recordings}
    rows = {name: found for name, found in rows.items() if np.isfinite(found).any()}
    if not rows:
        sys.exit(f"no recording has {FEWEST} beats in a part")
    seeds = {
        "songs": len(rows),
        "from_file": sum(song.from_file for song in recordings if song.name in rows),
        "parts": size.parts,
        "samples": size.samples,
        "sampling": [0],
        "steps": STEPS,
        "weights": weights,
    }
    return [one.as_record("real.", seeds, command) for one in music_measures(rows)]
