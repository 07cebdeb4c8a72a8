"""A walker samples with its own schedule in its own units.

`generate` leads in and out of metres.
"""

import inspect
from dataclasses import replace

import numpy as np
import pytest
import torch
from devices import devices_of

from data_synth.walking import walk
from motiondiff_edu import rollout
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.ddpm import ddim_steps, linear_schedule, sample_steps
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.motion.motion import Motion, MotionWarning
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.continuation import leg_size
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.prediction import to_eps
from motiondiff_edu.rollout import generate

S = 6
T_H = 4
T_P = 3


def tiny_walker(target: str = "eps") -> Walker:
    """Untrained, with scalers far from the identity, so that a forgotten one shows."""
    torch.manual_seed(1)
    model = MoDiff(MoDiffConfig(T_h=T_H, T_p=T_P, S=S, width=16, heads=2, hidden=24, target=target))
    pose = Scaler(torch.linspace(-2, 3, 63), torch.linspace(0.1, 0.6, 63))
    control = Scaler(torch.tensor([1.0, 0.1, -0.2]), torch.tensor([0.5, 0.2, 0.8]))
    return Walker(model.eval(), linear_schedule(S, 0.2, 0.95), pose, control, {"name": "tiny"})


def inputs(batch: int = 2, frames: int = 5) -> tuple[torch.Tensor, torch.Tensor]:
    random = torch.Generator().manual_seed(2)
    return torch.randn(batch, T_H, 63, generator=random), torch.randn(
        batch, T_H + frames, 3, generator=random
    )


@pytest.mark.parametrize("target", ["eps", "x0", "v"])
def test_a_window_is_algorithm_2_on_the_plain_network(target: str):
    walker = tiny_walker(target)
    past, control = inputs(frames=T_P)
    drawn = walker.window_sampler()(past, control, torch.Generator().manual_seed(3))
    random = torch.Generator().manual_seed(3)
    x_S = torch.randn(2, T_P, 63, generator=random)

    def denoise(x_s, s):
        return to_eps(walker.model(x_s, s, past, control), x_s, s, walker.schedule, target)

    *_, last = sample_steps(denoise, x_S, walker.schedule, generator=random)
    assert torch.allclose(drawn, last.x_s, rtol=1e-3, atol=1e-3)


def test_generate_standardises_and_comes_back_in_metres():
    walker, (past, control) = tiny_walker(), inputs(frames=1)
    new = generate(walker, past, control, seed=5)
    units = walker.pose_scaler.transform(past), walker.control_scaler.transform(control[:, :T_H])
    held = torch.cat([units[1], units[1][:, -1:].expand(-1, T_P, -1)], 1)
    window = walker.window_sampler()(units[0], held, torch.Generator().manual_seed(5))
    assert new.shape == (2, 1, 63)
    assert torch.allclose(new[:, 0], walker.pose_scaler.inverse(window[:, 0]), atol=1e-5)


def test_same_seed_same_walk_other_seed_another():
    walker, (past, control) = tiny_walker(), inputs()
    first = generate(walker, past, control, seed=5)
    assert torch.equal(first, generate(walker, past, control, seed=5))
    assert torch.equal(
        first, generate(walker, past, control, generator=torch.Generator().manual_seed(5))
    )
    assert (first - generate(walker, past, control, seed=6)).abs().mean() > 0.01


def test_without_a_batch_axis_the_result_has_none():
    walker, (past, control) = tiny_walker(), inputs(batch=1)
    assert torch.equal(
        generate(walker, past[0], control[0], seed=5), generate(walker, past, control, seed=5)[0]
    )


def test_a_batch_walks_like_its_members_given_their_noise():
    """With DDIM the only noise is the start, drawn for the whole batch at once."""
    walker, (past, control) = tiny_walker(), inputs(batch=3)
    denoise_apart = []
    whole = walker.window_sampler(steps=3)(
        past, control[:, : T_H + T_P], torch.Generator().manual_seed(7)
    )
    start = torch.randn(3, T_P, 63, generator=torch.Generator().manual_seed(7))
    for i in range(3):
        denoise = walker.denoiser(past[i : i + 1], control[i : i + 1, : T_H + T_P])
        *_, last = ddim_steps(denoise, start[i : i + 1], walker.schedule, steps=3)
        denoise_apart.append(last.x_s)
    assert torch.allclose(whole, torch.cat(denoise_apart), atol=1e-4)


def test_the_future_of_the_control_matters_only_with_look_ahead():
    walker, (past, control) = tiny_walker(), inputs(frames=2)
    other = control.clone()
    other[:, T_H + 1 :] += 1  # beyond the last step that is taken
    held = [generate(walker, past, c, seed=1, hold=True) for c in (control, other)]
    ahead = [generate(walker, past, c, seed=1, hold=False) for c in (control, other)]
    assert torch.equal(*held)
    assert not torch.allclose(*ahead, atol=1e-4)


def test_steps_and_keep_change_the_work_not_the_shape():
    walker, (past, control) = tiny_walker(), inputs(frames=5)
    for steps, keep in [(None, 1), (2, 1), (3, 2), (None, 3)]:
        assert generate(walker, past, control, steps=steps, keep=keep).shape == (2, 5, 63)


def test_errors_say_what_is_wrong():
    walker, (past, control) = tiny_walker(), inputs()
    with pytest.raises(ValueError, match=r"continues 4 past poses, not 3.*past\[\.\.\., -4:, :\]"):
        generate(walker, past[:, :3], control)
    with pytest.raises(ValueError, match=r"flatten positions \(T, 21, 3\)"):
        inspect.unwrap(generate)(
            walker, past[0].unflatten(-1, (21, 3)), control[0]
        )  # past the tests' own type checks
    with pytest.raises(ValueError, match=r"and \(B, T, 3\)"):
        generate(walker, past, control[..., :2])
    with pytest.raises(ValueError, match="4 rows and 4 of them belong to the past"):
        generate(walker, past, control[:, :T_H])
    for broken in (0, 1):
        holed = [past.clone(), control.clone()]
        holed[broken][1, 2, 0] = torch.nan
        with pytest.raises(ValueError, match="NaN or infinity"):
            generate(walker, *holed)
    with pytest.raises(ValueError, match="must be between 1 and 6"):
        generate(walker, past, control, steps=7)


def test_a_walker_moved_is_a_copy_that_walks_alike():
    walker, (past, control) = tiny_walker(), inputs()
    moved = walker.to("cpu")
    assert moved.model is not walker.model and moved.card == walker.card
    torch.testing.assert_close(generate(moved, past, control), generate(walker, past, control))


def test_columns_of_ones_own_reach_the_network_as_they_are(monkeypatch):
    """Speeds belong to the size of a figure, other columns do not; the first row is the past's."""
    config = MoDiffConfig(C=5, T_h=T_H, T_p=T_P, S=S, width=16, heads=2, hidden=24)
    past = walk(constant_control(1.0, seconds=1.0), seed=5)
    large = replace(Motion.of_clip(past), source="large")
    large = replace(large, positions=1.2 * large.positions, root=large.root * [1.2, 1.2, 1])
    control = np.column_stack([np.tile([1.2, 0.0, 0.0], (3, 1)), [[7, 1], [8, 2], [9, 3]]])
    units = Scaler.fit(torch.from_numpy(past.features())), Scaler.nothing(5)
    walker = Walker(MoDiff(config).eval(), linear_schedule(S, 0.2, 0.95), *units)
    seen = []
    monkeypatch.setattr(rollout, "check_range", lambda steer, *_: seen.append(steer[0]))
    with pytest.warns(MotionWarning, match="would jump"):  # an untrained network
        walker.walk(large, control, progress=False)
    assert seen[0].shape == (T_H + 3, 5)
    torch.testing.assert_close(
        seen[0][:, 3:].T, torch.tensor([[7.0] * 5 + [8, 9], [1.0] * 5 + [2, 3]])
    )
    assert (seen[0][-3:, 0] - 1.2 / leg_size(large.positions)).abs().max() < 1e-6


def test_a_network_with_dropout_samples_without_it_and_stays_in_training():
    walker, (past, control) = tiny_walker(), inputs(frames=T_P)
    drop = walker.model.decoder[0].drop
    drop.p = 0.5
    x_s, s = torch.randn(2, T_P, 63), torch.full((2,), 3)
    wanted = walker.denoiser(past, control)(x_s, s)
    walker.model.train()
    assert not torch.allclose(walker.model(x_s, s, past, control), wanted, atol=1e-3)
    torch.testing.assert_close(walker.denoiser(past, control)(x_s, s), wanted)
    assert walker.model.training and drop.training


def places(walker: Walker) -> set[str]:
    """The devices of all that a performer needs."""
    return devices_of(walker.model, walker.pose_scaler, walker.control_scaler)


def test_all_of_a_walker_is_moved_and_the_first_one_stays():
    walker = tiny_walker()
    assert places(walker.to("meta")) == {"meta"}
    assert places(walker) == {"cpu"}
