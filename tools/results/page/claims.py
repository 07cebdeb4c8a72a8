"""The papers' claims, each judged by a number measured here: what agrees, what does not.

No verdict is written by hand.

When the whole interval lies on the right side of the limit, the claim agrees; when the whole
interval lies on the wrong side, it does not; otherwise it is undecided. A limit can be a measured
measure: then its interval counts as well.
"""

from dataclasses import dataclass

from ..dances.budget import on_old_dances
from .markdown import cell, number, table

AGREES = "agrees"
DIFFERS = "does not agree"
OPEN = "undecided"
MISSING = "not measured yet"
TEXT = """## The papers' claims, tested

These are the claims of MoFusion, and one of MoDiff, that a measure of this course can judge. The
verdict is computed: **agrees** when the whole 95 % interval lies on the right side of the limit,
**does not agree** when it lies on the wrong side, and **undecided** when it reaches across. The
data, the sizes and the length of training are ours, so a verdict is about the idea at this scale,
not about the papers' own measures. Intervals are over songs, or over walks and trainings; another
training seed may change more. A claim may ask for less repetition or more diversity than the data
have. That alone does not make a better dance.

"""


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, the record that tests it, and the limit.

    The limit is a number, or a share of another record.
    """

    words: str
    where: str
    measure: str
    sign: int  # 1: at least the limit; -1: at most
    limit: float = 1.0
    of: str = ""  # the record whose share `limit` is
    beside: tuple[str, ...] = ()  # records shown beside it

    @property
    def rule(self) -> str:
        """The limit in words."""
        side = "at least" if self.sign > 0 else "at most"
        whole = "" if self.limit == 1 else f"{number(self.limit)} of "
        return f"{side} {whole}`{self.of}`" if self.of else f"{side} {number(self.limit)}"

    def verdict(self, records: dict[str, dict]) -> str:
        """One of AGREES, DIFFERS, OPEN, MISSING."""
        needed = [records.get(name) for name in (self.measure, self.of) if name]
        if any(one is None or one["low"] is None for one in needed):
            return MISSING
        low, high = (needed[0][side] for side in ("low", "high"))
        least, most = (self.limit, self.limit)
        if self.of:
            least, most = (self.limit * needed[1][side] for side in ("low", "high"))
        agrees, differs = (
            (low >= most, high < least) if self.sign > 0 else (high <= least, low > most)
        )
        return AGREES if agrees else DIFFERS if differs else OPEN


KNOWN = {
    "limit": 0.7,
    "of": "dancer.bas_share",
}  # seven tenths of the share with music like that of training
MEL = "dance-budget.x0.bas_share"
CLEAN = "dance-budget.no-feet.bas_share"
WEIGHTED = "dance-budget.alpha_bar"
CLAIMS = (
    Claim(
        "predicting several poses at once is better: walks follow the control less well with one",
        "MoDiff III-C",
        "ladder.ours-T_p-1.adherence_excess_mps_minus_base",
        1,
        0.0,
        beside=("ladder.ours-T_p-1.adherence_excess_mps", "ladder.ours.adherence_excess_mps"),
    ),
    Claim(
        "dances rarely repeat themselves: no more than the data",
        "1, 4.1",
        "dancer.repeat",
        -1,
        of="dancer.repeat_data",
    ),
    Claim(
        "dances repeat themselves less than those of a deterministic method",
        "4.1",
        "dancer.repeat",
        -1,
        of="regression.repeat",
    ),
    Claim(
        "raw Mel is enough: MFCC and given beats gain at most a tenth of the data's alignment",
        "2, 3.3",
        "dance-budget.mfcc.bas_share_minus_x0",
        -1,
        0.1,
        beside=(MEL, "dance-budget.mfcc.bas_share"),
    ),
    Claim(
        "a linear layer is enough for the music: it loses at most a tenth of the data's alignment",
        "3.3",
        "dance-budget.linear-music.bas_share_minus_x0",
        1,
        -0.1,
        beside=(MEL, "dance-budget.linear-music.bas_share"),
    ),
    Claim(
        "the dancer dances to a metre that was not in training",
        "1",
        "dancer.unheard.metre5.bas_share",
        1,
        **KNOWN,
    ),
    Claim(
        "the dancer dances to tempi that were not in training (the worse of two ranges)",
        "1",
        "dancer.unheard_tempo_worst_share",
        1,
        **KNOWN,
    ),
    Claim(
        "the dancer dances to instruments that were not in training",
        "1",
        "dancer.unheard.mallets.bas_share",
        1,
        **KNOWN,
    ),
    Claim(
        "the U-Net is light: a transformer of equal size dances no faster",
        "1",
        "dance-time.transformer.dance_over_x0",
        1,
        beside=("dance-time.transformer.pass_over_x0",),
    ),
    Claim(
        "the U-Net is light: a transformer of equal size trains no faster",
        "1",
        "dance-time.transformer.step_over_x0",
        1,
    ),
    Claim(
        "lightness costs no quality: a transformer gains at most a tenth of the data's alignment",
        "1",
        "dance-budget.transformer.bas_share_minus_x0",
        -1,
        0.1,
        beside=("dance-budget.transformer.bone_gain_over_x0",),
    ),
    Claim(
        "kinematic losses help: the bone error falls (shipped weights)",
        "3.2",
        "dancer.bone_gain",
        1,
        0.0,
    ),
    Claim(
        "kinematic losses help: the bone error falls (trainings of equal length)",
        "3.2",
        f"{WEIGHTED}.bone_gain_over_x0",
        1,
        0.0,
        beside=(f"{WEIGHTED}.bas_share_minus_x0",),
    ),
    Claim(
        "their weight over time helps: the bone error is smaller than with equal weights",
        "3.2",
        f"{WEIGHTED}.bone_gain_over_constant",
        1,
        0.0,
    ),
    Claim(
        "their weight over time helps: dances are more on the beat than with equal weights",
        "3.2",
        f"{WEIGHTED}.bas_share_minus_constant",
        1,
        0.0,
    ),
    Claim(
        "the noise, unweighted, is a good target: it reaches seven tenths of the alignment of x0",
        "3.1",
        "dance-budget.eps.bas_share",
        1,
        0.7,
        CLEAN,
        ("dance-budget.eps-weighted.bas_share",),
    ),
    Claim(
        "dances are on the beat at least as well as the data",
        "Table 1",
        "dancer.bas",
        1,
        of="dancer.bas_data",
    ),
    Claim(
        "one piece has many dances, which differ as much as the data's",
        "Table 1",
        "dancer.multimodality_over_data",
        1,
        beside=("regression.multimodality",),
    ),
    Claim(
        "attention falls on the beats, more than on those of other songs",
        "Fig. 4",
        "attention.beat_mass_over_shuffled",
        1,
        beside=("attention.beat_mass_over_shifted",),
    ),
    Claim(
        "attention falls on the beats at the bottom of the U-Net",
        "Fig. 4",
        "attention.bottom.beat_mass_over_shuffled",
        1,
    ),
    Claim(
        "the bottom of the U-Net reads less of the music at a time than the top",
        "Fig. 4",
        "attention.bottom_over_top_seconds",
        -1,
    ),
    Claim(
        "motions to text barely confuse left and right: at most in one of twenty acts",
        "1",
        "words.side_confused",
        -1,
        0.05,
        beside=("words.side_accuracy",),
    ),
)


def claims(records: dict[str, dict]) -> str:
    """The claims that agree and those that do not; then, folded, a line for each claim."""
    judged = [(claim, claim.verdict(records)) for claim in CLAIMS]
    rows = [
        [_said(one, records), one.where, f"**{said}**", _measured(one, records), one.rule]
        for one, said in judged
    ]
    judgements = table(
        ["claim", "where in MoFusion, unless said", "verdict here", "measured", "limit"], rows
    )
    sums = [
        f"* **{said}** ({len(of)}): {'; '.join(of) or 'none'}"
        for said in (AGREES, DIFFERS, OPEN, MISSING)
        for of in [[_said(claim, records) for claim, found in judged if found == said]]
    ]
    fold = f"<details><summary>Each claim with its measures</summary>\n\n{judgements}\n</details>\n"
    return TEXT + "\n".join(sums) + "\n\n" + fold


def _said(claim: Claim, records: dict[str, dict]) -> str:
    """The claim, and whether it was tested on earlier data."""
    old = claim.measure in records and on_old_dances(records[claim.measure])
    return claim.words + " *(tested on the old dances)*" * old


def _measured(claim: Claim, records: dict[str, dict]) -> str:
    names = [name for name in (claim.measure, claim.of, *claim.beside) if name]
    return "; ".join(f"`{name}` {cell(records.get(name), unit=False)}" for name in names)
