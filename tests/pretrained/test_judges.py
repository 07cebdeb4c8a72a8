"""Judges of words: files, shipped ones, and that they know what a caption says."""

import numpy as np
import pytest
import torch
from safetensors.torch import load_file

from data_synth.actions import captions, clips
from data_synth.actions.neighbours import neighbour
from motiondiff_edu.conditions.text import TextError, base_vocabulary
from motiondiff_edu.conditions.word_encoder import FIRST
from motiondiff_edu.metrics.distributions import Space, r_precision
from motiondiff_edu.motion.moving_frame import D
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.pretrained.checkpoints import available
from motiondiff_edu.pretrained.judges import FORMAT, Judge, judges, load_judge, save_judge
from motiondiff_edu.pretrained.weights_file import CheckpointError, write_weights

WORDS = base_vocabulary(captions.vocabulary())


def tiny() -> Judge:
    torch.manual_seed(0)
    space = Space(D, FIRST + len(WORDS), 8).eval().requires_grad_(False)
    scaler = Scaler(torch.linspace(-1, 1, D), torch.linspace(0.5, 2, D))
    return Judge(space, scaler, WORDS, {"a": 1})


@pytest.fixture(scope="module")
def unseen():
    return list(clips(96, 404, "test"))


def test_a_judge_comes_back_from_its_file(tmp_path, unseen):
    judge, path = tiny(), tmp_path / "judge.safetensors"
    save_judge(judge, path)
    back = load_judge(path)
    assert back.words == WORDS and back.card == {"a": 1}
    some = [one.acted.positions for one in unseen[:3]]
    np.testing.assert_allclose(back.of_motions(some), judge.of_motions(some), atol=0.03)
    for wrong in ({"width": 9000}, {"width": "8"}, {"width": 10**6}, {"words": 5}):
        changed = tmp_path / "changed.safetensors"
        weights, about = load_file(path), {"format": FORMAT}
        write_weights(changed, weights, about, {"words": list(WORDS), "width": 8} | wrong, {})
        with pytest.raises(CheckpointError, match="weights and configuration disagree"):
            load_judge(changed)
    path.write_bytes(path.read_bytes()[:-40])
    with pytest.raises(CheckpointError, match="damaged"):
        load_judge(path)
    with pytest.raises(CheckpointError, match="is not a judge"):
        load_judge(available()["walker"])


def test_the_points_of_a_motion_do_not_depend_on_the_others(unseen):
    some = [one.acted.positions for one in unseen[:4]]
    judge = tiny()
    alone = np.concatenate([judge.of_motions([one]) for one in some])
    np.testing.assert_allclose(judge.of_motions(some), alone, atol=1e-6)
    with pytest.raises(TextError, match="does not know 'cartwheel'"):
        judge.of_texts(["does a cartwheel"])


def test_the_shipped_judges_find_unseen_motions_by_their_captions(unseen):
    """Every judge: nearly always among 32, and nearer than a caption that differs in one thing."""
    every = judges()
    assert len(every) == 3 and len({judge.card["recipe"]["seed"] for judge in every}) == 3
    texts = [one.captions[0] for one in unseen]
    motions = [one.acted.positions for one in unseen]
    sentences = [one.acted.sentence for one in unseen]
    others = [neighbour(s, np.random.default_rng(k)) for k, s in enumerate(sentences)]
    told = [k for k, other in enumerate(others) if other]
    wrong = [captions.caption(others[k], np.random.default_rng(k)) for k in told]
    own = [captions.caption(sentences[k], np.random.default_rng(k)) for k in told]
    for judge in every:
        points = judge.of_motions(motions)
        found = r_precision(judge.of_texts(texts), points, sentences, np.random.default_rng(0))
        assert found[0] > 0.9 and found[2] > 0.97
        near, far = (
            np.linalg.norm(judge.of_texts(x) - points[told], axis=-1) for x in (own, wrong)
        )
        assert (near < far).mean() > 0.9
