"""The parts of the pitched instruments.

They are chords that lead into one another, a bass below them, and a melody that comes back.

Patterns have five cells like those of grooves.py. Bass: R root, F fifth, O octave, T third, A one
step from the next root. Chords: L held until the next, s short, a one note of the chord after
another.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from .form import Bar, Form
from .grooves import cells, marks

SCALES = {
    "major": (0, 2, 4, 5, 7, 9, 11),
    "minor": (0, 2, 3, 5, 7, 8, 10),
    "dorian": (0, 2, 3, 5, 7, 9, 10),
}
# degrees of the scale, 0 the tonic, one chord a bar
PROGRESSIONS: dict[str, dict[str, tuple[tuple[int, ...], ...]]] = {
    "house": {
        "major": ((0, 5, 3, 4), (3, 4, 5, 0)),
        "minor": ((0, 5, 6, 0), (0, 2, 5, 6), (5, 6, 0, 0)),
        "dorian": ((0, 3), (0, 0, 3, 3), (0, 6, 3, 0)),
    },
    "hiphop": {
        "major": ((1, 4, 0, 5), (3, 2, 1, 0)),
        "minor": ((0, 5), (0, 3, 5, 4), (5, 4, 0, 0)),
        "dorian": ((0, 3), (0, 1)),
    },
    "pop": {
        "major": ((0, 4, 5, 3), (5, 3, 0, 4), (0, 5, 3, 4), (0, 3, 0, 4)),
        "minor": ((0, 5, 2, 6), (0, 3, 5, 4)),
        "dorian": ((0, 6, 3, 0),),
    },
    "latin": {
        "major": ((0, 3, 4, 3), (0, 1, 4, 0)),
        "minor": ((0, 6, 5, 4), (0, 3, 4, 0)),
        "dorian": ((0, 3, 0, 3),),
    },
    "waltz": {
        "major": ((0, 0, 4, 4), (0, 4, 4, 0), (0, 5, 1, 4), (0, 3, 4, 0)),
        "minor": ((0, 3, 4, 0), (0, 5, 3, 4)),
        "dorian": ((0, 1, 0, 6),),
    },
}
MODES = {  # probabilities of major, minor, dorian
    "house": (0.2, 0.45, 0.35),
    "hiphop": (0.2, 0.5, 0.3),
    "pop": (0.6, 0.3, 0.1),
    "latin": (0.35, 0.5, 0.15),
    "waltz": (0.6, 0.3, 0.1),
}
BASS = {
    "house": ("R.R. R.R. R.R. R.R. R.R.", "..R. ..R. ..R. ..R. ..R.", "R..R ..R. .R.. R.O. ..R.",
              "R... R... R... R.A. R...", "R.O. R.O. R.O. R.O. R.O."),
    "hiphop": ("R... .... ..R. ...A ....", "R..R .... ..F. .... ...R", "R... .... .... ..A. ....",
               "R.R. ...O ..R. ..F. ...."),
    "pop": ("R.R. R.R. R.R. R.R. R.R.", "R... ..R. R... ..A. ....", "R... .... R... .... ....",
            "R..R ..R. ..R. F.A. .R.."),
    "latin": ("R..F ..O. R..F ..O. ...F", "R... ...F O... ..A. ....", "...F ..O. ...F ..R. ..F.",
              "R... F... R... F.A. R..."),
    "waltz": ("R... .... F... .... ....", "R... .... R... ..A. ....", "R... .... F... F... T...",
              "R... ..F. ..O. .... ..F."),
}  # fmt: skip
CHORDS = {
    "house": ("..s. ..s. ..s. ..s. ..s.", "s..s ..s. .s.. s... ..s.", "L... .... .... .... ....",
              "s..s ..s. s..s ..s. s...", "s... s... s... s.s. s...", "s..s s... s..s s... s..."),
    "hiphop": ("L... .... .... ..s. ....", "L... .... ..L. .... ....", "..s. ...s .... ..s. ....",
               "L... .... .... .... ....", "s... s... s... s... s..."),
    "pop": ("L... .... L... .... ....", "s.s. s.s. s.s. s.s. s.s.", "a.a. a.a. a.a. a.a. a.a.",
            "L... .... .... .... ....", "s... ..s. ..s. s... ...."),
    "latin": ("s.s. .s.s .s.s .s.. s.s.", "s.s. s..s .s.s s... s.s.", "a.aa a.a. a.aa a.a. a.a.",
              "L..L ..L. .... .... ...."),
    "waltz": (".... s... .... s... s...", "L... .... .... .... ....", "a.a. a.a. a.a. a.a. a.a.",
              ".... s... s... s... s.s.", "s... ..s. s... ..s. ...."),
}  # fmt: skip
RHYTHMS = {  # of the melody; frequent ones are listed more than once
    "house": ("x..x", "..x.", "x...", ".x.x", "...."),
    "hiphop": ("x.x.", "..xx", "x...", ".x.x", "....", "...x"),
    "pop": ("x.x.", "x...", "x..x", "..x.", "...."),
    "latin": ("x..x", "..x.", ".x.x", "x.x.", "...."),
    "waltz": ("x...", "x...", "x.x.", "x...", "...."),
}


@dataclass(frozen=True)
class Note:
    """One note: its voice, start and length in beats, MIDI pitch, and strength (0-1)."""

    voice: str
    position: float
    length: float
    pitch: int
    velocity: float


@dataclass(frozen=True)
class Chord:
    """Pitch classes of a bar.

    First comes the root, then the other notes of the chord, and the scale of the bar.
    """

    root: int
    tones: tuple[int, ...]
    scale: tuple[int, ...]


def chord_on(degree: int, tonic: int, mode: str, sevenths: bool) -> Chord:
    """The chord on a degree; in minor the dominant has its leading tone. Pitch classes, 0 is C.

    chord_on(4, 9, "minor", False) is E G# B.
    """
    scale = list(SCALES[mode])
    if mode == "minor" and degree == 4:
        scale[6] = 11
    tones = [
        (tonic + scale[(degree + step) % 7]) % 12 for step in (0, 2, 4, 6)[: 4 if sevenths else 3]
    ]
    return Chord(tones[0], tuple(tones), tuple(sorted((tonic + s) % 12 for s in scale)))


def lead(tones: tuple[int, ...], before: tuple[int, ...], centre: int = 62) -> tuple[int, ...]:
    """The chord's notes, each pitch class once, near `before` and around `centre`.

    They move as little as possible.
    """
    near = [[p for p in range(centre - 9, centre + 12) if p % 12 == tone] for tone in tones]

    def cost(notes):
        notes = np.sort(notes)
        crowd = 3.0 * (np.diff(notes) < 2).sum() + max(0, notes[-1] - notes[0] - 14)
        moved = np.abs(notes[:, None] - np.array(before)).min(1).sum() if before else 0
        return moved + crowd + 0.25 * abs(notes.mean() - centre)

    return tuple(sorted(min(product(*near), key=cost)))


def draw_chords(form: Form, genre: str, rng: np.random.Generator) -> list[Chord]:
    """One chord for every bar; the last bar of a section leads back."""
    tonic = int(rng.integers(12))
    mode = str(rng.choice(list(SCALES), p=MODES[genre]))
    sevenths = rng.random() < {"house": 0.7, "hiphop": 0.8, "latin": 0.5}.get(genre, 0.25)
    choices = PROGRESSIONS[genre][mode]
    plan = {name: choices[int(rng.integers(len(choices)))] for name in ("verse", "chorus")}
    slow = 1 + (genre in ("house", "hiphop") and rng.random() < 0.4)
    turn = rng.random() < 0.6
    chords = []
    for bar in form.bars:
        progression = plan["chorus" if bar.section == "chorus" else "verse"]
        degree = progression[bar.place // slow % len(progression)]
        chords.append(chord_on(4 if bar.last and turn else degree, tonic, mode, sevenths))
    return chords


def write_bass(form: Form, chords: list[Chord], genre: str, rng: np.random.Generator) -> list[Note]:
    """Roots, and notes that lead to the next; the bass rests in breaks and quiet beginnings."""
    patterns = {
        n: marks(cells(BASS[genre][rng.integers(len(BASS[genre]))], form.groups))
        for n in ("verse", "chorus")
    }
    lowest = int(rng.integers(28, 34))
    short = rng.uniform(0.5, 0.95)
    notes = []
    for bar, chord, following in zip(form.bars, chords, [*chords[1:], chords[-1]], strict=True):
        if bar.level < 0.4:
            continue
        root = lowest + (chord.root - lowest) % 12
        strokes = patterns["chorus" if bar.section == "chorus" else "verse"]
        goal = lowest + (following.root - lowest) % 12
        above = goal + (2 if (goal + 2) % 12 in following.scale else 1)
        steps = {"R": root, "F": root + (chord.tones[2] - chord.root) % 12, "O": root + 12}
        steps |= {
            "T": root + (chord.tones[1] - chord.root) % 12,
            "A": goal - 1 if goal > root else above,
        }
        ends = [at for at, _ in strokes[1:]] + [form.metre]
        for (at, mark), end in zip(strokes, ends, strict=True):
            length = min(short * (end - at), 2.0)
            notes.append(
                Note(
                    "bass",
                    bar.number * form.metre + at,
                    length,
                    steps[mark],
                    0.95 if at == 0 else 0.8,
                )
            )
    return notes


def write_chords(
    form: Form, chords: list[Chord], genre: str, rng: np.random.Generator
) -> list[Note]:
    """The chords in their rhythm; in a break they are held."""
    patterns = {
        n: marks(cells(CHORDS[genre][rng.integers(len(CHORDS[genre]))], form.groups))
        for n in ("verse", "chorus")
    }
    # a song with only drums and bass, except in its breaks
    voicing = ()
    notes = []
    turn = 0
    absent = rng.random() < 0.08
    for bar, chord in zip(form.bars, chords, strict=True):
        if bar.section == "silence" or (absent and bar.section != "break"):
            continue
        voicing, start = lead(chord.tones, voicing), bar.number * form.metre
        held = bar.section in ("break", "intro")
        strokes = (
            [(0.0, "L")] if held else patterns["chorus" if bar.section == "chorus" else "verse"]
        )
        ends = [at for at, _ in strokes[1:]] + [form.metre]
        for (at, mark), end in zip(strokes, ends, strict=True):
            length = {"L": end - at, "s": 0.3, "a": 0.6}[mark]
            loud = 0.35 if held else 0.5 + 0.4 * bar.level
            pitches = (
                voicing if mark != "a" else [voicing[turn % len(voicing)] + 12 * (turn % 8 > 4)]
            )
            turn += mark == "a"
            notes += [Note("chords", start + at, length, pitch, loud) for pitch in pitches]
    return notes


@dataclass(frozen=True)
class Motif:
    """The tune of a phrase, without the chords.

    It has the positions of its notes (beats), and the movement of the line (scale steps).
    """

    at: list[float]
    step: list[int]


def draw_motif(form: Form, genre: str, rng: np.random.Generator) -> Motif:
    """The rhythm of one bar, repeated with a change in later bars, and a rest at the end.

    Sometimes it has a pickup.
    """
    choice = RHYTHMS[genre]
    bar = [str(choice[rng.integers(len(choice))]) for _ in range(form.metre)]
    if all(cell == "...." for cell in bar[:2]):
        bar[0] = "x..."
    rhythm = []
    for k in range(form.phrase_bars):
        other = list(bar)
        if k % 2 and form.metre > 1:
            other[-2:] = ["x...", "...."]
        rhythm += other
    at = [position for position, _ in marks(rhythm)]
    if rng.random() < 0.35:
        at = [-1.0 + 0.5 * k for k in range(2)] + at
    steps = [
        int(s)
        for s in rng.choice([-2, -1, 0, 1, 2], p=[0.12, 0.28, 0.16, 0.28, 0.16], size=len(at))
    ]
    return Motif(at, steps)


def write_melody(
    form: Form, chords: list[Chord], genre: str, rng: np.random.Generator
) -> list[Note]:
    """A tune in choruses, and often in verses: phrases a a a b.

    It has chord tones on the beats, and the root or third at the end.
    """
    motifs = {
        name: (draw_motif(form, genre, rng), draw_motif(form, genre, rng))
        for name in ("verse", "chorus")
    }
    sings = {"chorus": rng.random() < 0.85, "verse": rng.random() < 0.6}
    centre, notes = int(rng.integers(69, 76)), []
    for bar in form.bars:
        part = "chorus" if bar.section == "chorus" else "verse"
        if bar.in_phrase == 0 and bar.section in ("chorus", "verse") and sings[part]:
            turn = bar.place // form.phrase_bars
            notes += _phrase(
                form, chords, bar, motifs[part][turn % 4 == 3], centre + 2 * (part == "chorus")
            )
    return notes


def _phrase(form: Form, chords: list[Chord], bar: Bar, motif: Motif, centre: int) -> list[Note]:
    start = bar.number * form.metre
    pitch = centre
    notes = []
    for k, (at, step) in enumerate(zip(motif.at, motif.step, strict=True)):
        here = form.bars[min(max(int((start + at) // form.metre), 0), len(form.bars) - 1)]
        chord, ends = chords[here.number], k == len(motif.at) - 1
        if start + at < 0 or here.section == "break":
            continue
        step = (
            step if abs(pitch - centre) < 7 else -int(np.sign(pitch - centre))
        )  # back to the middle
        strong = at == int(at) or ends
        tones = chord.tones[:2] if ends else chord.tones[:3] if strong else chord.scale
        wanted = pitch + 2 * step
        pitch = min(
            (p for p in range(centre - 10, centre + 11) if p % 12 in tones),
            key=lambda p: abs(p - wanted),
        )  # noqa: B023
        length = min((motif.at[k + 1] if not ends else at + 2) - at, 2.0) * 0.92
        notes.append(
            Note(
                "lead",
                start + at,
                length,
                pitch,
                (0.9 if strong else 0.72) * (0.7 + 0.3 * here.level),
            )
        )
    return notes
