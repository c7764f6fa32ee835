"""One part of a batch: what is to be done with it, and what became of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

if TYPE_CHECKING:  # who hands parts out needs nothing of what does them
    from ..examine import ExamineOptions
    from ..job.options import MakeOptions
    from ..smoothing.result import SmoothOptions

    PartOptions: TypeAlias = MakeOptions | ExamineOptions | SmoothOptions

Json = dict[str, Any]


class BatchKind(Enum):
    """What is done with every part: the command of that name."""

    MAKE = "make"
    CHECK = "check"
    SMOOTH = "smooth"


class BatchVerdict(Enum):
    """What became of a part.

    Attributes:
        words: how people are told of it.
        final: whether the same input has the same fate again, so that nothing is gained by another try.
    """

    words: str
    final: bool

    def __new__(cls, key: str, words: str, final: bool) -> BatchVerdict:
        """Keep what is known of it beside the key."""
        verdict = object.__new__(cls)
        verdict._value_ = key
        verdict.words, verdict.final = words, final
        return verdict

    CLEAN = "clean", "clean", True
    FINDINGS = "findings", "with findings", True
    REFUSED = "refused", "cannot be used", True
    FAILED = "failed", "failed", False
    KILLED = "killed", "its process was killed", False
    OVERDUE = "overdue", "took too long", False
    OPEN = "open", "not done yet", False


@dataclass(frozen=True)
class BatchExtras:
    """What is written beside each program.

    Attributes:
        report: everything that was measured, as JSON.
        image: suffix of a picture of part and paths, .svg or .png; "" = none. sheet: of the sheet for the machine, .pdf
            or .html, alike. language: of sheets.
    """

    report: bool = False
    image: str = ""
    sheet: str = ""
    language: str = "en"


class NamedTask(Protocol):
    """Anything that a lane does: a part of a batch, a tile of a cut."""

    @property
    def name(self) -> str:
        """What people are told that it is."""


@dataclass(frozen=True)
class BatchTask:
    """A part, and what is to be done with it.

    Attributes:
        name: as the table has it: the path of its file from where the batch was told of it.
        data: the file's bytes.
        kind: what is done.
        options: those of the command of that name.
        output: of the program, a path from the batch's folder; of a check, which writes none, what reports are named
            after.
        extras: what else is written.
        file: name of the part's file, which tells its format; "" = the end of `name`.
        memory: bytes that it may take; None = as one job alone may.
    """

    name: str
    data: bytes
    kind: BatchKind
    options: PartOptions
    output: str
    extras: BatchExtras = BatchExtras()
    file: str = ""
    memory: int | None = None


@dataclass(frozen=True)
class BatchRow:
    """What the table tells of a part.

    Attributes:
        name: of the part.
        verdict: what became of it.
        time_s: of the program on its machine, s; None where there is no program.
        length_mm: of all its motions, mm; None alike.
        findings: sentences, what counts first; why it is not done where it is not.
        counting: how many of them count.
        picture: small SVG text; "" = none.
        left_mm2: what a made program leaves of the floor, whether or not a tool reaches it, mm2; None = not known.
    """

    name: str
    verdict: BatchVerdict
    time_s: float | None = None
    length_mm: float | None = None
    findings: tuple[str, ...] = ()
    counting: int = 0
    picture: str = ""
    left_mm2: float | None = None

    def values(self) -> Json:
        """Return it as plain values."""
        return asdict(self) | {"verdict": self.verdict.value}

    @staticmethod
    def of(values: Mapping[str, Any]) -> BatchRow:
        """Return what `values` was made of.

        Raises:
            KeyError, TypeError, ValueError: they are not those of a row.
        """
        told = {**values, "verdict": _verdict(values["verdict"]), "findings": tuple(values["findings"])}
        return BatchRow(**told)


def _verdict(key: str) -> BatchVerdict:
    """Return a verdict by its key.

    Raises:
        ValueError: there is none.
    """
    for verdict in BatchVerdict:
        if verdict.value == key:
            return verdict
    raise ValueError(f"{key!r} is no verdict")


@dataclass(frozen=True)
class BatchResult:
    """What became of a part, with its files.

    Attributes:
        row: of the table.
        files: bytes by path from the batch's folder.
    """

    row: BatchRow
    files: Mapping[str, bytes]
