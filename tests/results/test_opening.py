"""How the page of results opens: sentences computed from records and bars, the contents, words for
keys, and what is folded away."""

import re

import pytest

from tools.results.page import opening as page
from tools.results.page import words
from tools.results.page.bars import BARS, Bar
from tools.results.page.claims import CLAIMS
from tools.results.page.markdown import folded, table
from tools.results.page.render import read_records, render

GOOD = Bar("walker.bone_rmse_cm", at_most=0.3)
BAD = Bar("mend.table2_ratio", at_most=1.5)
CLOSE = Bar("walker.drift_ratio", at_most=1.2)
ABSENT = Bar("dancer.bas_share", at_least=0.6)
NAMELESS = Bar("bench.new_x", at_least=2)


def record(bar: Bar, value: float, low: float, high: float, unit: str = "ratio") -> dict:
    return dict(name=bar.name, value=value, low=low, high=high, unit=unit, seeds={})


@pytest.fixture
def records(monkeypatch) -> dict[str, dict]:
    monkeypatch.setattr(page, "BARS", (GOOD, BAD, CLOSE, ABSENT, NAMELESS))
    found = (
        record(GOOD, 0.2211, 0.208, 0.234, "cm"),
        record(BAD, 1.57, 1.33, 1.82),
        record(CLOSE, 1.15, 0.973, 1.54),
        record(NAMELESS, 1.2, 1.1, 1.3),
    )
    return {one["name"]: one for one in found}


def test_the_opening_counts_and_says_what_holds(records):
    text = page.opening(records)
    assert text.startswith("# Results\n\n**What holds.** 2 of 5 goals are met.\n")
    assert (
        "* The walker: all 2 goals are met. The walker's bone error is 0.221 cm; the goal is at "
        "most 0.3.\n" in text
    )
    assert "* Diffusion dropout and reconstruction: 0 of 1 goals are met.\n" in text
    assert "The dancer:" not in text  # nothing of it was measured


def test_what_was_missed_has_its_interval_and_whether_that_reaches_the_goal(records):
    missed = page.opening(records).split("**What was missed.**")[1].split("**What is not")[0]
    assert missed.split("\n* ")[1:] == [
        "The small walkers' bone error with joints missing (walks or reconstructed pasts, "
        "whichever is larger), over that without, is 1.57 [1.33, 1.82]; the goal is at most 1.5, "
        "which the interval reaches (`mend.table2_ratio`).",
        "`bench.new_x` is 1.2 [1.1, 1.3]; the goal is at least 2 (`bench.new_x`).\n\n",
    ]


@pytest.mark.parametrize(
    "value, shown",
    [(1.57, "1.57"), (1.504, "1.504"), (1.50004, "1.50004"), (1.5, "1.5"), (1.4961, "1.5")],
)
def test_rounding_hides_no_miss(value, shown):
    assert BAD.shown(value) == shown


def test_what_is_met_by_its_value_alone_is_not_certain_and_what_is_absent_is_said(records):
    text = page.opening(records)
    uncertain = text.split("**What is not certain.**")[1].split("**What is not")[0]
    assert re.fullmatch(
        r"The walker's bone or control error, whichever grows more, in the last 3 s, over that in "
        r"the first 3 s, is [\d.]+ \[[\d.]+, [\d.]+\]; the goal is at most 1.2.\s*",
        uncertain.split("\n* ", 1)[1],
    )
    (absent,) = re.findall(r"\*\*What is not measured yet\.\*\* (.*)\n", text)
    assert absent == (
        "These measures are missing: "
        "the beat alignment of the dances beyond chance, over that of the data."
    )


def test_a_page_without_misses_says_so(monkeypatch):
    monkeypatch.setattr(page, "BARS", (GOOD,))
    text = page.opening({GOOD.name: record(GOOD, 0.1, 0.1, 0.1, "cm")})
    assert "**What holds.** 1 of 1 goals are met." in text
    assert "**What was missed.** No measured goal was missed.\n" in text
    assert "What is not" not in text
    assert (
        f"0 agree with what we measured, 0 do not, 0 remain undecided, and {len(CLAIMS)} have not"
        in text
    )


def test_the_contents_lead_to_the_anchors_that_github_makes():
    parts = [
        "# Results\n",
        "## Table 1: MoDiff's, and 4.4 (again)\n\n### Not this\n",
        "",
        "## b_c\n",
    ]
    assert page.contents(parts).splitlines()[2:] == [
        "* [Table 1: MoDiff's, and 4.4 (again)](#table-1-modiffs-and-44-again)",
        "* [b_c](#b_c)",
    ]


def test_a_key_alone_gets_its_words():
    text = table(
        ["way", "`skating_mps`"], [["`masked.50.x5`", "`fid`"], ["`mend.table2_keep5_ratio`", "3"]]
    )
    assert text.splitlines() == [
        "| way | sliding of planted feet<br>`skating_mps` |",
        "| --- | --- |",
        "| under a mask, 50 steps, each 5 times<br>`masked.50.x5` | `fid` |",
        "| small walkers, five poses kept: the larger of walks and reconstructions, over complete "
        "pasts<br>`mend.table2_keep5_ratio` | 3 |",
    ]
    assert words.in_words("there-and-back.1") == "there and back, once"
    assert words.in_words("gibbs.20").startswith(
        "there and back, 20 times, with known entries seen"
    )
    assert words.in_words("no_such_key") is None


def test_every_goal_has_words_and_every_group_shows_one_of_its_own():
    assert [bar.name for bar in BARS if bar.name not in words.GOALS] == []
    names = {bar.name for bar in BARS}
    for starts, shown in page.GROUPS.values():
        assert shown in names and shown.startswith(starts)
    grouped = sum(bar.name.startswith(starts) for bar in BARS for starts, _ in page.GROUPS.values())
    assert grouped == len(BARS)


def test_what_follows_the_first_table_is_folded_away():
    one, two = table(["a"], [["1"]]), table(["b"], [["2"]])
    text = folded(f"## Head\n\n{one}\nMore:\n\n{two}", "more")
    assert text == (
        f"## Head\n\n{one}\n<details><summary>more</summary>\n\nMore:\n\n{two}\n</details>\n"
    )
    assert folded(f"## Head\n\n{one}", "more") == f"## Head\n\n{one}"


def test_the_projects_page_has_words_for_every_heading_and_row(root, tmp_path):
    (tmp_path / "results").mkdir()
    for path in (root / "docs" / "results").glob("*.json"):
        (tmp_path / "results" / path.name).write_bytes(path.read_bytes())
    render(tmp_path, root / "benchmarks" / "results")
    lines = (tmp_path / "RESULTS.md").read_text(encoding="utf-8").splitlines()
    heads = [
        line for line, rule in zip(lines, lines[1:], strict=False) if rule.startswith("| --- ")
    ]
    first = [line.split("|")[1].strip() for line in lines if line.startswith("| ")]
    cells = [cell.strip() for head in heads for cell in head.split("|")] + first
    assert [cell for cell in cells if re.fullmatch(r"`[^`]+`", cell)] == []
    further = (tmp_path / "RESULTS_ALL.md").read_text(encoding="utf-8")
    alone = read_records(tmp_path / "results", root / "benchmarks" / "results")
    assert "| `bench.import_torch_s` |" in further and len(alone) > 300
