"""The card of what is shipped says how it was made, in the names of the recipe."""

import copy
import json
from dataclasses import asdict

import pytest

from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.recipes.dancer import SHIPPED_DANCERS
from motiondiff_edu.recipes.inbetweener import INBETWEENER
from motiondiff_edu.recipes.mover import MOVER
from motiondiff_edu.recipes.walker import SHIPPED


@pytest.mark.parametrize(
    "recipe", [*SHIPPED, *SHIPPED_DANCERS, INBETWEENER, MOVER], ids=lambda one: one.name
)
def test_a_card_has_its_recipe(recipe):
    said = copy.deepcopy(checkpoints.load(recipe.name).card["recipe"])
    is_now = json.loads(json.dumps(asdict(recipe)))
    config, name = is_now.pop("config"), is_now.pop("name")
    assert name == recipe.name and config
    # the share of the steps in bfloat16, and how often a run was saved, are none of a recipe
    for record in (said, said.get("ear") or {}):
        record.pop("save_every", None)
        record.pop("bfloat16_share", None)
    assert said == is_now
