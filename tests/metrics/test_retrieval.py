"""R-Precision and MM-Dist against hand, chance and limits; a space that is learnt by contrast."""

import numpy as np
import pytest
import torch

from motiondiff_edu.metrics.distributions import Space, contrast, mm_dist, pools, r_precision

RNG = np.random.default_rng(0)


def test_each_text_beside_its_motion_is_always_first():
    texts = RNG.standard_normal((100, 7))
    found = r_precision(texts, texts + 1e-6, range(100), np.random.default_rng(1))
    assert found.tolist() == [1, 1, 1]


def test_random_motions_get_the_chance_level():
    texts, motions = RNG.standard_normal((2, 3200, 5))
    found = r_precision(texts, motions, range(3200), np.random.default_rng(1))
    np.testing.assert_allclose(found, np.arange(1, 4) / 32, atol=0.012)


def test_a_network_that_always_makes_one_motion_gets_the_chance_level():
    texts = np.random.default_rng(0).normal(size=(64, 4))
    same = r_precision(texts, np.ones((64, 4)), list(range(64)), np.random.default_rng(1))
    np.testing.assert_allclose(same, np.arange(1, 4) / 32)
    twins = np.repeat(np.eye(32), 2, axis=0)[:32]  # each motion is made for two texts
    found = r_precision(twins, twins, list(range(32)), np.random.default_rng(1))
    np.testing.assert_allclose(found, [0.5, 1, 1])


@pytest.mark.parametrize("which", ["texts", "motions"])
def test_a_broken_motion_is_no_near_one(which):
    points = {"texts": np.eye(32), "motions": np.eye(32)}
    points[which][3, 1] = np.nan
    with pytest.raises(ValueError, match=rf"{which}\[3\] is not finite"):
        r_precision(**points, truths=range(32), rng=np.random.default_rng(0))
    with pytest.raises(ValueError, match="not finite"):
        mm_dist(**points)


def test_ranks_by_hand():
    """Four texts on a line; the second motion lies beyond the third."""
    texts = np.array([[0.0], [1.0], [2.0], [3.0]])
    motions = np.array([[0.1], [2.6], [2.2], [3.1]])
    # text 1: motions at distance .9, 1.6, 1.2, 2.1: its own is third
    found = r_precision(texts, motions, range(4), np.random.default_rng(0), pool=4)
    np.testing.assert_allclose(found, [0.75, 0.75, 1.0])
    assert mm_dist(texts, motions) == pytest.approx((0.1 + 1.6 + 0.2 + 0.1) / 4)


def test_a_pool_has_no_two_equal_truths_and_no_motion_twice():
    truths = [k % 40 for k in range(300)]
    found = pools(truths, np.random.default_rng(2), 32)
    assert len(found) >= 6 and len({k for group in found for k in group}) == 32 * len(found)
    assert all(len({truths[k] for k in group}) == 32 for group in found)
    with pytest.raises(ValueError, match="32 texts that say different things; these say 10"):
        pools(truths[:10] * 9, np.random.default_rng(2), 32)


def toy(n: int, generator: torch.Generator) -> tuple[torch.Tensor, torch.Tensor]:
    """Motions whose first column swings as often as their text says, from a random phase."""
    kind = torch.randint(4, (n,), generator=generator)
    phase = torch.rand(n, 1, generator=generator)
    t = torch.arange(40) / 40
    wave = torch.sin(2 * torch.pi * ((kind[:, None] + 1) * t + phase))
    noise = 0.1 * torch.randn(n, 40, 3, generator=generator)
    return torch.cat([wave[..., None], noise[..., 1:]], -1) + noise, 1 + kind[:, None]


def test_a_space_is_learnt_by_contrast():
    torch.manual_seed(0)
    space, generator = Space(3, 6, 16), torch.Generator().manual_seed(1)
    optimizer = torch.optim.Adam(space.parameters(), 5e-3)
    for _ in range(150):
        motions, ids = toy(32, generator)
        same = (ids == ids.mT).float()
        optimizer.zero_grad()
        contrast(space, motions, ids, same).backward()
        optimizer.step()
    motions, ids = toy(200, generator)
    with torch.no_grad():
        texts, points = space.text_points(ids), space.motion_points(motions)
        choices = space.text_points(torch.arange(1, 5)[:, None])
    assert torch.allclose(points.norm(dim=-1), torch.ones(200), atol=1e-5)
    chosen = (points[:, None] - choices).norm(dim=-1).argmin(1)
    assert (chosen + 1 == ids[:, 0]).float().mean() > 0.9
    assert (texts - points).norm(dim=-1).mean() < 0.8


def test_texts_that_say_the_same_are_not_held_against_each_other():
    torch.manual_seed(0)
    space = Space(3, 6, 8)
    motions, ids = toy(2, torch.Generator().manual_seed(3))
    ids[:] = 2
    alone = contrast(space, motions, ids, torch.ones(2, 2))
    assert alone.item() == pytest.approx(0.0, abs=1e-6) and contrast(space, motions, ids) > 0.1


def test_padding_of_a_text_changes_nothing():
    torch.manual_seed(0)
    space = Space(3, 9, 8).eval()
    ids = torch.tensor([[2, 5, 3]])
    padded = torch.nn.functional.pad(ids, (0, 2))
    torch.testing.assert_close(space.text_points(ids), space.text_points(padded))


def unchecked(function):
    """As in a notebook, where no shape is checked."""
    return getattr(function, "__wrapped__", function)


def test_a_text_without_a_motion_or_a_truth_is_told():
    texts, rng = np.eye(40), np.random.default_rng(0)
    few = texts[:1]
    with pytest.raises(ValueError, match="40 texts, but 32 truths"):
        r_precision(texts, texts, range(32), rng)
    with pytest.raises(ValueError, match="give a motion for each text"):
        unchecked(r_precision)(texts, few, range(40), rng)
    with pytest.raises(ValueError, match="give a motion for each text"):
        unchecked(mm_dist)(texts, few)


def test_a_pool_of_nothing_is_refused():
    with pytest.raises(ValueError, match="at least one motion, not 0"):
        pools(range(40), np.random.default_rng(0), 0)
