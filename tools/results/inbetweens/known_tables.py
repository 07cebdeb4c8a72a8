"""Two sections of docs/RESULTS.md.

Filling in where the right answer is a formula, and both papers' repairs.
"""

from ..page.markdown import cell, table

KINDS = {
    "mean": "the mean's error, in deviations of the truth (root mean square; 0 is right)",
    "spread": "the spread over the true one (1 is right)",
    "share": "what is wrong about the shares of the five parts (0 is right)",
}


def _part(records: dict[str, dict], prefix: str) -> tuple[list[str], list[str], dict]:
    """What stands after the prefix.

    (columns, rows), each in the order of the records, and what they were made from.
    """
    found = [name for name in records if name.startswith(prefix)]
    names = [name.removeprefix(prefix) for name in found]
    columns = list(dict.fromkeys(name.split(".")[0] for name in names))
    rows = list(dict.fromkeys(name.split(".", 1)[1].rsplit(".", 1)[0] for name in names))
    return columns, rows, records[found[0]]["seeds"] if found else {}


def known_answers(records: dict[str, dict]) -> str:
    """A table for each kind of error: ways of filling in by what is missing."""
    prefix = "known-answer."
    holes, ways, seeds = _part(records, prefix)
    if not holes:
        return ""
    text = (
        "## A known answer (MoFusion 4.4, MoDiff III-E)\n\nFive Gaussians fitted to windows of "
        "walking: how far each way of filling in is from their true conditional, "
        f"{seeds['questions']} windows, {seeds['samples']} samples each. The denoiser is exact: "
        "the method alone errs. `masked.50.x5`: 50 steps, each made five times; `blended` and "
        "`guided`: as in `inbetweening`; `gibbs`: there-and-back whose way back sees what is "
        "known; `exact`: draws from the wanted, which err by counting only.\n"
    )
    for kind, words in KINDS.items():
        rows = [
            [f"`{way}`", *(cell(records.get(f"{prefix}{hole}.{way}.{kind}")) for hole in holes)]
            for way in ways
        ]
        text += f"\n{words.capitalize()}:\n\n" + table(["way", *holes], rows)
    return text


def both(records: dict[str, dict]) -> str:
    """Repairs of the same holes by there-and-back and by masking, with the trained networks."""
    prefix = "mend-both."
    faults, ways, seeds = _part(records, prefix)
    if not faults:
        return ""
    columns = [(fault, kind) for fault in faults for kind in ("mean", "one")]
    rows = [
        [
            f"`{way}`",
            *(
                cell(records[f"{prefix}{fault}.{way}.{kind}_cm"], unit=False)
                for fault, kind in columns
            ),
        ]
        for way in ways
    ]
    head = ["way", *(f"{fault}, {kind}" for fault, kind in columns)]
    return (
        "## Both papers' repairs (MoDiff III-E beside MoFusion 4.4)\n\nThe same holes in ten past "
        "frames, filled by a walker there and back (as in the paper; `_masked`: what is known "
        "held on the way back) and by the unconditional network under a mask (as in the paper; "
        "`_blended`: by `editing.inbetween.inbetween`). Both know where the walk goes, then and "
        "for ten frames more: the one by its control, the other by the pelvis itself, which is "
        "not scored. Errors in cm of what was missing, "
        f"of the mean of {seeds['samples']} repairs and of one; {seeds['clips']} unseen pasts.\n\n"
        + table(head, rows)
    )
