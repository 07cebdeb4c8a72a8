"""A motion as a recording of somebody else: another body, other names, unit, frame rate, and noise.

Real files differ from the course's in all of these. So where a notebook asks for a recording and
has none, it reads such a file, and goes through all that a real one goes through.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import scipy
from jaxtyping import Float

from motiondiff_edu._files import replacing
from motiondiff_edu.motion.formats.bvh.fit import Fit, fit
from motiondiff_edu.motion.formats.bvh.write import text

FPS = 60.0  # frames/s of the file
# times the course's bones: whoever this is has long shanks, short feet and a short back
BODY = {
    "LeftLeg": 0.95, "RightLeg": 0.95, "LeftFoot": 1.12, "RightFoot": 1.12,
    "LeftToeBase": 0.85, "RightToeBase": 0.85, "Spine1": 0.8, "Neck1": 0.9,
    "LeftHand": 1.08, "RightHand": 1.08,
}  # fmt: skip
UNIT = 1 / 2.54  # centimetres become inches
SHAKE = 0.15  # degrees: what a capture system adds to each angle
# as Mixamo calls them
NAMES = {
    "LowerBack": "Spine", "Spine": "Spine1", "Spine1": "Spine2", "Neck1": "Neck",
    "LeftHandIndex1": "LeftHandMiddle1", "RightHandIndex1": "RightHandMiddle1",
}  # fmt: skip


def write_foreign(
    path: str | Path, positions: Float[np.ndarray, "T 21 3"], seed: int, fps: float = 20.0
) -> Path:
    """Write a motion (metres, world) as the BVH file of another body; returns the path.

    In inches and at 60 frames/s, with joints named as Mixamo names them, below a pelvis that is as
    high as the other legs are long, and with noise of the angles, which `seed` draws.
    Notebook: 15
    """
    times = np.arange(0, len(positions) - 1 + 1e-9, fps / FPS)
    fitted = other_body(
        fit(scipy.interpolate.CubicSpline(np.arange(len(positions)), positions)(times))
    )
    shake = SHAKE * np.random.default_rng(seed).standard_normal(fitted.angles.shape)
    names = tuple(f"mixamorig:{NAMES.get(name, name)}" for name in fitted.names)
    root, offsets = UNIT * fitted.root, UNIT * fitted.offsets
    whole = replace(fitted, names=names, root=root, offsets=offsets, angles=fitted.angles + shake)
    path = Path(path)
    with replacing(path) as aside:
        aside.write_text(text(whole, FPS), encoding="ascii", newline="\n")
    return path


def other_body(fitted: Fit) -> Fit:
    """The same turns of the joints, with bones of BODY; steps are as long as the legs make them."""
    offsets = fitted.offsets.copy()
    for name, factor in BODY.items():
        offsets[fitted.names.index(name)] *= factor
    legs = [sum(np.linalg.norm(table[fitted.names.index(n)]) for n in ("LeftLeg", "LeftFoot"))
            for table in (offsets, fitted.offsets)]  # fmt: skip
    return replace(fitted, offsets=offsets, root=fitted.root * legs[0] / legs[1])
