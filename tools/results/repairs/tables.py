"""Diffusion dropout, repairs and in-betweens.

Sections of docs/RESULTS.md, and their pictures, from the records.
"""

from pathlib import Path

import numpy as np

from motiondiff_edu._files import replacing
from motiondiff_edu.viz.gaps_and_faults import by_fault, over_gaps, rate_map

from ..inbetweens.departures import ROWS
from ..inbetweens.inbetween import GAPS
from ..page.markdown import cell, number, table
from .dropout import MEASURES, RATES, SHARES, SHIPPED_PAIR, SMALL_PAIRS
from .repair import FAULTS

COMPARED = (SHIPPED_PAIR, SMALL_PAIRS)
UNITS = {kind: f"{kind}_{unit}" for kind, (unit, _) in MEASURES.items()}
METHODS = {
    "error_cm": "mean of the samples",
    "error_one_cm": "one sample",
    "error_best_cm": "best of the samples",
    "error_lines_cm": "straight lines",
    "error_arcs_cm": "arcs",
    "error_free_cm": "sampled without the mask",
}
SLIDING = {
    "skating_mps": "one sample",
    "skating_masked_mps": "masked, as in the paper",
    "skating_lines_mps": "lines",
    "skating_data_mps": "the data",
}
REPAIRS = {
    "rmse_cm": "mean of ten reconstructions",
    "one_rmse_cm": "one reconstruction",
    "paper_rmse_cm": "as in the paper, mean",
    "rmse_ridge_cm": "ridge regression",
    "rmse_interpolation_cm": "straight lines",
    "rmse_meanpose_cm": "mean pose",
}
MASKED = {"error_masked_cm": "masked, as in the paper"}  # one sample


def dropout(records: dict[str, dict], folder: Path) -> str:
    """The shipped walker and the small pairs, with dropout and without; the map over rates."""
    one = records.get("mend.pairs_dropout_cost_complete")
    if one is None:
        return ""
    seeds = one["seeds"]
    sides = [f"{pair.prefix}{kind}" for pair in COMPARED for kind in ("plain", "dropout")]
    rows = [
        [words, what, *(cell(records.get(f"mend.{side}_{words}_{UNITS[what]}")) for side in sides)]
        for words in ("complete", "missing")
        for what in MEASURES
    ]
    gains = [
        [f"`{n}`", cell(records.get(f"mend.{n}"))]
        for pair in COMPARED
        for n in (*(f"{pair.prefix}dropout_gain_{unit}" for unit in UNITS.values()), pair.cost)
    ]
    text = (
        "## Diffusion dropout (MoDiff III-D)\n\nTwo comparisons. `walker` was trained with "
        "diffusion dropout, and `walker-plain` without; they share the first part of the training, "
        "in which the paper's rate of dropout is 0. The small pairs are alike from the beginning, "
        f"with {seeds['trainings']} training seeds of each. All are shipped. Both sides of a "
        "comparison have the same network, data and number of steps. They continue "
        f"{seeds['clips']} unseen pasts by {seeds['frames']} frames: once complete, and once with "
        f"{seeds['missing']:.0%} of the joints missing throughout (zero after standardisation). "
        "Intervals are over clips, and for the small pairs over training seeds too; three seeds "
        "are few. `gain` is the error without dropout minus the error with it, from broken pasts; "
        "`cost` is the error with dropout over that without, from complete pasts: the larger of "
        "the ratios of bone and control error.\n\n"
    )
    head = ["past", "error", "walker-plain", "walker", "small, plain", "small, with dropout"]
    text += table(head, rows) + "\n" + table(["measure", "measured"], gains)
    picture = folder / "dropout-map.png"
    return (
        text
        + "\n![Errors by rate of dropout and share of the past missing](results/dropout-map.png)\n"
        * picture.exists()
    )


def repairs(records: dict[str, dict], folder: Path) -> str:
    """Each fault, also with methods that need no walker; then Table II."""
    ours = tuple(f"mend.{fault}_" for fault in FAULTS)
    kinds = list(dict.fromkeys(n.split("_", 1)[1] for n in records if n.startswith(ours)))
    if not kinds:
        return ""
    rows = [
        [fault, *(cell(records.get(f"mend.{fault}_{kind}"), unit=False) for kind in kinds)]
        for fault in FAULTS
    ]
    text = (
        "## Reconstruction (MoDiff III-E)\n\nWhat was missing in ten past frames is "
        f"reconstructed, for {_pasts(records)} unseen pasts. Errors are root mean squared "
        "distances in cm, of the mean of ten reconstructions and of one. A mean is closer to the "
        "truth, but it moves too little. Our way starts from the guess of ridge regression, holds "
        "what is known on the way back as well, and keeps the bones' lengths. The paper's way "
        "starts from the mean pose and does neither. Where the error over ridge regression is "
        "above 1, the regression that the reconstruction starts from is closer to the truth than "
        "the reconstruction.\n\n"
    )
    text += table(["missing", *(f"`{kind}`" for kind in kinds)], rows)
    text += (
        "\n![Errors of reconstructions and of methods without a walker](results/repairs.png)\n"
        * (folder / "repairs.png").exists()
    )
    second = [
        [f"`{n}`", cell(records[n])]
        for n in records
        if n.startswith(("mend.table2", "mend.footsteps"))
    ]
    said = (
        "\n### Table II\n\nIn every past 30 % of the joints are missing throughout (6 of 21, set "
        "to zero). The small walkers with dropout, three trainings, go frame by frame as in the "
        "paper. The same walkers are also tried with five poses kept of every window of ten; their "
        "errors grow less. The shipped walker is larger and was trained for longer. Walks "
        "of 12 s are generated from the broken pasts (`ge`) and from complete ones (`whole`). "
        "Reconstructed pasts are judged as they come from the network (`re`), with their bones "
        "kept, which is our way (`re_bones`), and by the paper's way (`re_paper`). The paper "
        "prints, on other data, 0.101 cm and 0.108 cm for MoDiff with dropout, and 0.105 cm and "
        "0.116 cm without.\n\n"
    )
    return text + said + table(["measure", "measured"], second) if second else text


def inbetweens(records: dict[str, dict], folder: Path) -> str:
    """Errors over the length of the gap, and measures that errors do not show."""
    if "inbetween.keyframe_error_cm" not in records:
        return ""
    seeds = records["inbetween.keyframe_error_cm"]["seeds"]
    named = METHODS | MASKED
    kinds = [*named, *(f"npss_{of}over_interpolation" for of in ("", "velocity_"))]
    kinds += [*(f"seam_jump{of}_over_data" for of in ("", "_lines", "_masked"))]
    kinds += [*(f"skating{of}_mps" for of in ("", "_lines", "_masked", "_data"))]
    rows = [
        [str(g), *(cell(records.get(f"inbetween.gap{g}.{kind}"), unit=False) for kind in kinds)]
        for g in GAPS
    ]
    text = (
        "## In-betweens (MoFusion 4.4)\n\nA network fills a gap in the middle of "
        f"{seeds['motions']} unseen motions of 100 frames, half of them walks and half dances. "
        f"There are {seeds['samples']} samples of each, with {seeds['steps']} DDIM steps. Ours "
        "(`inbetweener`) is shown what is given and generates the remainder around straight lines; "
        "at the end bones keep their lengths, and feet are locked. Columns that say *masked* "
        "show one sample as in the paper, of the network `unconditional` that knows nothing of "
        "what is given. The mean of several samples has a smaller "
        "error than a sample, but it moves less. Therefore the spectral error (NPSS), the jump at "
        "the seam and the sliding of planted toes are of single samples. Given frames stay exactly "
        "as they are: the error there is "
        f"{number(records['inbetween.keyframe_error_cm']['value'])}.\n\n"
    )
    picture = (
        "\n![Errors, spectra, seams and sliding over the length of the "
        "gap](results/inbetween.png)\n"
    )
    head = ["gap, frames", *(named.get(kind, f"`{kind}`") for kind in kinds)]
    shown = text + table(head, rows) + picture * (folder / "inbetween.png").exists()
    return shown + in_between_departures(records)


DEPARTURES = {
    "error_one_cm": "error of a sample",
    "error_one_minus_base_cm": "minus that of its base",
    "seam_jump_over_data": "jump at the seam over the data's",
    "bone_rmse_cm": "bone error",
    "skating_mps": "sliding of planted feet",
    "skating_minus_base_mps": "minus that of its base",
}


def in_between_departures(records: dict[str, dict]) -> str:
    """What each departure from masked sampling gains: all of them, and all but one."""
    first = records.get("inbetween-departures.ours.error_one_cm")
    if first is None:
        return ""
    rows = [
        [
            row.words,
            *(cell(records.get(f"inbetween-departures.{name}.{kind}")) for kind in DEPARTURES),
        ]
        for name, row in ROWS.items()
    ]
    text = (
        "\n### What each departure is worth\n\nThe same gaps of "
        f"{first['seeds']['gap']} frames, motions and noise in every row; one departure is left "
        "out at a time. The base of a row is the first row; for *the same*, it is the row of the "
        "network that is not shown what is given, which is guided and blended instead. Bone errors "
        "are those of the generated frames against the given ones.\n\n"
    )
    return text + table(["", *DEPARTURES.values()], rows)


def draw(records: dict[str, dict], folder: Path) -> None:
    """Draw the pictures whose records exist."""
    missing = [round(100 * share) for share in SHARES]
    names = [name for name in RATES if f"mend-map.{name}.missing-0.{UNITS['bone']}" in records]
    if names:
        panels = {
            words: np.array(
                [
                    [records[f"mend-map.{n}.missing-{m}.{UNITS[kind]}"]["value"] for m in missing]
                    for n in names
                ]
            )
            for kind, words in (("bone", "bone RMSE, cm"), ("adherence", "adherence, m/s"))
        }
        words = (
            "Errors of the next ten frames, by the rate of dropout in training "
            "and the share of joints missing."
        )
        rates = [f"{RATES[name]:.0%}" for name in names]
        _save(
            rate_map(panels, rates, [f"{m} %" for m in missing], words), folder / "dropout-map.png"
        )
    if "mend.arm_rmse_cm" in records:
        _save(
            by_fault(
                _repairs(records),
                "Errors of what was missing, with 95 % intervals over pasts.",
                "cm",
            ),
            folder / "repairs.png",
        )
    if "inbetween.keyframe_error_cm" in records:
        measures = {
            "error, cm": METHODS,
            "NPSS": {"npss": "one sample", "npss_interpolation": "interpolation"},
            "jump at the seam / data's": {
                "seam_jump_over_data": "one sample",
                "seam_jump_lines_over_data": "lines",
            },
            "sliding of planted toes, m/s": SLIDING,
        }
        panels = {
            title: {w: _line(records, kind) for kind, w in kinds.items()}
            for title, kinds in measures.items()
        }
        words = "In-betweens at gaps of 5 to 60 frames, with 95 % intervals over motions."
        _save(over_gaps(panels, words, log=["error, cm"]), folder / "inbetween.png")


def _pasts(records: dict[str, dict]) -> str:
    """How many pasts were reconstructed."""
    return str(records.get("mend.arm_rmse_cm", {"seeds": {}})["seeds"].get("pasts", "the"))


def _repairs(records: dict[str, dict]):
    """The methods of each fault, in the order of REPAIRS."""
    sides = ("value", "low", "high")
    return {
        fault: {
            words: tuple(records[name][side] for side in sides)
            for kind, words in REPAIRS.items()
            if (name := f"mend.{fault}_{kind}") in records
        }
        for fault in FAULTS
    }


def _line(records: dict[str, dict], kind: str):
    found = [records[f"inbetween.gap{g}.{kind}"] for g in GAPS]
    return GAPS, *([one[side] for one in found] for side in ("value", "low", "high"))


def _save(figure, path: Path) -> None:
    with replacing(path) as aside:
        figure.savefig(aside, dpi=110, format="png")
