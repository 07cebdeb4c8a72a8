"""Trainings on a GPU: a loss moves all of its batch to the network's device, and stays there.

The meta device stands in for a GPU. It has no values, but it refuses to mix its tensors with those
of the CPU, as a GPU does. Walkers and judges look at values, so they are not tried.
"""

from dataclasses import replace

import pytest
import torch
from torch import Tensor, nn

from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.performers.networks import network
from motiondiff_edu.recipes import dancer, inbetweener, mover
from motiondiff_edu.recipes.dancer import DANCER, REGRESSED, UNCONDITIONAL
from motiondiff_edu.recipes.mover import MOVER
from motiondiff_edu.training import LossFn

CLIPS = 12
DANCES = {
    "dancer": replace(DANCER, songs=1, seconds=8.0, batch=2),
    "regression": replace(REGRESSED, songs=1, seconds=8.0, batch=2),
    "unconditional": replace(UNCONDITIONAL, songs=2, seconds=8.0, batch=2),
}


@pytest.fixture
def answers(monkeypatch):
    """Every frame counts."""
    asked = Tensor.all

    def every(x: Tensor, *dims: int) -> Tensor:
        return torch.tensor(True) if x.is_meta and not dims else asked(x, *dims)

    monkeypatch.setattr(Tensor, "all", every)


def of_dancer(name: str) -> tuple[nn.Module, LossFn]:
    recipe = DANCES[name]
    windows = dancer.training_windows(recipe)
    loss_fn = dancer.loss_of(recipe, windows, cosine_schedule(recipe.config.S))
    return network(recipe.config), loss_fn


def of_mover(name: str) -> tuple[nn.Module, LossFn]:
    windows = mover.training_clips(CLIPS, 1)
    recipe = replace(MOVER, config=replace(MOVER.config, words=windows.words), frames=400)
    schedule = cosine_schedule(recipe.config.S)
    model = network(recipe.config)
    if name == "planner":
        return model.planner, mover.plan_loss_of(recipe, windows, schedule)
    return model, mover.loss_of(recipe, windows, schedule)


def of_inbetweener(name: str) -> tuple[nn.Module, LossFn]:
    few = {"motions": 2, "acts": 2, "recordings": 0, "seconds": 8.0, "batch": 3}
    recipe = replace(inbetweener.INBETWEENER, **few)
    windows, schedule = inbetweener.training_windows(recipe), cosine_schedule(recipe.config.S)
    return network(recipe.config), inbetweener.loss_of(recipe, windows, schedule)


MADE = dict.fromkeys(DANCES, of_dancer) | {"mover": of_mover, "planner": of_mover}
MADE |= {"inbetweener": of_inbetweener}


@pytest.mark.parametrize("name", MADE)
def test_a_loss_and_its_gradients_are_on_the_networks_device(answers, name):
    model, loss_fn = MADE[name](name)
    model = model.to("meta")
    loss = loss_fn(model, torch.Generator().manual_seed(0))
    loss.backward()
    assert loss.is_meta and loss.shape == ()
    learnt = [p for p in model.parameters() if p.requires_grad]
    assert learnt and all(p.grad is None or p.grad.is_meta for p in learnt)


def test_the_stand_in_refuses_what_a_gpu_refuses():
    here, there = torch.ones(2, 3), torch.ones(2, 3, device="meta")
    with pytest.raises(RuntimeError):
        here + there
