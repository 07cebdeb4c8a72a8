"""An analytic gait whose steps are known.

Feet that stand still, and swing from one footprint to the next.
"""

import numpy as np

from motiondiff_edu.motion.root_frame import forward_left, root_path, to_root_frame
from motiondiff_edu.motion.skeleton import HEELS, OFFSETS, PARENTS, TOES

FPS = 20.0
STANCE = 0.6  # seconds


def rest_pose() -> np.ndarray:
    pose = OFFSETS.copy()
    for joint, parent in enumerate(PARENTS):
        pose[joint] += pose[parent] if parent >= 0 else 0
    return pose


def control_of(seconds: float, forward=1.2, left=0.0, yaw=0.0) -> np.ndarray:
    return np.tile([forward, left, yaw], (round(seconds * FPS), 1)).astype(float)


def gait(control: np.ndarray, phase=0.3, cycle=1.04, slide=0.0, lift=0.08) -> np.ndarray:
    """Root-frame poses (T, 21, 3) of a walk under `control`.

    Each foot still for STANCE seconds of every `cycle`.

    A foot stands where the root is at mid-stance, a hand's breadth to its side; `slide` (m/s)
    pushes it along +z.
    """
    frames, pad = len(control), round(4 * FPS)
    longer = np.concatenate(
        [np.repeat(control[:1], pad, 0), control, np.repeat(control[-1:], pad + 1, 0)]
    )
    path, heading = root_path(longer)
    clock = (np.arange(len(longer)) - pad) / FPS
    world = np.tile(rest_pose(), (len(longer), 1, 1))
    world[:, :, [0, 2]] += path[:, None]
    for side, (heel, toe) in enumerate(zip(HEELS, TOES, strict=True)):
        foot, height = _foot(clock, path, heading, 1 - 2 * side, phase + side / 2, cycle, slide)
        for joint, ahead in ((heel, 0.0), (toe, 0.115)):
            world[:, joint] = np.stack(
                [foot[:, 0], height * lift + (0.075 if ahead == 0 else 0), foot[:, 1]], -1
            )
            world[:, joint, [0, 2]] += ahead * forward_left(foot[:, 2])[0]
    keep = slice(pad, pad + frames)
    return to_root_frame(world[keep], path[keep], heading[keep])[0]


def _foot(clock, path, heading, sign, phase, cycle, slide):
    turns = clock / cycle + phase
    number, seconds = np.floor(turns), (turns % 1) * cycle
    print_of = {
        n: _print((n - phase) * cycle + STANCE / 2, clock, path, heading, sign)
        for n in range(-9, 99)
    }
    here = np.array([print_of[n] for n in number])
    there = np.array([print_of[n + 1] for n in number])
    swing = np.clip((seconds - STANCE) / (cycle - STANCE), 0, 1)
    ease = (swing - np.sin(2 * np.pi * swing) / (2 * np.pi))[:, None]
    foot = here + ease * (there - here)
    foot[:, 1] += slide * seconds * (1 - ease[:, 0])
    return foot, np.sin(np.pi * swing)


def _print(when, clock, path, heading, sign):
    x, z, psi = (np.interp(when, clock, values) for values in (path[:, 0], path[:, 1], heading))
    left = forward_left(np.array(psi))[1]
    return np.array([x + sign * 0.08 * left[0], z + sign * 0.08 * left[1], psi])
