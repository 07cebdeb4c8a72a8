"""The ladder from the paper's walker to ours: its section of docs/RESULTS.md, and its picture."""

from pathlib import Path

from motiondiff_edu._files import replacing
from motiondiff_edu.viz.ladder import Rung, ladder

from ..page.markdown import cell, table
from .ladder import CELLS, CPU_SECONDS, MEASURES, PRINTED_RATE, RATES, SEEDS, TRIAL, root

PICTURE = "ladder.png"
GROUPS = {"ours": "our recipe, one choice taken out", "printed": "the printed recipe, one added"}
# one choice, taken out of ours and added to the printed recipe
PAIRS = {
    "footholds (with x0)": ("ours-no-footholds", "printed-footholds"),
    "x0 instead of eps": ("ours-eps", "printed-x0"),
    "the skip of an eps network": ("", "printed-skip"),
    "Muon": ("ours-adam", "printed-muon"),
    "the leap schedule": ("ours-linear", "printed-leap"),
    "the loss terms": ("ours-plain-loss", "printed-loss"),
    "past noise": ("ours-clean-past", "printed-noise"),
    "diffusion dropout": ("", "printed-clean-past"),
    "held control": ("ours-never-held", "printed-held"),
    "a tuned rate": ("", "printed-rate"),
}
WORDS = {
    "bone_rmse_cm": "bone error, cm",
    "adherence_excess_mps": "adherence above the data's, m/s",
    "skating_mps": "skating, m/s",
    "broken_over_whole": "bone error after a past with holes, over a whole one",
}


def measured(records: dict[str, dict]) -> list[str]:
    """The cells that there are records of, in the order of the ladder."""
    return [name for name in CELLS if f"ladder.{name}.bone_rmse_cm" in records]


def section(records: dict[str, dict], folder: Path) -> str:
    """The tables; nothing where no cell was measured."""
    there = measured(records)
    if not there:
        return ""
    waiting = [name for name in CELLS if name not in there]
    text = (
        "## From the paper's walker to ours\n\n"
        f"Small walkers of one size, {SEEDS} training seeds each. Every training has as many "
        f"steps as fit into {CPU_SECONDS} CPU-seconds on one thread. Each row takes one choice out "
        "of our recipe (that of the shipped walker before diffusion dropout is added at the end), "
        "or adds one to the recipe that MoDiff prints (with TimeGrad's schedule, for MoDiff gives "
        "none). "
        "The interval is over "
        "training seeds and walks. The sampler is DDPM with S = 100; the control is held, and one "
        "pose of every window is kept.\n\n"
        f"The printed recipe keeps the paper's rate, {PRINTED_RATE:g}, unless the row adds a tuned "
        "rate or Muon. The other rates were chosen for each of the two recipes and each optimiser: "
        f"the one of {', '.join(f'{rate:g}' for rate in RATES['muon'])} with the least loss on "
        f"validation clips after {TRIAL:.0%} of the budget.{at_the_edge(records)}\n\n"
    )
    head = ["recipe", "steps", "rate", *(WORDS[kind] for kind in MEASURES)]
    rows = []
    for name in there:
        seeds = records[f"ladder.{name}.bone_rmse_cm"]["seeds"]
        base = CELLS[name].base
        words = f"{'' if not base else base + ': '}{CELLS[name].words}"
        measures = [cell(records.get(f"ladder.{name}.{kind}"), unit=False) for kind in MEASURES]
        rows.append([words, str(seeds["steps"]), f"{seeds['rate']:g}", *measures])
    text += table(head, rows)
    if waiting:
        text += f"\nNot trained yet: {', '.join(f'`{name}`' for name in waiting)}.\n"
    if (folder / PICTURE).exists():
        text += (
            "\n![Bone error, adherence, skating and the cost of a past with holes for every recipe "
            f"of the ladder, a dot for each training seed](results/{PICTURE})\n"
        )
    return text + gains(records)


def at_the_edge(records: dict[str, dict]) -> str:
    """Which rates are the least or the largest of those that were tried, in a sentence."""
    found = []
    for name in measured(records):
        cell, rate = CELLS[name], records[f"ladder.{name}.bone_rmse_cm"]["seeds"]["rate"]
        tried = RATES[cell.recipe.optimizer]
        if cell.tuned and rate in (min(tried), max(tried)):
            found.append(
                f"{cell.recipe.optimizer.capitalize()} in the {root(name)} recipe ({rate:g})"
            )
    if not found:
        return ""
    which = " and ".join(dict.fromkeys(found))
    return (
        f" For {which} that is the first or the last of the three: a wider grid "
        "could find a better one, so read a loss against such a row with care."
    )


def gains(records: dict[str, dict]) -> str:
    """What each choice gains when it is added, beside what is lost when it is taken out."""

    def apart(name: str, kind: str) -> dict | None:
        return records.get(f"ladder.{name}.{kind}_minus_base") if name else None

    kinds = ("bone_rmse_cm", "adherence_excess_mps", "skating_mps")
    rows = []
    for words, (out, into) in PAIRS.items():
        found = [(apart(out, kind), apart(into, kind)) for kind in kinds]
        if any(one for pair in found for one in pair):
            cells = [cell(one, unit=False) for pair in found for one in pair]
            rows.append([words, *cells])
    if not rows:
        return ""
    head = ["choice"]
    for kind in kinds:
        head += [f"{WORDS[kind]}: without it, minus ours", "with it, minus printed"]
    words = (
        "\n### Taken out of ours, added to the printed recipe\n\n"
        "Left columns: above 0, the choice improves our recipe. Right columns: below 0, it "
        "improves the printed one (for diffusion dropout the right column is the printed recipe "
        "without it).\n\n"
    )
    return words + table(head, rows)


def draw(records: dict[str, dict], folder: Path) -> None:
    """The picture, where there are records."""
    there = measured(records)
    if not there:
        return
    rungs = [rung(name, records) for name in there]
    words = (
        "Every recipe of the ladder, a dot for each training seed. The dashed lines are the means "
        "of the two whole recipes. Smaller is better everywhere; wide axes are logarithmic."
    )
    picture = ladder(rungs, [WORDS[kind] for kind in MEASURES], words)
    with replacing(folder / PICTURE) as aside:
        aside.write_bytes(picture.as_png())


def rung(name: str, records: dict[str, dict]) -> Rung:
    """One row of the picture."""
    values = {
        WORDS[kind]: [
            records[key]["value"]
            for seed in range(SEEDS)
            if (key := f"ladder.{name}.{kind}.seed{seed}") in records
        ]
        for kind in MEASURES
    }
    group = GROUPS[root(name)]
    return Rung(CELLS[name].words, group, values)
