"""Weights in eight bits: half the space of float16.

    q = round(w / scale), scale = max |row| / 127,   and back:  w = q scale
The rounding error is at most half a scale, 1/254 of a row's largest weight (0.39 %); its RMS is
1/sqrt(12) of a scale (0.23 %). Vectors (biases, norms) are small but sensitive, so they stay in
float16. The weights of `walker` and `walker-eps` have 16 bits, all others 8, which keeps the
package small. Every published number comes from the shipped weights.
Source: symmetric quantisation with one scale per row, as usual.   Notebook: none
"""

import torch
from torch import Tensor

SCALE = ".scale"


def halved(weights: dict[str, Tensor]) -> dict[str, Tensor]:
    """Weights as float16; whole numbers stay as they are.

    Raises ValueError for weights beyond float16, of which the largest is 65,504.
    """
    made = {name: x.half() if x.is_floating_point() else x for name, x in weights.items()}
    for name, x in weights.items():
        if torch.isfinite(x).all() and not torch.isfinite(made[name]).all():
            raise ValueError(f"{name} goes up to {x.abs().max():.3g}, beyond float16: pass bits=32")
    return made


def pack(tensors: dict[str, Tensor]) -> dict[str, Tensor]:
    """Each matrix as int8 with one scale per row (`name.scale`), each vector in float16.

    Raises ValueError as `halved` does.
    """
    packed = {}
    for name, weight in tensors.items():
        if weight.dim() < 2 or not weight.is_floating_point():
            packed |= halved({name: weight})
            continue
        scale = weight.float().flatten(1).abs().amax(1).clamp(min=1e-12) / 127
        rows = scale.view(-1, *[1] * (weight.dim() - 1))
        packed[name] = (weight.float() / rows).round().clamp(-127, 127).to(torch.int8)
        packed[name + SCALE] = scale
    return packed


def unpack(packed: dict[str, Tensor]) -> dict[str, Tensor]:
    """Unpack to float32; tensors that were never packed pass through.

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
