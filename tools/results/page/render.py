"""docs/RESULTS.md, made from the records in docs/results/*.json and benchmarks/results/*.json.

No number is typed in.
"""

import json
from pathlib import Path

from motiondiff_edu._files import replacing
from motiondiff_edu.recipes.walkers import WALKER_PRINTED

from ..dances.tables import choices, hearing, table_1
from ..inbetweens import known_tables
from ..recordings import page as recordings
from ..recordings.beside import with_recordings
from ..repairs import tables
from ..walks import ladder_page
from ..walks.steps_table import PAPER_TABLE
from ..words.tables import table_2
from .bars import BARS, Bar
from .claims import claims
from .markdown import cell, folded, number, span, table
from .opening import contents, opening
from .words import GOALS

HEAD = """## How to read this page

`make results` and `make bench` write this page from the records in `docs/results` and
`benchmarks/results`. Do not edit it.

The course's data are synthetic (the network of in-betweens has also seen eight minutes of
recordings), and neither paper has published its code or its prepared data. Our numbers stand
beside the papers' for orientation: they do not reproduce them.

**[low, high]** is a 95 % bootstrap interval. It is taken over clips, for diversity over pasts, and
for times over repetitions. Unless a section says otherwise it belongs to one training run: another
training seed can change a number by more.

**Control error** is how far the velocity of a walk is from the one asked for: the measure
*adherence* of notebook 08, in m/s.
"""

ALL = "RESULTS_ALL.md"
FURTHER = """# Further measures

These measures have no section of their own in [RESULTS.md](RESULTS.md); some stand in its tables of
goals and claims. Each has its 95 % interval and the command that measures it. `make results` and
`make bench` write this page. Do not edit it.

"""


def read_records(*folders: Path) -> dict[str, dict]:
    """All records by name.

    A name in two files is an error, because one of the files must be old.
    """
    found, where = {}, {}
    for path in sorted(path for folder in folders for path in folder.glob("*.json")):
        for one in json.loads(path.read_text(encoding="utf-8")):
            if one["name"] in found:
                raise ValueError(
                    f"{one['name']} stands in {where[one['name']]} and in {path}: "
                    "delete the older file"
                )
            found[one["name"]], where[one["name"]] = one, path
    return found


def bars(records: dict[str, dict]) -> str:
    """Every bar with what was measured: met, missed, or not measured."""
    rows = [
        [GOALS.get(bar.name, ""), f"`{bar.name}`", bar.text, *_verdict(bar, records.get(bar.name))]
        for bar in BARS
    ]
    head = ["what", "measure", "goal", "measured", "interval", ""]
    return "## The goals\n\n" + table(head, rows) + timed_on(records)


def timed_on(records: dict[str, dict]) -> str:
    """The processors that the benchmarks were timed on; nothing where no record names one."""
    machines = sorted({one["machine"] for one in records.values() if "machine" in one})
    return f"\nThe speeds were measured on: {'; '.join(machines)}.\n" if machines else ""


def _verdict(bar: Bar, one: dict | None) -> list[str]:
    if one is None or one["value"] is None:
        return ["-", "-", "not measured"]
    return [bar.shown(one["value"]), span(one), "met" if bar.met(one["value"]) else "**missed**"]


def walkers(records: dict[str, dict]) -> str:
    """One column for each walker, one row for each measure, value and interval in a cell."""
    names = [n for n in records if n.split(".")[0].startswith("walker") and n.count(".") == 1]
    columns = sorted({n.split(".")[0] for n in names}, key=lambda c: (c != "walker", len(c), c))
    kinds = list(dict.fromkeys(n.split(".")[1] for n in names))
    rows = [
        [f"`{kind}`", *(cell(records.get(f"{column}.{kind}")) for column in columns)]
        for kind in kinds
    ]
    if not names:
        return "## The walkers\n\nNot measured yet.\n"
    seeds = {key: said for n in names for key, said in records[n]["seeds"].items()}
    ahead = any("lookahead" in column for column in columns)
    ahead = "; in columns named `lookahead` the window sees the future control" * ahead
    return (
        "## The walkers\n\n"
        f"Each walker continues {seeds.get('clips')} unseen pasts for {seeds.get('seconds')} s. We "
        "measure the network's raw output. The sampler is DDPM with all its steps; `ddim10` takes "
        f"ten steps of DDIM. The control is held over each window{ahead}. Rows of the data measure "
        "the data's own motion under the same control. Diversity "
        f"compares {seeds.get('each')} rollouts for each of {seeds.get('pasts')} pasts, after "
        f"their first second. Seeds: {_seed(names, records, 'walk')} for pasts and controls, "
        f"{_seed(names, records, 'diversity')} for those of the diversity, "
        f"{seeds.get('rollouts')} for the rollouts.\n\n"
        + table(["measure", *columns], rows)
        + _beside_the_paper(records)
    )


def _seed(names: list[str], records: dict[str, dict], what: str) -> str:
    """The data's seed for the measures of diversity, or for all others."""
    found = {
        records[n]["seeds"].get("data")
        for n in names
        if ("diversity" in n) == (what == "diversity")
    }
    return " and ".join(str(seed) for seed in sorted(found - {None})) or "-"


def _beside_the_paper(records: dict[str, dict]) -> str:
    one, printed = (records.get(f"{who}.bone_rmse_cm") for who in ("walker", "walker-printed"))
    if one is None or printed is None:
        return ""
    return (
        f"\nMoDiff prints a bone RMSE of {number(one['paper'])} cm (Table I, with diffusion "
        f"dropout). `walker` has {number(one['value'])} cm, and `walker-printed`, the paper's "
        f"recipe at our size for {WALKER_PRINTED.steps:,} steps, {number(printed['value'])} cm. "
        "The data, the skeleton, the sizes of the networks and the length of training differ, so "
        "only the order of magnitude can be compared. The paper gives no numbers for adherence to "
        "control, drift or diversity.\n"
    )


def footsteps(records: dict[str, dict], folder: Path) -> str:
    """MoDiff's Table I: the paper's rows, then ours."""
    head = ["motion", "f_est", "v95, cm/s", "mean step, s", "std, s", "bone RMSE, cm"]
    rows = [
        [f"{who} (the paper, other data)", *map(number, row)] for who, row in PAPER_TABLE.items()
    ]
    for kind, note in (("footsteps", ""), ("footsteps-robust", ", robust count")):
        for who in dict.fromkeys(n.split(".")[1] for n in records if n.startswith(f"{kind}.")):
            bone = records.get(
                "walker.bone_rmse_data_cm" if who == "data" else f"{who}.bone_rmse_cm"
            )
            cells = [
                records[f"{kind}.{who}.{what}"] for what in ("f_est", "v95_cmps", "mean_s", "std_s")
            ]
            bones = number(bone["value"]) if bone else "-"
            mine = cells[0]["seeds"].get("weights")
            before = who != "data" and bone and mine != bone["seeds"].get("weights")
            earlier = ", footsteps of earlier weights" if before else ""
            rows.append(
                [
                    f"**{who}**{note}{earlier}",
                    *(f"{number(c['value'])} {span(c)}" for c in cells),
                    bones,
                ]
            )
    text = (
        "## Footsteps: MoDiff's Table I and Fig. 3\n\nWe have other clips than the paper, and "
        "more of them. Compare rows within a block, never across blocks. Notebook 08 shows why the "
        "paper's count follows noise. The robust count closes gaps of one frame, and "
        "drops steps shorter than 0.1 s.\n\n"
    )
    picture = ""
    if (folder / "footsteps.png").exists():
        picture = (
            "\n![Number of footsteps against the velocity tolerance, "
            "data and walkers](results/footsteps.png)\n"
        )
    return text + table(head, rows) + picture


def attention(records: dict[str, dict], folder: Path) -> str:
    """MoFusion's Fig. 4 in numbers, level by level, and the picture."""
    kinds = ("beat_mass", "beat_mass_over_shuffled", "beat_mass_over_shifted", "seconds_read")
    levels = [
        n.split(".")[1] for n in records if n.startswith("attention.") and n.endswith(".beat_mass")
    ]
    places = {"": "all levels", **{f"{level}.": level for level in levels if level != "beat_mass"}}
    rows = [
        [words, *(cell(records.get(f"attention.{place}{kind}")) for kind in kinds)]
        for place, words in places.items()
    ]
    text = (
        "## Attention over the beats: MoFusion's Fig. 4\n\nThe first column is the share of a "
        "level's attention that lies within 0.1 s of a beat. The next two divide it by the share "
        "near the beats of other songs, and near its own beats after all were shifted together: "
        "1 is chance. The last column is how much music a frame reads. A level is named by its "
        "frames per second. Heads and three diffusion steps are averaged. With seven levels, one "
        "outlier may be chance.\n\n"
    )
    if "attention.beat_mass" not in records:
        return text + "Not measured yet.\n"
    picture = "\n![Attention of the levels over the sound, beats dotted](results/attention.png)\n"
    return (
        text
        + table(["level", *(f"`{k}`" for k in kinds)], rows)
        + picture * (folder / "attention.png").exists()
    )


def others(records: dict[str, dict]) -> str:
    """All measures without a section above, with the commands that measure them."""
    shown = (
        "walker",
        "footsteps",
        "ladder.",
        "dance-budget.",
        "dance-time.",
        "attention.",
    )
    shown += ("dancer.guided.", "dance_data.", "ear.")
    shown += ("mend", "words.", "words-budget.", "known-answer.", "inbetween.")
    shown += ("inbetween-departures.", "real.")
    rest = [one for name, one in sorted(records.items()) if not name.startswith(shown)]
    rows = [
        [f"`{r['name']}`", number(r["value"]), span(r), r["unit"], f"`{r['command']}`"]
        for r in rest
    ]
    head = ["measure", "value", "interval", "unit", "made by"]
    return FURTHER + table(head, rows) if rows else ""


def render(docs: Path, benchmarks: Path = Path("benchmarks/results")) -> None:
    """Write RESULTS.md and RESULTS_ALL.md beside the records, each to a temporary name first."""
    records = read_records(docs / "results", benchmarks)
    ladder_page.draw(records, docs / "results")
    parts = [HEAD, bars(records), with_recordings(walkers(records), "walker", records)]
    parts += [footsteps(records, docs / "results")]
    parts += [
        ladder_page.section(records, docs / "results"),
        with_recordings(table_1(records), "dancer", records),
        folded(choices(records), "What training and dancing cost in time"),
        hearing(records),
        attention(records, docs / "results"),
    ]
    tables.draw(records, docs / "results")
    parts += [tables.dropout(records, docs / "results")]
    parts += [with_recordings(tables.repairs(records, docs / "results"), "mend", records)]
    known = folded(known_tables.known_answers(records), "The spread, and the shares of the parts")
    parts += [known_tables.both(records), known]
    filled = tables.inbetweens(records, docs / "results")
    parts += [with_recordings(filled, "inbetween", records)]
    parts += [with_recordings(table_2(records), "words", records)]
    parts += [recordings.section(records), claims(records)]
    parts = [opening(records), contents(parts), *parts]
    for name, text in (("RESULTS.md", "\n".join(filter(None, parts))), (ALL, others(records))):
        with replacing(docs / name) as aside:
            aside.write_text(text, encoding="utf-8")
