"""A song: its sound, and its score.

The score has every beat, every drum hit, and the starts of bars and phrases.

The music is composed in `composer.py`. A dance follows the score (beats, bars, phrases, energy),
never the sound: so only the data connect the sound that a network hears with the dance.
"""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int

SAMPLE_RATE = 16_000  # Hz, MoFusion's

GENRES = {  # name: (slowest, fastest BPM, beats in a bar)
    "house": (110, 165, 4),
    "hiphop": (80, 108, 4),
    "pop": (96, 135, 4),
    "latin": (88, 126, 4),
    "waltz": (80, 132, 3),
}
TRAINING_TIMBRES = ("machine", "acoustic", "brushes", "lofi", "percussion", "chip")
HELD_OUT_TIMBRE = "mallets"  # clay pots and wooden bars: never drawn at random
TIMBRES = (*TRAINING_TIMBRES, HELD_OUT_TIMBRE)
DRUMS = ("kick", "snare", "clap", "rim", "hat", "open hat", "shaker", "tom", "crash")


@dataclass(frozen=True, eq=False)
class Song:
    """Mono sound at SAMPLE_RATE, and its score.

    All times are in seconds from the first sample.

    `bar_position` is 0 on a downbeat; `phrase` counts from 0 and changes on a downbeat; `energy` is
    0 (a break) to 1. `hits` has the time of every drum hit by the drum's name, one of DRUMS; a drum
    that is not played has none. `tempo` is the mean, in beats a minute. `info["section"]` names
    every beat's part: intro, verse, chorus, bridge, break.
    """

    audio: Float[np.ndarray, "N"]
    beats: Float[np.ndarray, "K"]
    bar_position: Int[np.ndarray, "K"]
    phrase: Int[np.ndarray, "K"]
    energy: Float[np.ndarray, "K"]
    hits: dict[str, Float[np.ndarray, "_"]]
    genre: str
    tempo: float
    metre: int
    timbre: str  # the set of instruments it is played on
    seed: int
    info: dict = field(default_factory=dict)

    @property
    def sample_rate(self) -> int:
        """Samples a second of the sound: SAMPLE_RATE."""
        return SAMPLE_RATE

    @property
    def seconds(self) -> float:
        """Length of the sound."""
        return len(self.audio) / SAMPLE_RATE

    @property
    def downbeats(self) -> Float[np.ndarray, "K2"]:
        """The first beat of every bar."""
        return self.beats[self.bar_position == 0]
