"""A fast twin follows its network: trained on, loaded anew, or watched."""

import pytest
import torch

from motiondiff_edu.cross_modal_attention import watch
from motiondiff_edu.ddpm import cosine_schedule, linear_schedule
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.mofusion import MoFusion, MoFusionConfig
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.training import TrainState, train_steps

T_H, T_P = 4, 3
B = 2


def walker() -> Walker:
    torch.manual_seed(1)
    model = MoDiff(MoDiffConfig(T_h=T_H, T_p=T_P, S=6, width=16, heads=2, hidden=24))
    pose, control = (Scaler(torch.zeros(n), torch.ones(n)) for n in (63, 3))
    return Walker(model.eval(), linear_schedule(6, 0.2, 0.95), pose, control)


def dancer() -> Dancer:
    torch.manual_seed(0)
    config = MoFusionConfig(C=5, S=12, widths=(16, 24), heads=2, music_layers=1, target="x0")
    model = MoFusion(config)
    for weight in model.parameters():
        weight.data.add_(0.1 * torch.randn(weight.shape))
    motion, mel = (Scaler(torch.zeros(n), torch.ones(n)) for n in (63, 5))
    return Dancer(model.eval(), cosine_schedule(12), motion, mel)


def ask(who, fast: bool) -> torch.Tensor:
    """What a performer's network says of the same noise."""
    draw = torch.Generator().manual_seed(4)
    if isinstance(who, Walker):
        past, control = (torch.randn(B, n, d, generator=draw) for n, d in ((T_H, 63), (7, 3)))
        denoise, frames = who.denoiser(past, control, fast), T_P
    else:
        denoise = who.denoiser(torch.randn(B, 40, 5, generator=draw), 20, fast=fast)
        frames = 20
    x_s, s = torch.randn(B, frames, 63, generator=draw), torch.tensor([3, 5])
    with torch.no_grad():
        return denoise(x_s, s)


def train_a_step(model) -> None:
    optimizer = torch.optim.Adam(model.parameters(), lr=0.05)
    sum(weight.square().sum() for weight in model.parameters()).backward()
    optimizer.step()


def train_as_the_recipes_do(model) -> None:
    """One step of `train_steps`; its optimizer is fused."""

    def loss_fn(network, generator):
        return sum(weight.square().sum() for weight in network.parameters())

    next(train_steps(TrainState.start(model), loss_fn, 1, lr=0.05, progress=False))


def load_others(model) -> None:
    other = {name: 1.2 * value + 0.01 for name, value in model.state_dict().items()}
    model.load_state_dict(other)


def give_another_tensor(model) -> None:
    name, weight = next((n, w) for n, w in model.named_parameters() if n.endswith("out.weight"))
    model.get_submodule(name.rpartition(".")[0]).weight = torch.nn.Parameter(
        3 * weight.detach().flip(0)
    )


@pytest.mark.parametrize("make", [walker, dancer])
@pytest.mark.parametrize(
    "change", [train_a_step, train_as_the_recipes_do, load_others, give_another_tensor]
)
def test_a_twin_has_the_weights_of_now(make, change):
    who = make()
    before = ask(who, fast=True)
    twin = who.fast
    torch.testing.assert_close(before, ask(who, fast=False), atol=1e-4, rtol=1e-4)
    assert who.fast is twin  # nothing has changed: it is not built again
    change(who.model)
    after = ask(who, fast=True)
    torch.testing.assert_close(after, ask(who, fast=False), atol=1e-4, rtol=1e-4)
    assert (after - before).abs().max() > 1e-2 and who.fast is not twin


@pytest.mark.parametrize("make", [walker, dancer])
def test_a_watched_network_is_asked_itself(make):
    who = make()
    unseen = ask(who, fast=True)
    with watch(who.model) as maps:
        seen = ask(who, fast=True)
    assert all(maps.values()) and {len(m[0]) for m in maps.values()} <= {B, 1}
    torch.testing.assert_close(seen, unseen, atol=1e-4, rtol=1e-4)
    ask(who, fast=True)
    assert len(next(iter(maps.values()))) == 1  # outside of the block nothing is collected


def test_a_network_made_for_inference_has_a_twin():
    with torch.inference_mode():
        who = walker()
        fast = ask(who, fast=True)
        torch.testing.assert_close(fast, ask(who, fast=False), atol=1e-4, rtol=1e-4)
