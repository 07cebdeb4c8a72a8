"""What RESULTS says of shipped weights was measured with those that are shipped."""

import json

from motiondiff_edu.pretrained import checkpoints
from tools.results.__main__ import SWEEPS
from tools.results.walks.parts import weights_digest


def digests_of(record: dict) -> list[str]:
    found = record["seeds"].get("weights") or []
    if isinstance(found, dict):
        return list(found.values())
    return [found] if isinstance(found, str) else found


def test_records_are_of_the_weights_that_are_shipped(root):
    trained = {name for name, one in SWEEPS.items() if one.weights is None}
    shipped = {weights_digest(path) for path in checkpoints.available().values()}
    of_other_weights = {
        f"{path.name}: {digest}"
        for path in (root / "docs" / "results").glob("*.json")
        if path.name.split(".")[0] not in trained
        for record in json.loads(path.read_text(encoding="utf-8"))
        for digest in digests_of(record)
        if digest not in shipped
    }
    assert not of_other_weights, "measure these anew: python -m tools.results --only PART"
