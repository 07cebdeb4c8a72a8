"""Write dances and the beats of their songs to files: BVH for Blender, npz for everything else."""

import argparse
from itertools import islice
from pathlib import Path

import numpy as np

from motiondiff_edu._files import replacing

from ..music.song import GENRES, Song
from .performance import Dance, dances


def save_npz(danced: Dance, song: Song, path: Path) -> None:
    """Save positions, contacts, moves and the song's beats as plain arrays.

    The file is written under another name and then renamed.
    """
    starts, names, mirrored = zip(*danced.moves, strict=True)
    with replacing(path) as aside, open(aside, "wb") as f:
        np.savez_compressed(
            f,
            positions=danced.positions.astype(np.float32),
            contacts=danced.contacts,
            fps=danced.fps,
            move_starts=np.array(starts),
            move_names=np.array(names),
            move_mirrored=np.array(mirrored),
            beats=song.beats,
            bar_position=song.bar_position,
            phrase=song.phrase,
            energy=song.energy,
            tempo=song.tempo,
            metre=song.metre,
            genre=np.array(danced.genre),
            seed=danced.seed,
            song_seed=song.seed,
        )


def main(arguments: list[str] | None = None) -> None:
    """Write synthetic dances: `python -m data_synth dances --out FOLDER`."""
    parser = argparse.ArgumentParser(
        prog="python -m data_synth dances", description="Write synthetic dances."
    )
    parser.add_argument(
        "--out", type=Path, required=True, help="folder for dance_000.bvh, dance_000.npz, ..."
    )
    parser.add_argument("--dances", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--each", type=int, default=1, help="dances to one song")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--genre", choices=list(GENRES), help="one genre only; without it, all in turn"
    )
    given = parser.parse_args(arguments)
    if min(given.dances, given.each) < 1 or given.seconds < 3:
        parser.error(
            "write at least one dance (--dances, --each) of at least three seconds (--seconds)"
        )
    from motiondiff_edu.motion.formats.bvh.write import write_bvh

    songs = -(-given.dances // given.each)
    made = dances(songs, given.seed, given.seconds, each=given.each, genre=given.genre)
    genres = []
    for k, (song, danced) in enumerate(islice(made, given.dances)):
        genres += [song.genre] if song.genre not in genres else []
        save_npz(danced, song, given.out / f"dance_{k:03d}.npz")
        write_bvh(given.out / f"dance_{k:03d}.bvh", danced.positions, danced.fps)
    print(f"{given.dances} dances of {given.seconds:g} s ({', '.join(genres)}) in {given.out}")


__all__ = ["main", "save_npz"]
