"""The papers' claims, each judged by a record. No verdict is written by hand.

A line of a `claims` block of the template is `claim | where in the paper | record | limit`. A limit
is `at least 0.7`, `at most 0.7`, or a share of another record: `at least 0.7 of dancer.bas_share`.
Where the whole interval is on the right side of the limit, the claim agrees; on the wrong side, it
does not; across, it is undecided. The interval of a limit that is a record counts as well.
"""

import re
from dataclasses import dataclass

from .records import cell, table

AGREES, DIFFERS = "agrees", "does not agree"
OPEN, MISSING = "undecided", "not measured"
LIMIT = re.compile(r"at (least|most) (\S+?)(?: of (\S+))?$")


@dataclass(frozen=True)
class Claim:
    """A claim of a paper, the record that tests it, and the limit."""

    words: str
    where: str
    record: str
    limit: str

    @property
    def names(self) -> list[str]:
        """The records that it needs."""
        return [self.record, *filter(None, [self.parts[2]])]

    @property
    def parts(self) -> tuple[str, str, str | None]:
        """Least or most, the share, and the record that it is a share of, if any."""
        found = LIMIT.match(self.limit)
        if found is None:
            raise ValueError(
                f"claim {self.words!r}: write 'at least x' or 'at most x of record', "
                f"not {self.limit!r}"
            )
        return found.groups()

    def verdict(self, records: dict[str, dict]) -> str:
        """One of AGREES, DIFFERS, OPEN, MISSING."""
        needed = [records.get(name) for name in self.names]
        if any(one is None or one["low"] is None for one in needed):
            return MISSING
        side, share, of = self.parts
        low, high = needed[0]["low"], needed[0]["high"]
        least = most = float(share)
        if of:
            least, most = (float(share) * needed[1][end] for end in ("low", "high"))
        if side == "most":
            low, high = -high, -low
            least, most = -most, -least
        return AGREES if low >= most else DIFFERS if high < least else OPEN


def read_claims(block: str) -> list[Claim]:
    """The claims of a block of the template."""
    return [Claim(*line.split(" | ")) for line in block.splitlines()]


def places(claims: list[Claim], records: dict[str, dict]) -> dict[str, str]:
    """What the template can name: the counts, and the table."""
    verdicts = [claim.verdict(records) for claim in claims]
    found = {f"number of claims: {word}": str(verdicts.count(word))
             for word in (AGREES, DIFFERS, OPEN, MISSING)}  # fmt: skip
    found["number of claims"] = str(len(claims) - verdicts.count(MISSING))
    return found | {"claims": _table(claims, verdicts, records)}


def _table(claims: list[Claim], verdicts: list[str], records: dict[str, dict]) -> str:
    order = [AGREES, DIFFERS, OPEN, MISSING]
    pairs = sorted(zip(claims, verdicts, strict=True), key=lambda pair: order.index(pair[1]))
    rows = [
        [
            claim.words,
            claim.where,
            f"**{verdict}**",
            cell(records.get(claim.record)),
            _limit_in_numbers(claim, records),
        ]
        for claim, verdict in pairs
    ]
    return table(["claim", "where", "verdict here", "measured", "limit"], rows)


def _limit_in_numbers(claim: Claim, records: dict[str, dict]) -> str:
    """The limit, with the numbers of the record that it is a share of."""
    _, _, of = claim.parts
    return (
        claim.limit.replace(" 1 of ", " ").replace(of, cell(records.get(of))) if of else claim.limit
    )
