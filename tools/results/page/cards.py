"""The measured numbers on the cards of the shipped weights.

So a card shows how good its weights are.
"""

from dataclasses import replace
from pathlib import Path

from motiondiff_edu.pretrained import checkpoints

from ..walks.parts import kept_records, weights_digest

SHOWN = (
    "bone_rmse_cm",
    "adherence_mps",
    "adherence_excess_mps",
    "drift_ratio",
    "skating_mps",
    "diversity_over_data",
    "bas_share",
    "speed_over_data",
    "beats_per_beat_over_data",
    "multimodality_over_data",
)


def metrics(folder: Path, name: str, digest: str) -> dict[str, float]:
    """The recorded measures of a walker or dancer, if they are of exactly these weights."""
    records = {one["name"]: one for one in kept_records(folder, name)}
    mine = {kind: records.get(f"{name}.{kind}") for kind in SHOWN}
    return {
        kind: one["value"]
        for kind, one in mine.items()
        if one and one["seeds"]["weights"] == digest
    }


def add_metrics(folder: Path) -> None:
    """Write the measures of `folder` into the cards.

    A file whose card has them already is not written.
    """
    for path in set(checkpoints.available().values()):
        performer = checkpoints.load(path)
        found = metrics(folder, path.stem, weights_digest(path))
        if performer.card.get("metrics", {}) != found:
            checkpoints.save(
                replace(performer, card=performer.card | {"metrics": found}),
                path,
                checkpoints.bits_of(path),
            )
