"""Texts and motions in one space: R-Precision, MM-Dist, and the network that learns the space.

    R-Precision  among 32 motions that show different things, how often is the own one of a text
                 among the nearest 1, 2, 3?
    MM-Dist      the mean distance of a text from the motion that was made for it
Both know only what the network knows: use them beside the recogniser (`metrics/actions.py`), and
with the data's own value.
Source: Guo and others, 2022 (HumanML3D), which MoFusion's Table 2 uses; this network is ours, and
learns by contrast (Radford and others, 2021).
Notebook: 17
"""

from collections.abc import Hashable, Sequence

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor, nn
from torch.nn import functional as F
from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

POOL = 32  # motions to choose from
TOP = 3


def r_precision(
    texts: Float[np.ndarray, "N E"],
    motions: Float[np.ndarray, "N E"],
    truths: Sequence[Hashable],
    rng: np.random.Generator,
    pool: int = POOL,
) -> Float[np.ndarray, "3"]:
    """How often the own motion of a text is among the nearest 1, 2 and 3 of `pool` motions.

    `truths`: what each text says; a pool has no two equal ones, so that only one motion is right.
    Of motions that are equally near any may come first, so a network that always makes the same
    motion gets chance: 1, 2, 3 over `pool`. Texts that are left over at the end are not counted.
    Raises ValueError unless there is a motion and a truth for each text, where there are fewer than
    `pool` different truths, or a point is not finite.
    """
    _check(texts, motions)
    if len(truths) != len(texts):
        raise ValueError(f"{len(texts)} texts, but {len(truths)} truths: give one for each text")
    hits, counted = np.zeros(TOP), 0
    for members in pools(truths, rng, pool):
        apart = np.linalg.norm(texts[members, None] - motions[None, members], axis=-1)
        own = np.diagonal(apart)[:, None]
        nearer, equal = (apart < own).sum(1), (apart == own).sum(1)  # the own one is equal, too
        hits += [((k - nearer) / equal).clip(0, 1).sum() for k in range(1, TOP + 1)]
        counted += len(members)
    return hits / counted


def pools(truths: Sequence[Hashable], rng: np.random.Generator, pool: int) -> list[list[int]]:
    """Disjoint groups of `pool` indices with different truths, drawn at random.

    Raises ValueError where not one group can be made, or a group would be empty.
    """
    if pool < 1:
        raise ValueError(f"a pool needs at least one motion, not {pool}")
    waiting = [int(k) for k in rng.permutation(len(truths))]
    found: list[list[int]] = []
    while True:
        group: dict[Hashable, int] = {}
        for k in waiting:
            if len(group) == pool:
                break
            group.setdefault(truths[k], k)
        if len(group) < pool:
            break
        found.append(list(group.values()))
        taken = set(found[-1])
        waiting = [k for k in waiting if k not in taken]
    if not found:
        raise ValueError(
            f"a pool needs {pool} texts that say different things; these say {len(set(truths))}"
        )
    return found


def mm_dist(texts: Float[np.ndarray, "N E"], motions: Float[np.ndarray, "N E"]) -> float:
    """The mean distance between a text and its motion, in the space of the network.

    Raises ValueError unless there is a motion for each text, or where a point is not finite.
    """
    _check(texts, motions)
    return float(np.linalg.norm(texts - motions, axis=-1).mean())


def _check(texts: np.ndarray, motions: np.ndarray) -> None:
    """A text has one motion; and a NaN, neither nearer nor farther, would pass for the nearest."""
    if texts.shape != motions.shape:
        raise ValueError(
            f"texts are {texts.shape} and motions {motions.shape}: give a motion for each text"
        )
    for name, points in (("texts", texts), ("motions", motions)):
        bad = np.flatnonzero(~np.isfinite(points).all(1))
        if len(bad):
            raise ValueError(f"{name}[{bad[0]}] is not finite: is the motion or network broken?")


class Space(nn.Module):
    """Texts and motions to points on a sphere of dimension `width`.

    Motions (B, T, D) are halved twice by convolutions, then read forwards and backwards; texts are
    ids (B, M) below `words`, 0 is padding. Motions of one batch have one length.
    """

    def __init__(self, D: int, words: int, width: int = 128):
        super().__init__()
        self.width = width
        self.shorten = nn.Sequential(
            nn.Conv1d(D, width, 4, 2, 1), nn.GELU(), nn.Conv1d(width, width, 4, 2, 1), nn.GELU()
        )
        self.read_motion = nn.GRU(width, width, batch_first=True, bidirectional=True)
        self.embed = nn.Embedding(words, width, padding_idx=0)
        self.read_text = nn.GRU(width, width, batch_first=True, bidirectional=True)
        self.motion_out = nn.Linear(2 * width, width)
        self.text_out = nn.Linear(2 * width, width)
        self.sharpness = nn.Parameter(torch.tensor(2.5))

    def motion_points(self, motions: Float[Tensor, "B T D"]) -> Float[Tensor, "B E"]:
        """The points of motions, in the units that the network was trained in."""
        h, _ = self.read_motion(self.shorten(motions.mT).mT)
        return F.normalize(self.motion_out(h.amax(1)), dim=-1)

    def text_points(self, ids: Int[Tensor, "B M"]) -> Float[Tensor, "B E"]:
        """The points of texts."""
        lengths = (ids != 0).sum(1).cpu()  # so that reading backwards does not begin at padding
        packed = pack_padded_sequence(self.embed(ids), lengths, True, enforce_sorted=False)
        h, _ = pad_packed_sequence(self.read_text(packed)[0], True, padding_value=-1e4)
        return F.normalize(self.text_out(h.amax(1)), dim=-1)


def contrast(
    space: Space,
    motions: Float[Tensor, "B T D"],
    ids: Int[Tensor, "B M"],
    same: Float[Tensor, "B B"] | None = None,
    wrong: Int[Tensor, "B M2"] | None = None,
) -> Float[Tensor, ""]:
    """The loss by which a space is learnt: each text's motion is nearer than the others', and back.

    same   1 where two texts of the batch say the same, which is then not held against them
    wrong  for each motion a text that differs from its own in one thing. Without such texts nothing
           in a batch tells "waves, then kicks" from "kicks, then waves", and the space does not
           learn it.
    Source: Radford and others, 2021; the wrong texts after Yuksekgonul and others, 2023.
    """
    points, sharpness = space.motion_points(motions), space.sharpness.exp()
    likeness = space.text_points(ids) @ points.mT * sharpness
    own = torch.eye(len(ids), device=ids.device)
    if same is not None:
        likeness = likeness.masked_fill((same > 0) & (own == 0), -1e4)
    of_motions = likeness.mT
    if wrong is not None:
        to_wrong = (space.text_points(wrong) * points).sum(-1, keepdim=True) * sharpness
        of_motions = torch.cat([of_motions, to_wrong], 1)
    target = torch.arange(len(ids), device=ids.device)
    return (F.cross_entropy(likeness, target) + F.cross_entropy(of_motions, target)) / 2
