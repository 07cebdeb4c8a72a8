"""Records of measured figures: complete, honest about their spread, never half written."""

import json
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))
import records  # noqa: E402


def test_a_record_has_median_and_interval():
    one = records.record("bench.x", [1.0, 2.0, 9.0, 3.0, 2.5], unit="ratio", command="python x.py")
    assert set(one) == {*records.KEYS, "machine"}
    assert (
        one["value"] == 2.5
        and one["low"] <= 2.5 <= one["high"]
        and one["low"] >= 1
        and one["high"] <= 9
    )
    assert one["seeds"] == [0, 1, 2, 3, 4] and one["paper"] is None


def test_the_record_names_the_processor(tmp_path, monkeypatch):
    said = tmp_path / "cpuinfo"
    said.write_text("processor\t: 0\nmodel name\t: Fast (R) Chip @ 3 GHz\nflags\t: avx\n")
    monkeypatch.setattr(records, "CPU_INFO", said)
    monkeypatch.setattr(records.os, "sched_getaffinity", lambda pid: {0, 1}, raising=False)
    assert records.machine() == "Fast (R) Chip @ 3 GHz, 2 cores"
    monkeypatch.setattr(records, "CPU_INFO", tmp_path / "none")
    monkeypatch.setattr(records.platform, "processor", lambda: "riscv")
    monkeypatch.setattr(records.os, "sched_getaffinity", lambda pid: {0}, raising=False)
    assert records.machine() == "riscv, 1 core"


@pytest.mark.parametrize("values", [[], [1.0, float("nan")]])
def test_what_was_not_measured_is_refused(values):
    with pytest.raises(ValueError, match="bench.x"):
        records.record("bench.x", values, unit="ratio", command="c")


def test_written_records_read_back(tmp_path):
    made = [records.record("bench.x", [1.0], unit="ratio", command="c")]
    records.write_records(tmp_path / "new" / "x.json", made)
    assert json.loads((tmp_path / "new" / "x.json").read_text()) == made
    assert [p.name for p in (tmp_path / "new").iterdir()] == ["x.json"]
    plain = tmp_path / "plain"
    plain.touch()
    assert (
        tmp_path / "new" / "x.json"
    ).stat().st_mode == plain.stat().st_mode  # readable by whom the umask says


def test_an_incomplete_record_is_not_written(tmp_path):
    with pytest.raises(ValueError, match="keys"):
        records.write_records(tmp_path / "x.json", [{"name": "bench.x", "value": 1.0}])
    assert not (tmp_path / "x.json").exists()
