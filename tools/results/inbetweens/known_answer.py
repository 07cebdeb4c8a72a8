"""Ways of filling in, judged where the right answer is a formula.

Windows of walking under a fitted mixture.

The denoiser is exact, so that the method alone errs. Each question is another window; the mixture
is fitted once.
Source: MoFusion 4.4; MoDiff III-E; the comparison is ours.  Notebook: 15
"""

from dataclasses import asdict, dataclass

import numpy as np
import torch

from data_synth.walking import dataset
from motiondiff_edu.baselines.known_answer import METHODS, ROUNDS, draw_samples, errors_of
from motiondiff_edu.baselines.known_walks import fit_walks, holes, holes_in_the_past
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.exact import sample_mixture

from ..walks.scores import figure_of

FRAMES, S = 8, 100  # of a window; diffusion steps


@dataclass(frozen=True)
class KnownSize:
    """Windows asked about, samples of each answer, walks the mixture is fitted to."""

    questions: int = 5
    samples: int = 100
    clips: int = 40


FULL = KnownSize()
QUICK = KnownSize(questions=2, samples=20, clips=6)
ERRORS = ("mean", "spread", "share")


def known_answer_records(size: KnownSize, command: str) -> list[dict]:
    """Errors of mean, spread and shares for every hole and way.

    With intervals over questions.
    """
    walked = fit_walks(dataset(size.clips, seconds=6.0, seed=3), FRAMES, generator=_seeded(0))
    windows = sample_mixture(walked.truth, size.questions, _seeded(1))
    schedule = cosine_schedule(S)
    seeds = {"data": 3, "questions": size.questions, "samples": size.samples, "clips": size.clips}
    asked = [(name, known, False) for name, known in holes(FRAMES).items()]
    asked += [(f"past-{name}", known, True) for name, known in holes_in_the_past(FRAMES).items()]
    records = []
    for name, known, past in asked:
        questions = [walked.problem(window, known, schedule, past) for window in windows]
        for method in (*METHODS, *ROUNDS) if past else METHODS:
            found = [
                errors_of(draw_samples(one, method, size.samples, _seeded(k)), one)
                for k, one in enumerate(questions)
            ]
            rows = {kind: np.array([asdict(one)[kind] for one in found]) for kind in ERRORS}
            figures = [
                figure_of(f"{method.name}.{kind}", "", np.mean, row) for kind, row in rows.items()
            ]
            records += [
                figure.as_record(f"known-answer.{name}.", seeds, command) for figure in figures
            ]
    return records


def _seeded(seed: int) -> torch.Generator:
    return torch.Generator().manual_seed(seed)
