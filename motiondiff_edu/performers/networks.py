"""The networks that a performer can have.

After one call of `register`, your own network is built, saved and loaded like ours.

    register("walker", MyNetwork, MyConfig)
    save(Walker(MyNetwork(MyConfig()), schedule, poses, control), "mine.safetensors")
    load("mine.safetensors")        # another program must register it first, too
docs/EXTENDING.md has a complete example.
Notebook: 07
"""

from collections.abc import Callable, Iterator
from dataclasses import MISSING, Field, dataclass, fields
from typing import Any, ClassVar, Protocol, Self, runtime_checkable

import torch
from torch import Tensor, nn

from ..mofusion import Music
from ..rollout import Sizes

# the fields that samplers and scalers need in a configuration
NEEDED = {
    "walker": ("D", "C", "S", "T_h", "T_p", "target"),
    "dancer": ("D", "C", "S", "target"),
    "mover": ("D", "C", "S", "target", "words"),
    "inbetweener": ("D", "C", "S", "target"),
}
# the methods that they call
METHODS = {
    "walker": ("encode", "decode"),
    "dancer": ("listen", "encode", "decode"),
    "mover": ("listen", "encode", "decode"),
    "inbetweener": ("lines",),
}


@runtime_checkable
class Config(Protocol):
    """The widths of a pose (D) and of a condition's row (C), the diffusion steps S, the target."""

    __dataclass_fields__: ClassVar[dict[str, Field]]

    @property
    def D(self) -> int: ...

    @property
    def C(self) -> int: ...

    @property
    def S(self) -> int: ...

    @property
    def target(self) -> str: ...


@runtime_checkable
class WalkerConfig(Config, Sizes, Protocol):
    """`Config`, and the frames given (T_h) and predicted (T_p)."""


@runtime_checkable
class MoverConfig(Config, Protocol):
    """`Config`, and the words that the network knows."""

    @property
    def words(self) -> tuple[str, ...]: ...


@runtime_checkable
class AnyNetwork(Protocol):
    """A network with its configuration, and what performers use of torch's nn.Module."""

    training: bool

    def __call__(self, *inputs: Any) -> Any: ...

    def eval(self) -> Any: ...

    def modules(self) -> Iterator[nn.Module]: ...

    def parameters(self) -> Iterator[nn.Parameter]: ...

    def state_dict(self) -> dict[str, Any]: ...

    def to(self, device: str | torch.device) -> Self: ...

    @property
    def config(self) -> Config: ...


@runtime_checkable
class WalkerNetwork(AnyNetwork, Protocol):
    """A network for walkers; `register` says what the methods do."""

    @property
    def config(self) -> WalkerConfig: ...

    def encode(self, past: Tensor, control: Tensor, /) -> Any: ...

    def decode(self, x_s: Tensor, s: Tensor, memory: Any, /) -> Tensor: ...


@runtime_checkable
class DancerNetwork(AnyNetwork, Protocol):
    """A network for dancers."""

    def listen(self, mel: Tensor, times: Tensor, /) -> Music: ...

    def encode(self, music: Any, frames: int, /) -> Any: ...

    def decode(self, x_s: Tensor, s: Tensor, memory: Any, /) -> Tensor: ...


@runtime_checkable
class MoverNetwork(AnyNetwork, Protocol):
    """A network for movers."""

    def listen(self, texts: Any, /) -> Any: ...

    def encode(self, context: Any, frames: int, /) -> Any: ...

    @property
    def decode(self) -> Callable[..., Tensor]: ...  # one that plans takes the plan as well

    @property
    def config(self) -> MoverConfig: ...


@dataclass(frozen=True)
class Network:
    """A kind of network: its class and its configuration."""

    performer: str
    model: type[nn.Module]
    config: type


_NETWORKS: dict[str, Network] = {}


def register(performer: str, model: type[nn.Module], config: type) -> None:
    """Register a network for a performer, one of NEEDED; files name it by its class.

    model   the class, which is called with a configuration. All networks but an in-betweener's have
            `decode(x_s, s, memory)`, which returns the target, and `encode`, which makes the memory
            once for all steps: of past and control for a walker, of music and a number of frames
            for a dancer, of a text and frames for a mover. For training they are called with
            (x_s, s, past, control), or (x_s, s, music). A dancer's has also `listen(mel, times)`,
            which makes that music, a mover's `listen(texts)`. A mover that plans is a
            `PlannedMoFusion`. An in-betweener's has the methods of `KeyframeMoFusion`
    config  a frozen dataclass with a default for every field, including `target`; the network keeps
            it as `.config`
    Raises ValueError for an unknown performer, a name or a configuration that another class has,
    a network that lacks a method, and a configuration that lacks a field or a default.
    """
    if performer not in NEEDED:
        raise ValueError(
            f"performer must be one of {', '.join(map(repr, NEEDED))}, not {performer!r}"
        )
    names = {field.name for field in fields(config)}
    missing = [name for name in NEEDED[performer] if name not in names]
    bare = [f.name for f in fields(config) if f.default is MISSING]
    if missing or bare:
        what = f"lacks {', '.join(missing)}" if missing else f"has no default for {', '.join(bare)}"
        raise ValueError(f"{config.__name__} {what}; a {performer}'s network needs that")
    unable = [name for name in METHODS[performer] if not callable(getattr(model, name, None))]
    if unable:
        raise ValueError(
            f"{model.__name__} has no method {', '.join(unable)}: a {performer} calls "
            f"{', '.join(METHODS[performer])}. Where nothing can be computed beforehand, `encode` "
            "returns what it is given"
        )
    taken = _NETWORKS.get(model.__name__)
    if taken and _full_name(taken.model) != _full_name(model):
        other = _full_name(taken.model)
        raise ValueError(f"{model.__name__} is the name of {other}: choose another name")
    if taken and taken.performer != performer:
        raise ValueError(
            f"{model.__name__} is a {taken.performer}'s network already: a {performer}'s needs a "
            "class of its own"
        )
    same = [one for one in _NETWORKS.values() if one.config is config]
    if same and _full_name(same[0].model) != _full_name(model):
        raise ValueError(
            f"{config.__name__} belongs to {_full_name(same[0].model)}: a configuration names one "
            f"network, so make a subclass of it for {model.__name__}"
        )
    _NETWORKS[model.__name__] = Network(performer, model, config)


def networks_of(performer: str) -> dict[str, Network]:
    """The networks for a performer, one of NEEDED, by the names of their classes."""
    return {name: one for name, one in _NETWORKS.items() if one.performer == performer}


def kind_of(model: object) -> Network | None:
    """The registration of a network's class, or None."""
    found = _NETWORKS.get(type(model).__name__)
    return found if found and _full_name(found.model) == _full_name(type(model)) else None


def network(config: Config) -> Any:
    """A new network for a configuration.

    Raises ValueError for a configuration without a registered network.
    """
    for one in _NETWORKS.values():
        if one.config is type(config):
            return one.model(config)
    raise ValueError(
        f"no network is registered for {type(config).__name__}; call performers.networks.register"
    )


def _full_name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"
