"""The fast twin of a network, made anew when the network's weights have changed since.

A twin works on a copy of the weights. Training on, loading other weights, or changing one in place
makes the copy stale: torch counts the changes of every tensor, and the count is compared.
"""

from collections.abc import Callable

from torch import Tensor, nn

from ..cross_modal_attention import CrossModalAttention


class Twin:
    """`twin()` is the fast twin of `model`, with its weights of now.

    Only a change through `.data` escapes it: torch does not count those.
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
    """Where every weight and buffer lies, and how often it was changed in place."""
    tensors = [*model.parameters(), *model.buffers()]
    return tuple((tensor.data_ptr(), _changes(tensor)) for tensor in tensors)


def _changes(tensor: Tensor) -> int:
    """A tensor made in inference mode counts nothing, and cannot be trained."""
    return 0 if tensor.is_inference() else tensor._version


def watched(model: nn.Module) -> bool:
    """Whether somebody collects this network's attention.

    See `cross_modal_attention.watch`: a twin's layers are others.
    """
    layers = (m for m in model.modules() if isinstance(m, CrossModalAttention))
    return any(layer.watcher is not None for layer in layers)
