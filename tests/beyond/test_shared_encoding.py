"""One encoding for several noises: the same numbers, fewer windows encoded."""

import pytest
import torch

from motiondiff_edu.beyond.footholds import CleanFootholds, FootholdConfig, FootholdMoDiff
from motiondiff_edu.beyond.shared_encoding import SharedEncoding, repeated
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.diffusion_dropout import Dropout
from motiondiff_edu.modiff import MoDiff, MoDiffConfig, training_loss
from motiondiff_edu.motion.scaler import Scaler

SIZES = dict(T_h=4, T_p=3, S=6, width=16, heads=2, hidden=24, cross_layers=1)
CONFIG = MoDiffConfig(**SIZES)


def inputs() -> tuple:
    draw = torch.Generator().manual_seed(0)
    past, control = torch.randn(2, 4, 63, generator=draw), torch.randn(2, 7, 3, generator=draw)
    return torch.randn(6, 3, 63, generator=draw), torch.arange(1, 7), *repeated((past, control), 3)


def test_the_answer_is_that_of_the_plain_call_and_each_window_is_encoded_once():
    torch.manual_seed(0)
    model, given = MoDiff(CONFIG), inputs()
    seen = []
    wanted, encode = model(*given), model.encode
    model.encode = lambda past, control: seen.append(past) or encode(past, control)
    torch.testing.assert_close(SharedEncoding(model, 3)(*given), wanted)
    assert len(seen) == 1 and torch.equal(seen[0], given[2][::3])
    assert SharedEncoding(model, 3).config is CONFIG


def test_copies_lie_side_by_side():
    (out,) = repeated((torch.tensor([1.0, 2.0]),), 3)
    assert out.tolist() == [1, 1, 1, 2, 2, 2]


@pytest.mark.parametrize("which", [2, 3])
def test_copies_that_differ_are_encoded_too(which):
    torch.manual_seed(0)
    model, given = MoDiff(CONFIG), [part.clone() for part in inputs()]
    given[which][[0, 4]] += 1  # the first copy of a window, and the second of another
    seen = []
    wanted, encode = model(*given), model.encode
    model.encode = lambda past, control: seen.append(past) or encode(past, control)
    torch.testing.assert_close(SharedEncoding(model, 3)(*given), wanted)
    assert len(seen[0]) == 2 + 2 + 1


def test_diffusion_dropout_and_a_shared_encoding_give_the_plain_loss():
    torch.manual_seed(0)
    scalers = [Scaler(torch.zeros(n), torch.ones(n)) for n in (63, 3)]
    model = FootholdMoDiff(FootholdConfig(**SIZES), *scalers)
    schedule = cosine_schedule(CONFIG.S)
    _, _, past, control = inputs()
    x0 = torch.randn(6, 3, 63, generator=torch.Generator().manual_seed(1))

    def loss_of(share):
        dropout = Dropout(schedule, lambda done: 0.5, 1, done=0.0)
        network = CleanFootholds(share(model), past, past, 0.05)
        draw = torch.Generator().manual_seed(3)
        return training_loss(network, (past, x0, control), schedule, draw, dropout=dropout)

    plain, shared = loss_of(lambda model: model), loss_of(lambda model: SharedEncoding(model, 3))
    torch.testing.assert_close(shared, plain)
