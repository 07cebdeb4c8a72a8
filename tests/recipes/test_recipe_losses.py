"""A walker's loss is Algorithm 1. A dancer's is MoFusion's eq. 4, plus the departures it names:
term by term the numbers that the shipped dancers were trained with."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from motiondiff_edu.beyond.past_noise import past_noise
from motiondiff_edu.ddpm import cosine_schedule, linear_schedule
from motiondiff_edu.diffusion_dropout import Dropout
from motiondiff_edu.kinematic_loss import OVER_TIME
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.mofusion import MOFUSION_SMALL, MoFusion
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.performers.dance_windows import DanceWindows
from motiondiff_edu.performers.windows import Windows, typical_change
from motiondiff_edu.recipes import dancer, walker
from motiondiff_edu.recipes.dancer import DANCER, DANCER_PLAIN
from motiondiff_edu.recipes.walker import WALKER_TRUNK, WalkerRecipe

T_H, T_P = 4, 3
SIZES = dict(
    T_h=T_H, T_p=T_P, S=100, width=16, heads=2, hidden=24,
    motion_layers=1, control_layers=1, cross_layers=1, decoder_layers=1,
)  # fmt: skip


@pytest.fixture(scope="module")
def walks() -> Windows:
    rng = np.random.default_rng(0)
    poses = rng.normal(size=(90, 21, 3)).cumsum(0) * np.linspace(0.1, 1, 63).reshape(21, 3)
    return Windows.of([Clip(poses, rng.normal(size=(90, 3)), source="drift")], T_H, T_P)


def seeded(seed: int = 8) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def dances(music: bool = True) -> DanceWindows:
    rng, parts = np.random.default_rng(0), []
    for frames in (90, 74):
        drift = 0.02 * rng.normal(size=(frames, 21, 3)).cumsum(0) + rng.normal(size=(1, 21, 3))
        stands = rng.random((frames, 2)) < 0.5
        parts.append((drift, stands, torch.from_numpy(rng.normal(size=(2 * frames, 5))).float()))
    positions, contacts, mels = (list(part) for part in zip(*parts, strict=True))
    return DanceWindows.of(positions, contacts, mels if music else None, 40)


X0 = replace(MOFUSION_SMALL, target="x0", skip=False)
SMALL = dict(C=5, S=50, widths=(16, 24), heads=2, music_layers=1)
WITHOUT_EAR = {"config": replace(X0, **SMALL), "ear": None, "no_music": 0.0}
PLAIN = replace(
    DANCER,
    **WITHOUT_EAR | {"config": replace(X0, **SMALL | {"target": "eps", "skip": True})},
    kinematic=None, changes=0.0, toes=0.0, batch=5,
)  # fmt: skip
DANCED_WITH = {
    "dancer": (
        replace(DANCER, **WITHOUT_EAR),
        [10.614416122436523, 10.859406471252441, 12.676359176635742],
        0.5583015084266663,
    ),
    "dancer-plain": (
        replace(DANCER_PLAIN, **WITHOUT_EAR),
        [10.470932006835938, 10.653160095214844, 12.557601928710938],
        0.5583015084266663,
    ),
    "unconditional": (
        replace(DANCER, **WITHOUT_EAR | {"config": replace(X0, **SMALL | {"C": 0})}),
        [6.9156270027160645, 7.592430591583252, 8.509102821350098],
        0.5583015084266663,
    ),
}


@pytest.mark.parametrize("name", DANCED_WITH)
def test_dancers_losses_are_those_that_the_shipped_ones_were_trained_with(name):
    recipe, losses, after = DANCED_WITH[name]
    schedule = cosine_schedule(recipe.config.S)
    torch.manual_seed(0)
    model = MoFusion(recipe.config)
    torch.nn.init.normal_(model.out.weight, std=0.1)
    windows = dances(music=recipe.config.C > 0)
    loss_fn, generator = (dancer.loss_of(replace(recipe, batch=6), windows, schedule), seeded())
    assert [loss_fn(model, generator).item() for _ in range(3)] == pytest.approx(losses, rel=2e-5)
    assert torch.rand(1, generator=generator).item() == after


@pytest.mark.parametrize("rate", [None, 0.6])
@pytest.mark.parametrize("held, noise", [(0.0, 0.0), (0.5, 0.3)])
def test_a_walkers_loss_is_algorithm_1(walks, rate, held, noise):
    """s ~ Uniform(1..S); with probability P_d the past is noised to step s; eps ~ N(0, I); the mean
    of the squared error of eps. Written out with the same draws, in the same order, after some of
    the windows have held their control, and pasts got their noise."""
    schedule = linear_schedule(6, 0.2, 0.95)
    torch.manual_seed(0)
    model = MoDiff(MoDiffConfig(**SIZES | {"S": 6}))
    recipe = WalkerRecipe(
        "short", model.config, steps=1, batch=7, held_control=held, past_noise=noise
    )
    dropout = Dropout(schedule, lambda done: rate, 1, done=0.0) if rate else None
    loss = walker.loss_of(recipe, walks, schedule, dropout)(model, seeded())

    generator = seeded()
    start = walks.starts[torch.randint(len(walks.starts), (7,), generator=generator)]
    holds = torch.rand(7, generator=generator) < held
    rows = start[:, None] + torch.arange(T_H + T_P)
    c = walks.control[torch.where(holds[:, None], rows.clamp(max=start[:, None] + T_H - 1), rows)]
    past, y = walks.poses[rows[:, :T_H]], walks.poses[rows[:, T_H:]]
    past = past_noise(past, noise, typical_change(walks), generator)
    s = torch.randint(1, 7, (7,), generator=generator)
    alpha_bar = torch.cumprod(1 - torch.linspace(0.2, 0.95, 6), 0)[s - 1][:, None, None]
    if rate:
        hit = torch.rand(7, generator=generator) < rate
        noised = torch.randn(7, T_H, 63, generator=generator)
        noised = alpha_bar**0.5 * past + (1 - alpha_bar) ** 0.5 * noised
        past = torch.where(hit[:, None, None], noised, past)
        assert 0 < hit.sum() < 7
    eps = torch.randn(7, T_P, 63, generator=generator)
    y_s = alpha_bar**0.5 * y + (1 - alpha_bar) ** 0.5 * eps
    squares = (eps - model(y_s, s, past, c)).square()
    assert loss.item() == pytest.approx(squares.mean().item(), rel=1e-5)
    assert 0 < holds.sum() < 7 or not held


def test_without_departures_a_dancer_s_loss_is_the_mean_square_of_eps():
    recipe, windows = PLAIN, dances()
    schedule = cosine_schedule(recipe.config.S)
    generator = seeded()
    torch.manual_seed(0)
    model = MoFusion(recipe.config)
    loss = dancer.loss_of(recipe, windows, schedule)(model, seeded())
    x0, mel, _ = windows.draw(5, generator)
    s = torch.randint(1, 51, (5,), generator=generator)
    eps = torch.randn(x0.shape, generator=generator)
    alpha_bar = schedule.alpha_bar[s].float()[:, None, None]
    x_s = alpha_bar**0.5 * x0 + (1 - alpha_bar) ** 0.5 * eps
    by_hand = (eps - model(x_s, s, model.listen(mel, windows.mel_times))).square().mean()
    assert loss.item() == pytest.approx(by_hand.item(), rel=1e-5)


def test_kinematic_losses_have_the_recipes_weight_over_time():
    windows, found = dances(), {}
    for name in OVER_TIME:
        recipe = replace(DANCED_WITH["dancer"][0], batch=6)
        recipe = replace(recipe, kinematic=replace(recipe.kinematic, over_time=name))
        torch.manual_seed(0)
        model = MoFusion(recipe.config)
        loss_fn = dancer.loss_of(recipe, windows, cosine_schedule(recipe.config.S))
        found[name] = loss_fn(model, seeded()).item()
    assert found["none"] < found["alpha_bar"] < found["constant"] and len(set(found.values())) == 4
    wrong = replace(recipe, kinematic=replace(recipe.kinematic, over_time="always"))
    with pytest.raises(ValueError, match="over_time must be one of none, constant"):
        dancer.loss_of(wrong, windows, cosine_schedule(wrong.config.S))


def test_a_plain_loss_needs_no_toe_that_moves():
    still = [np.ones((60, 21, 3)) * np.linspace(0, 1, 21)[:, None]] * 2
    mels = [torch.zeros(120, 5)] * 2
    windows = DanceWindows.of(still, [np.ones((60, 2), bool)] * 2, mels, 40)
    torch.manual_seed(0)
    loss_fn = dancer.loss_of(PLAIN, windows, cosine_schedule(PLAIN.config.S))
    assert loss_fn(MoFusion(PLAIN.config), seeded()).isfinite()


def test_a_batch_needs_a_window():
    with pytest.raises(ValueError, match="a window at least"):
        replace(WALKER_TRUNK, batch=0)
