"""The targets that a network can predict: the noise eps, the clean sample x0, or v.

Each can be converted into the others. With a = sqrt(alpha_bar_s) and b = sqrt(1 - alpha_bar_s),
x_s = a x0 + b eps and v = a eps - b x0. So (x_s, v) is (x0, eps) rotated by an angle, and every
conversion is a line of algebra.
"""

import torch
from jaxtyping import Float
from torch import Tensor

from .ddpm import Schedule, Steps

TARGETS = ("eps", "x0", "v")


def _ab(x: Tensor, s: Steps, schedule: Schedule, first: int = 0) -> tuple:
    """a and b of the step s.  Raises IndexError for a step below `first`, or above S."""
    now = schedule.at(s, x, first)
    return now.signal, now.noise


def x0_from_eps(
    x_s: Float[Tensor, "B *shape"], s: Steps, eps: Float[Tensor, "B *shape"], schedule: Schedule
) -> Float[Tensor, "B *shape"]:
    """x0 = x_s / a - (b / a) eps. Source: MoFusion eq. 5."""
    a, b = _ab(x_s, s, schedule)
    return (x_s - b * eps) / a


def eps_from_x0(
    x_s: Float[Tensor, "B *shape"], s: Steps, x0: Float[Tensor, "B *shape"], schedule: Schedule
) -> Float[Tensor, "B *shape"]:
    """eps = (x_s - a x0) / b. Source: MoFusion eq. 5, solved for eps. Notebook: 05

    Raises IndexError for step 0: clean data have no noise that could be found.
    """
    a, b = _ab(x_s, s, schedule, first=1)
    return (x_s - a * x0) / b


def v_from_x0_eps(
    x0: Float[Tensor, "B *shape"], s: Steps, eps: Float[Tensor, "B *shape"], schedule: Schedule
) -> Float[Tensor, "B *shape"]:
    """v = a eps - b x0."""
    a, b = _ab(x0, s, schedule)
    return a * eps - b * x0


def eps_from_v(
    x_s: Float[Tensor, "B *shape"], s: Steps, v: Float[Tensor, "B *shape"], schedule: Schedule
) -> Float[Tensor, "B *shape"]:
    """eps = a v + b x_s."""
    a, b = _ab(x_s, s, schedule)
    return a * v + b * x_s


def x0_from_v(
    x_s: Float[Tensor, "B *shape"], s: Steps, v: Float[Tensor, "B *shape"], schedule: Schedule
) -> Float[Tensor, "B *shape"]:
    """x0 = a x_s - b v."""
    a, b = _ab(x_s, s, schedule)
    return a * x_s - b * v


def to_eps(
    output: Float[Tensor, "B *shape"],
    x_s: Float[Tensor, "B *shape"],
    s: Steps,
    schedule: Schedule,
    target: str,
) -> Float[Tensor, "B *shape"]:
    """Convert a network's output to eps_hat; `target` is what it was trained to predict.

    Raises IndexError for step 0 if that is x0 (`eps_from_x0`), ValueError for an unknown target.
    """
    _check(target)
    if target == "eps":
        return output
    return (eps_from_x0 if target == "x0" else eps_from_v)(x_s, s, output, schedule)


def to_x0(
    output: Float[Tensor, "B *shape"],
    x_s: Float[Tensor, "B *shape"],
    s: Steps,
    schedule: Schedule,
    target: str,
) -> Float[Tensor, "B *shape"]:
    """Convert a network's output to x0_hat; `target` is what it was trained to predict.

    Notebook: 05.
    """
    _check(target)
    if target == "x0":
        return output
    return (x0_from_eps if target == "eps" else x0_from_v)(x_s, s, output, schedule)


def target_of(
    x0: Float[Tensor, "B *shape"],
    eps: Float[Tensor, "B *shape"],
    s: Steps,
    schedule: Schedule,
    target: str,
) -> Float[Tensor, "B *shape"]:
    """The right output of a network with this target: eps, x0 or v. Notebook: 05."""
    _check(target)
    return {"eps": eps, "x0": x0}[target] if target != "v" else v_from_x0_eps(x0, s, eps, schedule)


def denoiser_of(network, schedule: Schedule, target: str):
    """Wrap a network that predicts `target` as a denoiser, which always returns eps_hat.

    The denoiser raises ValueError if x_s needs a gradient and the network's output has none; the
    conversion alone would give a wrong one.
    Notebook: 05.
    """
    _check(target)

    def denoise(x_s, s):
        output = network(x_s, s)
        if torch.is_grad_enabled() and x_s.requires_grad and not output.requires_grad:
            raise ValueError(
                "no gradient here: call the network outside torch.no_grad() and "
                "torch.inference_mode()"
            )
        return output if target == "eps" else to_eps(output, x_s, s, schedule, target)

    return denoise


def _check(target: str) -> None:
    if target not in TARGETS:
        raise ValueError(f"target must be one of {', '.join(TARGETS)}, not {target!r}")
