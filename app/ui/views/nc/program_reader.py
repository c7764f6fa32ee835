"""Reading programs in the background: from a file or a text to lines, motions and pictures."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from ....core.atomic import read_whole
from ....core.errors import InputError
from ....core.progress import Progress
from ....gcode.interpreter.dialect import Dialect
from ....gcode.interpreter.options import PATIENT, ReadOptions, ToolOffset
from ....gcode.interpreter.program import NcProgram
from ....gcode.timing.duration import Duration
from ....model.part import Units
from ...framework.worker import Answer, Worker
from .line_marks import LineMarks, line_marks
from .motion_shapes import MotionShapes, ViewSide, shape_motions
from .painting.motion_layer import MotionLayer
from .program_text import ProgramText, program_text

SUFFIXES = (".ngc", ".nc", ".tap", ".gcode", ".cnc", ".g", ".gc", ".eia", ".min", ".mpf", ".spf", ".h", ".iso", ".txt")
"""Those of controls that are not read are among them: what is said of such a program names its control."""

_HEAD_BYTES, _BLOCKS = 4096, 2
_BLOCK = re.compile(rb"^\s*/?(?:N\d+\s*)?[GMTO]\s*\d", re.MULTILINE)
FILTER = f"NC programs ({' '.join('*' + suffix for suffix in SUFFIXES)});;All files (*)"


def is_program(path: Path) -> bool:
    """Return whether a file's name says that it is an NC program."""
    return path.suffix.lower() in SUFFIXES


def looks_like_program(path: Path) -> bool:
    """Return whether a file of any name begins as an NC program does: many controls give theirs no suffix, or an own
    one; of none that cannot be read.
    """
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD_BYTES)
    except OSError:
        return False
    return b"\0" not in head and len(_BLOCK.findall(head)) >= _BLOCKS


@dataclass(frozen=True, eq=False)
class ProgramSource:
    """What is to be read.

    Attributes:
        name: for people. data: the bytes; None = those of the file. path: the file, None = it is in none.
        dialect: the control's; None = as it looks. tools: the control's tool table, for cutter compensation.
        units: of a program that names none; None = nobody has said, and mm are taken.
    """

    name: str
    data: bytes | None = None
    path: Path | None = None
    dialect: Dialect | None = None
    tools: Mapping[int, ToolOffset] = field(default_factory=dict)
    units: Units | None = None

    def options(self, dialect: Dialect) -> ReadOptions:
        """Return how the program is to be read."""
        return ReadOptions(dialect, self.tools, limits=PATIENT, units=self.units)

    def named_units(self) -> bytes:
        """Return the bytes of a program whose text says its units, or whose mm are what everything takes it in.

        Raises:
            InputError: it was said to be in inches, which its own text does not say; the file cannot be read.
        """
        if self.units is Units.INCH:
            raise InputError(f"{self.name} names no units; write G20 at its beginning, so that its own text says inch.")
        return self.bytes()

    def bytes(self) -> bytes:
        """Return the program's bytes.

        Raises:
            InputError: the file cannot be read.
        """
        if self.data is not None:
            return self.data
        try:
            return read_whole(Path(self.path or self.name))
        except OSError as error:
            raise InputError(f"Cannot read {self.path}: {error.strerror}. Choose another file.") from error


@dataclass(frozen=True, eq=False)
class ShownProgram:
    """A program that was read, ready to be shown.

    Attributes:
        source: where it came from, with its bytes. dialect: in which it was read.
        text, looks, shapes: lines, their looks, the motions; where the tool stands before them nobody knows, so the
            first ones begin where the program sends each axis. times: when each motion ends.
        pictures: of the sides that were asked for.
        unnamed: it moves, and names no units.
    """

    source: ProgramSource
    dialect: Dialect
    guessed: Dialect
    text: ProgramText
    looks: LineMarks
    shapes: MotionShapes
    times: Duration
    pictures: dict[ViewSide, MotionLayer]
    unnamed: bool = False

    @property
    def program(self) -> NcProgram:
        """What the reader made of it."""
        return self.shapes.program


def read_shown(source: ProgramSource, side: ViewSide, progress: Progress) -> ShownProgram:
    """Read a program and prepare everything that is shown of it.

    Raises:
        InputError: the file cannot be read.
        Cancelled: the job was asked to stop.
    """
    from ....formats.machine_toml import DEFAULT_MACHINE, load_machine
    from ....gcode.interpreter.dialect_guess import guess_dialect
    from ....gcode.interpreter.foreign_codes import names_units
    from ....gcode.interpreter.notes_operation import contour_motions
    from ....gcode.interpreter.reader import read_program
    from ....gcode.timing.duration import duration
    from ....model.motion_path import anchored

    progress.step(0.0, f"Reading {source.name}")
    data = source.bytes()
    text = program_text(data)
    guessed = guess_dialect(data)
    dialect = source.dialect or guessed
    program = read_program(data, source.options(dialect), progress.part(0.05, 0.6))
    progress.step(0.6, "Preparing the picture")
    program = replace(program, motions=anchored(program.motions))
    shapes = shape_motions(program, contour_motions(data, program))
    progress.step(0.7, "Preparing the picture")
    picture = MotionLayer(shapes, side)
    progress.step(0.95, "Estimating the time")
    times = duration(program, load_machine(DEFAULT_MACHINE))
    looks = line_marks(len(text), shapes, program.problems)
    read = replace(source, data=data)
    unnamed = len(shapes) > 0 and not names_units(data)
    return ShownProgram(read, dialect, guessed, text, looks, shapes, times, {side: picture}, unnamed)


class ProgramReader(QObject):
    """Runs one job for the NC view at a time; a newer one takes its place.

    Signals:
        failed(sentence).
    """

    failed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.worker = Worker(self)
        self.worker.failed.connect(lambda outcome: self.failed.emit(outcome.error or ""))

    def start(self, function: Callable[[Progress], Answer], take: Callable[[Answer], None]) -> None:
        """Run `function(progress)` on another thread, then call `take(answer)` on this one."""
        self.worker.start(function, 0, take)

    def read(self, source: ProgramSource, side: ViewSide, then: Callable[[ShownProgram], None]) -> None:
        """Read a program, then show it."""
        self.start(lambda progress: read_shown(source, side, progress), then)
