"""Intervals of few draws: what is tested here is not their width (`test_results` tests that)."""

from functools import partial

import pytest

from tools.results.intervals import interval
from tools.results.walks import scores


@pytest.fixture(autouse=True, scope="package")
def few_draws():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scores, "interval", partial(interval, draws=60))
        yield
