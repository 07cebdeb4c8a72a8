"""The section "On recordings" of docs/RESULTS.md."""

from ..page.markdown import cell, number, table

STARTS = ("real.", "real.unblended.")
ROWS = {
    "seam_over_motion": "the fastest joint at the seam, over the fastest within a second (median)",
    "seam_p95_over_motion": "the same (95th percentile)",
    "continuation_bone_cm": "bone error, cm",
    "continuation_skating_mps": "sliding of the planted foot, m/s",
    "continuation_early_skating_mps": "the same in the first second, m/s",
    "continuation_adherence_mps": "error of the control, m/s",
    "continuation_floor_cm": "depth of the lowest joint under the floor, cm (95th percentile)",
}


def section(records: dict[str, dict]) -> str:
    """Continuations of recordings, as shipped and without blending."""
    title = "## On recordings\n\n"
    share = records.get("real.blended_share")
    if share is None:
        return title + "Not measured yet.\n"
    seeds = share["seeds"]
    text = (
        f"The walker continues {seeds['windows']} windows of {seeds['files']} recordings for four "
        "seconds, at the speed of their last second: walks, dances, martial arts, climbing, "
        "washing. It was trained on synthetic walks alone. Where the first new frame jumps, which "
        f"is in {number(100 * share['value'])} % of the windows, the first half second takes over "
        "pose and speed of the recording (`beyond/inertialize.py`), and a warning says so. A leg "
        "that must get from a kneeling pose to a walk slides on the way.\n\n"
    )
    rows = [
        [words, *(cell(records.get(start + name), unit=False) for start in STARTS)]
        for name, words in ROWS.items()
    ]
    return title + text + table(["", "as shipped", "without blending"], rows)
