"""The masks of the training, what the network is shown, and its loss by hand."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from data_synth.mixed import motions, sentences
from motiondiff_edu.beyond.around_lines import GivenLines
from motiondiff_edu.beyond.schedules import shifted
from motiondiff_edu.ddpm import cosine_schedule, q_sample
from motiondiff_edu.editing.inbetween import inbetween
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.kinematic_loss import kinematic_parts
from motiondiff_edu.motion import dance_frame
from motiondiff_edu.motion.skeleton import HIPS, TOES, J
from motiondiff_edu.performers.dance_windows import DanceWindows, toes_moved
from motiondiff_edu.performers.inbetweener import KeyframeConfig, KeyframeMoFusion
from motiondiff_edu.prediction import to_x0
from motiondiff_edu.recipes import inbetweener
from motiondiff_edu.recipes.drawn_masks import SHARES, drawn_mask, drawn_masks
from motiondiff_edu.recipes.inbetweener import (
    INBETWEENER,
    as_seen,
    body_around,
    loss_of,
    train_inbetweener,
    with_path_scale,
)

T = 32
SMALL = KeyframeConfig(S=60, widths=(16, 24), heads=2)
SCHEDULE = cosine_schedule(60)
RECIPE = replace(INBETWEENER, config=SMALL, steps=3, batch=4, frames=T)


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


@pytest.fixture(scope="module")
def windows() -> DanceWindows:
    positions, contacts = zip(*motions(2, 3, 4.0), *sentences(1, 3, 4.0), strict=True)
    return DanceWindows.of(positions, contacts, None, T)


def test_masks_are_of_all_kinds_and_never_give_a_joint_without_the_pelvis():
    known = drawn_masks(400, 100, seeded())
    assert known.shape == (400, 100, J)
    assert not (known.any(-1) & ~known[..., HIPS]).any()
    share = known.float().mean((1, 2))
    assert (share == 0).float().mean() == pytest.approx(SHARES["nothing"], abs=0.05)
    assert not (share == 1).any(), "something must be left to generate"
    frames = known.all(-1)
    alone = frames[:, 1:-1] & ~frames[:, 2:] & ~frames[:, :-2]
    assert (alone.any(1)).float().mean() > 0.35, "single keyframes are the usual case"
    assert torch.equal(known, drawn_masks(400, 100, seeded()))
    assert not torch.equal(known, drawn_masks(400, 100, seeded(1)))


@pytest.mark.parametrize("kind", SHARES)
def test_a_mask_of_each_kind_has_its_form(kind):
    for k in range(40):
        known, generator = drawn_mask(kind, 50, seeded(k)), seeded(k)
        whole, some = known.all(-1), known.any(-1)
        assert torch.equal(known, drawn_mask(kind, 50, generator))
        if kind == "nothing":
            assert not some.any()
        if kind == "keyframes":
            assert torch.equal(whole, some) and some.any() and not some.all()
        if kind == "gap":
            missing = (~whole).nonzero()[:, 0]
            assert len(missing) and int(missing[-1] - missing[0]) == len(missing) - 1
        if kind == "seed":
            first = int(some.sum())
            assert 1 <= first <= 25 and some[:first].all() and torch.equal(whole, some)
        if kind == "part":
            assert some.all() and not whole.all()


def test_too_short_a_motion_is_refused():
    with pytest.raises(ValueError, match="4 frames or more, not 3"):
        drawn_masks(2, 3, seeded())


def test_motions_are_seen_from_their_first_given_pose_and_resized(windows):
    motion, _, _ = windows.draw(2, seeded())
    known = torch.zeros(2, T, J, dtype=torch.bool)
    known[0, 9], known[1, 0] = True, True
    motion = windows.motion_scaler.inverse(motion)
    seen = as_seen(motion, known, torch.tensor([1.0, 1.2]), torch.tensor([0.0, 0.5]))
    pose = dance_frame.to_positions(seen)[0, 9].numpy()
    assert np.abs(pose[HIPS, [0, 2]]).max() < 1e-5
    assert abs(float(dance_frame.facing(pose[None])[0])) < 1e-5
    before, after = (dance_frame.to_positions(x)[1] for x in (motion, seen))
    higher = torch.tensor([0.0, 0.5, 0.0])
    torch.testing.assert_close(after, 1.2 * before + higher, atol=1e-4, rtol=0)


@pytest.mark.parametrize("all_terms", [False, True])
@pytest.mark.parametrize("target", ["x0", "v"])
def test_the_loss_of_a_batch_is_eq_4_of_what_remains_without_the_lines(windows, target, all_terms):
    """Errors are those of x0, whatever the network predicts.

    With all terms: errors of changes and of the toes, and L_k of lines and remainder together.
    """
    config = replace(SMALL, target=target)
    recipe = replace(RECIPE, config=config, sizes=0.0, stages=0.0)
    if not all_terms:
        recipe = replace(recipe, kinematic=None, changes=0.0, toes=0.0)
    torch.manual_seed(0)
    model, asked = KeyframeMoFusion(config), []
    torch.nn.init.normal_(model.unet.out.weight, std=0.1)
    forward = model.forward

    def watched(r_s, s, lines):
        asked.append((r_s, s, lines, forward(r_s, s, lines)))
        return asked[-1][-1]

    model.forward = watched
    loss = loss_of(recipe, windows, SCHEDULE)(model, seeded(5))
    ((r_s, s, lines, output),) = asked
    r0_hat = to_x0(output, r_s, s, SCHEDULE, target)
    generator = seeded(5)
    motion, _, planted = windows.draw(4, generator)
    known = drawn_masks(4, T, generator)
    torch.rand(12, generator=generator)  # sizes, who stands on a stage, and how high
    scaler = windows.motion_scaler
    seen = as_seen(scaler.inverse(motion), known, torch.ones(4), torch.zeros(4))
    seen = scaler.transform(seen)
    columns = known.repeat_interleave(3, -1)
    wanted = GivenLines.of(seen, columns)
    r0 = wanted.remainder(seen)
    assert all(torch.equal(getattr(lines, k), getattr(wanted, k)) for k in ("lines", "known"))
    steps = torch.randint(1, SCHEDULE.S + 1, (4,), generator=generator)
    eps = torch.randn(r0.shape, generator=generator)
    assert torch.equal(s, steps)
    torch.testing.assert_close(r_s, q_sample(r0, steps, SCHEDULE, eps))
    errors = (lines.whole(r0_hat) - seen).where(~columns, 0.0)
    typical = lines.scale.square().mean((1, 2), keepdim=True).sqrt()
    by_hand = (errors / typical).square().mean()
    if all_terms:
        errors = (r0_hat - r0) * lines.scale / typical
        steps = dance_frame.moves(errors * scaler.std)[:, :, list(TOES)].square().mean()
        by_hand += 5 * errors.diff(dim=1).square().mean() + 0.2 / toes_moved(windows) * steps
        parts = kinematic_parts(r0_hat, r0, body_around(lines, scaler), planted)
        L_k = 400 * parts["skeleton"] + 5 * parts["asymmetry"] + 0.3 * parts["slide"]
        by_hand += (SCHEDULE.alpha_bar[s].float() * L_k).mean()
    torch.testing.assert_close(loss, by_hand)


def test_some_motions_stand_on_stages_but_none_of_which_nothing_is_given(windows, monkeypatch):
    asked = []

    def watched(motion, known, sizes, heights):
        asked.append((known, heights))
        return as_seen(motion, known, sizes, heights)

    monkeypatch.setattr(inbetweener, "as_seen", watched)
    recipe = replace(RECIPE, batch=300, stages=0.5)
    loss_of(recipe, windows, SCHEDULE)(KeyframeMoFusion(SMALL), seeded(1))
    ((known, heights),) = asked
    given = known.flatten(1).any(1)
    assert (heights[~given] == 0).all() and not given.all()
    assert (heights[given] > 0).float().mean() == pytest.approx(0.5, abs=0.1)
    assert 0.9 < heights.max() <= 1


def test_bones_are_those_of_lines_and_remainder_together(windows):
    motion, _, _ = windows.draw(2, seeded())
    lines = GivenLines.of(motion, torch.rand(motion.shape, generator=seeded()) < 0.2)
    body = body_around(lines, windows.motion_scaler)
    wanted = dance_frame.body_of(windows.motion_scaler).to_positions(motion)
    made = body.to_positions(lines.remainder(motion))
    torch.testing.assert_close(made, wanted, atol=1e-4, rtol=1e-4)


def test_a_path_is_measured_in_metres_of_the_recipe_and_motions_stay_the_same(windows):
    scaled = with_path_scale(windows, 0.3)
    assert scaled.motion_scaler.std[[0, 2]].tolist() == pytest.approx([0.3, 0.3])
    other = [column for column in range(63) if column not in (0, 2)]
    assert torch.equal(scaled.motion_scaler.std[other], windows.motion_scaler.std[other])
    some = torch.tensor([0, 3])
    same = [one.motion_scaler.inverse(one.take(some)[0]) for one in (windows, scaled)]
    torch.testing.assert_close(*same, atol=1e-5, rtol=0)


def test_a_network_is_trained_and_fills_in(windows, tmp_path):
    made_by = train_inbetweener(RECIPE, tmp_path / "run.safetensors", windows, log=lambda _: None)
    assert made_by.card["recipe"]["sizes"] == 0.1 and made_by.card["windows"] == len(windows)
    wanted = shifted(SCHEDULE, RECIPE.snr).alpha_bar
    assert RECIPE.snr == 0.3 and torch.equal(made_by.schedule.alpha_bar, wanted)
    truth = (
        dance_frame.to_positions(windows.motion_scaler.inverse(windows.draw(1, seeded())[0]))[0]
        .double()
        .numpy()
    )
    known = keyframes(T, 10)
    made = inbetween(made_by, truth, known, samples=2, steps=3, generator=seeded())
    assert np.array_equal(made[:, known], np.broadcast_to(truth[known], made[:, known].shape))
    assert np.isfinite(made).all() and np.abs(made[0] - made[1]).max() > 1e-3
