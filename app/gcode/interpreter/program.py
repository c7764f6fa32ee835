"""What reading an NC program gives: its motions, what happens between them, and what is wrong with the text."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import printable
from ...model.fields import built
from ...model.job import Copies
from ...model.motion import MotionKind, Motions, Nurbs, Plane
from ...model.moves import DogBone, Tab
from ...model.operation import Operation
from ...model.part import Units
from ...model.read_options import AS_DRAWN, DrawingOptions


class FeedMode(Enum):
    """What an F word means."""

    PER_MINUTE = "G94"
    INVERSE_TIME = "G93"
    PER_REVOLUTION = "G95"


@dataclass(frozen=True, slots=True)
class ModalState:
    """What is in force while a motion is done, but for its own G word and feed.

    Attributes:
        units, plane: of the words to come.
        absolute: G90 rather than G91. arc_absolute: G90.1 rather than G91.1.
        feed_mode: what F means.
        tool: T number in the spindle, 0 = none yet. length_offset: H number of G43, 0 = G49.
        speed: rpm, >= 0; under G96 the surface speed in m/min. constant_surface: G96 rather than G97.
        spindle: -1 counter-clockwise (M4), 0 off (M5), 1 clockwise (M3).
        flood, mist: coolant.
        work_offset: "G54" ... "G59.3", or "G54.1 P12".
        shift: what is added to program coordinates, mm: work offset, G52, G92. rotation: of G10 L2 R, radians.
        respelled: words of axes are no coordinates: G16, G51, G51.1.
        path: "G61", "G61.1", "G64", with P and Q as the program says.
        path_tolerance: P of G64, mm; None where none is given, 0 for G61.
        retract_to_r: G99 rather than G98.
    """

    units: Units = Units.MM
    plane: Plane = Plane.XY
    absolute: bool = True
    arc_absolute: bool = False
    feed_mode: FeedMode = FeedMode.PER_MINUTE
    tool: int = 0
    length_offset: int = 0
    speed: float = 0.0
    constant_surface: bool = False
    spindle: int = 0
    flood: bool = False
    mist: bool = False
    work_offset: str = "G54"
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: float = 0.0
    respelled: bool = False
    path: str = "G64"
    path_tolerance: float | None = None
    retract_to_r: bool = False


class EventKind(Enum):
    """What a control does between motions."""

    DWELL = "dwell"
    TOOL_CHANGE = "tool change"
    STOP = "stop"
    OPTIONAL_STOP = "optional stop"
    END = "end"


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happens before a motion.

    Attributes:
        before: index of the motion that comes next; the number of motions at the end.
        line: 1-based line of the text.
        value: seconds of a dwell, T number of a tool change; 0 for others.
    """

    kind: EventKind
    before: int
    line: int
    value: float = 0.0


class Severity(Enum):
    """How bad a problem is."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True)
class ProgramProblem:
    """Something in the text that the control would refuse, or that the reader cannot follow.

    Attributes:
        line, column: 1-based; column counts characters, 0 = the whole line.
        word: the word as it is written, or "".
        text: a sentence: what is wrong, what was expected.
        severity: an error ended the reading there; after a warning it went on.
    """

    line: int
    column: int
    word: str
    text: str
    severity: Severity = Severity.ERROR

    def message(self, file: str) -> str:
        """Return the problem with its place: "part.ngc:12:7: G41: ...".

        Args:
            file: name of the program.
        """
        place = f"{file}:{self.line}:{self.column}" if self.column else f"{file}:{self.line}"
        return printable(f"{place}: {self.word + ': ' if self.word else ''}{self.text}")


@dataclass(frozen=True, slots=True)
class ToolNote:
    """A tool as the program's comments tell of it.

    Attributes:
        number: T number, 0 where the comment names none and no T word was near.
        kind: "flat", "ball", "bull", "v", "drill", "taper", or "" where it is not told.
        diameter, corner_radius: mm, 0 = not told. angle: full angle of the tip, radians, 0 = not told.
        line: 1-based line of the comment.
        tip_diameter: mm, 0 = not told.
    """

    number: int
    kind: str = ""
    diameter: float = 0.0
    corner_radius: float = 0.0
    angle: float = 0.0
    line: int = 0
    tip_diameter: float = 0.0


@dataclass(frozen=True, slots=True)
class StockNote:
    """The stock as the program's comments tell of it.

    Attributes:
        low, high: corners of the box, mm, program coordinates; NaN where a coordinate is not told.
        size: x, y, z of the box, mm; NaN where it is not told.
        line: 1-based line of the comment.
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    size: tuple[float, float, float]
    line: int = 0


@dataclass(frozen=True, slots=True)
class OperationNote:
    """An operation as the header of our own tells of it.

    Attributes:
        kind: of operation.
        values: parameters that are told, by key. Controls that write capitals alone write names so too.
    """

    kind: type[Operation]
    values: tuple[tuple[str, Any], ...]

    def operation(self) -> Operation:
        """Return the operation; a step that is not told is never in the way of its depth.

        Raises:
            ParameterError: the values make none.
        """
        noted = dict(self.values)
        return built(self.kind, {"stepdown": noted.get("depth", 2.0), **noted})


class KeepOutNote(NamedTuple):
    """Layers of clamps, and how high these are, mm."""

    layers: tuple[str, ...] = ()
    height: float = 0.0


NO_KEEP_OUT = KeepOutNote()


class PlungeRateNote(NamedTuple):
    """A T number, and how fast it may be fed straight down, mm/min."""

    tool: int
    rate: float


@dataclass(frozen=True, slots=True)
class HeaderNote:
    """What the header of our own tells beside tools and stock (`app.gcode.writer.header`); None or nothing where
    it does not.

    Attributes:
        origin: the program's zero in the coordinates of the drawing, mm.
        operations: in their order.
        drawing_units: of the drawing.
        layers: that were machined; empty = all visible ones. Controls that write capitals alone write these so too.
        reading: what else was said about reading the drawing.
        join_tolerance: within which loose ends were joined, mm.
        path_tolerance: by how much the written path may be too near to the walls, mm.
        allowance: so thick a skin may paths made from pixels leave along the walls, mm.
        copies: of the part.
        keep_out: where clamps are.
        tabs, dog_bones: where metal was left standing, and where walls were cut into, part coordinates.
        plunge_rates: how fast tools may be fed straight down.
        under: thickness of the waste below the stock that may be cut into, mm. above: what of the stock stands above Z
            0 of the drawing, mm.
    """

    origin: tuple[float, float, float] | None = None
    operations: tuple[OperationNote, ...] = ()
    drawing_units: Units | None = None
    layers: tuple[str, ...] = ()
    join_tolerance: float | None = None
    path_tolerance: float | None = None
    allowance: float | None = None
    copies: Copies | None = None
    keep_out: KeepOutNote = NO_KEEP_OUT
    tabs: tuple[Tab, ...] = ()
    dog_bones: tuple[DogBone, ...] = ()
    reading: DrawingOptions = AS_DRAWN
    plunge_rates: tuple[PlungeRateNote, ...] = ()
    under: float = 0.0
    above: float = 0.0


@dataclass(frozen=True, eq=False)
class NcProgram:
    """A program as the control would run it, up to its end or to the first error.

    Attributes:
        motions: in the order of doing, loops and subroutines unrolled.
        states: what `Motions.state` counts in; never empty.
        events: in order.
        homeward: motions to a place of the machine (G28, G30, G53). Where that is in these coordinates only the
            machine's work offset tells, so their ends, and the starts of those behind them, are no places of the part.
        problems: in the order of the text's running; at most one error, the last one.
        tools, stock: what comments say.
        line_count: lines of the text.
        header: what the header of our own says beside that; None in any other program.
        rapids_bend: the control may be set to move each axis of a rapid at its own rate, so that its way is not
            straight.
        probe_lines: lines of the motions that end where a probe touches.
    """

    motions: Motions
    states: tuple[ModalState, ...] = (ModalState(),)
    events: tuple[Event, ...] = ()
    homeward: tuple[int, ...] = ()
    problems: tuple[ProgramProblem, ...] = ()
    tools: tuple[ToolNote, ...] = ()
    stock: StockNote | None = None
    line_count: int = 0
    header: HeaderNote | None = None
    rapids_bend: bool = False
    probe_lines: frozenset[int] = frozenset()

    @property
    def error(self) -> ProgramProblem | None:
        """The error that ended the reading, if there was one."""
        return next((problem for problem in self.problems if problem.severity is Severity.ERROR), None)


# The columns of a program's motions while they grow: the reader's core adds rows one by one, its lane many at once.


_FIRST = 1024
"""Rows that are reserved at first."""

_GROWTH = 1.5
"""By how much they grow where they are full: copying costs a few times the rows in all."""

_NOWHERE = (float("nan"),) * 3

Place = tuple[float, float, float]


@dataclass(slots=True)
class Motion:
    """One motion; what each field is, `Motions` says."""

    kind: MotionKind | int
    start: Place
    end: Place
    feed: float
    line: int
    state: int
    plane: Plane | int = Plane.XY
    centre: Place = _NOWHERE
    turns: int = 0


class MotionColumns:
    """The columns of `Motions`, longer than they need be: rows from `count` on mean nothing yet.

    Attributes:
        count: how many motions there are. Who writes rows straight into the arrays raises it.
        start, end, centre, kind, plane, turns, feed, line, state: see `Motions`.
    """

    __slots__ = ("centre", "count", "end", "feed", "kind", "line", "plane", "start", "state", "turns")

    def __init__(self) -> None:
        self._clear()

    def _clear(self) -> None:
        self.count = 0
        self.start, self.end, self.centre = np.zeros((3, 0, 3))
        self.feed = np.zeros(0)
        self.kind, self.plane = np.zeros((2, 0), np.uint8)
        self.turns, self.line, self.state = np.zeros((3, 0), np.int32)

    def __len__(self) -> int:
        return self.count

    def arrays(self) -> tuple[NDArray[np.float64] | NDArray[np.uint8] | NDArray[np.int32], ...]:
        """Return the arrays in the order in which kernels take them."""
        return self.start, self.end, self.centre, self.kind, self.plane, self.turns, self.feed, self.line, self.state

    def reserve(self, more: int) -> None:
        """Make room for some more motions.

        Args:
            more: how many, >= 0.
        """
        if self.count + more > len(self.kind):
            self._resize(max(self.count + more, int(_GROWTH * len(self.kind)), _FIRST))

    def add(self, motion: Motion) -> None:
        """Add a motion at the end."""
        self.reserve(1)
        row = self.count
        self.start[row], self.end[row], self.centre[row] = motion.start, motion.end, motion.centre
        self.kind[row], self.plane[row], self.turns[row] = motion.kind, motion.plane, motion.turns
        self.feed[row], self.line[row], self.state[row] = motion.feed, motion.line, motion.state
        self.count = row + 1

    def motions(self, splines: dict[int, Nurbs] | None = None, known_from: tuple[int, int, int] = (0, 0, 0)) -> Motions:
        """Return all motions, and be empty again: the arrays are handed over, so that nothing is held twice.

        Args:
            splines: the curves of the SPLINE rows.
            known_from: see `Motions`.
        """
        self._resize(self.count)
        cut = Motions(
            self.start,
            self.end,
            self.centre,
            self.kind,
            self.plane,
            self.turns,
            self.feed,
            self.line,
            self.state,
            splines or {},
            known_from,
        )
        self._clear()
        return cut

    def _resize(self, rows: int) -> None:
        """Give every array its rows; what is there stays."""
        for name in ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state"):
            old = getattr(self, name)
            new = np.empty((rows, *old.shape[1:]), old.dtype)
            new[: self.count] = old[: self.count]
            setattr(self, name, new)


# What is wrong with a block, as the stages find it: without its place, which only the reader knows.


class BlockFault(Exception):
    """A block cannot be carried out.

    Attributes:
        text: a sentence: what is wrong, what was expected.
        letter: the word that it is about, such as "R"; "" = the block. The reader finds the word by it.
        column: 1-based, where the stage knows it; 0 = not known.
        word: the word as written, where the stage knows it.
    """

    def __init__(self, text: str, letter: str = "", column: int = 0, word: str = "") -> None:
        super().__init__(text)
        self.text, self.letter, self.column, self.word = text, letter, column, word
