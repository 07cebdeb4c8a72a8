"""Verdicts and tables are computed from records: intervals on either side, across, and missing."""

import json

import pytest

from tools.results.dances import tables
from tools.results.dances.budget import DANCES, RIVALS, VARIANTS
from tools.results.page import claims
from tools.results.page.claims import AGREES, CLAIMS, DIFFERS, MISSING, OPEN, Claim
from tools.results.page.render import render


def record(name: str, low: float, high: float, value: float | None = None, **seeds) -> dict:
    value = (low + high) / 2 if value is None else value
    return dict(
        name=name,
        value=value,
        low=low,
        high=high,
        seeds=seeds,
        unit="ratio",
        paper=None,
        command="c",
    )


def named(*records: dict) -> dict[str, dict]:
    return {one["name"]: one for one in records}


@pytest.mark.parametrize(
    "sign, low, high, verdict",
    [(1, 1.1, 1.4, AGREES), (1, 0.8, 1.2, OPEN), (1, 0.5, 0.9, DIFFERS),
     (-1, 1.1, 1.4, DIFFERS), (-1, 0.8, 1.2, OPEN), (-1, 0.5, 0.9, AGREES)],
)  # fmt: skip
def test_an_interval_is_on_the_right_side_or_the_wrong_or_across(sign, low, high, verdict):
    assert Claim("x", "1", "a.b", sign).verdict(named(record("a.b", low, high))) == verdict


def test_a_limit_that_was_measured_has_an_interval_too():
    claim = Claim("x", "1", "a.b", 1, 0.5, of="c.d")
    assert claim.rule == "at least 0.5 of `c.d`"
    limit = record("c.d", 0.8, 1.2)
    for low, high, verdict in (
        (0.61, 0.7, AGREES),
        (0.55, 0.7, OPEN),
        (0.3, 0.45, OPEN),
        (0.3, 0.39, DIFFERS),
    ):
        assert claim.verdict(named(record("a.b", low, high), limit)) == verdict
    assert claim.verdict(named(record("a.b", 0.7, 0.8))) == MISSING == claim.verdict(named(limit))
    assert claim.verdict(named(limit, record("a.b", 0.7, 0.8) | {"low": None})) == MISSING


def test_every_claim_is_listed_with_its_verdict_and_once_in_the_sum():
    assert claims.claims({}).count(f"**{MISSING}**") == len(CLAIMS) + 1
    found = claims.claims(
        named(
            record("dancer.bone_gain", 0.2, 0.4),
            record("dance-time.transformer.step_over_x0", 0.5, 0.7),
        )
    )
    lines = found.splitlines()
    assert any(
        "(shipped weights)" in line and f"**{AGREES}**" in line and "0.3 [0.2, 0.4]" in line
        for line in lines
    )
    assert any("trains no faster" in line and f"**{DIFFERS}**" in line for line in lines)
    (agrees,) = [line for line in lines if line.startswith(f"* **{AGREES}** (1)")]
    assert agrees.endswith("kinematic losses help: the bone error falls (shipped weights)")
    assert f"* **{MISSING}** ({len(CLAIMS) - 2})" in found


def test_claims_ask_for_measures_that_are_measured():
    rows = {f"dance-budget.{name}" for name in VARIANTS}
    for claim in CLAIMS:
        for name in filter(None, (claim.measure, claim.of, *claim.beside)):
            group, _, measure = name.rpartition(".")
            if not group.startswith("dance-budget"):
                continue
            assert group in rows
            for kind in ("_minus_", "_over_"):
                if kind in measure and not measure.endswith("_data"):
                    own = group.removeprefix("dance-budget.")
                    rival = measure.split(kind)[1]
                    assert rival in (VARIANTS[own][1], *RIVALS.get(own, ()))


def test_table_1_has_the_papers_rows_the_datas_and_ours():
    kinds = ("bas_music", "fid", "diversity", "multimodality", "bas")
    mine = [
        record(f"dance-budget.alpha_bar.{kind}", 0.1 * k, 0.3 * k, trained_steps=77, dances=2)
        for k, kind in enumerate(kinds)
    ]
    mine += [
        record(f"dance-budget.alpha_bar.{kind}_data", 2 + k, 3 + k) for k, kind in enumerate(kinds)
    ]
    text = tables.table_1(named(*mine))
    assert "| MoFusion (Ours) (the paper, AIST++) | 0.253 | 50.3 | 9.09 | 11.4 |" in text
    assert "| Ground Truth (the paper, AIST++) | 0.237 | 17.1 | 8.19 | n/a |" in text
    data, ours = (
        next(line for line in text.splitlines() if who in line) for who in ("**data**", "77 steps")
    )
    assert "2.5 [2, 3]" in data and "6.5 [6, 7]" in data
    assert "weighted by alpha_bar**, 77 steps | 0 | 0.2 [0.1, 0.3]" in ours and "stored" in ours
    assert text.count("not measured yet") == 4 + 4 and text.count("**data**") == 1
    old = record("dance-budget.x0.bas", 0.5, 0.5, trained_steps=66)
    other = record("dance-budget.x0.bas_data", 9, 9)
    both = tables.table_1(named(*mine, old, other))
    assert "66 steps, on the old dances" in both and "2.5 [2, 3]" in both
    alone = tables.table_1(named(old, other))
    assert "**data** (same steps, the old dances)" in alone


def test_the_page_marks_what_is_stored(tmp_path):
    (tmp_path / "results").mkdir()
    (tmp_path / "bench").mkdir()
    rows = [record(f"dance-budget.v.{kind}", 0.2, 0.6, trained_steps=77) for kind in tables.SHOWN]
    rows += [record("dance-budget.v.bas_share_minus_no-feet", -0.2, -0.1)]
    (tmp_path / "results" / "dance-budget.v.json").write_text(json.dumps(rows))
    attention = [
        record(f"attention.{at}beat_mass{k}", 1, 1.4)
        for at in ("", "down-20.")
        for k in ("", "_over_shuffled")
    ]
    (tmp_path / "results" / "attention.json").write_text(json.dumps(attention))
    render(tmp_path, tmp_path / "bench")
    page = (tmp_path / "RESULTS.md").read_text()
    (line,) = [line for line in page.splitlines() if line.startswith("| `v`: target v")]
    assert (
        "| stored, 77 steps, on the old dances |" in line
        and "-0.15 [-0.2, -0.1]" in line
        and line.count("0.4 [0.2, 0.6]") == len(tables.SHOWN)
    )
    assert (
        "| down-20 | 1.2 [1, 1.4] | 1.2 [1, 1.4] | - | - |" in page and "attention.png" not in page
    )
    (tmp_path / "results" / "attention.png").touch()
    render(tmp_path, tmp_path / "bench")
    assert "](results/attention.png)" in (tmp_path / "RESULTS.md").read_text()


@pytest.mark.parametrize(("dances", "old"), [(1, True), (DANCES, False), (None, True)])
def test_a_row_and_a_claim_of_earlier_dances_say_so(dances, old):
    about = {"trained_steps": 77} | ({"dances": dances} if dances else {})
    kinds = (*tables.SHOWN, "bas_share_minus_x0")
    rows = [record(f"dance-budget.mfcc.{kind}", 0.02, 0.04, **about) for kind in kinds]
    records = {one["name"]: one for one in rows}
    page = tables.choices(records)
    assert ("Rows *on the old dances*" in page) == old
    assert ("| stored, 77 steps, on the old dances |" in page) == old
    assert ("| stored, 77 steps |" in page) != old
    told = claims.claims(records)
    assert told.count("*(tested on the old dances)*") == 2 * old
    assert f"**{AGREES}** (1)" in told
