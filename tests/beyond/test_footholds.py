"""Footholds: held joints rest in the world, and the gate chooses.

The weights file keeps both.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from motiondiff_edu.beyond.footholds import (
    COLUMNS,
    FEET,
    CleanFootholds,
    FootholdConfig,
    FootholdMoDiff,
    blend,
    held_positions,
    openness,
)
from motiondiff_edu.beyond.shared_encoding import SharedEncoding, repeated
from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.diffusion_dropout import Dropout
from motiondiff_edu.modiff import MoDiff, MoDiffConfig, training_loss
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.motion.skeleton import JOINTS
from motiondiff_edu.performers.networks import network
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.performers.windows import Windows
from motiondiff_edu.pretrained.checkpoints import load_walker, save

T_H = 4
T_P = 5
B = 3
SIZES = dict(T_h=T_H, T_p=T_P, S=8, width=16, heads=2, hidden=24)
TINY = FootholdConfig(**SIZES)
FREE = MoDiffConfig(**SIZES, target="x0", skip=False)
POSE = Scaler(torch.linspace(-2, 3, 63), torch.linspace(0.1, 0.6, 63))
CONTROL = Scaler(torch.tensor([1.0, 0.1, -0.2]), torch.tensor([0.5, 0.2, 0.8]))


def tiny(gate: float | None = None, seed: int = 0) -> FootholdMoDiff:
    """A network that answers at random; with `gate`, one whose gate gives this logit everywhere."""
    torch.manual_seed(seed)
    model = FootholdMoDiff(TINY, POSE, CONTROL).eval()
    with torch.no_grad():
        model.gate.weight.normal_() if gate is None else model.gate.bias.fill_(gate)
    return model


def inputs(seed: int = 1):
    g = torch.Generator().manual_seed(seed)
    shapes = ((B, T_P, 63), (B, T_H, 63), (B, T_H + T_P, 3))
    x_s, past, control = (torch.randn(shape, generator=g) for shape in shapes)
    return x_s, torch.tensor([2, 7, 5]), past, control


def test_the_feet_are_the_ankles_and_toes():
    assert [JOINTS[j] for j in FEET] == ["LeftFoot", "LeftToeBase", "RightFoot", "RightToeBase"]
    assert COLUMNS == [9, 10, 11, 12, 13, 14, 21, 22, 23, 24, 25, 26]


def test_held_joints_rest_in_the_world():
    """The oracle is the way back: poses and control, placed in the world, do not move."""
    rng = np.random.default_rng(0)
    control = rng.normal(size=(2, 7, 3)) * [2, 1, 3]
    joints = rng.normal(size=(2, 4, 3))
    held = held_positions(torch.from_numpy(joints), torch.from_numpy(control)).numpy()
    for b in range(2):
        poses = np.concatenate([joints[b : b + 1], held[b]])
        world = to_world(
            poses, np.concatenate([control[b], control[b, -1:]]), start=(0.3, -0.2, 1.1)
        )
        assert np.abs(world - world[:1]).max() < 1e-12


def test_held_joints_by_hand():
    """1 m/s ahead: a toe at rest falls back by 5 cm a frame.

    A quarter turn to the left: what was ahead is right.
    """
    toe = torch.tensor([[[0.1, 0.02, 0.3]]])
    back = held_positions(toe, torch.tensor([[[1.0, 0, 0]] * 2]))
    torch.testing.assert_close(back[0, :, 0], torch.tensor([[0.1, 0.02, 0.25], [0.1, 0.02, 0.2]]))
    turned = held_positions(toe, torch.tensor([[[0.0, 0, torch.pi / 2 * 20]]]))
    torch.testing.assert_close(turned[0, 0, 0], torch.tensor([-0.3, 0.02, 0.1]))


def metres(output: torch.Tensor) -> np.ndarray:
    return POSE.inverse(output).double().numpy().reshape(B, -1, 21, 3)


def test_an_open_gate_leaves_the_feet_where_they_are():
    x_s, s, past, control = inputs()
    with torch.no_grad():
        poses = metres(torch.cat([past[:, -1:], tiny(gate=50.0)(x_s, s, past, control)], 1))
    steer = CONTROL.inverse(control[:, T_H - 1 :]).double().numpy()
    world = np.stack([to_world(p, c) for p, c in zip(poses, steer, strict=True)])
    moved = np.abs(world - world[:, :1]).max((0, 1, 3))
    assert moved[FEET].max() < 1e-5
    assert np.delete(moved, FEET).min() > 0.01


def test_a_closed_gate_is_plain_modiff():
    closed, plain = tiny(gate=-50.0), MoDiff(FREE).eval()
    plain.load_state_dict(
        {k: v for k, v in closed.state_dict().items() if not k.startswith("gate")}
    )
    x_s, s, past, control = inputs()
    torch.testing.assert_close(
        closed(x_s, s, past, control), plain(x_s, s, past, control), atol=1e-6, rtol=1e-6
    )


def test_the_gate_shares_by_joint():
    held, free = torch.ones(1, 1, 12), torch.zeros(1, 1, 63)
    out = blend(free, torch.tensor([[[0.1, 0.2, 0.3, 0.4]]]), held)[0, 0]
    wanted = torch.zeros(21, 3)
    wanted[FEET] = torch.tensor([[0.1], [0.2], [0.3], [0.4]])
    torch.testing.assert_close(out.view(21, 3), wanted)
    assert not free.any()  # what it was given stays


def test_another_pose_may_stand():
    x_s, s, past, control = inputs()
    model, other = tiny(gate=50.0), past[:, -1] + 0.5
    with torch.no_grad():
        by_default = model.encode(past, control)
        standing = model.encode(past, control, other)
    for one, other_one in zip(by_default.layers, standing.layers, strict=True):
        assert torch.equal(one.keys, other_one.keys)
    assert torch.equal(standing.held, model.held(other, control)) and not torch.equal(
        standing.held, by_default.held
    )
    chosen = standing.rows(torch.tensor([1, 0, 1]))
    assert torch.equal(chosen.held, standing.held[[1, 0, 1]])
    keys, wanted = (one.layers[0].keys for one in (chosen, standing))
    assert torch.equal(keys, wanted[[1, 0, 1]])


def test_the_weights_file_keeps_the_gate_and_the_walker_walks(tmp_path: Path):
    walker = Walker(tiny(), linear_schedule(8, 0.2, 0.95), POSE, CONTROL)
    back = load_walker(save(walker, tmp_path / "tiny.safetensors", bits=32))
    assert isinstance(back.model, FootholdMoDiff)
    _, _, past, control = inputs()
    found = back.window_sampler()(past, control, torch.Generator().manual_seed(3))
    wanted = walker.window_sampler()(past, control, torch.Generator().manual_seed(3))
    torch.testing.assert_close(found, wanted)


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"target": "eps"}, "target"),
        ({"skip": True}, "skip"),
        ({"D": 30}, "63, not 30"),
        ({"C": 4}, "3, not 4"),
    ],
)
def test_what_has_no_place_is_refused(settings, reason):
    with pytest.raises(ValueError, match=reason):
        replace(TINY, **settings)


def test_the_configuration_names_the_network():
    assert type(network(TINY, POSE, CONTROL)) is FootholdMoDiff
    assert type(network(FREE, POSE, CONTROL)) is MoDiff


def walk_windows() -> Windows:
    rng = np.random.default_rng(0)
    return Windows.of(
        [Clip(rng.normal(size=(60, 21, 3)).cumsum(0), rng.normal(size=(60, 3)), source="drift")],
        T_H,
        T_P,
    )


def watched(windows: Windows, seen: dict) -> FootholdMoDiff:
    """A network that writes down the last poses it is shown.

    And those on which its feet may stand.
    """
    model = FootholdMoDiff(TINY, windows.pose_scaler, windows.control_scaler)
    encode = model.encode

    def spy(past, control, standing):
        seen.update(past=past[:, -1], standing=standing)
        return encode(past, control, standing)

    model.encode = spy
    return model


def drawn(windows: Windows, batch: int) -> tuple[torch.Tensor, ...]:
    return windows.draw(batch, torch.Generator().manual_seed(5))


def loss_on(model, batch, **options) -> None:
    schedule, draws = linear_schedule(8, 0.2, 0.95), torch.Generator().manual_seed(6)
    training_loss(model, batch, schedule, draws, **options)


@pytest.mark.parametrize("foot_noise", [0.0, 0.4, 1.0])
def test_foot_noise_is_the_fraction_of_the_past_noise_under_the_feet(foot_noise: float):
    """The pose whose feet are held lies between the clean past and the one that is seen."""
    windows, seen = walk_windows(), {}
    clean, x0, control = drawn(windows, 6)
    noised = clean + torch.randn(clean.shape, generator=torch.Generator().manual_seed(7))
    model = CleanFootholds(watched(windows, seen), clean, noised, foot_noise)
    loss_on(model, (noised, x0, control))
    assert torch.equal(seen["past"], noised[:, -1]) and model.config is TINY
    wanted = clean[:, -1] + foot_noise * (noised - clean)[:, -1]
    torch.testing.assert_close(seen["standing"], wanted)


def test_a_dropped_past_leaves_no_clean_feet_to_stand_on():
    """Wherever the past was dropped, the feet that are held are those of the dropped past."""
    windows, seen = walk_windows(), {}
    clean, x0, control = drawn(windows, 40)
    noised = clean + torch.randn(clean.shape, generator=torch.Generator().manual_seed(7))
    dropout = Dropout(linear_schedule(8, 0.2, 0.95), lambda done: 0.5, steps=1, done=0.0)
    model = CleanFootholds(watched(windows, seen), clean, noised, 0.5)
    loss_on(model, (noised, x0, control), dropout=dropout)
    dropped = (seen["past"] != noised[:, -1]).any(1)
    assert 8 < dropped.sum() < 32
    assert torch.equal(seen["standing"][dropped], seen["past"][dropped])
    wanted = (clean + noised)[:, -1] / 2
    torch.testing.assert_close(seen["standing"][~dropped], wanted[~dropped])


def test_feet_are_held_alike_where_the_encoding_is_shared():
    windows = walk_windows()
    model = FootholdMoDiff(TINY, windows.pose_scaler, windows.control_scaler)
    torch.nn.init.normal_(model.gate.weight)
    clean, x0, control = repeated(drawn(windows, 3), 2)
    noised = clean + 0.1
    x_s, s = torch.randn(6, T_P, 63), torch.arange(1, 7)
    plain, shared = (
        CleanFootholds(network, clean, noised, 0.3)(x_s, s, noised, control)
        for network in (model, SharedEncoding(model, 2))
    )
    torch.testing.assert_close(shared, plain)
    assert not torch.allclose(model(x_s, s, noised, control), plain)


def test_in_use_a_gate_leans_towards_holding_and_goes_all_the_way():
    """Where a sigmoid stops short of 0 and 1 the stretched one is there.

    Where both places agree, halfway lies at -2; far apart at +0.25; 15 mm apart 1/e of the way.
    """
    gate = torch.tensor([-9.0, -4.4, -2.0, 0.4, 9.0])
    torch.testing.assert_close(openness(gate), torch.tensor([0.0, 0.0, 0.5, 1.0, 1.0]))
    for apart, lean in ((0.015, -0.25 + 2.25 / np.e), (0.2, -0.25)):
        same = openness(gate - lean, torch.full((5,), apart)), 1.2 * torch.sigmoid(gate) - 0.1
        torch.testing.assert_close(same[0], same[1].clamp(0, 1))


def test_training_sees_the_plain_gate_and_use_the_leaning_one():
    x_s, s, past, control = inputs()
    model = tiny()
    std = torch.linspace(0.5, 2.0, 12)
    model.pose_std.copy_(std)
    for training in (True, False):
        part = model.train(training)
        with torch.no_grad():
            context = part.encode(past, control)
            x = part.attend(part.embed(x_s, s, context), context)
            gate = part.gate(x)
            free = part.head(x)
            out = part(x_s, s, past, control)
        metres = (context.held - free[..., COLUMNS]).unflatten(-1, (4, 3)) * std.view(4, 3)
        in_use = openness(gate, metres.square().sum(-1).sqrt())
        torch.testing.assert_close(
            out, blend(free, torch.sigmoid(gate) if training else in_use, context.held)
        )
        other = blend(free, in_use if training else torch.sigmoid(gate), context.held)
        assert not torch.allclose(out, other, atol=1e-4)


def test_gates_are_those_the_answer_was_made_with():
    x_s, s, past, control = inputs()
    model = tiny()
    with torch.no_grad():
        context = model.encode(past, control)
        x = model.attend(model.embed(x_s, s, context), context)
        free, held = model.head(x), context.held
        apart = ((held - free[..., COLUMNS]) * model.pose_std).unflatten(-1, (4, 3)).norm(dim=-1)
        gates = openness(model.gate(x), apart)
        out = model(x_s, s, past, control)
    assert gates.shape == (B, T_P, 4) and 0 <= gates.min() < 0.3 and 0.7 < gates.max() <= 1
    share = (
        ((out - free)[..., COLUMNS] / (context.held - free[..., COLUMNS]))
        .unflatten(-1, (4, 3))
        .median(-1)
        .values
    )
    torch.testing.assert_close(share, gates, atol=1e-3, rtol=1e-3)
