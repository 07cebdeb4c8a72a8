"""MoFusion's Table 1 beside ours, and what each choice of a dancer is worth.

Sections of docs/RESULTS.md.
"""

from collections.abc import Sequence

from motiondiff_edu.performers.dancer import ETA, STEPS

from ..page.markdown import cell, number, table
from .budget import FULL, VARIANTS, on_old_dances
from .finishing import FINISHED
from .finishing import KINDS as ENDED
from .floor import FLOOR
from .guided import WEIGHTS
from .timing import BASE, TIMED

# BAS, FID, Div, MModality: MoFusion (Dabral et al., CVPR 2023), Table 1, AIST++
PAPER_TABLE = {
    "Ground Truth": (0.237, 17.10, 8.19, None),
    "Li et al.": (0.160, 86.43, 6.85, None),
    "DanceNet": (0.143, 69.13, 2.86, None),
    "Dance Revolution": (0.195, 73.42, 3.52, None),
    "AI Choreographer": (0.221, 35.35, 5.94, None),
    "Bailando": (0.233, 28.16, 7.83, None),
    "MoFusion (Ours)": (0.253, 50.31, 9.09, 11.38),
}
COLUMNS = ("bas_music", "fid", "diversity", "multimodality", "bas", "bas_share")
TRAINED_ROWS = {  # the trainings of Table 1, by the names of VARIANTS
    "regression": "regression",
    "x0": "MoFusion, no kinematic losses",
    "constant": "MoFusion, kinematic losses all alike",
    "alpha_bar": "MoFusion, weighted by alpha_bar",
    "snr": "MoFusion, weighted by alpha_bar / (1 - alpha_bar)",
}
SHIPPED_ROWS = {
    "regression": "regression, shipped",
    "dancer-plain": "MoFusion, no kinematic losses, shipped",
    "dancer": "MoFusion, weighted by alpha_bar, shipped",
    "dancer.guided.1": "the same without guidance",
}
STORED, ANEW = "`make results FULL=1`; stored", "`make results`"
SHOWN = (
    "bas_share",
    "speed_over_data",
    "beats_per_beat_over_data",
    "bone_rmse_cm",
    "skating_mps",
    "multimodality_over_data",
    "fid",
)
TABLE_1 = """## MoFusion's Table 1

| here | in the paper | the same? |
| --- | --- | --- |
| beats of the music danced to, `bas_music` | BAS, eq. 10 | the same formula, with sigma = 3 of 60 \
frames a second; we use the true beats, the paper those of librosa |
| `fid`, `diversity`, `multimodality` | FID, Div, MModality | the same kind of score, without the \
public code's misplaced bracket |
| stops of the dance on a beat, `bas` | the words above eq. 10 | averaged over the stops of the \
dance, so that stopping all the time gains nothing |
| share of the data's alignment, `bas_share` | none | how much of the data's own alignment is \
reached, beyond that with other songs' beats |

The data differ. AIST++ is recorded; our songs are composed and danced by a program, with other
joints and with fewer clips, of 5 s. Compare rows within a block, never across blocks. FID falls
with the number of clips. The data's row judges other dances to the same pieces: it is what a
perfect dancer would get. There is one training seed each, and **[low, high]** is over songs.

"""


def table_1(records: dict[str, dict]) -> str:
    """The paper's rows, then ours: trainings of one length, then the shipped weights."""
    head = [
        "motion",
        "bas_music (BAS)",
        "fid (FID)",
        "diversity (Div)",
        "multimodality (MModality)",
        *COLUMNS[4:],
    ]
    rows = [
        [
            f"{who} (the paper, AIST++)",
            *(number(x) if x is not None else "n/a" for x in row),
            "-",
            "-",
            "printed",
        ]
        for who, row in PAPER_TABLE.items()
    ]
    rows += _block(
        records,
        {f"dance-budget.{name}": words for name, words in TRAINED_ROWS.items()},
        "same steps",
    )
    rows += _block(records, SHIPPED_ROWS, "shipped weights")
    parts = guidance(records), finishing(records), floor(records)
    return "".join([TABLE_1, table([*head, "made by"], rows), *parts])


def _block(records: dict[str, dict], names: dict[str, str], what: str) -> list[list[str]]:
    """The data's row, read from whatever was measured with it, and a row for each name."""
    there = [name for name in names if f"{name}.bas" in records]
    newest = [name for name in there if not on_old_dances(records[f"{name}.bas"])]
    made = STORED if what == "same steps" else ANEW
    unmeasured = ["-"] * len(COLUMNS)
    rows = []
    if there:
        data = [_of_data(records, newest or there, kind) for kind in COLUMNS]
        old = ", the old dances" * (not newest)
        rows.append([f"**data** ({what}{old})", *data, "with the rows below"])
    for name, words in names.items():
        steps = records[f"{name}.bas"]["seeds"].get("trained_steps") if name in there else None
        old = name in there and on_old_dances(records[f"{name}.bas"])
        cells = (
            [cell(records.get(f"{name}.{kind}"), unit=False) for kind in COLUMNS]
            if there
            else unmeasured
        )
        said = made if name in there else f"not measured yet ({made.removesuffix('; stored')})"
        about = f", {steps} steps" * bool(steps) + ", on the old dances" * old
        rows.append([f"**{words}**{about}", *cells, said])
    return rows


def _of_data(records: dict[str, dict], names: list[str], kind: str) -> str:
    found = (records.get(f"{name}.{kind}_data") for name in names)
    return (
        "1" if kind == "bas_share" else cell(next((one for one in found if one), None), unit=False)
    )


def guidance(records: dict[str, dict]) -> str:
    """What the weight of guidance gains and costs; nothing where it was not measured."""
    weights = {
        f"dancer.guided.{w}.": number(w)
        for w in WEIGHTS
        if f"dancer.guided.{w}.bas_share" in records
    }
    if not weights:
        return ""
    text = (
        "\nThe shipped dancer at several weights of guidance; 1 is none. Compare what is gained in "
        "alignment with what is lost in the variety of dances to one song.\n\n"
    )
    return text + _kinds_table(records, "weight", weights, SHOWN)


def finishing(records: dict[str, dict]) -> str:
    """The network's own dances beside those of the verb; nothing where they were not measured."""
    dances = {"dancer.": "the network's own", f"dancer.{FINISHED}": "as `dance` returns it"}
    if f"dancer.{FINISHED}bas_share" not in records:
        return ""
    text = (
        "\nThe measures of the dancer are of the network's own dances. `dance` gives the bones the "
        "lengths that they have in the data, and holds standing feet "
        "(`motion/cleanup`).\n\n"
    )
    return text + _kinds_table(records, "the dance", dances, ENDED)


def floor(records: dict[str, dict]) -> str:
    """How the data's dances use the floor, genre by genre; nothing where it was not measured."""
    genres = [n.split(".")[1] for n in records if n.startswith("dance_data.") and n.count(".") > 1]
    means = {"dance_data.": "mean over genres"}
    means |= {f"dance_data.{genre}.": genre for genre in dict.fromkeys(genres)}
    if "dance_data.standing_feet" not in records:
        return ""
    text = (
        "\nHow the data's own dances use the floor. A foot stands while its ankle is slower than "
        "0.15 m/s. The angle turned is that between the outermost directions which the "
        "figure faces within 8 s.\n\n"
    )
    return text + _kinds_table(records, "the data's dances", means, tuple(FLOOR))


def hearing(records: dict[str, dict]) -> str:
    """What the dancer's ear hears, beside a beat tracker."""
    kinds = ("beats_f", "tracker_f", "beats_f_over_tracker", "downbeats_f", "genre_accuracy")
    text = (
        "## What the dancer hears\n\nThe ear of the shipped dancer was taught beat, bar and genre "
        "by songs alone, before it danced (`beyond/hearing.py`). F-measures of beats within 0.07 "
        "s, of songs that it never heard; `tracker_f` is that of librosa's tracker, which also "
        "says half or double the tempo.\n\n"
    )
    if "ear.beats_f" not in records:
        return text + "Not measured yet.\n"
    songs = {"ear.": "tempi of training", "ear.kept_out.": "66-74 and 146-154 BPM"}
    return text + _kinds_table(records, "songs", songs, kinds)


def choices(records: dict[str, dict]) -> str:
    """One row for each variant that was trained for the same number of steps."""
    head = [
        "the choice",
        "compare with",
        *(f"`{kind}`" for kind in SHOWN),
        "share gained",
        "bone error saved",
        "",
    ]
    rows = []
    for name, (words, base, *_) in VARIANTS.items():
        mine = [
            f"dance-budget.{name}.{kind}"
            for kind in (*SHOWN, f"bas_share_minus_{base}", f"bone_gain_over_{base}")
        ]
        said = "not measured yet"
        if mine[0] in records:
            said = f"stored, {records[mine[0]]['seeds']['trained_steps']} steps"
            said += ", on the old dances" * on_old_dances(records[mine[0]])
        beside = f"`{base}`" if base else "-"
        rows.append(
            [f"`{name}`: {words}", beside, *(cell(records.get(n), unit=False) for n in mine), said]
        )
    text = (
        "## What each choice of a dancer is worth\n\nAll dancers were trained on the same songs "
        f"with the same seed, for {FULL.steps} steps of {FULL.batch} windows. Each row differs in "
        f"one choice from the row named beside it; that with an ear has {FULL.ear_steps} steps of "
        f"the ear besides. All dance with {STEPS} DDIM steps (eta = "
        f"{_etas(records)}). The share gained and the bone error saved are relative to that row, "
        "on the same songs. The trainings are short, with one seed each: read these as a ranking, "
        "not as what a choice is worth in the end. `make results FULL=1` trains them again; "
        "`make results` keeps what is stored.\n\n"
    )
    if any(on_old_dances(one) for one in records.values()):
        text += (
            "Rows *on the old dances* were trained and measured on earlier dances of `data_synth`, "
            "which hardly travelled or turned, and on songs without rooms, noise and swing: "
            "compare them with each other alone.\n\n"
        )
    return text + table(head, rows) + _times(records)


def _etas(records: dict[str, dict]) -> str:
    """The eta of the stored rows; that of today, where there are none."""
    found = {
        one["seeds"]["eta"]
        for name, one in records.items()
        if name.startswith("dance-budget.") and "eta" in one["seeds"]
    }
    return " or ".join(f"{eta:g}" for eta in sorted(found or {ETA}))


def _times(records: dict[str, dict]) -> str:
    kinds = ["parameters"] + [
        f"{what}{part}" for what in ("step", "pass", "dance") for part in ("_ms", f"_over_{BASE}")
    ]
    networks = {
        f"dance-time.{name}.": f"`{name}`: {VARIANTS[name][0]}"
        for name in TIMED
        if f"dance-time.{name}.step_ms" in records
    }
    if not networks:
        return ""
    about = records[f"dance-time.{BASE}.step_ms"]["seeds"]
    text = (
        f"\nCPU milliseconds on one thread for a training step (batch {about['batch']}), for one "
        f"pass through the plain network, and for a whole sampling ({about['dances']} dances of "
        f"{about['frames']} frames at once, {about['steps']} steps of DDIM). The U-Net samples by "
        "its fast twin, which encodes the music once. Ratios are of the same round.\n\n"
    )
    return text + _kinds_table(records, "network", networks, kinds)


def _kinds_table(
    records: dict[str, dict], head: str, rows: dict[str, str], kinds: Sequence[str]
) -> str:
    """A row for each beginning of names of records, a column for each of their kinds."""
    cells = [
        [words, *(cell(records.get(f"{start}{kind}"), unit=False) for kind in kinds)]
        for start, words in rows.items()
    ]
    return table([head, *(f"`{kind}`" for kind in kinds)], cells)
