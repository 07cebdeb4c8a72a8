"""Every departure says where its gain is measured."""

import json
import re
from pathlib import Path

import pytest

import motiondiff_edu.beyond

ROOT = Path(__file__).parents[2]
FILES = sorted(Path(motiondiff_edu.beyond.__file__).parent.glob("[a-z]*.py"))
NAMES = [
    record["name"]
    for folder in ("docs/results", "benchmarks/results")
    for path in (ROOT / folder).glob("*.json")
    for record in json.loads(path.read_text(encoding="utf-8"))
]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_departure_names_the_rows_of_its_gain(path):
    head = path.read_text(encoding="utf-8").split('"""')[1]
    told = re.search(r"^Gain: docs/RESULTS(?:_ALL)?\.md.*?(?=^\S+: |\Z)", head, re.M | re.S)
    assert told, f"{path.name} does not say where its gain is measured"
    rows = re.findall(r"`([\w.-]+?)(?:\.\*)?`", told[0])
    assert rows
    group = ""
    for row in rows:
        row = group + row if row.startswith(".") else row
        group = row.split(".")[0]
        assert any(name == row or name.startswith(f"{row}.") for name in NAMES), row
