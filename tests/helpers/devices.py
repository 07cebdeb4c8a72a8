"""Where the tensors of a performer are."""

from torch import nn

from motiondiff_edu.motion.scaler import Scaler


def devices_of(model: nn.Module, *scalers: Scaler) -> set[str]:
    """The devices of all weights, buffers and scalers."""
    units = [x for scaler in scalers for x in (scaler.mean, scaler.std)]
    tensors = [*model.parameters(), *model.buffers(), *units]
    return {tensor.device.type for tensor in tensors}
