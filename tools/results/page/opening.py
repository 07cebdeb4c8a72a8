"""The opening of docs/RESULTS.md: which goals are met and which were missed, in sentences, then the
contents. All of it is computed from the records and the bars.
"""

import re

from motiondiff_edu.course.anchors import on_a_host

from .bars import BARS, Bar
from .claims import AGREES, CLAIMS, DIFFERS, MISSING, OPEN
from .markdown import span
from .words import GOALS

# For each group, the beginnings of its bars' names, and the measure in its sentence.
GROUPS = {
    "The walker": (("walker.",), "walker.bone_rmse_cm"),
    "The dancer": (("dancer.", "regression."), "dancer.bas_share"),
    "The data's dances": (("dance_data.",), "dance_data.standing_feet"),
    "Diffusion dropout and reconstruction": (("mend.",), "mend.frames_rmse_over_interpolation"),
    "Words": (("words.",), "words.action_accuracy"),
    "In-betweens": (("inbetween.",), "inbetween.gap30_error_over_interpolation"),
    "Continuations of recordings": (
        ("real.seam", "real.continuation", "real.style"),
        "real.seam_p95_over_motion",
    ),
    "In-betweens of recordings": (("real.inbetween",), "real.inbetween_over_interpolation"),
    "The checks of the exercises": (("course.",), "course.mutants_passing"),
    "Speed, and sound in the player": (("bench.", "player."), "bench.sampler_over_diffusers"),
}
UNITS = ("cm", "m/s", "ms", "s", "m")  # the others are ratios, which have no unit


def opening(records: dict[str, dict]) -> str:
    """Which goals are met, missed, close, and not measured."""
    measured = {bar: one for bar in BARS if (one := _measured(bar, records))}
    met = {bar for bar, one in measured.items() if bar.met(one["value"])}
    missed = [missed_sentence(bar, one) for bar, one in measured.items() if bar not in met]
    close = [
        f"{_what(bar)} is {amount(bar, one)} {span(one)}; the goal is {bar.text}."
        for bar, one in measured.items()
        if bar in met and not _surely(bar, one)
    ]
    absent = [subject(bar) for bar in BARS if bar not in measured]
    text = f"# Results\n\n**What holds.** {len(met)} of {len(BARS)} goals are met.\n\n"
    text += "".join(f"* {line}\n" for line in (group(g, measured, met) for g in GROUPS) if line)
    none = " No measured goal was missed.\n"
    text += "\n**What was missed.**" + (_list(missed) if missed else none)
    if close:
        text += (
            "\n**What is not certain.** These goals are met, but their 95 % intervals reach past"
        )
        text += f" the goal:{_list(close)}"
    if absent:
        text += (
            f"\n**What is not measured yet.** These measures are missing: {'; '.join(absent)}.\n"
        )
    return text + "\n" + paper(records)


def group(name: str, measured: dict[Bar, dict], met: set[Bar]) -> str:
    """One sentence: how many goals of a group are met, with one of them as an example."""
    starts, shown = GROUPS[name]
    mine = [bar for bar in measured if bar.name.startswith(starts)]
    if not mine:
        return ""
    count = sum(bar in met for bar in mine)
    all_of = f"all {count}" if count == len(mine) else f"{count} of {len(mine)}"
    text = f"{name}: {all_of} goals are met."
    example = next((bar for bar in mine if bar.name == shown and bar in met), None)
    return f"{text} {sentence(example, measured[example])}" if example else text


def sentence(bar: Bar, one: dict) -> str:
    """A measure and its goal."""
    return f"{_what(bar)} is {amount(bar, one)}; the goal is {bar.text}."


def missed_sentence(bar: Bar, one: dict) -> str:
    """A measure that misses its goal, with its interval, and whether that reaches the goal."""
    reaches = any(bar.met(one[side]) for side in ("low", "high") if one[side] is not None)
    more = ", which the interval reaches" if reaches else ""
    number = f"{amount(bar, one)} {span(one)}"
    return f"{_what(bar)} is {number}; the goal is {bar.text}{more} (`{bar.name}`)."


def subject(bar: Bar) -> str:
    """The subject of the bar in words; its key if it has no words yet."""
    return GOALS.get(bar.name, f"`{bar.name}`")


def amount(bar: Bar, one: dict) -> str:
    """The value with its unit, if it has one."""
    return bar.shown(one["value"]) + (f" {one['unit']}" if one["unit"] in UNITS else "")


def paper(records: dict[str, dict]) -> str:
    """How many of the papers' claims agree with what was measured."""
    verdicts = [claim.verdict(records) for claim in CLAIMS]
    agrees, differs, undecided = (verdicts.count(said) for said in (AGREES, DIFFERS, OPEN))
    missing = verdicts.count(MISSING)
    more = f", and {missing} have not been measured" if missing else ""
    place = on_a_host("The papers' claims, tested")
    return (
        f"**The papers' claims.** Of the {len(CLAIMS)} claims that we can judge at this scale, "
        f"{agrees} agree with what we measured, {differs} do not, {undecided} remain "
        f"undecided{more}: [the list](#{place}).\n"
    )


def contents(parts: list[str]) -> str:
    """A list of links to the sections, as GitHub names their anchors."""
    heads = [head for part in parts for head in re.findall(r"^## (.+)$", part, re.M)]
    return "## Contents\n\n" + "".join(f"* [{head}](#{on_a_host(head)})\n" for head in heads)


def _what(bar: Bar) -> str:
    """The subject at the beginning of a sentence; "a, over b" gets its second comma."""
    words = subject(bar)
    return words[:1].upper() + words[1:] + "," * ("," in words)


def _measured(bar: Bar, records: dict[str, dict]) -> dict | None:
    one = records.get(bar.name)
    return None if one is None or one["value"] is None else one


def _surely(bar: Bar, one: dict) -> bool:
    """Whether the whole interval lies within the goal."""
    return all(one[side] is None or bar.met(one[side]) for side in ("low", "high"))


def _list(lines: list[str]) -> str:
    return "\n\n" + "".join(f"* {line}\n" for line in lines)
