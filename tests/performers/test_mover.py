"""A mover: sentences to motions, its files, and what it refuses."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import torch
from seeds import seeded
from small_movers import PLANNED, SMALL, WORDS, mover_of

import motiondiff_edu as md
from data_synth.actions import clips
from motiondiff_edu.beyond import timeline
from motiondiff_edu.conditions.acts import Act
from motiondiff_edu.conditions.text import TextError
from motiondiff_edu.conditions.word_encoder import (
    NOTHING,
    PADDING,
    WordEncoder,
    WordReader,
    ids_of,
    present,
)
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.kinematic_loss import training_loss
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.motion.motion import MotionWarning
from motiondiff_edu.motion.moving_frame import D, to_features, to_positions
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.motion.skeleton import BONE_LENGTHS
from motiondiff_edu.performers.described_windows import DescribedWindows
from motiondiff_edu.performers.mover import Mover, written
from motiondiff_edu.performers.text_mofusion import TextMoFusion
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.recipes.mover import timeline_of
from motiondiff_edu.training import TrainState, train_steps


@pytest.fixture(scope="module", params=[SMALL, PLANNED], ids=["alone", "planned"])
def mover(request) -> Mover:
    return mover_of(request.param, card={"name": "tiny"})


@pytest.fixture(scope="module")
def planning() -> Mover:
    return mover_of(PLANNED)


@pytest.fixture(scope="module")
def windows() -> DescribedWindows:
    made = list(clips(24, 3))
    return DescribedWindows.of(
        [one.acted.positions for one in made],
        [one.acted.contacts for one in made],
        [one.captions for one in made],
        WORDS,
        [timeline_of(one.acted.spans, len(one.acted)) for one in made],
    )


def test_ids_of_texts_are_padded_and_the_empty_text_has_a_token_of_its_own():
    ids = ids_of([("walk", "then", "kick"), ("kick",), ()], WORDS)
    assert ids.shape == (3, 3) and ids[1, 0] == ids[0, 2] and ids[1, 1] == PADDING
    assert ids[2].tolist() == [NOTHING, PADDING, PADDING]
    assert present(ids).sum(1).tolist() == [3, 1, 1]


def test_padding_changes_no_token_and_the_order_of_words_does():
    torch.manual_seed(1)
    encoder = WordEncoder(5, 12, 2, 2, 9).eval()
    ids = torch.tensor([[2, 3, 4], [4, 3, 2]])
    tokens = encoder(ids)
    padded = encoder(torch.nn.functional.pad(ids, (0, 4)))
    torch.testing.assert_close(padded[:, :3], tokens)
    assert (tokens[0, 1] - tokens[1, 1]).abs().max() > 0.01  # the same word, among others


def test_a_sentence_makes_motions(mover):
    alone = mover.act("walks forward", seconds=2.5, steps=3, progress=False, tries=1)
    assert alone.positions.shape == (50, 21, 3) and alone.source == "walks forward"
    first, second = mover.act(
        "walks forward", seconds=2.5, samples=2, steps=3, progress=False, tries=1
    )
    assert np.abs(first.positions - alone.positions).max() < 1e-3
    assert np.abs(second.positions - alone.positions).max() > 0.01
    other = mover.act("kicks with the left foot", seconds=2.5, steps=3, progress=False, tries=1)
    assert np.abs(other.positions - alone.positions).max() > 0.001


def test_an_act_has_bones_of_the_course(mover):
    """Of a network as good as any, whose bones are off by some millimetres."""
    clip = next(iter(clips(1, 5))).acted.positions[:40]
    shaken = torch.from_numpy(clip + 0.005 * np.sin(np.arange(clip.size)).reshape(clip.shape))
    acting = replace(mover)
    object.__setattr__(acting, "positions_of", lambda x0: shaken[None])
    made = Mover.act(acting, "walks", seconds=2.0, progress=False, tries=1).positions
    np.testing.assert_allclose(bone_lengths(made), BONE_LENGTHS[None].repeat(40, 0), atol=1e-3)
    assert np.abs(bone_lengths(shaken.numpy()) - BONE_LENGTHS).max() > 0.005
    assert np.abs(made - clip).max() < 0.07


def test_a_length_between_those_of_the_training_is_cut_from_the_next_one(mover):
    long = mover.act("walks", seconds=2.4, steps=2, progress=False, tries=1).positions
    short = mover.act("walks", seconds=2.05, steps=2, progress=False, tries=1).positions
    assert len(long) == 48 and len(short) == 41
    np.testing.assert_array_equal(short, long[:41])


def test_a_plan_is_made_tidied_and_followed(planning):
    ids = ids_of([("walk",), ("kick",)], WORDS)
    plans = planning.plans(ids, 40, steps=3, generator=seeded())
    assert plans.shape == (2, 40, timeline.D)
    torch.testing.assert_close(timeline.tidied(plans), plans)
    draws = seeded()
    again = planning.plans(ids, 40, steps=3, generator=draws)
    assert torch.equal(again, plans)
    made = planning.act_ids(ids, 40, steps=3, plan=plans, generator=draws)
    torch.testing.assert_close(planning.act_ids(ids, 40, steps=3, generator=seeded()), made)
    acts = [timeline.Timed("bow", "", 2, 0.2, 1.6)]
    other = torch.from_numpy(timeline.timeline(acts, 40)).float()[None]
    moved = planning.act_ids(ids, 40, steps=3, plan=other, generator=seeded())
    assert (moved - planning.act_ids(ids, 40, steps=3, plan=0 * other, generator=seeded())).any()


@pytest.mark.parametrize(
    "text, wanted",
    [
        ("walks while waving with the left hand", [("walk", ""), ("wave", "left")]),
        ("kicks with the left foot, then bows", [("bow", ""), ("kick", "left")]),
    ],
)
def test_what_is_not_shown_is_drawn_again_by_a_timeline_written_for_it(
    planning, monkeypatch, text, wanted
):
    plans = []
    before = Mover.denoiser

    def denoiser(mover, ids, frames, guidance=1.0, plan=None):
        plans.append(plan)
        return before(mover, ids, frames, guidance, plan)

    monkeypatch.setattr(Mover, "denoiser", denoiser)
    how = {"seconds": 3.0, "steps": 2, "progress": False}
    with pytest.warns(MotionWarning, match=f"asked: {text}; but .*is not to be seen"):
        made = planning.act(text, samples=2, tries=3, **how)
    assert all("is not to be seen" in one.notes[-1] for one in made)  # of an untrained network
    assert len(plans) == 3 and all(plan.shape == (2, 64, timeline.D) for plan in plans)
    for plan in plans[1:]:
        for row in plan.numpy():
            acts = [(one.verb, one.side) for one in timeline.acts_of(row)]
            assert sorted(acts) == wanted
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        planning.act("stands still", tries=3, **how)
    assert len(plans) == 4  # nothing is to be seen, and so nothing is missing


def test_written_timelines_are_those_of_their_draw():
    parts = ((Act("kick", "right", 2),), (Act("clap"),))
    draws = [torch.Generator().manual_seed(k) for k in (1, 2, 1)]
    first, other, again = written(parts, 160, draws)
    assert torch.equal(first, again) and not torch.equal(first, other)
    found = [(one.verb, one.side, one.count) for one in timeline.acts_of(first.numpy())]
    assert found == [("kick", "right", 2), ("clap", "", 3)]


@pytest.mark.parametrize("text", ["goes down", "throws his arm", "keeps still", "no waving"])
def test_a_sentence_without_an_act_is_refused_by_the_shipped_reader(text):
    with pytest.raises(TextError, match="names no act|does not know"):
        WordReader(checkpoints.load(checkpoints.available()["mover"]).config.words).read(text)


def test_a_plan_needs_a_network_that_takes_one(planning):
    ids = ids_of([("walk",)], WORDS)
    with pytest.raises(ValueError, match="plan: this mover needs one"):
        planning.denoiser(ids, 40)
    with pytest.raises(ValueError, match="plan: this mover takes none"):
        mover_of(SMALL).denoiser(ids, 40, plan=torch.zeros(1, 40, timeline.D))
    assert planning.can_plan and not mover_of(SMALL).can_plan


def test_a_plan_of_ones_own_is_an_array_of_the_right_shape(planning):
    ids = ids_of([("walk",), ("kick",)], WORDS)
    acts = [timeline.Timed("kick", "left", 2, 0.2, 1.6)]
    own = timeline.timeline(acts, 40)[None]
    made = planning.act_ids(ids, 40, steps=2, plan=own, generator=seeded())
    again = planning.act_ids(
        ids, 40, steps=2, plan=torch.from_numpy(own).float(), generator=seeded()
    )
    torch.testing.assert_close(made, again)
    with pytest.raises(ValueError, match="plan: it has 40 frames, and the motion 44"):
        planning.act_ids(ids, 44, steps=2, plan=own)
    for wrong in (own[0], own[..., :5], np.repeat(own, 3, 0)):
        with pytest.raises(ValueError, match=r"its shape must be \(1 or 2, frames, 24\)"):
            planning._plan(wrong, len(ids), 40)  # the tests' check of shapes comes first otherwise


def test_plans_are_guided_too(planning):
    ids = ids_of([("walk",)], WORDS)
    x, s = torch.randn(1, 40, timeline.D, generator=seeded()), torch.tensor([5])
    nothing = planning.reader.encoded([()])
    own, free, guided = (
        planning.plan_denoiser(text, x.shape[1], w)(x, s)
        for text, w in ((ids, 1), (nothing, 1), (ids, 2.5))
    )
    torch.testing.assert_close(guided, free + 2.5 * (own - free), atol=1e-4, rtol=1e-3)
    apart = planning.act_ids(ids, 40, steps=2, guidance=2.5, generator=seeded())
    assert (apart - planning.act_ids(ids, 40, steps=2, generator=seeded())).abs().max() > 1e-3


def test_a_mover_in_training_acts_without_dropout(mover):
    mover = Mover(mover.model, mover.schedule, mover.motion_scaler)
    before = mover.act("walks", seconds=2.0, steps=2, progress=False, tries=1).positions
    mover.model.train()
    try:
        after = mover.act("walks", seconds=2.0, steps=2, progress=False, tries=1).positions
        assert all(part.training for part in mover.model.modules())
        frozen = next(part for part in mover.model.modules() if isinstance(part, torch.nn.Linear))
        frozen.eval()
        mover.act("walks", seconds=2.0, steps=2, progress=False, tries=1)
        assert [part for part in mover.model.modules() if not part.training] == [frozen]
    finally:
        mover.model.eval()
    np.testing.assert_array_equal(before, after)


@pytest.mark.parametrize("guidance", [float("nan"), -3.0, float("inf"), 21.0])
def test_guidance_is_a_number_from_0_to_20(mover, guidance):
    with pytest.raises(ValueError, match="guidance must be a number from 0 to 20"):
        mover.act("walks", seconds=2.0, steps=2, guidance=guidance, progress=False, tries=1)


def test_the_bar_counts_the_plan_as_well(mover, monkeypatch):
    told = []

    def counting(what, total, shown):
        return lambda loop: (told.append(total) or step for step in loop)

    monkeypatch.setattr("motiondiff_edu.performers.mover.bar", counting)
    mover.act("walks", seconds=2.0, steps=3, tries=1)
    assert told == [3 + 1] * (3 + 1) * (1 + mover.can_plan)


def test_the_units_of_a_motion_are_those_of_the_network(mover):
    positions = next(iter(clips(1, 8))).acted.positions[:40]
    units = mover.units_of(positions)
    assert units.shape == (40, D)
    back = mover.pose_scaler.inverse(units)
    torch.testing.assert_close(back, torch.from_numpy(to_features(positions)).float())
    start = torch.from_numpy(to_positions(back).numpy())
    torch.testing.assert_close(mover.positions_of(units), start)


def test_guidance_of_one_is_the_conditional_network_and_more_leads_away_from_no_text(mover):
    ids, nothing = ids_of([("walk",)], WORDS), ids_of([()], WORDS)
    x, s = torch.randn(1, 40, D, generator=seeded()), torch.full((1,), 20)
    plan = mover.plans(ids, 40, steps=2, generator=seeded()) if mover.can_plan else None
    with torch.no_grad():
        plain, free = (mover.denoiser(text, 40, plan=plan)(x, s) for text in (ids, nothing))
        guided = mover.denoiser(ids, 40, 2.5, plan)(x, s)
        torch.testing.assert_close(guided, 2.5 * plain - 1.5 * free)
    assert (plain - free).abs().max() > 1e-3
    assert mover.model.training is False


@pytest.mark.parametrize(
    "text, options, told",
    [
        ("", {}, "is empty"),
        ("does a cartwheel", {}, "does not know 'cartwheel'"),
        ("walks", {"seconds": 1.0}, "seconds must be from 2 to 10"),
        ("walks", {"seconds": 20.0}, "seconds must be from 2 to 10"),
        ("walks", {"samples": 0}, "samples must be a whole number of at least 1"),
        ("walks", {"seed": -1}, "seed must be a whole number"),
    ],
)
def test_what_cannot_be_acted_is_refused_in_words(mover, text, options, told):
    with pytest.raises((TextError, ValueError), match=told):
        mover.act(text, progress=False, **options)


def test_a_word_that_is_read_as_another_is_said(mover):
    with pytest.warns(UserWarning, match="'marches' is read as 'walk'"):
        marched = mover.act("marches ahead", seconds=2, steps=2, progress=False, tries=1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # a network that was not trained walks nowhere
        warnings.filterwarnings("ignore", "asked: walks ahead; but")
        walked = mover.act("walks ahead", seconds=2, steps=2, progress=False, tries=1)
    assert np.array_equal(marched.positions, walked.positions)


def test_a_mover_comes_back_from_its_file(mover, tmp_path):
    path = checkpoints.save(mover, tmp_path / "mine.safetensors", bits=32)
    back = md.load(path)
    assert isinstance(back, Mover) and back.config == mover.config and back.card == mover.card
    one, two = (
        who.act("turns left", seconds=2, steps=2, progress=False, tries=1) for who in (mover, back)
    )
    np.testing.assert_array_equal(one.positions, two.positions)
    with pytest.raises(AttributeError, match="a mover cannot walk; md.load"):
        back.walk()


def test_batches_have_one_length_and_about_the_frames_that_were_asked_for(windows):
    assert len(windows) == 24 and all(n % 8 == 0 for n in windows.motions)
    for seed in range(6):
        x, ids, planted = windows.draw(400, seeded(seed))
        assert len(x) == len(ids) == len(planted) == max(1, 400 // x.shape[1])
        assert x.shape[1] == planted.shape[1] and (ids != PADDING).any(1).all()
    again = windows.draw(400, seeded(5))
    assert all(torch.equal(a, b) for a, b in zip((x, ids, planted), again, strict=True))


def test_a_mirrored_motion_has_its_words_exchanged(windows):
    left, right = ids_of([("left", "right")], WORDS)[0].tolist()
    assert windows.exchanged[left] == right and windows.exchanged[right] == left
    others = [k for k in range(2 + len(WORDS)) if k not in (left, right)]
    assert windows.exchanged[others].tolist() == others
    n = max(windows.motions, key=lambda n: len(windows.motions[n]))
    only = replace(
        windows,
        motions={n: windows.motions[n][:1]},
        contacts={n: windows.contacts[n][:1]},
        captions={n: windows.captions[n][:1, :1]},
        scaler=Scaler.nothing(D + timeline.D),
    )
    x, ids, planted = only.draw(40 * n, seeded(1))
    turned = (x - x[0]).abs().amax((1, 2)) > 1e-4
    assert 8 < turned.sum() < 32  # of 40, both ways occur
    one, other = x[~turned][0], x[turned][0]
    torch.testing.assert_close(one[:, 0], -other[:, 0])  # the pelvis, x
    torch.testing.assert_close(one[:, 1:3], other[:, 1:3])
    torch.testing.assert_close(one[:, D:], timeline.mirrored(other[:, D:]))
    assert torch.equal(windows.exchanged[ids[~turned][0]], ids[turned][0])
    assert torch.equal(planted[~turned][0], planted[turned][0].flip(-1))


def test_a_mover_can_be_trained(windows):
    """A few steps on a few clips: the loss falls, and the words get gradients."""
    torch.manual_seed(0)
    model, schedule = TextMoFusion(SMALL), cosine_schedule(30)
    alone = windows.without_timeline()

    def loss_fn(network, generator):
        x, ids, _ = alone.draw(300, generator)
        return training_loss(network, (x, network.listen(ids)), schedule, generator)

    state = TrainState.start(model, 0, torch.optim.Adam(model.parameters(), 3e-3), 0.9)
    losses = [
        one.loss for one in train_steps(state, loss_fn, 60, lr=lambda k: 3e-3, progress=False)
    ]
    assert np.mean(losses[-10:]) < 0.8 * np.mean(losses[:10])
    assert model.words.embed.weight.grad.abs().sum() > 0
