"""Walks for dances, and Mel frames that say when they sound.

Material for the tests of windows and dancers.
"""

import numpy as np
import torch

from data_synth.walking import random_control, walk
from motiondiff_edu.conditions.music import FRAMES_PER_SECOND
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.performers.dance_windows import DanceWindows


def material(frames=(120, 90), seed: int = 0):
    """Two walks for dances, and Mel frames that say when they sound.

    Every band holds the time in seconds.
    """
    rng = np.random.default_rng(seed)
    dances = []
    contacts = []
    mels = []
    for k, T in enumerate(frames):
        clip = walk(random_control(T / 20, rng, "turn"), k)
        dances.append(to_world(clip.poses, clip.control)[:T])
        contacts.append(clip.contacts[:T])
        M = int(T / 20 * FRAMES_PER_SECOND) + 1
        mels.append((torch.arange(M) / FRAMES_PER_SECOND)[:, None].repeat(1, 5) + 100 * k)
    return dances, contacts, mels


def windows(n: int = 40, **kwargs) -> DanceWindows:
    return DanceWindows.of(*material(**kwargs), n)
