"""What a set-up sheet says, whatever it is written as."""

from __future__ import annotations

from dataclasses import dataclass

from ..plot.page import Box, TracedPolyline


@dataclass(frozen=True)
class SheetColumn:
    """A column of a table.

    Attributes:
        title: above it. width: share of the table's width. number: figures, which stand at its right edge.
    """

    title: str
    width: float
    number: bool = False


@dataclass(frozen=True)
class SheetTable:
    """A table: of tools, or of operations.

    Attributes:
        rows: cells by column. total: last row, in bold; none = there is none.
    """

    title: str
    columns: tuple[SheetColumn, ...]
    rows: tuple[tuple[str, ...], ...]
    total: tuple[str, ...] = ()


@dataclass(frozen=True)
class SheetFact:
    """Something that whoever sets the machine up has to know.

    Attributes:
        label: a word for it. text: sentences of the program. own: somebody's own words, which stand before these.
    """

    label: str
    text: str
    own: str = ""

    @property
    def said(self) -> str:
        """All of it."""
        return " ".join(filter(None, (self.own, self.text)))


@dataclass(frozen=True)
class SheetProof:
    """A line of the certificate.

    Attributes:
        claim: what holds. bound: by which figure, and how it was found.
        holds: True = proven; False = it does not hold; None = nobody has looked.
    """

    claim: str
    bound: str
    holds: bool | None


@dataclass(frozen=True)
class SheetHash:
    """The SHA-256 of a file that the certificate is about."""

    what: str
    sha256: str


Legend = tuple[tuple[str, TracedPolyline], ...]
"""Word and line of each kind of line in a picture."""


@dataclass(frozen=True, eq=False)
class SetupPicture:
    """Stock, part and paths seen from above, mm, in one frame of coordinates.

    Attributes:
        stock: x0, y0, x1, y1 of the stock; None = not known.
        zero: where the program's X 0 Y 0 is; None = not known.
        lines: what is drawn, first to last.
        legend: of the kinds of line that are seen.
    """

    stock: Box | None
    zero: tuple[float, float] | None
    lines: tuple[TracedPolyline, ...]
    legend: Legend = ()


@dataclass(frozen=True)
class SheetWords:
    """What a sheet says itself.

    Attributes:
        sheet: what it is. goes_on: on a page that is not the first. holds, fails, open: of a line of the certificate,
            where it is proven, is not so, or nobody has looked. set_up_by, date: what is written by hand.
    """

    sheet: str = "Set-up sheet"
    goes_on: str = "goes on"
    certificate: str = "Certificate"
    holds: str = "holds"
    fails: str = "does not hold"
    open: str = "not proven"
    counts: str = "What counts"
    remarks: str = "Remarks"
    set_up_by: str = "Set up by"
    date: str = "Date"

    def verdict(self, holds: bool | None) -> str:
        """Return the word for a line of the certificate."""
        return self.open if holds is None else self.holds if holds else self.fails


@dataclass(frozen=True, eq=False)
class SetupSheet:
    """Everything on the sheet of one set-up.

    Attributes:
        title: of the part. program: names of its files, and for which control.
        verdict: the certificate in a sentence; good: whether the program may run; None = nothing counts, but it was not
            compared with a part, so that nobody can say.
        facts: stock, zero, clamping and the like.
        findings: sentences that count; remarks: others.
        hashes: of drawing, job and each file.
        made_by: program and version.
        language: code of that which it is in. words: what it says itself.
    """

    title: str
    program: str
    verdict: str
    good: bool | None
    picture: SetupPicture
    facts: tuple[SheetFact, ...]
    tables: tuple[SheetTable, ...]
    proofs: tuple[SheetProof, ...]
    findings: tuple[str, ...]
    remarks: tuple[str, ...]
    hashes: tuple[SheetHash, ...]
    made_by: str
    language: str = "en"
    words: SheetWords = SheetWords()
