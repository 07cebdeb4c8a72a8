"""A line "On recordings" at the end of each block of docs/RESULTS.md that is about synthetic data.

What is not measured on recordings is said, so that nobody takes a synthetic figure for a real one.
"""

from ..page.markdown import cell

# block: {words: record}
MEASURED = {
    "walker": {
        "bone error of continuations": "real.continuation_bone_cm",
        "sliding of planted feet": "real.continuation_skating_mps",
        "error of the control": "real.continuation_adherence_mps",
        "the fastest joint at the seam over the fastest around it": "real.seam_over_motion",
    },
    "dancer": {
        "beat alignment beyond that of the same dances shifted in time, over a few songs": (
            "real.music_gain"
        ),
    },
    "mend": {
        "error of an arm that is missing for a second, over straight lines', in walks": (
            "real.reconstruction_arm_walks_over_lines"
        ),
        "in all other motions": "real.reconstruction_arm_others_over_lines",
    },
    "inbetween": {
        "error of the samples' mean over interpolation's, a keyframe a second": (
            "real.inbetween_over_interpolation"
        ),
        "of walks alone": "real.inbetween_walks_over_interpolation",
        "energy score over interpolation's": "real.inbetween_energy_over_interpolation",
    },
}
MISSING = {
    "walker": "not measured yet",
    "inbetween": "not measured yet",
    "dancer": "dances to recorded music are not measured yet",
    "mend": "not measured yet",
    "words": "the mover was trained on synthetic acts alone, and edits of recordings are not "
    "measured",
}
MORE = "See [On recordings](#on-recordings)."


def with_recordings(text: str, block: str, records: dict[str, dict]) -> str:
    """The text of a block, and below it what is measured on recordings, or that nothing is."""
    if not text:
        return ""
    found = {
        words: records[name]
        for words, name in MEASURED.get(block, {}).items()
        if records.get(name, {}).get("value") is not None
    }
    told = "; ".join(f"{words} {cell(one)}" for words, one in found.items())
    return f"{text}\n**On recordings**: {f'{told}. {MORE}' if told else f'{MISSING[block]}.'}\n"
