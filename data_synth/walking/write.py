"""Write walks to files: BVH for Blender, npz for everything else."""

import argparse
from pathlib import Path

import numpy as np

from motiondiff_edu._files import replacing
from motiondiff_edu.motion.clip import Clip

from .styles import STYLES
from .walks import dataset


def save_npz(clip: Clip, path: Path) -> None:
    """Save poses, control, contacts, fps and source as plain arrays.

    The file is written under another name and then renamed.
    """
    with replacing(path) as aside, open(aside, "wb") as f:
        np.savez_compressed(
            f,
            poses=clip.poses.astype(np.float32),
            control=clip.control,
            contacts=clip.contacts,  # type: ignore[arg-type]  # a walk has them
            fps=clip.fps,
            source=np.array(clip.source),
            style=np.array(clip.info.get("style", "")),
        )


def main(arguments: list[str] | None = None) -> None:
    """Write synthetic walks: `python -m data_synth walks --out FOLDER`."""
    parser = argparse.ArgumentParser(
        prog="python -m data_synth walks", description="Write synthetic walks."
    )
    parser.add_argument(
        "--out", type=Path, required=True, help="folder for walk_000.bvh, walk_000.npz, ..."
    )
    parser.add_argument("--clips", type=int, default=8)
    parser.add_argument("--seconds", type=float, default=12.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--style",
        choices=list(STYLES),
        help="one style only; without it, all are drawn by their shares",
    )
    given = parser.parse_args(arguments)
    if given.clips < 1 or given.seconds < 0.5:
        parser.error("write at least one clip (--clips) of at least half a second (--seconds)")
    from motiondiff_edu.motion.formats.bvh.write import write_bvh

    styles = None if given.style is None else [given.style]
    clips = dataset(given.clips, given.seconds, given.seed, styles)
    for k, clip in enumerate(clips):
        save_npz(clip, given.out / f"walk_{k:03d}.npz")
        write_bvh(given.out / f"walk_{k:03d}.bvh", clip.world(), clip.fps)
    names = ", ".join(sorted({clip.info["style"] for clip in clips}))
    print(f"{given.clips} walks of {given.seconds:g} s ({names}) in {given.out}")


__all__ = ["main", "save_npz"]
