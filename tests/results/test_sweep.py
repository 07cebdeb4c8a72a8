"""The runner of sweeps: it resumes, and pairs variants by seed and clip; intervals are over both.

A sweep here trains nothing: a variant is a number that is added to rows which differ by seed and
clip.
"""

import json

import numpy as np
import pytest

from tools.results import sweep as runner
from tools.results.intervals import interval, interval_over_seeds
from tools.results.sweep import GROUPS, Sweep, Variant, minus
from tools.results.walks.scores import Kind

CLIPS = 12
MEAN = Kind("cm", ("error",), np.nanmean)


def hard(seed: int, clips: int = CLIPS) -> np.ndarray:
    """What all variants have in common: some clips and some seeds are far harder than others."""
    return 10.0 * seed + np.random.default_rng(0).normal(0, 5, clips)


class Lab:
    """A sweep of three variants, and which of its trainings were run."""

    def __init__(self, seeds=(0, 1, 2), clips: int = CLIPS, steps: int = 7):
        self.trained: list[tuple[str, int]] = []

        def train(name: str, seed: int) -> float:
            self.trained.append((name, seed))
            return variants[name].recipe

        def measure(name: str, added: float, seed: int) -> dict:
            return {"error": hard(seed, clips) + added, "whole": np.array([100.0 * seed + added])}

        variants = {
            "base": Variant("the recipe", 0.0),
            "more": Variant("a bit more", 0.5, {"base": "base"}),
            "twice": Variant("twice as much", 1.0, {"base": "base", "more": "more"}),
        }
        self.sweep = Sweep(
            "lab", variants, train, measure,
            {"error_cm": MEAN, "whole": Kind("", ("whole",), np.mean)},
            {"error_cm_minus_{}": minus(MEAN)},
            lambda name: {"steps": steps, "clips": clips}, seeds,
        )  # fmt: skip

    def run(self, name: str, folder) -> dict[str, dict]:
        made = runner.run(self.sweep, name, folder, "c")
        assert all(one["name"].startswith(f"lab.{name}.") for one in made)
        return {one["name"].removeprefix(f"lab.{name}."): one for one in made}


def test_a_variant_is_trained_measured_and_not_again(tmp_path):
    lab = Lab()
    first = lab.run("base", tmp_path)
    assert lab.trained == [("base", 0), ("base", 1), ("base", 2)]
    assert lab.run("base", tmp_path) == first and len(lab.trained) == 3
    expected = np.mean([hard(seed) for seed in range(3)])
    assert first["error_cm"]["value"] == pytest.approx(expected, rel=1e-3)
    assert first["error_cm.seed2"]["value"] == pytest.approx(hard(2).mean(), rel=1e-3)
    assert first["error_cm"]["seeds"] == {"steps": 7, "clips": CLIPS, "trainings": 3}
    assert first["whole"]["value"] == pytest.approx(100) and first["whole"]["low"] < 100


def test_a_killed_run_continues_with_the_seed_that_it_was_at(tmp_path):
    lab = Lab()
    whole = lab.run("base", tmp_path / "whole")
    short = Lab(seeds=(0,))
    short.run("base", tmp_path / "killed")
    again = Lab()
    assert again.run("base", tmp_path / "killed") == whole
    assert again.trained == [("base", 1), ("base", 2)]
    kept = json.loads((tmp_path / "killed" / "base.json").read_text())
    assert list(kept["seeds"]) == ["0", "1", "2"]


def test_rows_of_a_training_that_fails_are_not_lost(tmp_path):
    Lab(seeds=(0, 1)).run("base", tmp_path)
    before = (tmp_path / "base.json").read_text()
    broken = Lab()
    failing = Sweep(**vars(broken.sweep) | {"train": lambda name, seed: 1 / 0})
    with pytest.raises(ZeroDivisionError):
        runner.run(failing, "base", tmp_path, "c")
    assert (tmp_path / "base.json").read_text() == before


def test_rows_of_other_settings_are_refused_and_stay(tmp_path):
    Lab(steps=7).run("base", tmp_path)
    before = (tmp_path / "base.json").read_text()
    with pytest.raises(ValueError, match=r"measured with {'steps': 7}, not with {'steps': 8}"):
        Lab(steps=8).run("base", tmp_path)
    assert (tmp_path / "base.json").read_text() == before


def test_differences_are_paired_by_seed_and_clip(tmp_path):
    """Seeds and clips differ by far more than the variants; paired, the difference is exact."""
    lab = Lab()
    lab.run("base", tmp_path)
    more = lab.run("more", tmp_path)
    assert more["error_cm"]["high"] - more["error_cm"]["low"] > 10
    gained = more["error_cm_minus_base"]
    assert [gained[side] for side in ("value", "low", "high")] == pytest.approx([0.5] * 3, abs=1e-2)
    twice = lab.run("twice", tmp_path)
    assert twice["error_cm_minus_base"]["value"] == pytest.approx(1.0, abs=1e-2)
    assert twice["error_cm_minus_more"]["high"] == pytest.approx(0.5, abs=1e-2)


def test_a_rival_with_fewer_seeds_is_compared_on_those_that_both_have(tmp_path, capsys):
    Lab(seeds=(1, 2)).run("base", tmp_path)
    more = Lab().run("more", tmp_path)
    assert more["error_cm_minus_base"]["value"] == pytest.approx(0.5, abs=1e-2)
    alone = Lab().run("more", tmp_path / "alone")
    assert "error_cm_minus_base" not in alone
    assert "there are no rows of base to compare with" in capsys.readouterr().out


def test_a_rival_of_other_clips_is_refused(tmp_path):
    Lab(clips=5).run("base", tmp_path)
    path = tmp_path / "base.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"clips": CLIPS}))
    with pytest.raises(ValueError, match="base was measured on other clips"):
        Lab().run("more", tmp_path)


def test_numbers_that_are_missing_are_left_out_and_kept_as_none(tmp_path):
    lab = Lab(seeds=(0,))
    holed = Sweep(
        **vars(lab.sweep)
        | {"measure": lambda *_: {"error": np.array([1.0, np.nan, 3.0]), "whole": np.ones(1)}}
    )
    made = {one["name"]: one for one in runner.run(holed, "base", tmp_path, "c")}
    assert made["lab.base.error_cm"]["value"] == 2
    assert json.loads((tmp_path / "base.json").read_text())["seeds"]["0"]["error"] == [1, None, 3]
    assert "lab.base.error_cm.seed0" not in made, "one training has no seeds to tell apart"


# ---- intervals -----------------------------------------------------------------------------------
def test_an_interval_over_seeds_is_wide_where_trainings_differ():
    alike = np.tile(np.linspace(0, 1, 40), (3, 1))
    apart = alike + np.array([[-2.0], [0.0], [2.0]])
    value, low, high = interval_over_seeds(np.mean, alike)
    assert value == pytest.approx(0.5) and low < 0.5 < high and high - low < 0.3
    wide = interval_over_seeds(np.mean, apart)
    assert wide[0] == pytest.approx(0.5) and wide[1] < -0.5 and wide[2] > 1.5


def test_an_interval_holds_the_mean_and_narrows_with_the_clips():
    rng = np.random.default_rng(5)
    few, many = (interval(np.mean, rng.normal(3, 1, n)) for n in (20, 2000))
    assert few[1] < 3 < few[2] and many[2] - many[1] < 0.3 * (few[2] - few[1])
    one = rng.normal(3, 1, 50)
    assert interval_over_seeds(np.mean, one[None])[1] == pytest.approx(
        interval(np.mean, one)[1], abs=0.1
    )


@pytest.mark.parametrize("over", [interval, lambda f, x, **k: interval_over_seeds(f, x[None], **k)])
def test_clips_of_one_person_are_drawn_together(over):
    """Nineteen clips of one person and one of another are two persons, not twenty."""
    values = np.array([1.0] * 19 + [5.0])
    persons = np.array(["a"] * 19 + ["b"])
    alone, together = over(np.mean, values), over(np.mean, values, groups=persons)
    assert alone[0] == together[0] == pytest.approx(1.2)
    assert together[1] == 1 and together[2] == 5 and alone[2] < 3


def test_a_sweep_draws_groups_and_whole_numbers_together(tmp_path):
    """A row `group` says whose the clips are; a row of one number shares the draw of the seeds."""
    rows = {"error": np.array([1.0, 1.0, 1.0, 9.0]), GROUPS: np.array(["a", "a", "a", "b"])}
    lab = Lab(seeds=(0,))
    both = Kind("", ("error", "whole"), lambda a, b: a.mean() + b.mean())
    grouped = Sweep(
        **vars(lab.sweep)
        | {"measure": lambda *_: rows | {"whole": np.ones(1)}}
        | {"kinds": {"error_cm": MEAN, "both": both}}
    )
    made = {one["name"]: one for one in runner.run(grouped, "base", tmp_path, "c")}
    assert made["lab.base.error_cm"]["high"] == 9 and made["lab.base.error_cm"]["low"] == 1
    assert made["lab.base.both"]["value"] == pytest.approx(4)


def test_a_difference_drawn_apart_would_be_wide():
    """What pairing is worth: the same numbers, shuffled against each other."""
    own, other = hard(0) + 0.5, hard(0)
    paired = interval(lambda a, b: a.mean() - b.mean(), own, other)
    apart = interval(lambda a, b: a.mean() - b.mean(), own, np.roll(other, 5))
    assert paired[2] - paired[1] < 1e-9 < 1 < apart[2] - apart[1]
