"""The drum parts.

Each genre has patterns of four sixteenths a beat, from which a song part makes its bars.

A pattern has five cells, for the beats "one back strong last weak" of form.roles, so that it serves
every metre: a bar of 4 is one back strong last, of 3 one weak last, of 5 one weak back strong last.
Marks: X accent, x normal, o soft, g ghost, . nothing.
"""

from dataclasses import dataclass

import numpy as np

from .form import Bar, Form, roles

ROLES = ("one", "back", "strong", "last", "weak")
VELOCITY = {"X": 1.0, "x": 0.8, "o": 0.55, "g": 0.27}
# genre -> drum -> patterns; a part draws one of them
GROOVES = {
    "house": {
        "kick": ("X... X... X... X... X...", "X... X... X... X... X...", "X... X... X... X..o X...",
                 "X... X... X..o X... X...", "X... X... X... X.o. X...",
                 "X..x ..X. .x.. X... ..x.", "X... ..x. ..X. ...x ...x"),
        "clap": (".... X... .... X... ....", ".... X... .... X... ....",
                 ".... .... .... X... ...."),
        "snare": ("...g .... ..g. .... ....", "...o ..o. ...o ..o. ..o.",
                  ".... .... .... ..g. ...."),
        "hat": ("..X. ..X. ..X. ..X. ..X.", "o.x. o.x. o.x. o.x. o.x.", "x.x. x.x. x.x. x.x. x.x.",
                "xogo xogo xogo xogo xogo", "xgog xgog xgog xgog xgog", "x... x... x... x... x..."),
        "open hat": ("..o. ..o. ..o. ..o. ..o.", ".... .... .... ..x. ....",
                     ".... ..x. .... ..x. ...."),
        "shaker": ("xgog xgog xgog xgog xgog", "xgxg xgxg xgxg xgxg xgxg",
                   "g.o. g.o. g.o. g.o. g.o."),
        "rim": ("x..x ..x. ..x. x... .x..", "x.o. .x.. x..x ..x. ...x"),
        "tom": (".... ...o .... .o.o ....", "..o. .... ..oo .... ...."),
    },
    "hiphop": {
        "kick": ("X... .... ..X. .... ....", "X..x .... ..x. ...o ....", "X... ..x. .xX. .... ...x",
                 "X.x. .... ..X. ..o. ....", "..X. ...x ..X. .... ..x."),
        "snare": (".... X... .... X... ....", ".... X..g .g.. X... ....",
                  ".... X... ..g. X..g .g..",
                  ".... .... .... X... ...."),
        "clap": (".... x... .... x... ....", ".... .... .... x... ...."),
        "hat": ("x.o. x.o. x.o. x.o. x.o.", "x.x. x.xo x.x. xoxo x.x.", "xogo xogo xogo xogo xogo",
                "..X. ..X. ..X. .gX. ..X."),
        "open hat": (".... .... .... ..o. ....", "..o. .... .... .... ...."),
        "rim": ("...o .... ..o. .... .o..", ".... ..o. .... ..o. ...."),
        "shaker": ("g.o. g.o. g.o. g.o. g.o.", "gogo gogo gogo gogo gogo"),
        "tom": (".... .... .... ..oo ....",),
    },
    "pop": {
        "kick": ("X... .... X... .... ....", "X... ..x. X... .... ....", "X.x. .... ..X. .... ..x.",
                 "X... ...x X... ..o. ....", "X... x... X... x... x...",
                 "..X. .... ..x. ..o. ...."),
        "snare": (".... X... .... X... ....", ".... X... .... X..g ....",
                  ".... X..g .g.. X... .g..",
                  ".... .... X... .... ....", ".... X... .... X.x. ...."),
        "clap": (".... x... .... x... ....", ".... .... .... x... ...."),
        "hat": ("x.o. x.o. x.o. x.o. x.o.", "X.x. X.x. X.x. X.x. X.x.", "xgog xgog xgog xgog xgog",
                "x... x... x... x... x...", "..X. ..X. ..X. ..X. ..X."),
        "open hat": (".... .... .... ..x. ....", "..o. ..o. ..o. ..o. ..o."),
        "shaker": ("ogxg ogxg ogxg ogxg ogxg", "x.o. x.o. x.o. x.o. x.o."),
        "rim": (".... x... .... x... ....", "...o ..o. .... x... ...."),
        "tom": ("x.x. x.x. x.x. x.x. x.x.", "..o. .... ..oo .... ...."),
    },
    "latin": {
        "kick": ("X..x ..o. X..x ..o. ...x", "X... X... X... X... X...", "X... x... X... x... x...",
                 "o... X... o... X... o...", "...x ..x. ...x ..X. ..x.",
                 "X... ...x X... ...x ...."),
        "snare": ("...x ..x. ...x ..x. ..x.", "..g. x... ..g. x.g. ..g.",
                  ".... x... .... x... ....",
                  ".... .... .... ..x. ...."),
        "clap": ("X... x... X... x... x...", "X.o. x.ox X.o. x.o. xo..",
                 "X... x... X.o. x.o. x..."),
        "rim": ("X..x ..x. ..x. x... .x..", "..x. x... x..x ..x. ...x", "X... x..x ..x. x... .x.."),
        "hat": ("x.o. x.o. x.o. x.o. x.o.", "xgog xgog xgog xgog xgog"),
        "open hat": (".... .... .... ..o. ....",),
        "shaker": ("xgog xgog xgog xgog xgog", "Xgog Xgog Xgog Xgog Xgog",
                   "xgxg xgxg xgxg xgxg xgxg"),
        "tom": ("g.g. X.xx g.g. X.xx g.g.", "..x. ..xx .x.. ..xx ..x.", "...o x... .o.. xx.. ...."),
    },
    "waltz": {
        "kick": ("X... .... X... .... ....", "X... .... X... ..o. ....", "X... .... x... .... ..x.",
                 ".... .... X... .... ....", "X... ..x. X... .... ..x."),
        "snare": (".... x... .... x... x...", ".... o... .... o.g. o...",
                  ".... x... ..g. x... x.g.",
                  ".... .... .... o... ....", "..o. .... ..o. X... ...."),
        "clap": (".... o... .... o... o...", ".... .... .... x... ...."),
        "rim": (".... o... .... o... o...", ".... .... .... o... ....", "x... ..o. x... .... ..o."),
        "hat": ("x... o... x... o... o...", "x... x.o. x... x.o. x...", "x.o. x.o. x.o. x.o. x.o.",
                "..x. ..x. ..x. ..x. ..x.", "x... o.g. x... o.g. o.g.", "x... x... x... x... x..."),
        "open hat": (".... .... .... o... ....", "..o. .... ..o. .... ...."),
        "shaker": ("x.g. o.g. x.g. o.g. o.g.", "g.o. g.o. g.o. g.o. g.o."),
        "tom": ("o... .... .... .... ....", ".... .... .... o.o. ...."),
    },
}  # fmt: skip
# the probability that a part has the drum, and how loud a section must be for it
PLAYS = {
    "kick": (0.95, 0.35),
    "snare": (0.9, 0.4),
    "clap": (0.45, 0.5),
    "rim": (0.3, 0.3),
    "hat": (0.9, 0.3),
    "open hat": (0.4, 0.55),
    "shaker": (0.35, 0.5),
    "tom": (0.15, 0.45),
}
OWN = {  # genres with another probability
    "house": {"kick": 1.0, "clap": 1.0, "hat": 1.0, "snare": 0.2, "open hat": 0.3},
    "hiphop": {"snare": 1.0},
    "pop": {"snare": 1.0},
    "latin": {"rim": 0.8, "shaker": 0.8, "hat": 0.4, "snare": 0.6, "clap": 0.6, "tom": 0.4},
    "waltz": {"hat": 1.0},
}
ONE_BACKBEAT = ("hiphop", "pop", "waltz")  # their claps fall on the snare's strokes
FILLS = ("xxxx", "x.xx", "xx.x", "..xx", "x.x.", ".xxx")


@dataclass(frozen=True)
class Groove:
    """What drummers play in a kind of music.

    patterns      of each drum; a part draws one of them
    plays         the probability that a part has the drum
    one_backbeat  claps fall on the snare's strokes
    """

    patterns: dict[str, tuple[str, ...]]
    plays: dict[str, float]
    one_backbeat: bool = False


def groove_of(genre: str) -> Groove:
    """The groove of a genre."""
    usual = {drum: share for drum, (share, _) in PLAYS.items()}
    return Groove(GROOVES[genre], usual | OWN[genre], genre in ONE_BACKBEAT)


@dataclass(frozen=True)
class Hit:
    """One stroke of a drum.

    It has the drum, the beats since the form's first, the strength (0-1), and the sound's number.
    """

    drum: str
    position: float
    velocity: float
    sound: int = 0


def cells(pattern: str, groups: tuple[int, ...]) -> list[str]:
    """The cell of every beat of a bar."""
    by_role = dict(zip(ROLES, pattern.split(), strict=True))
    return [by_role[role] for role in roles(groups)]


def marks(bar: list[str]) -> list[tuple[float, str]]:
    """(beats since the bar's first, mark) of everything that is not a rest."""
    return [
        (b + k / len(cell), mark)
        for b, cell in enumerate(bar)
        for k, mark in enumerate(cell)
        if mark != "."
    ]


def draw_part(
    groove: Groove, groups: tuple[int, ...], rng: np.random.Generator
) -> dict[str, tuple[list, list]]:
    """The marks of each drum's bar, and of the varied bar at a phrase's end."""
    part = {}
    for drum, patterns in groove.patterns.items():
        first, answer = rng.choice(len(patterns)), rng.random(2)
        bar = marks(cells(patterns[first], groups))
        other = (
            marks(cells(patterns[rng.integers(len(patterns))], groups))
            if answer[0] < 0.2
            else list(bar)
        )
        if answer[1] < 0.5 and drum in (
            "kick",
            "snare",
            "open hat",
        ):  # one more stroke, off the beat
            other.append(
                (
                    sum(groups) - float(rng.choice([0.25, 0.5, 0.75, 1.5])),
                    "g" if drum == "snare" else "x",
                )
            )
        if rng.random() < groove.plays[drum]:
            part[drum] = (bar, other)
    if (
        "clap" in part and "snare" in part and groove.one_backbeat
    ):  # all of them have the backbeat at the same place
        first, second = ([(at, "x") for at, mark in bar if mark in "Xx"] for bar in part["snare"])
        part["clap"] = (first, second)
    return part


def fill(bar: Bar, metre: int, rng: np.random.Generator) -> list[Hit]:
    """The last beats of a bar on snare and toms, getting louder, or rarely silence."""
    start, style = bar.number * metre + metre - bar.fill, rng.random()
    if style < 0.12:
        return []
    shape = str(rng.choice(FILLS)) if style < 0.85 else "xxx"  # triplets
    strokes = marks([shape if k else str(rng.choice(FILLS)) for k in range(bar.fill)])
    on_toms = rng.random() < 0.6
    hits = []
    for k, (at, _) in enumerate(strokes):
        share = (k + 1) / len(strokes)
        drum = "tom" if on_toms and share > 0.3 else "snare"
        hits.append(
            Hit(
                drum,
                start + at,
                (0.45 + 0.5 * share) * rng.uniform(0.85, 1.0),
                int(3 * share - 1e-9),
            )
        )
    return hits


def write_drums(form: Form, groove: Groove, rng: np.random.Generator) -> list[Hit]:
    """All strokes of the song, without the player's unevenness; breaks are almost empty."""
    parts = {name: draw_part(groove, form.groups, rng) for name in ("verse", "chorus")}
    kept = ("kick", "snare") if rng.random() < 0.6 else ()
    # the chorus has all drums of the verse and more; often kick and snare play the same as there
    parts["chorus"] |= {
        d: p for d, p in parts["verse"].items() if d in kept or d not in parts["chorus"]
    }
    shifted = rng.random() < 0.06
    stops = (
        form.phrase_bars * form.metre - int(rng.integers(1, 3)) if rng.random() < 0.2 else -1
    )  # a beat of silence
    hits, metre = [], form.metre
    for bar in form.bars:
        if bar.section == "break":
            hits += _in_break(bar, metre, rng)
        elif bar.section != "silence":
            played = _bar(bar, parts["chorus" if bar.section == "chorus" else "verse"], form, rng)
            if shifted:  # the kick is half a beat late, during the whole song
                played = [
                    Hit(h.drum, h.position + 0.5 * (h.drum == "kick"), h.velocity, h.sound)
                    for h in played
                ]
            first = (bar.number - bar.in_phrase) * metre
            hits += [h for h in played if int(h.position) - first != stops or bar.last]
    return sorted(hits, key=lambda hit: hit.position)


def _bar(bar: Bar, part: dict, form: Form, rng: np.random.Generator) -> list[Hit]:
    start, filled = bar.number * form.metre, form.metre - bar.fill
    loud = 0.55 + 0.5 * bar.level
    hits = []
    for drum, (plain, answer) in part.items():
        if bar.level < PLAYS[drum][1]:
            continue
        for at, mark in answer if bar.in_phrase == form.phrase_bars - 1 else plain:
            covered = at >= filled and drum in ("kick", "snare", "clap", "tom", "rim")
            if not covered and rng.random() > 0.015:
                pick = int(rng.integers(3))
                sound = (
                    int(4 * at) % 3 if drum == "tom" else pick
                )  # toms play a tune; each other drum has three sounds
                hits.append(Hit(drum, start + at, min(VELOCITY[mark] * loud, 1.0), sound))
    if bar.fill:
        hits += fill(bar, form.metre, rng)
    if bar.place == 0 and (bar.section == "chorus" or rng.random() < 0.3):
        hits.append(Hit("crash", start, 0.8 * loud, 0))
    return hits


def _in_break(bar: Bar, metre: int, rng: np.random.Generator) -> list[Hit]:
    """Nothing, or a soft hat on the beats; sometimes a roll that leads out of the break."""
    start, hits = bar.number * metre, []
    if rng.random() < 0.3:
        hits += [Hit("hat", start + b, 0.2, int(rng.integers(3))) for b in range(metre)]
    if bar.last and rng.random() < 0.5:
        hits += [Hit("snare", start + metre - 1 + k / 4, 0.25 + 0.15 * k, k % 3) for k in range(4)]
    return hits
