"""Muon for the matrices of the blocks, Adam for the rest.

Who gets which, the step's form, and a resumed run.
"""

from dataclasses import replace
from pathlib import Path

import pytest
import torch
from torch import nn

from motiondiff_edu.cross_modal_attention import Block
from motiondiff_edu.modiff import MODIFF_SMALL, MoDiff
from motiondiff_edu.recipes.muon import Muon, MuonAndAdam
from motiondiff_edu.recipes.training import resume_run, saver
from motiondiff_edu.training import TrainState, train_steps

TINY = replace(MODIFF_SMALL, D=9, T_h=4, T_p=5, S=20, width=16, heads=2, hidden=24)


def block_loss(model, generator):
    x = torch.randn(6, 5, 16, generator=generator)
    return (model(x) - x.flip(1)).square().mean()


def test_every_parameter_has_one_optimizer_and_only_block_matrices_go_to_muon():
    model = MoDiff(TINY)
    muon, adam = (
        {id(p) for g in part.param_groups for p in g["params"]} for part in MuonAndAdam(model).parts
    )
    assert not muon & adam and muon | adam == {id(p) for p in model.parameters()}
    names = {name for name, p in model.named_parameters() if id(p) in muon}
    assert all("blocks" in name or "decoder" in name for name in names)
    assert (
        len(names) == (2 + 2 + 2) * 5 + 3 * 8
    )  # q, kv, out and two of the feed-forward; cross-attention has three more
    assert not any(
        "norm" in name or "bias" in name or "_in" in name or "head" in name for name in names
    )


def test_a_first_step_moves_every_direction_of_a_matrix_alike():
    """The closed form.

    U V^T of the gradient's singular value decomposition, times 0.2 sqrt(larger side) lr.
    """
    torch.manual_seed(0)
    layer = Block(16, 2, 24)
    optimizer, weight = MuonAndAdam(layer, lr=1e-2), layer.ff[0].weight
    block_loss(layer, torch.Generator().manual_seed(1)).backward()
    before = weight.detach().clone()
    u, _, vt = torch.linalg.svd(weight.grad.float(), full_matrices=False)
    optimizer.step()
    moved = before - weight.detach()
    expected = 1e-2 * 0.2 * 24**0.5 * (u @ vt)
    cosine = nn.functional.cosine_similarity(moved.flatten(), expected.flatten(), dim=0)
    assert (
        cosine > 0.95 and 0.7 < moved.norm() / expected.norm() < 1.2
    )  # the iteration is approximate


@pytest.mark.parametrize("shape", [(24, 16), (16, 24), (20, 20)])
def test_steps_are_those_of_torch(shape):
    """torch.optim.Muon rounds to bfloat16 on the way.

    Alike to a few per cent of a step, over several steps.
    """
    torch.manual_seed(1)
    ours, theirs = (nn.Parameter(torch.zeros(shape)) for _ in range(2))
    optimizers = (
        Muon([ours], lr=0.01),
        torch.optim.Muon([theirs], lr=0.01, weight_decay=0.0, adjust_lr_fn="match_rms_adamw"),
    )
    for k in range(6):
        gradient = torch.randn(shape) * 10.0 ** (k - 3)
        ours.grad, theirs.grad = gradient.clone(), gradient.clone()
        before = ours.detach().clone()
        for optimizer in optimizers:
            optimizer.step()
        assert (ours - theirs).norm() < 0.05 * (k + 1) * (ours - before).norm() > 0


def test_a_resumed_run_continues_bit_for_bit(tmp_path: Path):
    def start():
        torch.manual_seed(2)
        model = Block(16, 2, 24)
        return TrainState.start(model, 3, MuonAndAdam(model))

    def run(state, steps, save=None):
        return [r.loss for r in train_steps(state, block_loss, steps, save=save, progress=False)]

    whole = run(start(), 12)
    run(start(), 5, saver(tmp_path / "run"))
    state = resume_run(start(), tmp_path / "run")
    assert state.step == 5 and run(state, 12) == whole[5:]
    forgetful = resume_run(
        start(), tmp_path / "run"
    )  # without the moments it goes elsewhere: the test can fail
    forgetful.optimizer = MuonAndAdam(forgetful.model)
    assert run(forgetful, 12) != whole[5:]


def test_a_network_without_blocks_is_refused():
    with pytest.raises(ValueError, match='Sequential has no block.*write optimizer="adam"'):
        MuonAndAdam(nn.Sequential(nn.Linear(3, 4)))
