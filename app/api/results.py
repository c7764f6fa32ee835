"""What the calls of the Python door return: frozen values with arrays in them, that save themselves and show themselves
in a notebook.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.atomic import write_together
from ..core.catalogue import LANGUAGES
from ..core.errors import InputError
from ..core.input_file import read_input
from ..core.wording import counted, either, minutes_words
from ..formats.sheet import SUFFIXES
from ..gcode.interpreter.program import ProgramProblem
from ..model.finding import Finding
from ..model.job import Job
from ..model.motion import Motions
from ..model.moves import Moves
from ..simulation.field.workpiece import Heights
from ..usecases.better import report as better_report
from ..usecases.better.result import BetterProgram
from ..usecases.cutting.cut import CutProgram
from ..usecases.cutting.report import CutReport
from ..usecases.examine import ExaminedProgram
from ..usecases.inlay import InlayFit, InlayPair
from ..usecases.making.make import MakeResult
from ..usecases.scene_program.nc import WrittenScene
from ..usecases.scene_program.report import SurfaceReport
from ..usecases.smoothing import report as smoothing_report
from ..usecases.smoothing.result import SmoothedProgram
from .words import speaks_python

Report = dict[str, Any]


class _Shown:
    """What a prompt shows of a result: its first line, not the ten thousand values that are behind it."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {str(self).partition(chr(10))[0]}>"


@dataclass(frozen=True, eq=False, repr=False)
class MadeProgram(_Shown):
    """A program that was made, read back and proven.

    Attributes:
        result: all that is known of it.
    """

    result: MakeResult

    @property
    def job(self) -> Job:
        """What it was computed from: tools, operations, stock."""
        return self.result.job

    @property
    def text(self) -> str:
        """Its NC text; of several files the first one's."""
        return self.result.nc.text

    @property
    def moves(self) -> Moves:
        """Arrays (n, ...) of its moves: start, end, centre, mm, part coordinates; kind, feed, tool, operation, line."""
        return self.result.program.moves

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Everything there is to say, what counts first."""
        return self.result.findings

    @property
    def clean(self) -> bool:
        """True when no finding counts."""
        return self.result.clean

    @property
    def report(self) -> Report:
        """Every measured number, by the keys of `make --report`."""
        return self.result.report.data

    def save(self, path: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write the program, all its files whole or none; return their paths: one a tool where the control
        changes none.

        Raises:
            InputError: one cannot be written.
        """
        files = {file.named(Path(path)): file.nc.text.encode("ascii") for file in self.result.files}
        write_together(files)
        return tuple(files)

    def sheet(
        self, path: str | os.PathLike[str], drawing: str | os.PathLike[str] | None = None, language: str = "en"
    ) -> Path:
        """Write the sheet that goes to the machine; return its path.

        Args:
            path: ends in .pdf or .html. drawing: whose SHA-256 is to stand on it. language: "en" or "ja", Japanese.

        Raises:
            InputError: it cannot be written, or is neither; the language is none of these, or this machine has no font
                with its letters.
        """
        from ..usecases.make_files import other_files

        target = Path(path)
        if target.suffix.lower() not in SUFFIXES:
            raise InputError(f"{target}: a sheet is .pdf or .html; change the name")
        if language not in LANGUAGES:
            raise InputError(f"language is {language!r}; use {either(map(repr, LANGUAGES))}")
        data = None if drawing is None else read_input(Path(drawing))
        write_together({target: other_files(self.result, {"sheet": target}, data, language)["sheet"]})
        return target

    def svg(self) -> str:
        """Return the picture of part and paths."""
        from ..formats.plot.plot import plot
        from ..usecases.making.picture import picture_of

        picture = picture_of(self.job.part.name, self.result.program, self.result.coverage)
        return plot(picture, ".svg").decode()

    def _repr_svg_(self) -> str:
        return self.svg()

    def __str__(self) -> str:
        return self.result.report.summary(self.job.part.name)


@dataclass(frozen=True, eq=False, repr=False)
class MadeInlay(_Shown):
    """A pocket and the plug that fits into it, read back, proven, and laid into one another.

    Attributes:
        result: all that is known of them.
    """

    result: InlayPair

    @property
    def pocket(self) -> MadeProgram:
        """The program of the pocket."""
        return MadeProgram(self.result.pocket)

    @property
    def plug(self) -> MadeProgram:
        """The program of the plug; its drawing is mirrored, x to -x."""
        return MadeProgram(self.result.plug)

    @property
    def fit(self) -> InlayFit:
        """How they fit, mm of height."""
        return self.result.fit

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What is wrong with the fit; each program has its own."""
        return self.result.findings

    @property
    def clean(self) -> bool:
        """True when no finding counts, of the fit and of both programs."""
        return self.result.clean

    @property
    def report(self) -> Report:
        """Every measured number, by the keys of `inlay --report`."""
        return self.result.values()

    def save(self, path: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write both programs, all files whole or none; return their paths: `path` with _pocket and _plug behind it.

        Raises:
            InputError: one cannot be written.
        """
        files = self.result.files(Path(path))
        write_together(files)
        return tuple(files)

    def __str__(self) -> str:
        return "\n".join([str(self.pocket), str(self.plug), self.fit.summary()])


@dataclass(frozen=True, eq=False, repr=False)
class CheckedProgram(_Shown):
    """An NC program as its control reads it.

    Attributes:
        result: all that is known of it.
    """

    result: ExaminedProgram

    @property
    def problems(self) -> tuple[ProgramProblem, ...]:
        """What its control would refuse, or warn of."""
        return self.result.problems

    @property
    def clean(self) -> bool:
        """True when there is no problem."""
        return not self.result.problems

    @property
    def motions(self) -> Motions:
        """Arrays (n, ...) of its motions: start, end, centre, mm, program coordinates; kind, feed, line."""
        return self.result.program.motions

    @property
    def time_s(self) -> float:
        """How long it takes on the machine that it was timed on, s."""
        return self.result.time.total

    @property
    def report(self) -> Report:
        """Everything that was found, by the keys of `check --report`."""
        return self.result.report()

    def __str__(self) -> str:
        lines = [problem.message(self.result.name) for problem in self.problems]
        return "\n".join(
            [f"{self.result.name}: {counted(len(lines), 'problem')}, {minutes_words(self.time_s)} min", *lines]
        )


@dataclass(frozen=True, eq=False, repr=False)
class _Reported(_Shown):
    """What a report has been made of.

    Attributes:
        told: its report.
    """

    told: CutReport | SurfaceReport

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Everything that is wrong, with its place; of a cut also what went wrong on the way, what counts first."""
        return self.told.findings

    @property
    def clean(self) -> bool:
        """True when no finding counts."""
        return not any(finding.counts for finding in self.findings)

    @property
    def report(self) -> Report:
        """Every measured number, by the keys of `--report` of the command of the same name."""
        return self.told.data

    def __str__(self) -> str:
        return "\n".join(self.told.summary())


@dataclass(frozen=True, eq=False, repr=False)
class CutMetal(_Reported):
    """What programs leave of their stock, and how near it is to the part.

    Attributes:
        result: all that is known of it. name: of the first program.
    """

    result: CutProgram
    name: str

    @property
    def heights(self) -> Heights:
        """Of what is left at the middles of cells, (rows, columns), mm, program coordinates; rows go along Y."""
        return self.result.cut.heights

    def png(self) -> bytes:
        """Return the picture of what is left: gouges red, metal left blue where it was compared with a part."""
        from ..usecases.cut_files import picture_of

        return picture_of(self.result, self.name)

    def _repr_png_(self) -> bytes:
        return self.png()


@dataclass(frozen=True, eq=False, repr=False)
class _NewText(_Shown):
    """A program in place of another one.

    Attributes:
        result: all that is known of it.
    """

    result: SmoothedProgram | BetterProgram

    @property
    def text(self) -> str:
        """Its NC text."""
        return self.result.data.decode("latin-1")

    def save(self, path: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write the program, whole or not at all.

        Raises:
            InputError: it cannot be written.
        """
        write_together({Path(path): self.result.data})
        return (Path(path),)


@dataclass(frozen=True, eq=False, repr=False)
class SmoothedText(_NewText):
    """A program that was smoothed, read back and proven.

    Attributes:
        result: all that is known of it.
    """

    result: SmoothedProgram

    @property
    def bound(self) -> float:
        """Proven: nowhere are curve and moves farther apart, mm."""
        return self.result.bound

    @property
    @speaks_python
    def findings(self) -> tuple[Finding, ...]:
        """Stretches that could not be proven and stayed as they were."""
        return smoothing_report.findings(self.result)

    @property
    def clean(self) -> bool:
        """True when no finding counts."""
        return not self.findings

    @property
    def report(self) -> Report:
        """The certificate and every stretch, by the keys of `smooth --report`."""
        return smoothing_report.report(self.result)

    def __str__(self) -> str:
        return "\n".join(smoothing_report.certificate(self.result))


@dataclass(frozen=True, eq=False, repr=False)
class BetterText(_NewText):
    """A program whose passes were made anew, cut again and compared with the old one.

    Attributes:
        result: all that is known of it.
    """

    result: BetterProgram

    @property
    @speaks_python
    def findings(self) -> tuple[Finding, ...]:
        """What somebody has to know before it is used."""
        return better_report.findings(self.result)

    @property
    def clean(self) -> bool:
        """True when no finding counts."""
        return not any(finding.counts for finding in self.findings)

    @property
    def report(self) -> Report:
        """Everything that was found, by the keys of `better --report`."""
        return better_report.report(self.result)

    def __str__(self) -> str:
        return "\n".join(better_report.lines(self.result))


@dataclass(frozen=True, eq=False, repr=False)
class MadeSurface(_Reported):
    """The program over the surfaces of a scene, proven.

    Attributes:
        result: all that is known of it.
    """

    result: WrittenScene

    def save(self, path: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write the program, all its files whole or none; return their paths.

        Raises:
            InputError: one cannot be written.
        """
        from ..usecases.surface_files import program_files

        files = program_files(self.result, Path(path))
        write_together(files)
        return tuple(files)

    def svg(self) -> str:
        """Return the paths in the order of cutting, by surface."""
        from ..usecases.scene.plot import plot_surface

        return plot_surface(self.result.computed, ".svg")[0].decode()

    def _repr_svg_(self) -> str:
        return self.svg()
