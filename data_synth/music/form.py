"""The form of a song, without its notes.

It has the times of beats, bars, phrases and sections, breaks and fills.

A phrase is two bars; in 3 it may be four. A section (intro, verse, chorus, bridge) is one to four
phrases. A section before a chorus may end in a break: a bar or two without drums, in which the
beats continue.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

LEVELS = {"silence": 0.0, "intro": 0.38, "verse": 0.58, "chorus": 0.9, "bridge": 0.46}
NEXT = {
    "silence": ("intro", "verse"),
    "intro": ("verse",),
    "verse": ("chorus",),
    "bridge": ("chorus",),
}
NEXT |= {"chorus": ("verse", "verse", "bridge")}
# beats as groups of two and three: a listener expects a stress at the start of each
GROUPS = {
    2: ((2,),),
    3: ((3,),),
    4: ((2, 2),),
    5: ((3, 2), (2, 3)),
    6: ((3, 3),),
    7: ((2, 2, 3), (3, 2, 2)),
}
LEAD = 3.0  # seconds of music before the recording begins, for sounds that still ring
DRIFT = 0.02  # the length of a beat stays within this share of the mean


@dataclass(frozen=True)
class Bar:
    """One bar of a song's form.

    It has its section and phrase, the loudness of the section, and the events at its end.
    """

    number: int
    section: str
    place: int  # in its section
    last: bool  # of its section
    phrase: int
    in_phrase: int
    level: float  # 0 to 1; 0 in a break
    fill: int  # beats of fill at its end


@dataclass(frozen=True, eq=False)
class Form:
    """Bars, and the time of every beat from the first of bars[0] on.

    Times are negative before the recording begins.
    """

    bars: list[Bar]
    times: Float[np.ndarray, "B"]
    groups: tuple[int, ...]
    phrase_bars: int
    swing: float  # where the second of two short notes falls: 0.5 is even
    swing_unit: float  # the short notes' length in beats

    @property
    def metre(self) -> int:
        """Beats in a bar."""
        return sum(self.groups)

    def at(self, position: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
        """Times in seconds of positions in beats; between the beats the swing shifts them."""
        whole, part = np.divmod(position / (2 * self.swing_unit), 1.0)
        late = np.where(
            part < 0.5, 2 * self.swing * part, self.swing + (2 * part - 1) * (1 - self.swing)
        )
        return np.interp(
            (whole + late) * 2 * self.swing_unit, np.arange(len(self.times)), self.times
        )


def roles(groups: tuple[int, ...]) -> list[str]:
    """The role of each beat of a bar.

    "one", "strong" (another group's first), "back" (a group's last), "weak" or "last".

    roles((2, 2)) = one back strong last; roles((3, 2)) = one weak back strong last.
    """
    names = [name for size in groups for name in ("strong", *["weak"] * (size - 2), "back")]
    return ["one", *names[1:-1], "last"]


def _sections(rng: np.random.Generator, phrase_bars: int, silent_bars: int):
    """Endless generator of (name, bars, bars of break at its end)."""
    now = (
        "silence"
        if silent_bars
        else str(rng.choice(["intro", "verse", "chorus", "bridge"], p=[0.1, 0.4, 0.4, 0.1]))
    )
    while True:
        most = {"intro": 2, "bridge": 2}.get(now, 4) * 2 // phrase_bars
        bars = (
            silent_bars
            if now == "silence"
            else phrase_bars * int(rng.integers(1 if most < 4 else 2, most + 1))
        )
        following = str(rng.choice(NEXT[now]))
        rest = (
            int(rng.integers(1, 3))
            if rng.random() < (0.65 if following == "chorus" else 0.12)
            else 0
        )
        yield now, bars, 0 if now == "silence" else min(rest, bars - 1)
        now = following


def _bars(
    rng: np.random.Generator, metre: int, phrase_bars: int, silent_bars: int, enough: int
) -> list[Bar]:
    """Whole sections until there are `enough` bars."""
    bars = []
    phrase = -1
    loud = rng.uniform(-0.08, 0.08)
    for name, length, rest in _sections(rng, phrase_bars, silent_bars):
        for place in range(length):
            in_phrase, last = place % phrase_bars, place == length - 1
            phrase += in_phrase == 0
            broken, ends = place >= length - rest, in_phrase == phrase_bars - 1
            draw, size = rng.random(), int(rng.integers(1, min(metre, 3) + 1))
            fill = size * (draw < (0.85 if last else 0.35) and ends and name != "silence")
            level = (
                0.0 if broken else np.clip(LEVELS[name] + loud + 0.1 * (place / length - 0.5), 0, 1)
            )
            section = "break" if broken else name
            bars.append(Bar(len(bars), section, place, last, phrase, in_phrase, float(level), fill))
        if len(bars) >= enough:
            return bars
    raise AssertionError("sections never end")


def _periods(rng: np.random.Generator, n: int) -> Float[np.ndarray, "n"]:
    """Lengths of n beats divided by their mean:
    a slow random walk within DRIFT, or all 1 in a steady song.
    """
    steady, spread = rng.random() < 0.35, rng.uniform(0.3, 1.0)
    steps, walk = rng.standard_normal(n), np.zeros(n)
    for k in range(1, n):
        walk[k] = 0.94 * walk[k - 1] + 0.35 * steps[k]
    walk -= walk.mean()
    return np.ones(n) + (0 if steady else spread * DRIFT) * walk / max(1.0, np.abs(walk).max())


def draw_form(
    rng: np.random.Generator, seconds: float, tempo: float, metre: int, swing: tuple[float, float]
) -> Form:
    """Draw the form of a song. The recording begins anywhere, one in four at the song's beginning.

    `swing` has the position of the second short note, and the length of such notes.
    """
    groups = GROUPS[metre][int(rng.integers(len(GROUPS[metre])))]
    phrase_bars = int(rng.choice([2, 4])) if metre == 3 else 2
    beginning = rng.random() < 0.25
    skip = int(rng.integers(0, 4 * metre))
    phase = rng.random()
    own, drift = rng.spawn(2)
    lead = int(np.ceil(LEAD * tempo / 60 / metre / phrase_bars)) * phrase_bars
    beats = round(seconds * tempo / 60)
    start = lead * metre + (0 if beginning else skip)
    bars = _bars(own, metre, phrase_bars, lead if beginning else 0, (start + beats) // metre + 3)
    n = len(bars) * metre
    periods = np.ones(n)
    periods[start : start + beats + 2] = _periods(drift, beats + 2)
    times = np.concatenate([[0.0], np.cumsum(periods)[:-1]]) * 60 / tempo
    times += (0.4 if beginning else 1.0) * phase * 60 / tempo - times[start]
    return Form(bars, times, groups, phrase_bars, *swing)


def energies(form: Form, rng: np.random.Generator) -> Float[np.ndarray, "B"]:
    """Energy of every beat.

    It is that of the section, rises towards the section's end, and is at most 0.1 in a break.
    """
    quiet = rng.uniform(0, 0.1)
    level = np.repeat([bar.level for bar in form.bars], form.metre)
    wander = 0.03 * np.convolve(rng.standard_normal(len(level)), np.ones(5) / 5, "same")
    one = np.where(np.arange(len(level)) % form.metre == 0, 0.03, 0.0)
    return np.where(level > 0, np.clip(level + wander + one, 0.2, 1.0), quiet)
