"""Runs are saved and logged after every step, so that a killed one goes on where it was killed."""

import pytest

from motiondiff_edu.recipes import training


@pytest.fixture(autouse=True)
def after_every_step(monkeypatch):
    monkeypatch.setattr(training, "SAVE_EVERY", 0.0)
    monkeypatch.setattr(training, "LOG_EVERY", 0.0)
