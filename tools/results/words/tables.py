"""MoFusion's Table 2 beside ours, sentences never seen, editing: sections of docs/RESULTS.md."""

from ..page.markdown import cell, number, table
from .budget import VARIANTS

# Diversity, MultiModality, R-Precision: MoFusion (Dabral et al., CVPR 2023), Table 2, HumanML3D
PAPER_TABLE = {
    "Real Motions": (9.503, None, 0.797),
    "Language2Pose": (7.676, None, 0.486),
    "Text2Gesture": (6.409, None, 0.345),
    "MoCoGAN": (0.462, 0.019, 0.106),
    "Dance2Music": (0.725, 0.043, 0.097),
    "Guo et al.": (9.188, 2.090, 0.740),
    "MoFusion (Ours)": (8.82, 2.521, 0.492),
}
RETRIEVAL = (
    "r_precision_top1",
    "r_precision_top2",
    "r_precision_top3",
    "mm_dist",
    "fid",
    "diversity",
    "multimodality",
)
RECOGNISED = ("action_accuracy", "side_accuracy", "count_accuracy", "order_accuracy")
BODY = ("bone_rmse_cm", "skating_mps", "speed_over_data", "nearest_training_over_data")
ROWS = {
    "words.data.": "the data",
    "words.second.": "the data's second motion for the same caption",
    "words.shuffled.": "the data, captions shuffled",
    "words.noise.": "noise",
    "words.nearest.": "the training clip with the nearest caption",
    "words.": "**the mover**, w = 1",
    "words.guided.": "the mover, w = 2.5",
}
TRIALS = {  # by the beginning of their measures
    "": "unseen clips of trained combinations",
    "heldout_": "combinations held out: each word is seen in training, the pair never",
    "wording_": "wordings held out: verbs that no training caption has",
}
HELD = ("understood", *RECOGNISED, "minimal_pair", "r_precision_top3", "r_precision_top3_over_real")
PAIRS = ("", ".side", ".count", ".order", ".speed")
CHOSEN = (
    *RECOGNISED,
    "minimal_pair",
    "minimal_pair.order",
    "r_precision_top3_over_real",
    "bone_rmse_cm",
    "skating_mps",
)
EDITS = ("changes", "keeps_m", "keeps_over_resampled")
TABLE_2 = """## MoFusion's Table 2

The paper's rows are of HumanML3D, judged by the network of Guo and others; ours are of described
synthetic motions, judged by three small networks of our own. The two blocks have nothing in common
but the names of the measures. R-Precision chooses among 32 motions that show different things; the
paper's column is the top 3. Intervals of retrieval hold 95 % of the values of three judges and 20
draws of the pools, the others are over clips.

"""
OURS = """
A judge by contrast knows which motion belongs to which text, but it does not say why. So the
recogniser stands beside it: rules that read verb, side, count and order off a motion. Compare each
row with the data's. The training clip with the nearest caption is a fool: it generates nothing.

"""


def table_2(records: dict[str, dict]) -> str:
    """The paper's rows, then ours."""
    head = ["motion (the paper, HumanML3D)", "Diversity", "Multi-Modality", "R-Precision"]
    printed = [
        [who, *(number(x) if x is not None else "n/a" for x in row)]
        for who, row in PAPER_TABLE.items()
    ]
    text = TABLE_2 + table(head, printed)
    if "words.action_accuracy" not in records:
        return text + "\nOurs: not measured yet.\n" + choices(records)
    seeds = records["words.action_accuracy"]["seeds"]
    text += f"\nOurs: {seeds['trials']} unseen clips, {seeds['steps']} steps of DDIM.\n\n"
    text += _rows(records, RETRIEVAL) + OURS + _rows(records, RECOGNISED) + "\n"
    text += _rows(records, BODY) + never_seen(records) + edits(records)
    return text + choices(records)


def _rows(records: dict[str, dict], kinds: tuple[str, ...]) -> str:
    there = [prefix for prefix in ROWS if any(prefix + kind in records for kind in kinds)]
    rows = [
        [ROWS[prefix], *(cell(records.get(prefix + kind), unit=False) for kind in kinds)]
        for prefix in there
    ]
    return table(["motion (ours)", *(f"`{kind}`" for kind in kinds)], rows)


def never_seen(records: dict[str, dict]) -> str:
    """What of the mover holds on sentences unlike those of the training."""
    rows = [
        [words, *(cell(records.get(f"words.{start}{kind}"), unit=False) for kind in HELD)]
        for start, words in TRIALS.items()
    ]
    pairs = [
        [words, *(cell(records.get(f"{row}minimal_pair{kind}"), unit=False) for kind in PAIRS)]
        for row, words in ROWS.items()
        if f"{row}minimal_pair" in records
    ]
    return (
        "\n### Sentences that nobody trained for\n\nOf verbs that no caption had, some are read as "
        "others by the table of synonyms, and some are refused; a refused caption counts as the "
        "empty text.\n\n"
        + table(["captions", *(f"`{kind}`" for kind in HELD)], rows)
        + "\nTwo captions differ in one thing: how often is the motion nearer to its own? Chance "
        "is one half.\n\n" + table(["motion", "all", "side", "count", "order", "speed"], pairs)
    )


def choices(records: dict[str, dict]) -> str:
    """What each choice of the recipe is worth, by trainings of equal length."""
    there = [name for name in VARIANTS if f"words-budget.{name}.action_accuracy" in records]
    if not there:
        return ""
    about = records[f"words-budget.{there[0]}.action_accuracy"]["seeds"]
    rows = [
        [VARIANTS[name][0], *(cell(records.get(f"words-budget.{name}.{k}"), False) for k in kinds)]
        for name, kinds in ((name, CHOSEN) for name in there)
    ]
    waiting = [f"`{name}`" for name in VARIANTS if name not in there]
    return (
        f"\n### What each choice is worth\n\nEach row is trained {len(about['trainings'])} times "
        f"for {about['trained_steps']} steps, and differs from the first row in one choice. The "
        "intervals are over clips and trainings.\n\n"
        + table(["recipe", *(f"`{kind}`" for kind in CHOSEN)], rows)
        + (f"\nNot trained yet: {', '.join(waiting)}.\n" if waiting else "")
    )


def edits(records: dict[str, dict]) -> str:
    """Editing by words: what was asked for, and what stayed."""
    if "words.edit_changes" not in records:
        return ""
    rows = [
        [words, *(cell(records.get(f"words.{start}_{kind}")) for kind in EDITS)]
        for start, words in (("edit", "noised part of the way"), ("edit_masked", "and a mask"))
    ]
    before = cell(records.get("words.edit_changes_before"))
    return (
        "\n### Editing by words\n\nA figure on its way gets other arms by a new sentence. The "
        "columns say how often the new act is recognised, how far legs and pelvis are from where "
        "they were, and the same over plain sampling of the new sentence with the same seed. In "
        f"the unedited motions the new act is recognised in a share of {before}.\n\n"
        + table(["edit", *(f"`{kind}`" for kind in EDITS)], rows)
    )
