"""Weights in eight bits: half the space of float16.

Errors are up to 0.4 % of each row's largest weight.

    q = round(w / scale), scale = max |row| / 127,   and back:  w = q scale
Rounding errs by half a scale at most, 1/254 of the largest (0.39 %), and by 1/sqrt(12) of a scale
(0.23 %) RMS. Vectors (biases, norms) are few and dear: they stay in float16. Used for weights that
would not fit otherwise, and every figure is taken from what is shipped.  Source: symmetric
quantisation, one scale a row, as is usual.   Notebook: none
"""

import torch
from torch import Tensor

SCALE = ".scale"


def pack(tensors: dict[str, Tensor]) -> dict[str, Tensor]:
    """Each matrix as int8 with a scale for each row, each vector in float16.

    The scales lie beside the matrix (`name.scale`).
    """
    packed = {}
    for name, weight in tensors.items():
        if weight.dim() < 2 or not weight.is_floating_point():
            packed[name] = weight.half() if weight.is_floating_point() else weight
            continue
        scale = weight.float().flatten(1).abs().amax(1).clamp(min=1e-12) / 127
        rows = scale.view(-1, *[1] * (weight.dim() - 1))
        packed[name] = (weight.float() / rows).round().clamp(-127, 127).to(torch.int8)
        packed[name + SCALE] = scale
    return packed


def unpack(packed: dict[str, Tensor]) -> dict[str, Tensor]:
    """Float32 again; what was never packed passes through.

    Raises KeyError for an int8 matrix without its scale.
    """
    tensors = {}
    for name, weight in packed.items():
        if name.endswith(SCALE) and name.removesuffix(SCALE) in packed:
            continue
        if weight.dtype == torch.int8:
            scale = packed[name + SCALE]
            weight = weight.float() * scale.view(-1, *[1] * (weight.dim() - 1))
        tensors[name] = weight.float() if weight.is_floating_point() else weight
    return tensors
