"""Feels: how drummers mark, shift or leave out the beat, beside the genres' own grooves.

Patterns are written as in grooves.py: cells for the beats "one back strong last weak".
"""

from dataclasses import dataclass

import numpy as np

from .grooves import Groove, Hit, groove_of
from .song import DRUMS
from .tempi import held_out

STRAIGHT = (0.5, 0.5)
SHUFFLED = (0.6, 0.68)
USUAL = {
    "kick": 0.9,
    "snare": 0.85,
    "clap": 0.3,
    "rim": 0.5,
    "hat": 0.75,
    "open hat": 0.4,
    "shaker": 0.4,
    "tom": 0.3,
}


@dataclass(frozen=True)
class Feel:
    """A groove, the tempi that it suits, and its swing.

    swing  where the second of two eighths falls, from ... to ...; 0.5 is even
    tempi  slowest and fastest BPM
    half   the backbeat comes once a bar, so the music feels half as fast
    """

    groove: Groove
    swing: tuple[float, float] = STRAIGHT
    tempi: tuple[float, float] = (60.0, 180.0)
    half: bool = False


def _groove(patterns: dict[str, tuple[str, ...]]) -> Groove:
    return Groove(patterns, {drum: USUAL[drum] for drum in patterns})


FEELS = {
    "half time": Feel(_groove({
        "kick": ("X... .... .... ..x. ....", "X..x .... .... .x.. ....",
                 "X... ...x .... .... ...."),
        "snare": (".... .... X... .... ....", ".... .... X..g ...g ....",
                  "...g .... X... .... ...."),
        "hat": ("x.o. x.o. x.o. x.o. x.o.", "x... x... x... x... x...", "xgog xgog xgog xgog xgog"),
        "open hat": (".... ..o. .... .... ....", ".... .... .... ..o. ...."),
        "clap": (".... .... X... .... ....",),
    }), tempi=(100, 180), half=True),
    "shuffle": Feel(_groove({
        "kick": ("X... ..x. X... ..x. ....", "X... .... X.x. .... ....",
                 "X... x... X... x... x..."),
        "snare": (".... X... .... X... ....", ".... X... .... X.g. ....",
                  "..g. X.g. ..g. X.g. ..g."),
        "hat": ("x.o. x.o. x.o. x.o. x.o.", "x... x.o. x... x.o. x...", "x... x... x... x... x..."),
        "tom": (".... ..o. .... o.o. ....",),
    }), SHUFFLED, (60, 150)),
    "ride": Feel(_groove({
        "kick": ("g... g... g... g... g...", ".... .... .... ..o. ....",
                 "o... .... .... .... ...."),
        "snare": ("..g. .... ..g. .... ....", ".... ..g. .... o... ..g.",
                  ".... .... ..o. .... ...."),
        "hat": ("x... X.o. x... X.o. x...", "X.o. X.o. X.o. X.o. X.o.", "x... x.o. x.o. x... x.o."),
        "open hat": (".... o... .... o... o...",),
        "rim": (".... .... .... x... ....",),
    }), SHUFFLED, (74, 180)),
    "one drop": Feel(_groove({
        "kick": (".... .... X... .... ....", "X... .... X... .... ....",
                 "...x .... X... .... ...."),
        "rim": (".... .... X... .... ....", "..o. .... X..o ..o. ....", ".... ..o. .... x... ..o."),
        "hat": ("..x. ..x. ..x. ..x. ..x.", "x.x. x.x. x.x. x.x. x.x.", "..X. .gX. ..X. .gX. ..X."),
        "open hat": (".... .... .... ..o. ....",),
        "tom": (".... ..o. .... .oo. ....",),
    }), (0.5, 0.6), (60, 170)),
    "syncopated": Feel(_groove({
        "kick": ("X.x. .... ..X. .x.. ..x.", "X..x ..x. .x.. ..x. ....", "..X. ...x .X.. ..x. .x..",
              ".x.. ..X. ...x .... ..X."),
        "snare": (".... X..g .g.. X... ..g.", "...x ..X. .... X... ....",
                  ".... ..X. .... ..X. ....",
               "..x. .... ..x. .... ..x."),
        "hat": ("x.x. x.x. x.x. x.x. x.x.", "..x. ..x. ..x. ..x. ..x.", "xoxo xoxo xoxo xoxo xoxo"),
        "open hat": ("..o. .... .... ..o. ....", "...x .... ...x .... ...."),
        "clap": ("..x. .... ..x. .... ....",),
    }), (0.5, 0.56), (74, 146)),
    "bossa": Feel(_groove({
        "kick": ("X..x X..x X..x X..x X..x", "X..x ...x X..x ...x ...x"),
        "rim": ("X..x ..x. ..x. ..x. .x..", "..x. x... x..x ..x. ...x", "X... x..x ..x. x... .x.."),
        "shaker": ("xgog xgog xgog xgog xgog", "x.o. x.o. x.o. x.o. x.o."),
        "hat": ("x.x. x.x. x.x. x.x. x.x.", ".... x... .... x... x..."),
        "tom": ("..x. ..xx .x.. ..xx ..x.",),
    }), STRAIGHT, (74, 160)),
    "march": Feel(_groove({
        "kick": ("X... .... X... .... ....", "X... x... X... x... x...",
                 "X... .... .... .... ...."),
        "snare": ("x.xx x.x. x.xx xxxx x.x.", "g.g. X.gg g.g. X.gg g.g.",
                  "X... xx.x x... xx.x xx.x"),
        "open hat": ("x... .... x... .... ....",),
    }), (0.5, 0.55), (74, 146)),
    "hand drums": Feel(_groove({
        "tom": ("X..x ..x. x.x. ..xx ..x.", "o.x. X.xx o.x. X.x. o.x.", "X.o. ..x. .x.. X.o. ..o.",
             "x.xX x.xX x.xX x.xX x.xX"),
        "rim": ("..x. ...x ..x. .... ..x.", "X..x ..x. ..x. x... .x.."),
        "shaker": ("xgog xgog xgog xgog xgog", "..x. ..x. ..x. ..x. ..x.",
                   "o.x. o.x. o.x. o.x. o.x."),
        "clap": (".... X... .... X... ....", ".... ..x. .... X... ...."),
    }), (0.5, 0.58)),
    "sparse": Feel(_groove({
        "kick": ("X... .... .... .... ....", "X... .... ..o. .... ....",
                 ".... .... X... .... ...."),
        "rim": (".... .... X... .... ....", ".... x... .... x... ....", "..o. .... .... ..o. ...."),
        "hat": ("o... o... o... o... o...", "..o. ..o. ..o. ..o. ..o."),
        "shaker": ("g.o. g.o. g.o. g.o. g.o.",),
    }), (0.5, 0.6)),
    # its kick stays on the beat: otherwise nobody could say which is the beat
    "off-beats": Feel(_groove({
        "kick": ("X... .... X... .... ....", "X... x... X... x... x...",
                 "X... .... X..x .... ...."),
        "snare": ("..x. ..x. ..x. ..x. ..x.", ".... ..X. .... ..X. ....",
                  "..X. .... ..X. .... ..X."),
        "hat": ("..X. ..X. ..X. ..X. ..X.", "..x. ..x. ..x. ..x. ..x."),
        "open hat": ("..x. ..x. ..x. ..x. ..x.",),
        "clap": ("..x. ..x. ..x. ..x. ..x.",),
    }), STRAIGHT, (74, 180)),
    "all beats": Feel(_groove({
        "snare": ("X... X... X... X... X...", "x... x... x... x... x..."),
        "kick": ("X... ..x. X.x. .... ....", "X... ...x X... ...x ....",
                 "X... .... X... .... ...."),
        "hat": ("x.x. x.x. x.x. x.x. x.x.", "x... x... x... x... x..."),
        "shaker": ("x.x. x.x. x.x. x.x. x.x.",),
        "clap": (".... x... .... x... ....",),
    }), (0.5, 0.6), (74, 180)),
    "three and three and two": Feel(_groove({
        "kick": ("X..x ..x. X..x ..x. X.x.", "X... X... X... X... X...",
                 "X..x ..x. .... ..x. ..x."),
        "snare": ("...x ..x. ...x ..x. ..x.", ".... .... ...x ..x. ...."),
        "hat": ("x..x ..x. x..x ..x. x.x.", "x.x. x.x. x.x. x.x. x.x."),
        "shaker": ("xgxg xgxg xgxg xgxg xgxg",),
        "tom": ("X..x ..x. X..x ..x. X.x.",),
    }), STRAIGHT, (74, 130)),
}  # fmt: skip


def draw_feel(genre: str, tempo: float, own: float, rng: np.random.Generator) -> tuple[str, Feel]:
    """The name of a feel for this tempo (BPM), and the feel: by probability `own` the genre's.

    A half-time feel is not drawn where half of the tempo is kept out of training.
    """
    fits = [
        name
        for name, feel in FEELS.items()
        if feel.tempi[0] <= tempo <= feel.tempi[1] and not (feel.half and held_out(tempo / 2))
    ]
    draw, name = rng.random(), str(rng.choice(fits))
    shuffled = rng.random() < 0.3
    if draw < own:
        return genre, Feel(groove_of(genre), SHUFFLED if shuffled else STRAIGHT)
    return name, FEELS[name]


def without_some(hits: list[Hit], chance: float, rng: np.random.Generator) -> list[Hit]:
    """The strokes without those of some drums: each drum is left out by `chance`."""
    kept = {drum for drum, draw in zip(DRUMS, rng.random(len(DRUMS)), strict=True) if draw > chance}
    return [hit for hit in hits if hit.drum in kept]
