"""Which networks a walker or a dancer may have.

One call of `register`, and a network of one's own is built, saved and loaded like ours.

    register("walker", MyNetwork, MyConfig)
    save(Walker(MyNetwork(MyConfig()), schedule, poses, control), "mine.safetensors")
    load("mine.safetensors")        # in a program that has registered it, too
Notebook: 07
"""

from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from typing import Protocol, runtime_checkable

from torch import nn

# what a configuration must name, so that samplers and scalers fit it
NEEDED = {"walker": ("D", "C", "S", "T_h", "T_p", "target"), "dancer": ("D", "C", "S", "target")}


@runtime_checkable
class Config(Protocol):
    """Numbers in a pose and in a row of the condition, diffusion steps, and what is predicted."""

    D: int
    C: int
    S: int
    target: str


@dataclass(frozen=True)
class Network:
    """A kind of network: its class, its configuration, how it is built, and its fast twin."""

    performer: str
    model: type[nn.Module]
    config: type
    build: Callable[..., nn.Module]
    fast: Callable[[nn.Module], object] | None


_NETWORKS: dict[str, Network] = {}


def register(
    performer: str,
    model: type[nn.Module],
    config: type,
    *,
    build: Callable[..., nn.Module] | None = None,
    fast: Callable[[nn.Module], object] | None = None,
) -> None:
    """Let a "walker" or a "dancer" have this network; files name it by its class.

    `config` is a frozen dataclass with a default for every field, `target` among them; the network
    keeps it as `.config`. A walker's network is called (x_s, s, past, control), a dancer's (x_s, s,
    music) with a method `listen(mel, times)`; both return the target.
    `build(config, *scalers)` makes a fresh network, by default `model(config)`; the scalers are
    those of poses and control, or of motion and Mel.
    `fast(network)` makes its fast twin, with the methods of `fast.modiff.FastMoDiff` or of
    `fast.mofusion.FastMoFusion`; without one the network itself is used.
    Raises ValueError for an unknown performer, a name that another class has, and a configuration
    that lacks something.
    """
    if performer not in NEEDED:
        raise ValueError(f'a network is for a "walker" or a "dancer", not for {performer!r}')
    names = {field.name for field in fields(config)}
    missing = [name for name in NEEDED[performer] if name not in names]
    bare = [f.name for f in fields(config) if f.default is MISSING]
    if missing or bare:
        what = f"lacks {', '.join(missing)}" if missing else f"has no default for {', '.join(bare)}"
        raise ValueError(f"{config.__name__} {what}: a {performer}'s network cannot do without")
    taken = _NETWORKS.get(model.__name__)
    if taken and _full_name(taken.model) != _full_name(model):
        other = _full_name(taken.model)
        raise ValueError(f"{model.__name__} is the name of {other}: call yours something else")
    make = build or (lambda config, *scalers: model(config))
    _NETWORKS[model.__name__] = Network(performer, model, config, make, fast)


def networks_of(performer: str) -> dict[str, Network]:
    """The networks that a "walker" or a "dancer" may have, by the names of their classes."""
    return {name: one for name, one in _NETWORKS.items() if one.performer == performer}


def kind_of(model: nn.Module) -> Network | None:
    """What a network was registered as; None where it was not."""
    found = _NETWORKS.get(type(model).__name__)
    return found if found and _full_name(found.model) == _full_name(type(model)) else None


def network(config: Config, *scalers) -> nn.Module:
    """A fresh network of the kind that a configuration is for.

    Raises ValueError for a configuration of which no network is registered.
    """
    for one in _NETWORKS.values():
        if one.config is type(config):
            return one.build(config, *scalers)
    raise ValueError(f"no network is registered for a {type(config).__name__}: see register")


def _full_name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"
