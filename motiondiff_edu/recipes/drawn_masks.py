"""Masks for training: what a user of in-betweens may give, drawn at random.

Keyframes, regular or not, with all joints or some; a gap; a beginning; a part of the body; nothing.
"""

import torch
from jaxtyping import Bool
from torch import Tensor

from ..editing.masks import PARTS
from ..motion.skeleton import HIPS, J, joint_index

SHARES = {"nothing": 0.1, "keyframes": 0.5, "gap": 0.1, "seed": 0.05, "part": 0.15, "joints": 0.1}
CLOSEST, WIDEST = 3, 45  # frames between keyframes
GAP = 70  # frames, at most
HALF = 0.5  # probability of either of two ways


def drawn_masks(n: int, T: int, generator: torch.Generator) -> Bool[Tensor, "n T 21"]:
    """A mask for each of n motions of T frames; a joint is given only with the pelvis.

    Raises ValueError for fewer than 4 frames.
    """
    if T < 4:
        raise ValueError(f"masks are drawn for 4 frames or more, not {T}")
    shares = torch.tensor(list(SHARES.values()))
    kinds = torch.multinomial(shares, n, replacement=True, generator=generator).tolist()
    names = list(SHARES)
    return torch.stack([drawn_mask(names[kind], T, generator) for kind in kinds])


def drawn_mask(kind: str, T: int, generator: torch.Generator) -> Bool[Tensor, "T 21"]:
    """A mask of one kind, a name of SHARES."""
    known = torch.zeros(T, J, dtype=torch.bool)
    if kind == "keyframes":
        known[drawn_keyframes(T, generator)] = True
    elif kind == "joints":
        joints = uniform(generator, J) < float(uniform(generator))
        known[drawn_keyframes(T, generator)] = joints
        known[:, HIPS] = known.any(-1)
    elif kind == "gap":
        length = random_int(1, min(GAP, T - 2), generator)
        first = random_int(0, T - length, generator)
        known[:] = True
        known[first : first + length] = False
    elif kind == "seed":
        known[: random_int(1, T // 2, generator)] = True
    elif kind == "part":
        part = list(PARTS.values())[random_int(1, len(PARTS) - 1, generator)]
        known[:, [HIPS, *map(joint_index, part)]] = True
        if float(uniform(generator)) < HALF:
            known[drawn_keyframes(T, generator)] = True
    return known


def drawn_keyframes(T: int, generator: torch.Generator) -> list[int]:
    """Frames at regular distances, or at irregular ones; mostly with the first and the last one."""
    widest = min(WIDEST, T - 1)
    share = float(uniform(generator))
    every = round(CLOSEST * (widest / CLOSEST) ** share)  # as many short distances as long ones
    regular = float(uniform(generator)) < HALF
    frames = [random_int(0, every, generator) if float(uniform(generator)) < 0.2 else 0]
    while frames[-1] < T:
        frames.append(frames[-1] + (every if regular else random_int(1, 2 * every, generator)))
    last = [T - 1] if float(uniform(generator)) < 0.8 else []
    return sorted({frame for frame in frames if frame < T} | set(last))


def uniform(generator: torch.Generator, *shape: int) -> Tensor:
    """Numbers drawn evenly between 0 and 1."""
    return torch.rand(shape, generator=generator)


def random_int(low: int, high: int, generator: torch.Generator) -> int:
    """A whole number from low to high, both included."""
    return int(torch.randint(low, high + 1, (), generator=generator))
