"""Methods of filling in, measured on tasks whose answer is a formula.

The data are windows of walking under a fitted mixture.

The denoiser is exact, so that all errors come from the method. Each question is another window; the
mixture is fitted once.
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

from ..walks.scores import measure_of

FRAMES, S = 8, 100  # of a window; diffusion steps


@dataclass(frozen=True)
class KnownSize:
    """Number of windows, of samples of each answer, and of walks for the mixture."""

    questions: int = 5
    samples: int = 100
    clips: int = 40


FULL = KnownSize()
QUICK = KnownSize(questions=2, samples=20, clips=6)
ERRORS = ("mean", "spread", "share")


def known_answer_records(size: KnownSize, command: str) -> list[dict]:
    """Errors of mean, standard deviation and shares for every hole and method.

    The intervals are over windows.
    """
    walked = fit_walks(dataset(size.clips, seconds=6.0, seed=3), FRAMES, generator=_seeded(0))
    windows = sample_mixture(walked.truth, size.questions, _seeded(1))
    schedule = cosine_schedule(S)
    seeds = {"data": 3, "questions": size.questions, "samples": size.samples, "clips": size.clips}
    questions = [(name, known, False) for name, known in holes(FRAMES).items()]
    questions += [
        (f"past-{name}", known, True) for name, known in holes_in_the_past(FRAMES).items()
    ]
    records = []
    for name, known, past in questions:
        problems = [walked.problem(window, known, schedule, past) for window in windows]
        for method in (*METHODS, *ROUNDS) if past else METHODS:
            found = [
                errors_of(draw_samples(one, method, size.samples, _seeded(k)), one)
                for k, one in enumerate(problems)
            ]
            rows = {kind: np.array([asdict(one)[kind] for one in found]) for kind in ERRORS}
            measures = [
                measure_of(f"{method.name}.{kind}", "", np.mean, row) for kind, row in rows.items()
            ]
            records += [
                measure.as_record(f"known-answer.{name}.", seeds, command) for measure in measures
            ]
    return records


def _seeded(seed: int) -> torch.Generator:
    return torch.Generator().manual_seed(seed)
