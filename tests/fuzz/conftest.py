"""How many examples: some 50 a reader, the same each time; `make fuzz` tries 2,000 new ones.

What a user hands over meets no type checker; here it is switched off, too.
"""

import os

import pytest
from hypothesis import HealthCheck, settings
from jaxtyping import config

MANY = os.environ.get("MOTIONDIFF_FUZZ", "")
USUAL = {"deadline": None, "suppress_health_check": list(HealthCheck), "database": None}
settings.register_profile("few", max_examples=50, derandomize=True, **USUAL)
settings.register_profile("many", max_examples=int(MANY or 1), **USUAL)
settings.load_profile("many" if MANY else "few")


@pytest.fixture(autouse=True)
def no_type_checks():
    config.update("jaxtyping_disable", True)
    yield
    config.update("jaxtyping_disable", False)
