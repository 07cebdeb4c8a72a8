"""The judges' training: batches, equal truths, captions that are wrong, and the cards."""

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
import torch

from motiondiff_edu.conditions.word_encoder import FIRST
from motiondiff_edu.metrics.distributions import Space, contrast
from motiondiff_edu.motion.moving_frame import D
from motiondiff_edu.performers.described_windows import Chosen
from motiondiff_edu.pretrained.judges import judges
from motiondiff_edu.recipes.judges import (
    JUDGES,
    JudgeRecipe,
    SpaceConfig,
    loss_of,
    same,
    shown_to_judges,
    train_judge,
)

SHORT = JudgeRecipe("tiny", SpaceConfig(8), steps=4, frames=700, clips=30)


@pytest.fixture(scope="module")
def data():
    return shown_to_judges(SHORT.clips, SHORT.data_seed)


def test_every_motion_has_its_truth_and_a_wrong_caption(data):
    windows = data.windows
    assert {n: len(x) for n, x in windows.motions.items()} == {
        n: len(x) for n, x in data.truths.items()
    }
    for n, wrong in data.wrong.items():
        for k, (truth, mirrored) in enumerate(data.truths[n]):
            own = {tuple(x.tolist()) for x in windows.captions[n][k]}
            assert tuple(wrong[k].tolist()) not in own
            sided = any(act.side in ("left", "right") for p in truth for act in p.acts)
            assert (truth != mirrored) == sided


def test_two_motions_of_one_sentence_are_the_same(data):
    n = max(data.truths, key=lambda n: len(data.truths[n]))
    truths = {n: [("a", "b"), ("b", "a"), ("c", "c")]}
    which = torch.tensor([0, 1, 2, 0])
    chosen = Chosen(n, which, torch.zeros(4).long(), torch.tensor([False, True, False, True]))
    wanted = torch.tensor([[1, 1, 0, 0], [1, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    assert torch.equal(same(chosen, truths), wanted.float())


def test_the_loss_is_contrast_with_the_wrong_captions_mirrored_too(data):
    torch.manual_seed(0)
    space = Space(D, FIRST + len(data.windows.words), 8)
    found = loss_of(SHORT, data)(space, torch.Generator().manual_seed(5))
    chosen = data.windows.choose(SHORT.frames, torch.Generator().manual_seed(5))
    x, ids, _ = data.windows.take(chosen)
    wrong = data.wrong[chosen.length][chosen.which].clone()
    for row in chosen.turned.nonzero()[:, 0].tolist():
        wrong[row] = data.windows.exchanged[wrong[row]]
    alike = same(chosen, data.truths)
    torch.testing.assert_close(found, contrast(space, x, ids, alike, wrong))
    assert not torch.isclose(found, contrast(space, x, ids, alike))


def test_a_judge_is_trained_and_a_killed_training_continues(tmp_path):
    whole = train_judge(SHORT, tmp_path / "whole.safetensors", log=lambda line: None)
    train_judge(replace(SHORT), tmp_path / "again.safetensors", log=lambda line: None)
    again = train_judge(SHORT, tmp_path / "again.safetensors", log=lambda line: None)
    for (name, a), (_, b) in zip(
        whole.space.state_dict().items(), again.space.state_dict().items(), strict=True
    ):
        assert np.allclose(a, b), name
    assert whole.card["recipe"]["clips"] == 30 and whole.card["clips"] == 30


def test_the_cards_of_the_shipped_judges_have_their_recipes():
    for judge, recipe in zip(judges(), JUDGES.values(), strict=True):
        is_now = json.loads(json.dumps(asdict(recipe)))
        assert judge.card["name"] == is_now.pop("name") and is_now.pop("config")
        # how often a run was saved is none of a recipe
        assert {k: v for k, v in judge.card["recipe"].items() if k != "save_every"} == is_now
