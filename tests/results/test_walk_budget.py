"""The table of choices: each variant's recipe differs from its base in what its words say."""

from dataclasses import asdict

from motiondiff_edu.recipes.walkers import WALKER_TRUNK
from tools.results.walks.budget import FEET, SMALL, VARIANTS, recipe_of


def flat(tree: dict, above: str = "") -> dict:
    """{"config.target": ...}"""
    found = {}
    for key, value in tree.items():
        found |= flat(value, f"{key}.") if isinstance(value, dict) else {above + key: value}
    return found


def test_each_variant_differs_from_its_base_in_what_its_words_say():
    differing = {
        "T_p-1": {"config.T_p"},
        "T_p-5": {"config.T_p"},
        "T_p-20": {"config.T_p"},
        "linear": {"schedule"},
        "footholds": set(),  # another network, of the same sizes
        "adam": {"optimizer", "lr"},
        "unshaken": {"past_noise"},
        "eps": {"config.target", "config.skip", "loss_weights.high_noise"},
        "joints": {"loss_weights.bones"},
        "spreads": {"loss_weights.metres"},
        "alike": {"loss_weights.near"},
    }
    for name, wanted in differing.items():
        own, base = (flat(asdict(recipe_of(n))) for n in (name, VARIANTS[name][1]))
        assert {key for key in own if own[key] != base[key]} - {"name"} == wanted, name
    assert set(differing) | {"T_p-10"} == set(VARIANTS)
    assert type(FEET) is not type(SMALL) and recipe_of("footholds").config is FEET


def test_the_base_has_the_trunk_s_choices_but_for_footholds_and_the_budget():
    own, shipped = (asdict(recipe) for recipe in (recipe_of("T_p-10"), WALKER_TRUNK))
    differing = {key for key in own if own[key] != shipped[key]}
    assert differing == {"name", "config", "batch", "lr", "decay"}
