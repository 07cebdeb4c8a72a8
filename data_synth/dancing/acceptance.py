"""Are synthetic dances like real ones, and on the beat?

The table compares dozens of dances with the real range.

python -m data_synth.dancing.acceptance [--dances 30] [--seconds 30]

The dances follow silent scores that cover the tempi of each genre; README.md shows the result.
"""

import argparse

import numpy as np

from motiondiff_edu.metrics.dances import beat_alignment

from ..music.score import beat_song
from ..music.song import GENRES, Song
from ..walking.acceptance import show, table
from ..walking.own_measures import bone_error, knee_angles, planted_slip
from .performance import Dance, dance
from .statistics import kinematic_beats, repeats, statistics

# name -> (lowest, highest) of 8 real upright dances at 20 frames/s
UPRIGHT = {
    "speed": (0.33, 1.6),
    "neither_planted": (0.06, 0.79),
    "hips_spread": (0.05, 0.26),
    "beats_per_second": (1.1, 2.4),
    "pca95": (6, 13),
    "jerk": (31, 362),
    "power4": (0.79, 0.99),
}
# our own goals: with the right song; the share of the music's beats that the body marks
OWN = {"own_song": (0.6, 0.85), "other_song": (0.15, 0.35), "beats_per_beat": (0.6, 1.3)}
# what a dance of every genre does with the floor, in the mean over its dances: limits of our own,
# between which two dances of CMU lie (0.33 and 0.31 of the time, 1443 and 259 degrees, 0.46 and
# 0.53 m/s); dances on the spot do not
FLOOR = {"standing_feet": (0.0, 0.4), "turn_8s": (120.0, 1500.0), "travel": (0.28, 0.6)}
# genres whose mean over dances lies outside, and why ("genre name": why); the data card says more
OUTSIDE: dict[str, str] = {}


def songs(count: int, seconds: float, first_seed: int = 0) -> list[Song]:
    """Silent songs, genre by genre in turn.

    Tempi are spread over each genre's range and drift by 2 %.
    """
    genres = list(GENRES.items())
    each, found = -(-count // len(genres)), []
    for k in range(count):
        genre, (slowest, fastest, metre) = genres[k % len(genres)]
        tempo = slowest + (fastest - slowest) * (k // len(genres) + 0.5) / each
        found.append(beat_song(seconds, tempo, metre, genre, first_seed + k, drift=0.02))
    return found


def measures(danced: Dance, song: Song, other: Song) -> dict[str, float]:
    """Statistics of one dance, with its alignment to its own song and to another."""
    moved = kinematic_beats(danced.positions, danced.fps)
    return statistics(danced.positions, danced.fps) | {
        "own_song": beat_alignment(moved, song.beats),
        "other_song": beat_alignment(moved, other.beats),
        "beats_per_beat": len(moved) / len(song.beats),
        "repeats": repeats(danced.positions, danced.fps),
    }


def acceptance(
    count: int = 30, seconds: float = 30.0
) -> tuple[list[Dance], list[dict[str, float]]]:
    """The dances, and the measures of each."""
    scores = songs(count, seconds)
    danced = [dance(song, k) for k, song in enumerate(scores)]
    others = [scores[(k + 7) % count] for k in range(count)]
    return danced, [measures(d, s, o) for d, s, o in zip(danced, scores, others, strict=True)]


def means_outside(danced: list[Dance], rows: list[dict[str, float]]) -> set[str]:
    """Statistics whose mean over dances is outside the real range or the limits of FLOOR.

    Over all dances (by name) or in a genre ("genre name").
    """
    found = set()
    for genre in ("", *GENRES):
        chosen = [r for d, r in zip(danced, rows, strict=True) if genre in ("", d.genre)]
        for name, mean, _, _, low, high, _ in table(chosen, UPRIGHT | FLOOR):
            if not low <= mean <= high:
                found.add(f"{genre} {name}".strip())
    return found


def limits(danced: list[Dance]) -> dict[str, float]:
    """The worst slip of a foot (mm), lowest joint (mm), bone (m), knee (degrees), hand (m/s).

    And of the pelvis over the ground: the fastest, and the median over dances of their fastest.
    """
    slip = 0.0
    low = np.inf
    bones = 0.0
    knees = []
    hands = 0.0
    pelvis = []
    for d in danced:
        p = d.positions
        slip = max(slip, planted_slip(p, d.contacts))
        low = min(low, float(p[..., 1].min()))
        bones = max(bones, bone_error(p))
        bend = knee_angles(p)
        knees += [bend.min(), bend.max()]
        hands = max(hands, float(np.linalg.norm(np.diff(p, axis=0), axis=-1).max() * d.fps))
        over_ground = np.diff(p[:, 0, [0, 2]], axis=0) * d.fps
        pelvis.append(float(np.linalg.norm(over_ground, axis=-1).max()))
    return {
        "planted_toe_mm_a_frame": 1e3 * slip,
        "lowest_joint_mm": 1e3 * low,
        "bone_error_m": bones,
        "knee_smallest_deg": float(min(knees)),
        "knee_largest_deg": float(max(knees)),
        "fastest_joint_mps": hands,
        "fastest_pelvis_mps": max(pelvis),
        "fastest_pelvis_median_mps": float(np.median(pelvis)),
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m data_synth.dancing.acceptance")
    parser.add_argument("--dances", type=int, default=30)
    parser.add_argument("--seconds", type=float, default=30.0)
    given = parser.parse_args()
    danced, rows = acceptance(given.dances, given.seconds)
    print(show(table(rows, UPRIGHT | FLOOR | OWN)))
    for genre in GENRES:
        print(
            f"{genre}\n\n"
            + show(
                table(
                    [r for d, r in zip(danced, rows, strict=True) if d.genre == genre],
                    UPRIGHT | FLOOR | OWN,
                )
            )
        )
    print("outside:", ", ".join(sorted(means_outside(danced, rows))) or "nothing")
    print(f"highest repetition: {max(r['repeats'] for r in rows):.3g}")
    print("\n".join(f"{name}: {value:.3g}" for name, value in limits(danced).items()))
