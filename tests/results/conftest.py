"""Intervals of few draws: what is tested here is not their width (`test_sweep` tests that)."""

from functools import partial

import pytest

from tools.results.intervals import interval, interval_over_seeds
from tools.results.walks import scores


@pytest.fixture(autouse=True, scope="package")
def few_draws():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scores, "interval", partial(interval, draws=60))
        patch.setattr(scores, "interval_over_seeds", partial(interval_over_seeds, draws=60))
        yield
