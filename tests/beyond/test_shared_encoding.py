"""One encoding for several noises: the same numbers, fewer windows encoded, no unlike copies."""

import pytest
import torch

from motiondiff_edu.beyond.shared_encoding import SharedEncoding, repeated
from motiondiff_edu.modiff import MoDiff, MoDiffConfig

CONFIG = MoDiffConfig(T_h=4, T_p=3, S=6, width=16, heads=2, hidden=24, cross_layers=1)


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
def test_copies_that_differ_are_refused(which):
    given = [part.clone() for part in inputs()]
    given[which][4] += 1
    with pytest.raises(ValueError, match="their copies differ.*no diffusion dropout"):
        SharedEncoding(MoDiff(CONFIG), 3)(*given)
