"""Write clips of actions to files: BVH for Blender, npz for everything else, captions as text."""

import argparse
import json
from dataclasses import asdict
from pathlib import Path

import numpy as np

from motiondiff_edu._files import replacing

from .dataset import SPLITS, Described, clips


def save_npz(clip: Described, path: Path) -> None:
    """Save positions, contacts and the truth of what happens when, as plain arrays.

    `spans` (K, 2): seconds; `acts` (K,): each act as JSON. The file is written under another name
    and then renamed.
    """
    acted = clip.acted
    with replacing(path) as aside, open(aside, "wb") as f:
        np.savez_compressed(
            f,
            positions=acted.positions.astype(np.float32),
            contacts=acted.contacts,
            fps=acted.fps,
            spans=np.array([(span.first, span.last) for span in acted.spans]).reshape(-1, 2),
            acts=np.array([json.dumps(asdict(span.act)) for span in acted.spans]),
            captions=np.array(clip.captions),
            seed=acted.seed,
        )


def save_text(clip: Described, path: Path) -> None:
    """Save the captions, a line each."""
    with replacing(path) as aside:
        aside.write_text("".join(f"{text}\n" for text in clip.captions), encoding="utf-8")


def main(arguments: list[str] | None = None) -> None:
    """Write synthetic actions: `python -m data_synth actions --out FOLDER`."""
    parser = argparse.ArgumentParser(
        prog="python -m data_synth actions", description="Write synthetic actions with captions."
    )
    parser.add_argument(
        "--out", type=Path, required=True, help="folder for action_000.bvh, .npz and .txt, ..."
    )
    parser.add_argument("--clips", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--split", choices=list(SPLITS), default="train")
    given = parser.parse_args(arguments)
    if given.clips < 1 or given.seed < 0:
        parser.error("write at least one clip (--clips), with a seed of 0 or more (--seed)")
    from motiondiff_edu.motion.formats.bvh.write import write_bvh

    for k, clip in enumerate(clips(given.clips, given.seed, given.split)):
        save_npz(clip, given.out / f"action_{k:03d}.npz")
        save_text(clip, given.out / f"action_{k:03d}.txt")
        write_bvh(given.out / f"action_{k:03d}.bvh", clip.acted.positions, clip.acted.fps)
    print(f"{given.clips} clips with captions in {given.out}")


__all__ = ["main", "save_npz", "save_text"]
