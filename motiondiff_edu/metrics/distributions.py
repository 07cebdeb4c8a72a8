"""Measures of sets of motions: FID, diversity, the features of dances, texts and motions together.

FID compares two sets by their means and covariances alone. A covariance of D features needs many
more than D clips; the published table had 40 generated dances for 72 features. With few clips the
distance is too large, even between two halves of the data. So print `fid_floor` beside it.

Diversity: how different are several motions with the same past and control, or the same music? More
is not better: noise scores highest in every measure here. Compare with the data's own value.

The features of a dance are three energies per joint. `kinetic_features` computes what the papers
describe, `published_kinetic_features` what the code behind the published tables does: there a
missing bracket makes the third number measure the distance from the origin. Both use 60 frames/s,
metres, seconds, and y up.

A network learns one space of texts and motions:
    R-Precision  among 32 motions that show different things, how often is the own one of a text
                 among the nearest 1, 2, 3?
    MM-Dist      the mean distance of a text from the motion that was made for it
Both know only what the network knows: use them beside the recogniser (`metrics/texts.py`), and
with the data's own value.
Source: MoFusion 4.1 (FID, Div, MModality), Table 1; for motion from text Guo and others, 2022
(HumanML3D), which MoFusion's Table 2 uses; this network is ours, and learns by contrast (Radford
and others, 2021).
Notebook: 08, 14, 17
"""

import warnings
from collections.abc import Hashable, Sequence

import numpy as np
import torch
from jaxtyping import Float, Int
from sklearn.covariance import ledoit_wolf
from torch import Tensor, nn
from torch.nn import functional as F
from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

from ..motion.resample import DANCE_FPS, resample
from ..motion.root_frame import FPS


# ---- FID -----------------------------------------------------------------------------------------
class FewSamplesWarning(UserWarning):
    """There are too few clips for so many features.

    Compare the value only with others from the same number of clips.
    """


def normalise(
    features: Float[np.ndarray, "*N F"], data: Float[np.ndarray, "M F"]
) -> Float[np.ndarray, "*N F"]:
    """(features - mean) / std, with the mean and population std of the *data's* features.

    A feature that is constant in the data is only shifted; otherwise rounding errors would be
    divided by rounding errors.
    Source: MoFusion 4.1, and the code it follows.  Notebook: 14
    """
    mean, std = data.mean(0), data.std(0)
    return (features - mean) / np.where(std > 1e-10 * np.maximum(np.abs(mean), 1e-10), std, 1.0)


def frechet_distance(
    mean_1: Float[np.ndarray, "F"],
    covariance_1: Float[np.ndarray, "F F"],
    mean_2: Float[np.ndarray, "F"],
    covariance_2: Float[np.ndarray, "F F"],
) -> float:
    """The squared Frechet distance of two Gaussians.

    d^2 = |m1 - m2|^2 + tr(C1 + C2 - 2 (C1^1/2 C2 C1^1/2)^1/2).

    The matrix under the root is symmetric, so its root comes from its eigenvalues: d^2 is real and
    never negative, even where C1 or C2 is singular. For covariances that commute it is
    |m1 - m2|^2 + |sqrt(l1) - sqrt(l2)|^2, with l the paired eigenvalues.
    Source: MoFusion 4.1.
    """
    values, vectors = np.linalg.eigh(covariance_1)
    root = (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T
    middle = np.linalg.eigvalsh(root @ covariance_2 @ root)
    mixed = np.sqrt(np.maximum(middle, 0.0)).sum()
    distance = (
        ((mean_1 - mean_2) ** 2).sum() + np.trace(covariance_1) + np.trace(covariance_2) - 2 * mixed
    )
    return float(max(distance, 0.0))  # rounding can make a distance of 0 negative


def shrunk_covariance(features: Float[np.ndarray, "N F"]) -> Float[np.ndarray, "F F"]:
    """The covariance (divided by N), shrunk towards a multiple of the identity.

    C* = (1 - w) C + w (tr C / F) I, with the weight w of Ledoit and Wolf (2004).

    The weight is larger for fewer clips. C* is singular only if all clips are equal.
    """
    return ledoit_wolf(features)[0]


def fid(generated: Float[np.ndarray, "N F"], data: Float[np.ndarray, "M F"]) -> float:
    """Frechet distance between the features of generated clips and those of the data.

    Both sets are normalised by the data; the covariances are unbiased. Unless both sets have more
    clips than features, the value is much too large and a FewSamplesWarning says so: compare it
    only with `fid_floor` for the same number of clips.
    Raises ValueError for fewer than two clips or features that are not finite.
    Source: MoFusion 4.1.   Notebook: 14
    """
    generated, data = _checked(generated, data)
    if min(len(generated), len(data)) <= data.shape[1]:
        warnings.warn(
            (
                f"{len(generated)} and {len(data)} clips for {data.shape[1]} features: "
                "more clips than features are needed"
            ),
            FewSamplesWarning,
            stacklevel=2,
        )
    parts = [part for x in (generated, data) for part in (x.mean(0), _covariance(x))]
    return frechet_distance(*parts)


def shrunk_fid(generated: Float[np.ndarray, "N F"], data: Float[np.ndarray, "M F"]) -> float:
    """`fid` with `shrunk_covariance`: less noise and bias for few clips, but not the published FID.

    Raises ValueError for fewer than two clips or features that are not finite.  Notebook: 14
    """
    generated, data = _checked(generated, data)
    return frechet_distance(
        generated.mean(0), shrunk_covariance(generated), data.mean(0), shrunk_covariance(data)
    )


def fid_floor(
    data: Float[np.ndarray, "M F"], n: int, rng: np.random.Generator, distance=fid, times: int = 10
) -> tuple[float, float]:
    """The FID of a perfect generator: n random clips of the data against all other clips.

    Returns the mean and standard deviation over `times` draws. A generator whose n clips reach this
    mean cannot be distinguished from the data. `distance` is `fid`, `shrunk_fid` ...
    Raises ValueError unless both sides have two clips.  Notebook: 14
    """
    if not 2 <= n <= len(data) - 2:
        raise ValueError(
            f"{n} of {len(data)} clips cannot be compared with the others: "
            "two are needed on both sides"
        )
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FewSamplesWarning)
        for _ in range(times):
            order = rng.permutation(len(data))
            found.append(distance(data[order[:n]], data[order[n:]]))
    return float(np.mean(found)), float(np.std(found))


def _covariance(features: np.ndarray) -> np.ndarray:
    """The unbiased covariance; it is a matrix for a single feature, too."""
    return np.atleast_2d(np.cov(features.T))


def _checked(generated: np.ndarray, data: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    for name, features in (("generated", generated), ("data's", data)):
        if len(features) < 2:
            raise ValueError(
                f"a covariance needs at least 2 clips; the {name} features have {len(features)}"
            )
        if not np.isfinite(features).all():
            bad = int(np.flatnonzero(~np.isfinite(features).all(1))[0])
            raise ValueError(f"row {bad} of the {name} features is not finite: check that clip")
    return normalise(generated, data), normalise(data, data)


# ---- diversity -----------------------------------------------------------------------------------
def spread(
    rollouts: Float[np.ndarray, "*B n T J 3"], fps: float | int = FPS, skip_s: float | int = 1.0
) -> float | Float[np.ndarray, "*B"]:
    """Root-frame RMS spread of n rollouts, in metres, from `skip_s` seconds on.

    Before that the shared past still dominates.

    spread^2 = 1 / (n - 1) * sum_i mean_{t, j} |p_i[t, j] - mean_i p_i[t, j]|^2

    Noise increases the spread as well as choice does. So divide it by the spread of the data's own
    continuations; a good model has the ratio 1. Raises ValueError for fewer than two rollouts, or
    no frames after `skip_s`.
    Notebook: 08
    """
    n, first = rollouts.shape[-4], round(skip_s * fps)
    if n < 2:
        raise ValueError("a spread needs at least 2 rollouts of the same past and control, got 1")
    if rollouts.shape[-3] <= first:
        raise ValueError(
            f"rollouts of {rollouts.shape[-3]} frames end before the spread begins, "
            f"at frame {first}"
        )
    late = np.asarray(rollouts, np.float64)[..., first:, :, :]
    deviation = late - late.mean(-4, keepdims=True)
    return np.sqrt((deviation**2).sum(-1).mean((-2, -1)).sum(-1) / (n - 1))


def diversity(features: Float[np.ndarray, "*B N F"]) -> float | Float[np.ndarray, "*B"]:
    """Mean distance over all N (N - 1) / 2 pairs of (normalised) feature vectors: the papers' Div.

    Normalise by the data first: `frechet.normalise(features, data)`.
    Raises ValueError for fewer than two vectors.
    Source: MoFusion 4.1, Table 1, Table 2.  Notebook: 14
    """
    n = features.shape[-2]
    if n < 2:
        raise ValueError(f"a distance needs at least 2 motions, not {n}")
    first, second = np.triu_indices(n, 1)
    return np.linalg.norm(features[..., first, :] - features[..., second, :], axis=-1).mean(-1)[()]


def multimodality(features: Float[np.ndarray, "B K F"]) -> float:
    """How different the K dances to one piece of music are: the mean distance of their pairs.

    The result is the average over B pieces. The paper uses K = 50 and leaves the rest open; here
    all pairs count, and the features are normalised by the data before.
    Raises ValueError for fewer than two dances per piece.
    Source: MoFusion 4.1, Table 1, Table 2.   Notebook: 14
    """
    return float(np.mean(diversity(features)))


# ---- features of dances --------------------------------------------------------------------------
WINDOW = 2  # frames to either side, at 60 frames/s


def kinetic_features(
    positions: Float[np.ndarray, "T J 3"], fps: float | int = FPS
) -> Float[np.ndarray, "F"]:
    """Energies of joint 0, of joint 1 and so on.

    Each has (horizontal energy, vertical energy, energy expenditure): F = 3 J numbers.

    v[t] and a[t] are velocity and acceleration at 60 frames/s, each averaged over two frames to
    either side. Horizontal = mean_t |v_xz|^2 and vertical = mean_t v_y^2, in (m/s)^2; expenditure =
    mean_t |a| in m/s^2. The dancer's place in the world makes no difference.
    Raises ValueError for fewer than three frames.  Source: MoFusion 4.1.  Notebook: 14
    """
    positions = _at_60(positions, fps)
    steps = np.diff(positions, axis=0) * DANCE_FPS
    return _together(steps, np.diff(steps, axis=0) * DANCE_FPS)


def published_kinetic_features(
    positions: Float[np.ndarray, "T J 3"], fps: float | int = FPS
) -> Float[np.ndarray, "F"]:
    """The same features with the fault of the public code, to compare with published numbers.

    The code is that of fairmotion, AIST++ and Bailando. Its earlier velocity is p[t] - p[t-1] / dt
    instead of (p[t] - p[t-1]) / dt, so the expenditure is about 59 * 60 * mean_t |p|. It measures
    the distance from the origin, and is not 0 for a motionless joint. Bailando first moves the root
    to the origin (`from_the_origin`) and AIST++ does not, so their numbers differ.
    Raises ValueError for fewer than three frames.  Source: MoFusion 4.1.  Notebook: 14
    """
    positions = _at_60(positions, fps)
    steps = np.diff(positions, axis=0) * DANCE_FPS
    earlier = positions[1:-1] - positions[:-2] * DANCE_FPS
    return _together(steps, (steps[1:] - earlier) * DANCE_FPS)


def from_the_origin(positions: Float[np.ndarray, "T J 3"]) -> Float[np.ndarray, "T J 3"]:
    """The motion moved so that joint 0 starts at (0, 0, 0), as in Bailando's code.

    Notebook: 14
    """
    return positions - positions[:1, :1]


def _at_60(positions: np.ndarray, fps: float | int) -> np.ndarray:
    if len(positions) < 3:
        raise ValueError(
            f"an acceleration needs three frames, and this motion has {len(positions)}"
        )
    return resample(positions, fps)


def _averaged(rates: Float[np.ndarray, "N J 3"], frames: int) -> Float[np.ndarray, "{frames} J 3"]:
    """Mean of the rates over a window around each frame; the window is cut at the ends."""
    total = np.concatenate([np.zeros((1, *rates.shape[1:])), np.cumsum(rates, axis=0)])
    at = np.arange(
        frames
    )  # a last frame without an acceleration of its own has the mean of those before
    first = np.maximum(at - WINDOW, 0)
    last = np.minimum(at + WINDOW + 1, len(rates))
    return (total[last] - total[first]) / (last - first)[:, None, None]


def _together(
    steps: Float[np.ndarray, "N J 3"], changes: Float[np.ndarray, "_ J 3"]
) -> Float[np.ndarray, "F"]:
    """The three energies of each joint, from velocities (`steps`) and accelerations (`changes`)."""
    velocity = _averaged(steps, len(steps))
    acceleration = _averaged(changes, len(steps))
    horizontal = (velocity[..., [0, 2]] ** 2).sum(-1).mean(0)
    vertical = (velocity[..., 1] ** 2).mean(0)
    expenditure = np.linalg.norm(acceleration, axis=-1).mean(0)
    return np.stack([horizontal, vertical, expenditure], -1).reshape(-1)


# ---- texts and motions in one space --------------------------------------------------------------
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
