"""The section "On recordings" of docs/RESULTS.md."""

from motiondiff_edu.performers.joined import FAR

from ..page.markdown import cell, number, table
from .trainings import VARIANTS

# the beginnings of names
STARTS = {
    "as shipped": "real.",
    "as the network has it": "real.unblended.",
    "the recording itself": "real.recording.",
}
ROWS = {
    "seam_over_motion": "the fastest joint at the seam, over the fastest within a second (median)",
    "seam_p95_over_motion": "the same (95th percentile)",
    "seam_over_past": "the fastest joint at the seam, over the fastest in the second before it"
    " (median)",
    "seam_p95_over_past": "the same (95th percentile)",
    "seam_step_cm": "how much farther a joint goes at the seam than in the two frames on either"
    " side, cm (median)",
    "seam_step_p95_cm": "the same (95th percentile)",
    "continuation_bone_cm": "bone error, cm",
    "continuation_skating_mps": "sliding of the planted foot, m/s",
    "continuation_early_skating_mps": "the same in the first second, m/s",
    "continuation_adherence_mps": "error of the control, m/s",
    "continuation_floor_cm": "depth of the lowest joint under the floor, cm (95th percentile)",
}
PERSONS = {
    "style_kept": "continuations whose style is nearer to their own past than to another's; chance"
    " is a half",
    "continuation_diversity_over_synthetic": "spread of five continuations, over that of synthetic"
    " walks",
}
FILLED = {
    "over_interpolation": "error of the samples' mean, over interpolation's (median)",
    "walks_over_interpolation": "the same, walks alone",
    "others_over_interpolation": "the same, all other motions",
    "one_over_interpolation": "error of one sample, over interpolation's (median)",
    "one_p90_over_interpolation": "the same (90th percentile)",
    "energy_over_interpolation": "energy score of the samples, over interpolation's (median)",
    "others_energy_over_interpolation": "the same, all but walks",
    "skating_over_source": "sliding of planted feet, over the recording's (median)",
    "skating_p90_over_source": "the same (90th percentile)",
    "fastest_over_source": "fastest joint, over the recording's (90th percentile)",
    "floor_cm": "depth of the lowest joint under the recording's, cm (90th percentile)",
}
RECONSTRUCTED = {
    "arm_walks_over_lines": "an arm, in walks",
    "arm_others_over_lines": "an arm, in all other motions",
    "leg_walks_over_lines": "a leg, in walks",
    "leg_others_over_lines": "a leg, in all other motions",
}
MUSIC = {
    "music_gain": "gain in beat alignment",
    "music_alignment": "beat alignment",
    "music_alignment_shifted": "the same, shifted in time",
}
SECONDS = {  # between keyframes: beginnings of the names
    "0.25 s": "real.gap5.inbetween_",
    "0.5 s": "real.gap10.inbetween_",
    "1 s": "real.inbetween_",
    "1 s, before second tries": "real.inbetween_raw_",
    "2 s": "real.gap40.inbetween_",
}


def section(records: dict[str, dict]) -> str:
    """Continuations, reconstructions and in-betweens of recordings, and dances to music."""
    parts = [continued(records), reconstructed(records), filled_in(records)]
    parts += [trainings_table(records), danced(records)]
    return "## On recordings\n\n" + "\n\n".join(parts)


def reconstructed(records: dict[str, dict]) -> str:
    """Reconstructions of a limb that is missing for a second."""
    one = records.get("real.reconstruction_arm_others_over_lines")
    if one is None:
        return "Reconstructions of recordings are not measured yet.\n"
    text = (
        f"The walker reconstructs a limb that is missing for a second, in three seconds of "
        f"{one['seeds']['files']} recordings of {one['seeds']['persons']} persons. It was trained "
        "on synthetic walks alone. Errors are "
        "over those of straight lines (median).\n\n"
    )
    columns = {"error over straight lines'": "real.reconstruction_"}
    return text + measures(records, RECONSTRUCTED, "missing", columns)


def filled_in(records: dict[str, dict]) -> str:
    """In-betweens of recordings, at several distances of keyframes."""
    share = records.get("real.inbetween_fallback_share")
    if share is None:
        return "In-betweens of recordings are not measured yet.\n"
    seeds = share["seeds"]
    text = (
        f"In-betweens of {seeds['windows']} windows of {seeds['files']} recordings of "
        f"{seeds['persons']} persons, "
        f"{seeds['walks']} of them walks (two over uneven ground), from keyframes at equal "
        f"distances; "
        f"{seeds['samples']} samples of each. Interpolation"
        " is the better one of straight lines and arcs. "
        f"{number(100 * share['value'])} % of the samples are noticed as failures and drawn again. "
        "The intervals are over persons.\n\n"
    )
    return text + measures(records, FILLED, "a keyframe every", SECONDS)


def danced(records: dict[str, dict]) -> str:
    """Dances to recordings of music, and how few songs these are."""
    gain = records.get("real.music_gain")
    if gain is None:
        return "Dances to recorded music are not measured yet.\n"
    seeds = gain["seeds"]
    text = (
        f"The dancer dances to {seeds['songs']} recordings of music, which are few: the interval "
        "is over songs, and another song can change the mean by much. Nobody has marked their "
        f"beats: those of {seeds['from_file']} are another tracker's, the others are found by "
        "librosa's. The gain is the alignment of a dance's stops with the beats, minus that of the "
        "same dance moved in time within the song: 0 for a dancer that does not hear. The gain of "
        "one song has its interval over dances.\n\n"
    )
    rows = MUSIC | {
        name.removeprefix("real."): f"gain, {name.removeprefix('real.music_gain.')}"
        for name in records
        if name.startswith("real.music_gain.")
    }
    return text + measures(records, rows, "", {"as shipped": "real."})


def trainings_table(records: dict[str, dict]) -> str:
    """What recordings and variations in training are worth: trainings of equal length."""
    made = {
        words: f"inbetween-budget.{name}.inbetween_"
        for name, (words, _) in VARIANTS.items()
        if f"inbetween-budget.{name}.inbetween_over_interpolation" in records
    }
    if not made:
        return "Trainings with and without recordings are not measured yet.\n"
    first = next(iter(made.values()))
    seeds = records[f"{first}over_interpolation"]["seeds"]
    text = (
        f"With recordings in training and without: {len(seeds['trainings'])} trainings of "
        f"{seeds['trained_steps']} steps each, a keyframe a second, {seeds['samples']} samples. "
        "The intervals hold those of all trainings.\n\n"
    )
    return text + measures(records, FILLED, "", made)


def continued(records: dict[str, dict]) -> str:
    """Continuations of recordings, as shipped and as the network has them."""
    share = records.get("real.blended_share")
    if share is None:
        return "Continuations of recordings are not measured yet.\n"
    seeds = share["seeds"]
    text = (
        f"The walker continues {seeds['windows']} windows of {seeds['files']} recordings of "
        f"{seeds['persons']} persons for four seconds, at the speed of their last second: walks, "
        "dances, martial arts, climbing, washing. It was trained on synthetic walks alone. The "
        "first new frame of the network jumps in "
        f"{number(100 * share['value'])} % of the windows. The clean-up blends the seam, keeps the "
        "recording's bones and holds feet that stand (`motion/cleanup`); a warning says where a "
        f"joint would jump by more than {100 * FAR:g} cm. A leg that must get from a kneeling pose "
        "to a walk still slides on the way.\n\n"
    )
    persons = (
        "\nStyle is trunk lean, step width, arm swing and cadence (`metrics/gait_style.py`): of "
        "the past, and of the last two seconds when all pasts are continued at the same speed. One "
        "window of each file.\n\n"
    )
    text += measures(records, ROWS, "", STARTS)
    return text + persons + measures(records, PERSONS, "", {"as shipped": "real."})


def measures(
    records: dict[str, dict], rows: dict[str, str], corner: str, columns: dict[str, str]
) -> str:
    """A table of records: rows are {end of the name: words}, columns {words: beginning}."""
    cells = [
        [words, *(cell(records.get(start + name), unit=False) for start in columns.values())]
        for name, words in rows.items()
    ]
    return table([corner, *columns], cells)
