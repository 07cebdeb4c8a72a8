"""A BVH file of a walk on another body.

With it files with joints cut off, and what must hold for every clip made from one.
"""

from collections.abc import Collection
from dataclasses import replace

import numpy as np
from bvh_text import dump
from synthetic_walk import walk

from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.formats.bvh import Bvh
from motiondiff_edu.motion.formats.bvh.fit import fit
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, PARENTS, TOES

CHANNELS = ("Zrotation", "Xrotation", "Yrotation")


def foreign(path, frames=361, fps=120, unit=0.0254, z_up=False, t_pose=False, names=None, **motion):
    """A walk on another body (other proportions, unit, names), below a static root.

    Returns the file.
    """
    world, _ = walk(frames=frames, fps=fps, **motion)
    fitted = fit(world)
    offsets = fitted.offsets / unit
    for name, factor in {
        "LeftLeg": 1.15,
        "RightLeg": 1.15,
        "LeftFoot": 0.8,
        "RightFoot": 0.8,
        "Spine1": 0.7,
    }.items():
        offsets[fitted.names.index(name)] *= factor
    rows = np.concatenate([fitted.root / unit, *np.moveaxis(fitted.angles, 1, 0)], axis=1)
    rows = np.concatenate([np.tile([0.0, 0, 0, 0, 90.0 * z_up, 0], (len(rows), 1)), rows], axis=1)
    if t_pose:
        rows = np.concatenate([rows[:1] * 0, rows])
    nodes = ["Scene", *((names or {}).get(name, name) for name in fitted.names)]
    six = tuple(axis + "position" for axis in "XYZ") + CHANNELS
    channels = [six, six] + [CHANNELS] * (len(nodes) - 2)
    parents = np.concatenate([[-1], fitted.parents + 1])
    table = np.concatenate([np.zeros((1, 3)), offsets])
    path.write_text(
        dump(nodes, parents, table, channels, rows, 1 / fps, np.zeros(len(nodes), bool))
    )
    return path


def sound(clip: Clip) -> np.ndarray:
    """Check what must hold for every clip; returns its world positions."""
    world = clip.world()
    bones = np.linalg.norm(world[:, 1:] - world[:, PARENTS[1:]], axis=-1)
    assert np.abs(bones - BONE_LENGTHS).max() < 1e-6
    assert clip.fps == 20 and np.isfinite(world).all()
    toes = world[:, list(TOES)]
    assert toes[..., 1].min() > -1e-6
    assert np.abs(toes[clip.contacts][:, 1]).max() < 0.02
    steps = np.linalg.norm(np.diff(toes, axis=0), axis=-1)[clip.contacts[1:] & clip.contacts[:-1]]
    assert steps.mean() < 5e-4  # metres a frame
    return world


def without(bvh: Bvh, dropped: Collection[str]) -> Bvh:
    """The file without some of its leaves, and without any end site."""
    keep = [n for n, name in enumerate(bvh.names) if name not in dropped and not bvh.is_end[n]]
    columns = [
        c
        for n in keep
        for c in range(bvh.first_column[n], bvh.first_column[n] + len(bvh.channels[n]))
    ]
    return replace(
        bvh,
        names=tuple(bvh.names[n] for n in keep),
        parents=np.array([keep.index(bvh.parents[n]) if bvh.parents[n] >= 0 else -1 for n in keep]),
        offsets=bvh.offsets[keep],
        channels=tuple(bvh.channels[n] for n in keep),
        frames=bvh.frames[:, columns],
        is_end=bvh.is_end[keep],
    )


def seen_in_a_mirror(bvh: Bvh) -> Bvh:
    """The same motion with left and right exchanged, as careless exports have it.

    x and turns about y and z flip.
    """
    flips = {"Xposition", "Yrotation", "Zrotation"}
    signs = [-1.0 if channel in flips else 1.0 for channels in bvh.channels for channel in channels]
    return replace(bvh, offsets=bvh.offsets * [-1, 1, 1], frames=bvh.frames * signs)
