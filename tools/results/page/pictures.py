"""The pictures of docs/RESULTS.md, from the records. One whose records are missing is not drawn."""

from pathlib import Path

from motiondiff_edu._files import replacing
from motiondiff_edu.viz.repairs import by_fault, over_gaps

SIDES = ("value", "low", "high")
GAPS = (5, 15, 30, 60)
OVER_GAPS = {  # panel: {words: end of the record's name}
    "error, cm": {
        "mean of the samples": "error_cm", "one sample": "error_one_cm",
        "best of the samples": "error_best_cm", "straight lines": "error_lines_cm",
        "arcs": "error_arcs_cm", "sampled without the mask": "error_free_cm",
    },
    "NPSS": {"one sample": "npss", "interpolation": "npss_interpolation"},
    "jump at the seam / data's": {
        "one sample": "seam_jump_over_data", "lines": "seam_jump_lines_over_data",
    },
    "sliding of planted toes, m/s": {
        "one sample": "skating_mps", "masked, as in the paper": "skating_masked_mps",
        "lines": "skating_lines_mps", "the data": "skating_data_mps",
    },
}  # fmt: skip
REPAIRS = {
    "rmse_cm": "mean of ten reconstructions",
    "one_rmse_cm": "one reconstruction",
    "paper_rmse_cm": "as in the paper, mean",
    "rmse_ridge_cm": "ridge regression",
    "rmse_interpolation_cm": "straight lines",
    "rmse_meanpose_cm": "mean pose",
}
FAULTS = ("arm", "leg", "frames", "bursts")


def draw(records: dict[str, dict], folder: Path) -> None:
    """Write each picture whose records are there."""
    for name, make in (("repairs", repairs), ("inbetween", in_betweens)):
        try:
            figure = make(records)
        except KeyError:
            continue
        with replacing(folder / f"{name}.png") as aside:
            figure.savefig(aside, dpi=110, format="png")


def repairs(records: dict[str, dict]):
    """The methods of each fault, in the order of REPAIRS."""
    found = {
        fault: {
            words: tuple(records[name][side] for side in SIDES)
            for kind, words in REPAIRS.items()
            if (name := f"mend.{fault}_{kind}") in records
        }
        for fault in FAULTS
    }
    if not found["arm"]:
        raise KeyError("mend")
    return by_fault(found, "Errors of what was missing, with 95 % intervals over pasts.", "cm")


def in_betweens(records: dict[str, dict]):
    """Errors, spectra, seams and sliding over the length of the gap."""

    def line(kind: str):
        found = [records[f"inbetween.gap{g}.{kind}"] for g in GAPS]
        return GAPS, *([one[side] for one in found] for side in SIDES)

    panels = {
        title: {words: line(kind) for words, kind in kinds.items()}
        for title, kinds in OVER_GAPS.items()
    }
    words = "In-betweens at gaps of 5 to 60 frames, with 95 % intervals over motions."
    return over_gaps(panels, words, log=["error, cm"])
