"""The page of results: its numbers are the records', its template names what is there, it is short.

Goals and claims are judged by the records; claims tested on earlier data stand apart.
"""

import json
import re

import pytest

from motiondiff_edu.course.anchors import headings, on_a_host
from tools.results.page import claims, goals, records, render
from tools.results.page.claims import AGREES, DIFFERS, MISSING, OPEN, Claim
from tools.results.page.goals import Goal

WORDS = 6000
DECIMAL = re.compile(r"(?<![\w.])-?\d+\.\d+(?:e-?\d+)?|\d+e-?\d+")
TEMPLATE = render.TEMPLATE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def found(root):
    files = records.read_files(root / "docs" / "results", root / "benchmarks" / "results")
    return records.by_name(files)


def record(name: str, low: float, high: float, value: float | None = None, **seeds) -> dict:
    value = (low + high) / 2 if value is None else value
    one = dict(name=name, value=value, low=low, high=high, seeds=seeds, unit="ratio")
    return one | dict(paper=None, command="c")


def named(*some: dict) -> dict[str, dict]:
    return {one["name"]: one for one in some}


# ---- the template and the page -------------------------------------------------------------------
def test_the_template_names_only_records_that_exist(found):
    assert [name for name in render.names_in(TEMPLATE) if name not in found] == []
    assert [words for words, some in render.stars_in(TEMPLATE) if not set(some) & set(found)] == []


def test_a_name_that_does_not_exist_is_found():
    template = "{{walker.x}} {{about b.c clips}}\n```table\na | b => *.d\nrow => e\n```\n"
    assert list(render.names_in(template)) == ["walker.x", "b.c"]
    assert dict(render.stars_in(template)) == {"row": ["e.d"], "b": ["e.d"]}


def test_no_number_is_typed_but_those_of_the_papers_and_settings():
    """The papers' are in italics or in rows that begin so; settings and limits are in code."""
    prose = re.sub(r"^```(goals|claims)\n.*?^```", "", TEMPLATE, flags=re.M | re.S)
    prose = re.sub(r"^\*.*\|.*$|\*[^*\n]+\*|`[^`\n]+`|\{\{[^}]*\}\}", "", prose, flags=re.M)
    assert DECIMAL.findall(prose) == []


def test_each_number_on_the_page_changes_with_its_record(found):
    """A page of other records has none of the numbers of these, but those of the template."""
    ends = ("value", "low", "high")
    other = {
        name: one | {end: one[end] and 3.7 * one[end] + 1000.3 for end in ends}
        for name, one in found.items()
    }
    page = render.page(TEMPLATE, other)
    new = {part for one in other.values() for part in DECIMAL.findall(records.cell(one))}
    settings = {
        part for one in other.values() for part in DECIMAL.findall(json.dumps(one["seeds"]))
    }
    left = set(DECIMAL.findall(page)) - new - set(DECIMAL.findall(TEMPLATE)) - settings
    assert {x for x in left if float(x) < 1000} == set()
    assert DECIMAL.findall(render.page(TEMPLATE, found)) != DECIMAL.findall(page)


def test_the_pages_are_those_of_the_records_and_short(root, found):
    page = (root / "docs" / "RESULTS.md").read_text(encoding="utf-8")
    assert page == render.page(TEMPLATE, found), "write it anew: python -m tools.results --render"
    assert len(page.split()) <= WORDS
    every = (root / "docs" / "RESULTS_ALL.md").read_text(encoding="utf-8")
    assert [name for name in found if f"| `{name}` |" not in every] == []


def test_links_to_headings_of_the_pages_lead_there(root):
    """Those of the page itself, and those of notebooks and other pages."""
    there = {
        page: {on_a_host(one) for one in headings((root / "docs" / page).read_text("utf-8"))}
        for page in ("RESULTS.md", "RESULTS_ALL.md")
    }
    links = re.findall(r"\]\((RESULTS_ALL\.md|)#([^)]+)\)", TEMPLATE)
    for path in [*root.glob("notebooks/*.ipynb"), *root.glob("docs/*.md"), root / "README.md"]:
        text = path.read_text(encoding="utf-8")
        links += re.findall(r"\]\([./a-z]*(RESULTS(?:_ALL)?\.md)#([^)]+)\)", text)
    assert len(links) > 8
    assert [link for link in links if link[1] not in there[link[0] or "RESULTS.md"]] == []


def test_places_rows_and_columns():
    one = record("a.x", 0.1, 0.3, clips=7, rate=5e-05) | {"unit": "cm"}
    other = record("b.x", 2, 2) | {"unit": "cm"}
    template = (
        "{{a.x}}; {{value a.x}}; {{percent a.x}} %; {{about a.x clips}}; {{no.x}}\n"
        "```table\nwho | error => *.x | rate => *.x@rate\nfirst => a\nsecond => b\n"
        "*paper* | 9.5 | {{a.x}}\nnone => c\n```\n"
    )
    assert render.page(template, named(one, other)).splitlines() == [
        "0.2 [0.1, 0.3] cm; 0.2; 20 %; 7; -",
        "| who | error | rate |",
        "| --- | --- | --- |",
        "| first | 0.2 [0.1, 0.3] | 5e-05 |",
        "| second | 2 | - |",
        "| *paper* | 9.5 | 0.2 [0.1, 0.3] cm |",
        "| none | - | - |",
    ]


def test_both_pages_are_written_from_files_and_a_name_in_two_of_them_is_an_error(
    tmp_path, monkeypatch
):
    (tmp_path / "results").mkdir()
    path = tmp_path / "results" / "walker.json"
    path.write_text(json.dumps([record("walker.x", 0.1, 0.3)]))
    monkeypatch.setattr(render, "TEMPLATE", tmp_path / "template.md")
    render.TEMPLATE.write_text("It is {{walker.x}} and {{walker.y}}.\n")
    assert render.render(tmp_path, tmp_path / "bench") == ["walker.y"]
    assert (tmp_path / "RESULTS.md").read_text() == "It is 0.2 [0.1, 0.3] and -.\n"
    assert "## walker\n\n`c`\n" in (tmp_path / "RESULTS_ALL.md").read_text()
    path.with_name("old.json").write_text(path.read_text())
    with pytest.raises(ValueError, match="walker.x is in old.json and in walker.json"):
        render.render(tmp_path, tmp_path / "bench")


# ---- goals ---------------------------------------------------------------------------------------
GOALS = """# Walker
w.a | at most 0.3 | the error
w.b | 0.5 to 1.5 | the spread
# Dancer
d.a | at least 2 | the beat
d.b | at least 5 | the rest
"""


def test_goals_are_met_close_missed_or_not_measured():
    some = goals.read_goals(GOALS)
    made = named(record("w.a", 0.2, 0.25), record("w.b", 1.2, 1.6), record("d.a", 1, 2.1, 1.9))
    assert list(goals.judged(some, made).values()) == ["met", "close", "missed", "not measured"]
    texts = goals.places(some, made)
    assert texts["number of goals met"] == "2" and texts["number of goals"] == "4"
    assert texts["goals by group"] == "Walker 2 of 2; Dancer 0 of 2"
    assert texts["goals missed"].splitlines()[2:] == ["| the beat | at least 2 | 1.9 [1, 2.1] |"]
    assert texts["goals close"].splitlines()[2:] == ["| the spread | 0.5 to 1.5 | 1.4 [1.2, 1.6] |"]
    assert "| the rest | `d.b` | at least 5 | - | not measured |" in goals.goals_table(some, made)
    with pytest.raises(ValueError, match="w.c: write 'at least x'"):
        Goal("w.c", "around 3", "", "").met(3)


@pytest.mark.parametrize(
    "value, shown",
    [(1.57, "1.57"), (1.504, "1.504"), (1.50004, "1.50004"), (1.5, "1.5"), (1.4961, "1.5")],
)
def test_rounding_hides_no_miss(value, shown):
    assert Goal("x", "at most 1.5", "", "").shown(value) == shown


# ---- claims --------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    "side, low, high, verdict",
    [("least", 1.1, 1.4, AGREES), ("least", 0.8, 1.2, OPEN), ("least", 0.5, 0.9, DIFFERS),
     ("most", 1.1, 1.4, DIFFERS), ("most", 0.8, 1.2, OPEN), ("most", 0.5, 0.9, AGREES)],
)  # fmt: skip
def test_an_interval_is_on_the_right_side_or_the_wrong_or_across(side, low, high, verdict):
    claim = Claim("x", "1", "a.b", f"at {side} 1")
    assert claim.verdict(named(record("a.b", low, high))) == verdict


def test_a_limit_that_is_a_record_has_an_interval_too():
    claim, limit = Claim("x", "1", "a.b", "at least 0.5 of c.d"), record("c.d", 0.8, 1.2)
    for low, high, verdict in (
        (0.61, 0.7, AGREES), (0.55, 0.7, OPEN), (0.3, 0.45, OPEN), (0.3, 0.39, DIFFERS),
    ):  # fmt: skip
        assert claim.verdict(named(record("a.b", low, high), limit)) == verdict
    most = Claim("x", "1", "a.b", "at most 1 of c.d")
    assert most.verdict(named(record("a.b", 0.7, 0.79), limit)) == AGREES
    assert most.verdict(named(record("a.b", 0.7, 0.9), limit)) == OPEN
    assert claim.verdict(named(record("a.b", 0.7, 0.8))) == MISSING == claim.verdict(named(limit))
    assert claim.verdict(named(limit, record("a.b", 0.7, 0.8) | {"low": None})) == MISSING
    with pytest.raises(ValueError, match="claim 'x': write"):
        Claim("x", "1", "a.b", "about 3").verdict({})


def test_claims_are_counted_and_stand_in_a_table():
    made = named(record("a.v.x", 0.2, 0.4), record("dancer.x", 0.2, 0.4))
    some = claims.read_claims(
        "one | 3.1 | a.v.x | at least 0\n"
        "of both | 3.2 | dancer.x | at least 0.9 of a.v.x\n"
        "another | 3.3 | dancer.x | at least 0.5\n"
        "a third | 3.3 | dancer.x | at least 0.6\n"
        "later | 3.4 | b.x | at least 0.5\n"
    )
    texts = claims.places(some, made)
    counts = [texts[f"number of claims: {word}"] for word in (AGREES, DIFFERS, OPEN, MISSING)]
    assert texts["number of claims"] == "4", "those that can be judged"
    assert counts == ["1", "2", "1", "1"]
    assert f"| one | 3.1 | **{AGREES}** | 0.3 [0.2, 0.4] | at least 0 |" in texts["claims"]
    assert "at least 0.9 of 0.3 [0.2, 0.4] |" in texts["claims"]
