"""Write songs to files: the sound as WAV, and beside it the score as JSON."""

import argparse
import json
from pathlib import Path

import numpy as np
from scipy.io import wavfile

from motiondiff_edu._files import replacing

from .composer import compose, songs
from .song import GENRES, SAMPLE_RATE, TIMBRES, Song


def score(song: Song) -> dict:
    """The score of a song as lists and numbers.

    Times are in seconds, to a tenth of a millisecond.
    """

    def rounded(times):
        return np.round(times, 4).tolist()

    return {
        "genre": song.genre,
        "timbre": song.timbre,
        "seed": song.seed,
        "tempo": round(song.tempo, 3),
        "metre": song.metre,
        "seconds": song.seconds,
        "sample_rate": SAMPLE_RATE,
        "beats": rounded(song.beats),
        "downbeats": rounded(song.downbeats),
        "bar_position": song.bar_position.tolist(),
        "phrases": song.phrase.tolist(),
        "energy": rounded(song.energy),
        "sections": song.info["section"],
        "hits": {drum: rounded(times) for drum, times in song.hits.items()},
    }


def save_song(song: Song, path: Path) -> None:
    """Write path.wav, 16 bits, and path.json, each under a temporary name that is then changed."""
    with replacing(path.with_suffix(".wav")) as aside, open(aside, "wb") as f:
        wavfile.write(f, SAMPLE_RATE, np.round(song.audio * 32767).astype(np.int16))
    with replacing(path.with_suffix(".json")) as aside:
        aside.write_text(json.dumps(score(song), indent=1), encoding="utf-8")


def main(arguments: list[str] | None = None) -> None:
    """Write synthetic songs: `python -m data_synth songs --out FOLDER`."""
    parser = argparse.ArgumentParser(
        prog="python -m data_synth songs", description="Write songs with known beats."
    )
    parser.add_argument(
        "--out", type=Path, required=True, help="folder for song_000.wav, song_000.json, ..."
    )
    parser.add_argument("--songs", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--genre", help=f"one genre only ({', '.join(GENRES)}); without it, they take turns"
    )
    parser.add_argument(
        "--tempo", type=float, help="beats a minute; without it, drawn from the genre's"
    )
    parser.add_argument("--metre", type=int, help="beats in a bar; without it, the genre's")
    parser.add_argument(
        "--timbre", help=f"the instruments: {', '.join(TIMBRES)}; without it, drawn, never the last"
    )
    given = parser.parse_args(arguments)
    asked = {
        "genre": given.genre,
        "tempo": given.tempo,
        "metre": given.metre,
        "timbre": given.timbre,
    }
    try:
        made = songs(given.songs, given.seed, given.seconds, **asked)
        given.out.mkdir(parents=True, exist_ok=True)
    except ValueError as error:
        parser.error(str(error))
    except OSError as error:
        parser.error(
            f"--out {given.out} cannot be a folder ({error.strerror}): "
            "give the name of a folder, new or old"
        )
    for k, song in enumerate(made):
        save_song(song, given.out / f"song_{k:03d}")
        print(
            (
                f"song_{k:03d}: {song.genre}, {song.tempo:.0f} BPM, "
                f"{song.metre} beats a bar, {song.timbre}"
            ),
            flush=True,
        )
    print(f"{given.songs} songs of {given.seconds:g} s in {given.out}")


__all__ = ["compose", "main", "save_song", "score"]
