"""Two sections of docs/RESULTS.md: filling in where the answer is a formula, and both papers'
repairs.
"""

from ..page.markdown import cell, table

KINDS = {
    "mean": "error of the mean, in standard deviations of the truth (root mean square; 0 is right)",
    "spread": "standard deviation over the true one (1 is right)",
    "share": "error of the shares of the five Gaussians (0 is right)",
}


def _part(records: dict[str, dict], prefix: str) -> tuple[list[str], list[str], dict]:
    """The parts of the names after the prefix.

    Returns (columns, rows), each in the order of the records, and their settings.
    """
    found = [name for name in records if name.startswith(prefix)]
    names = [name.removeprefix(prefix) for name in found]
    columns = list(dict.fromkeys(name.split(".")[0] for name in names))
    rows = list(dict.fromkeys(name.split(".", 1)[1].rsplit(".", 1)[0] for name in names))
    return columns, rows, records[found[0]]["seeds"] if found else {}


def known_answers(records: dict[str, dict]) -> str:
    """A table for each kind of error: methods of filling in against the missing part."""
    prefix = "known-answer."
    holes, ways, seeds = _part(records, prefix)
    if not holes:
        return ""
    text = (
        "## A known answer (MoFusion 4.4, MoDiff III-E)\n\nWe fit a mixture of five Gaussians to "
        "windows of walking. Its conditional, given what is known of a window, is a formula, and "
        "so is its denoiser. So every error here comes from the way of filling in, not from a "
        f"network. There are {seeds['questions']} windows and {seeds['samples']} samples of each. "
        "Draws from the true conditional show the error of a finite number of samples.\n"
    )
    for kind, words in KINDS.items():
        rows = [
            [f"`{way}`", *(cell(records.get(f"{prefix}{hole}.{way}.{kind}")) for hole in holes)]
            for way in ways
        ]
        text += f"\n{words[:1].upper() + words[1:]}:\n\n" + table(["way", *holes], rows)
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
        "frames are filled in both ways. A walker goes there and back, as in MoDiff, or with what "
        "is known held on the way back. The unconditional network fills in under a mask, as in "
        "MoFusion, or by our `editing.inbetween.inbetween`. Both know where the walk goes in these "
        "frames and the next ten: the walker from its control, the network from the pelvis, which "
        f"is not scored. Errors are in cm, of the mean of {seeds['samples']} repairs and of one, "
        f"on {seeds['clips']} unseen pasts.\n\n" + table(head, rows)
    )
