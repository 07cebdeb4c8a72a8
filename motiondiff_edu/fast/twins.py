"""The fast twin of a network, rebuilt when the network's weights have changed.

A twin works on a copy of the weights. Training, loading other weights, or changing one in place
makes the copy stale. torch counts the in-place changes of every tensor; a different count triggers
a new copy.
"""

from collections.abc import Callable

from torch import nn

from ..cross_modal_attention import CrossModalAttention


class Twin:
    """`twin()` returns the fast twin of `model` with its current weights.

    Changes through `.data` and by fused optimizers are missed, because torch does not count them.
    `training.train_steps` counts its own steps; after a loop of yours with `fused=True`, call
    `torch.autograd.graph.increment_version` on the parameters.
    """

    def __init__(self, model: nn.Module, make: Callable[[nn.Module], object]):
        self.model, self.make = model, make
        self._made, self._stamp = None, None

    def __call__(self):
        stamp = stamp_of(self.model)
        if self._stamp != stamp:
            self._made, self._stamp = self.make(self.model), stamp
        return self._made


def stamp_of(model: nn.Module) -> tuple:
    """The address of every weight and buffer, and how often it was changed in place.

    torch keeps no count for tensors made in inference mode.
    """
    tensors = [*model.parameters(), *model.buffers()]
    return tuple((one.data_ptr(), 0 if one.is_inference() else one._version) for one in tensors)


def watched(model: nn.Module) -> bool:
    """Whether `cross_modal_attention.watch` collects this network's attention.

    A twin has other layers, so the network must then run itself.
    """
    layers = (m for m in model.modules() if isinstance(m, CrossModalAttention))
    return any(layer.watcher is not None for layer in layers)
