"""Bones that keep their length, a pelvis that keeps its shape, and a trunk that does not fold.

A network's joints are free points, so its bones are only nearly right. Here the generated joints
are moved until every bone has the length that it has where it is given. Given joints stay where
they are. Hips and spine are fixed to one bone in a body, so their distances are kept, too. With
distances between neighbours alone, a spine that came out too short would be folded like a ruler:
joints of the trunk that are two bones apart come no nearer to each other than where they are given.
Gain: docs/RESULTS.md, *In-betweens* (`inbetween-departures.no-bones.*`).
Source: position-based dynamics (Müller and others, 2007), distances only; MoFusion eq. 6 has the
same aim, as a loss.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from ..motion.skeleton import BONE_LENGTHS, BONES, HIPS, OFFSETS, joint_index

# rounds through all distances; errors of centimetres fall to a few mm at most, unless the given
# joints contradict the lengths
ROUNDS = 30

_LEFT, _RIGHT, _SPINE, _SPINE1, _NECK, _HEAD = map(
    joint_index, ("LeftUpLeg", "RightUpLeg", "Spine", "Spine1", "Neck1", "Head")
)
PELVIS = ((_LEFT, _RIGHT), (_LEFT, _SPINE), (_RIGHT, _SPINE))  # beside the bones from the pelvis
REST_PELVIS = np.array([np.linalg.norm(OFFSETS[b] - OFFSETS[a]) for a, b in PELVIS])
TRUNK = ((HIPS, _SPINE1), (_SPINE, _NECK), (_SPINE1, _HEAD))


@dataclass(frozen=True, eq=False)
class Lengths:
    """How long a body's parts are, in metres; NaN where nothing is known of one."""

    bones: Float[np.ndarray, "*B 20"]
    pelvis: Float[np.ndarray, "*B 3"]  # of PELVIS
    trunk: Float[np.ndarray, "*B 3"]  # of TRUNK; at least

    @classmethod
    def of(
        cls, positions: Float[np.ndarray, "*B T J 3"], known: Bool[np.ndarray, "*#B T J"]
    ) -> "Lengths":
        """Medians over the frames that give both ends; in the trunk, the least."""

        def distances(pairs, of_all):
            found = []
            for a, b in pairs:
                apart = np.linalg.norm(positions[..., b, :] - positions[..., a, :], axis=-1)
                given = np.broadcast_to(known[..., a] & known[..., b], apart.shape)
                shown = np.where(given, apart, np.nan)
                there = given.any(-1)
                one = np.full(there.shape, np.nan)
                one[there] = of_all(shown[there], axis=-1)
                found.append(one)
            return np.stack(found, -1)

        bones, pelvis = (distances(pairs, np.nanmedian) for pairs in (BONES, PELVIS))
        return cls(bones, pelvis, distances(TRUNK, np.nanmin))

    def completed(self) -> "Lengths":
        """The same, with unknown bones and pelvises as those of a course figure of the same size.

        Its size is the median over known bones; 1 where none is known.
        """
        shares = np.where(
            np.isnan(self.bones).all(-1, keepdims=True), 1.0, self.bones / BONE_LENGTHS
        )
        size = np.nanmedian(shares, axis=-1, keepdims=True)

        def filled(known, rest):
            return np.where(np.isnan(known), size * rest, known)

        bones, pelvis = filled(self.bones, BONE_LENGTHS), filled(self.pelvis, REST_PELVIS)
        return replace(self, bones=bones, pelvis=pelvis)

    def with_bones(self, bones: Float[np.ndarray, "20"]) -> "Lengths":
        """The same body with these bones."""
        return replace(self, bones=bones)


def steady_bones(
    positions: Float[np.ndarray, "*B T J 3"],
    known: Bool[np.ndarray, "*#B T J"],
    lengths: Lengths,
    rounds: int = ROUNDS,
) -> Float[np.ndarray, "*B T J 3"]:
    """Move the joints that are not known until the body has these lengths.

    Each of `rounds` rounds corrects one distance after the other. If both of its joints are free,
    each moves by half of the error; if one is known, the free joint moves by all of it. If known
    joints are farther apart than the bones reach, the remaining error is shared between the bones.
    """
    moved, free = np.array(positions, np.float64), (~known).astype(np.float64)
    wanted = [
        (*pair, length, most)
        for pairs, of, most in (
            (TRUNK, lengths.trunk, 0.0),  # these are not shortened
            (PELVIS, lengths.pelvis, np.inf),
            (BONES, lengths.bones, np.inf),
        )
        for pair, length in zip(pairs, np.moveaxis(of, -1, 0), strict=True)
    ]
    for _ in range(rounds):
        for a, b, length, most in wanted:
            mobile = free[..., a] + free[..., b]
            if np.isnan(length).all() or not mobile.any():
                continue
            apart = moved[..., b, :] - moved[..., a, :]
            now = np.maximum(np.linalg.norm(apart, axis=-1), 1e-9)
            error = np.nan_to_num(1 - length[..., None] / now)  # positive: too far apart
            share = np.minimum(error, most) / np.maximum(mobile, 1.0)
            moved[..., a, :] += (free[..., a] * share)[..., None] * apart
            moved[..., b, :] -= (free[..., b] * share)[..., None] * apart
    return np.where(known[..., None], positions, moved)
