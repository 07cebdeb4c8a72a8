"""Ridge regression from what is visible.

Against least squares with the penalty as extra rows, and by hand.
"""

import numpy as np
import pytest
import torch

from data_synth.walking import dataset
from motiondiff_edu.baselines import ridge
from motiondiff_edu.performers.windows import Windows

DRAW = torch.Generator().manual_seed(3)
ROWS = torch.randn(40, 7, generator=DRAW, dtype=torch.float64) @ torch.randn(
    7, 7, generator=DRAW, dtype=torch.float64
)


def test_it_is_the_ridge_regression_that_lstsq_finds_with_the_penalty_as_rows():
    known = torch.tensor(
        [
            [True, False, True, True, False, True, False],
            [False, True, True, False, True, True, True],
        ]
    )
    model, x = ridge.fit(ROWS, ridge=0.3), ROWS[:2] + 1.0
    filled = model.fill(x, known)
    centred = (ROWS - ROWS.mean(0)).numpy()
    for row, have in enumerate(known.numpy()):
        inputs = np.vstack([centred[:, have], np.sqrt(0.3 * len(ROWS)) * np.eye(have.sum())])
        outputs = np.vstack([centred[:, ~have], np.zeros((have.sum(), (~have).sum()))])
        weight = np.linalg.lstsq(inputs, outputs, rcond=None)[0]
        mean = ROWS.mean(0).numpy()
        wanted = mean[~have] + (x[row].numpy()[have] - mean[have]) @ weight
        np.testing.assert_allclose(filled[row, ~known[row]], wanted, rtol=1e-9)
        assert torch.equal(filled[row, known[row]], x[row, known[row]])


def test_two_numbers_by_hand():
    # variances 4 and 9, covariance 3: E[b | a] = mean_b + 3 / 4 (a - mean_a), almost, for a ridge
    # of nearly nothing
    model = ridge.ConditionalMean(
        torch.tensor([1.0, 2.0]).double(), torch.tensor([[4.0, 3], [3, 9]]).double(), 1e-9
    )
    filled = model.fill(torch.tensor([[5.0, float("nan")]]), torch.tensor([[True, False]]))
    assert filled.tolist() == [[5.0, pytest.approx(5.0)]]
    heavy = ridge.ConditionalMean(model.mean, model.covariance, 4.0)  # (4 + 4)^-1 instead of 4^-1
    assert heavy.fill(torch.tensor([[5.0, 0.0]]), torch.tensor([[True, False]]))[
        0, 1
    ] == pytest.approx(3.5)


def test_where_nothing_is_known_the_mean_stands_and_where_all_is_nothing_changes():
    model, x = ridge.fit(ROWS), ROWS[:3]
    nothing = model.fill(torch.full_like(x, float("nan")), torch.zeros(x.shape, dtype=torch.bool))
    torch.testing.assert_close(nothing, ROWS.mean(0).expand(3, -1))
    assert torch.equal(model.fill(x, torch.ones(x.shape, dtype=torch.bool)), x)


def test_windows_of_walks_are_filled_better_than_by_the_mean_pose():
    clips = dataset(12, 6.0, seed=5)
    windows = Windows.of(clips, 10, 7)
    model = ridge.fit_windows(windows)
    rows = windows.starts[1::211, None] + torch.arange(17)
    poses = windows.pose_scaler.inverse(windows.poses[rows[:, :10]])
    control = windows.control_scaler.inverse(windows.control[rows])
    known = torch.ones(poses.shape, dtype=torch.bool)
    known[:, :, 3:15] = False  # the left leg
    holes = poses.masked_fill(~known, float("nan"))
    repaired = model.reconstruct(holes, known, control)
    assert torch.equal(repaired[known], poses[known])
    far = (windows.pose_scaler.mean - poses)[~known].square().mean()
    assert (repaired - poses)[~known].square().mean() < 0.25 * far


def test_what_cannot_be_fitted():
    with pytest.raises(ValueError, match="two rows and a ridge above 0"):
        ridge.fit(ROWS[:1])
    with pytest.raises(ValueError, match="two rows and a ridge above 0"):
        ridge.fit(ROWS, ridge=0.0)
