"""Stage three: the control as it stands between two blocks, and what every code needs of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from ...model.motion import MotionKind, Nurbs
from ...model.part import Units
from .block import Block
from .codes import AXES, CYCLES, ModalGroup
from .compensation import Compensation
from .cycles import Cycle
from .dialect import DIALECT_RULES, Dialect
from .expression import Key, Parameters
from .offsets import OFFSETS, Place, SetParameters, WorkOffsets, counts_from
from .options import ReadOptions, ToolOffset
from .program import BlockFault, Event, EventKind, FeedMode, ModalState, Motion, MotionColumns
from .program_scale import ProgramScale
from .splines import OpenFanucNurbs, OpenNurbs

MOST_EVENTS = 1_000_000
MOST_WARNINGS = 200

_PLACES: dict[Key, int] = {
    5001: 0,
    5002: 1,
    5003: 2,
    5041: 0,
    5042: 1,
    5043: 2,
    5420: 0,
    5421: 1,
    5422: 2,
    "_x": 0,
    "_y": 1,
    "_z": 2,
}
"""Parameters that say where the tool is along an axis: the program tells that as soon as it has moved it there."""
_KEPT = range(500, 1000)
"""Numbers of parameters that Fanuc and Haas keep while they are switched off."""
_SYSTEM = 1000
"""From this number on Fanuc's and Haas' parameters are the control's own."""
_IN_FORCE = (*range(4001, 4004), *range(4005, 4008), 4009, 4010, 4109, 4119, 4120)
"""Numbers of macro B's system variables that the program settles."""
_OF_THE_PROGRAM = (5220, 5400)
"""Numbers of work offset and tool."""

CONTROL_NAMES = {"_vmajor": 2.9, "_vminor": 0.0}


class AxisWord(NamedTuple):
    """What a block says of an axis, 0 to 2, mm."""

    axis: int
    value: float


class ArcShape(NamedTuple):
    """The centre of an arc, and how often it goes round, >= 1."""

    centre: Place
    turns: int


class WordInLine(NamedTuple):
    """A word's letter, "" where it is of no word, and its line."""

    letter: str
    line: int


class SavedState(NamedTuple):
    """What M70 or M73 has kept.

    Attributes:
        modal: fields of `ModalState` by name.
        work_offset: its name.
        feed: as `Control.feed`.
        side: G word of cutter compensation, "" = none.
        length: whether a tool length was in force.
        returns: it comes back by itself where the subroutine ends, as M73 has it.
    """

    modal: dict[str, object]
    work_offset: str
    feed: float
    side: str
    length: bool
    returns: bool


class _NumberedState(NamedTuple):
    """A state, and its number among all."""

    state: ModalState | None
    number: int


class Control:
    """A control that runs a program.

    Attributes:
        options, rules: how to read.
        modal: what is in force. motion: the G word that bare axis words obey, "G80" = none.
        feed: mm/min, mm a revolution or 1/min, by the feed mode; NaN = not said.
        at: the controlled point, mm, table coordinates.
        offsets: where zero is. tool_table: as the program has changed it.
        selected: T number that the next M6 takes.
        homes: of G28 and G30, mm, machine coordinates.
        known: for each axis the first motion that the program itself set, -1 = none yet; then the first that moved it
            in G91 before any had set it.
        cycle: the last canned cycle with its words, None after another motion. initial: the height at which their run
            began, program coordinates and units. before_cycle: the motion before it.
        curve: the spline over several blocks that is being written, None outside of one. last_offset: P, Q of the last
            G5, mm.
        compensation: G41 or G42, None = G40, or a radius of 0. stray: where the tool itself is when that is not where
            the program takes it to be, after G40. side: the G word of compensation, also where the radius is 0.
        saved: what M70 and M73 have kept, of the program and of each subroutine that is running.
        newly_turned: G68 or G69 was obeyed, and no motion along X or Y since. polar: G16.
        cutter_register: the last D word, where that stays; None = there was none, or it does not.
        scale: G51 and G51.1. astray: axes that are not where that takes them to be, until the program says where to.
        returning: what comes back now that a subroutine has ended, None = nothing.
        registers_hold_wear: whether a D word whose register nobody tells means 0. register_diameters: what the program
            itself says of them, mm, by number.
        line: 1-based, of the block that is running. unrolled: blocks that were done again.
        set_parameters: the control's own that the program sets and that no code has asked for yet.
        requested: parameters that the machine tells, or that nobody has set, and the line that read each first.
        columns, splines, events, homeward, probe_lines, warnings: what comes out; a warning is a text, and of which
            word.
    """

    def __init__(self, options: ReadOptions) -> None:
        """Stand at the start, as a control does when it is switched on."""
        self.options, self.rules = options, DIALECT_RULES[options.dialect]
        self.modal = ModalState(units=options.units or Units.MM, retract_to_r=options.dialect is Dialect.LINUXCNC)
        self.motion = "G80" if options.dialect is Dialect.LINUXCNC else "G0"
        self.feed = math.nan
        self.at: Place = options.start
        self.offsets = WorkOffsets(local_is_set_here=options.dialect is Dialect.LINUXCNC)
        self.tool_table: dict[int, ToolOffset] = dict(options.tool_table)
        self.selected = 0
        self.homes: dict[str, Place] = {"G28": (0.0, 0.0, 0.0), "G30": (0.0, 0.0, 0.0)}
        self.known = [-1] * 6
        self.cycle: Cycle | None = None
        self.initial = 0.0
        self.before_cycle = "G0"
        self.curve: OpenNurbs | OpenFanucNurbs | None = None
        self.compensation: Compensation | None = None
        self.stray: Place | None = None
        self.side = ""
        self.saved: list[SavedState | None] = [None]
        self.returning: SavedState | None = None
        self.newly_turned = self.polar = False
        self.cutter_register: float | None = None
        self.scale, self.astray = ProgramScale(), set[int]()
        self.registers_hold_wear = False
        self.register_diameters: dict[int, float] = {}
        self.last_offset = (0.0, 0.0)
        self.line = self.unrolled = 0
        self.columns = MotionColumns()
        self.splines: dict[int, Nurbs] = {}
        self.events: list[Event] = []
        self.homeward: list[int] = []
        self.probe_lines: set[int] = set()
        self.warnings: dict[str, WordInLine] = {}
        self.parameters = Parameters(self.own_parameter, self.set_own_parameter, self.rules, lambda: self.least)
        self.set_parameters = SetParameters()
        self.requested: dict[Key, int] = {}
        self._states: dict[ModalState, int] = {}
        self._last = _NumberedState(None, 0)

    @property
    def unit(self) -> float:
        """Millimetres of a length unit of the program."""
        return self.modal.units.value

    def feed_unit(self, block: Block) -> float:
        """Return the millimetres of a unit of the block's F; only LinuxCNC takes it in the units before the block's
        own.
        """
        code = block.codes.get(ModalGroup.UNITS)
        if code is None or self.options.dialect is Dialect.LINUXCNC:
            return self.unit
        return Units.INCH.value if code == "G20" else Units.MM.value

    @property
    def ccw(self) -> bool:
        """Whether the arc in force turns counter-clockwise in its plane, mirrored or not."""
        u, v, _ = self.modal.plane.axes
        return (self.motion == "G3") != self.scale.turns_over(u, v)

    @property
    def least(self) -> float:
        """Length units that a length without a decimal point counts in."""
        return self.rules.least_inch if self.modal.units is Units.INCH else self.rules.least_mm

    @property
    def states(self) -> tuple[ModalState, ...]:
        """Every state that a motion belongs to; at least one."""
        return tuple(self._states) or (self.modal,)

    @property
    def program_place(self) -> Place:
        """Where the controlled point is in program coordinates, mm."""
        return self.offsets.to_program(self.at)

    def change(self, **values: object) -> None:
        """Change what is in force; what stays as it is costs little."""
        if any(getattr(self.modal, name) != value for name, value in values.items()):
            self.modal = replace(self.modal, **values)  # type: ignore[arg-type]  # which type belongs to which name mypy cannot tell

    def offsets_changed(self) -> None:
        """Take the offsets into what is in force."""
        self.change(work_offset=self.offsets.name, shift=self.offsets.shift, rotation=self.offsets.rotation)

    def spelling_changed(self) -> None:
        """Take into what is in force whether axis words are coordinates."""
        self.change(respelled=self.polar or not self.scale.plain)

    def state(self) -> int:
        """Return the index of what is in force."""
        return self.number_of(self.modal)

    def number_of(self, state: ModalState) -> int:
        """Return the index of a state."""
        if state is not self._last.state:
            self._last = _NumberedState(state, self._states.setdefault(state, len(self._states)))
        return self._last.number

    def length(self, block: Block, letter: str) -> float | None:
        """Return a length word in mm, None without the word."""
        value = block.values.get(letter)
        if value is None:
            return None
        return value * (self.unit * self.least if letter in block.whole else self.unit)

    def axis_words(self, block: Block) -> Iterator[AxisWord]:
        """Yield the axis words of a block."""
        for axis, letter in enumerate(AXES):
            value = self.length(block, letter)
            if value is not None:
                yield AxisWord(axis, value)

    def target(self, block: Block) -> Place:
        """Return where the axis words lead, table coordinates."""
        if self.offsets.rotation == 0.0:
            place, shift = list(self.at), self.modal.shift
            for axis, value in self.axis_words(block):
                place[axis] = value + shift[axis] if self.modal.absolute else place[axis] + value
        else:
            program = list(self.program_place)
            for axis, value in self.axis_words(block):
                program[axis] = value if self.modal.absolute else program[axis] + value
            place = list(self.offsets.to_table((program[0], program[1], program[2])))
        self._check_place(place)
        return (place[0], place[1], place[2])

    def _check_place(self, place: list[float]) -> None:
        if not all(abs(value) < 1e9 for value in place):
            raise BlockFault("the motion ends more than 1000 km away; check the numbers.")

    def note_known(self, block: Block, absolute: bool | None = None) -> None:
        """Note that the motion to come sets the axes of the block's words, or moves them from where the reading began.

        Args:
            absolute: whether it sets them; None = as the distance mode has it.
        """
        sets = self.modal.absolute if absolute is None else absolute
        for axis, letter in enumerate(AXES):
            entry = axis if sets else 3 + axis
            if letter in block.values and self.known[axis] < 0 and self.known[entry] < 0:
                self.known[entry] = self.row

    def known_from(self) -> tuple[int, int, int]:
        """Return from which motion on each axis is known, as `Motions` has it.

        Where one moves in G91 before it is set the tool is taken to stand at zero, as LinuxCNC has it, along all axes
        not set by then.
        """
        assumed, begun = self.taken_for_known(), self._first_in_g91
        x, y, z = (
            begun - 1 if letter in assumed else row if row >= 0 else self.columns.count
            for letter, row in zip("XYZ", self.known, strict=False)
        )
        return x, y, z

    @property
    def _first_in_g91(self) -> int:
        """The first motion that moves an axis in G91 before any has set it; the number of motions where none does."""
        return min((row for row in self.known[3:] if row >= 0), default=self.columns.count)

    def taken_for_known(self) -> str:
        """Return the axes that are taken to begin at zero."""
        begun = self._first_in_g91
        if begun >= self.columns.count:
            return ""
        return "".join(letter for letter, row in zip("XYZ", self.known, strict=False) if not 0 <= row < begun)

    def move(self, kind: MotionKind, end: Place, feed: float = 0.0, arc: ArcShape | None = None) -> None:
        """Add a motion from where the point is.

        Args:
            kind: how.
            end: where to, table coordinates.
            feed: mm/min.
            arc: of an arc.

        Raises:
            Fault: the program has made more motions than the reader takes.
        """
        if self.columns.count >= self.options.limits.motions:
            raise BlockFault(
                f"the program makes more than {self.options.limits.motions} motions; the reader stops here."
            )
        motion = Motion(kind, self.stray or self.at, end, feed, self.line, self.state(), self.modal.plane)
        if arc is not None:
            motion.centre, motion.turns = arc
        if self.compensation is not None:
            self.compensation.take(motion, self.columns)
        else:
            self.columns.add(motion)
        self.at, self.stray = end, None

    @property
    def row(self) -> int:
        """How many motions there are, those that wait for the next one included."""
        return self.columns.count + (len(self.compensation.waiting) if self.compensation is not None else 0)

    def end_compensation(self) -> None:
        """Obey G40: the tool stays where it is until the next motion."""
        if self.compensation is not None:
            self.compensation.flush(self.columns)
            self.stray = self.compensation.place
            self.compensation = None
        self.side = ""

    def feed_along(self, length: float) -> float:
        """Return the feed of a motion of some length, mm/min.

        Raises:
            Fault: the program has not said it.
        """
        if math.isnan(self.feed):
            raise BlockFault("a feed motion needs a feed rate; write F before it or with it.", letter="f")
        if self.modal.feed_mode is FeedMode.INVERSE_TIME:
            return self.feed * length
        if self.modal.feed_mode is FeedMode.PER_REVOLUTION:
            return self.feed * self.modal.speed
        return self.feed

    def unroll(self, blocks: int = 1) -> None:
        """Count blocks that are done again.

        Raises:
            Fault: they are more than the reader takes.
        """
        self.unrolled += blocks
        if self.unrolled > self.options.limits.looped_blocks:
            raise BlockFault(
                f"loops, calls and cycles repeat more than {self.options.limits.looped_blocks} blocks; the reader "
                "stops here."
            )

    def warn(self, text: str, letter: str = "") -> None:
        """Note something that the reader does not follow, once for each text."""
        if len(self.warnings) < MOST_WARNINGS:
            self.warnings.setdefault(text, WordInLine(letter, self.line))

    def event(self, kind: EventKind, value: float = 0.0) -> None:
        """Note something that is no motion.

        Raises:
            Fault: there are more than anybody needs.
        """
        if len(self.events) >= MOST_EVENTS:
            raise BlockFault(
                f"the program stops, dwells and changes tools more than {MOST_EVENTS} times; the reader stops here."
            )
        self.events.append(Event(kind, self.row, self.line, value))

    def set_own_parameter(self, key: int, value: float) -> bool:
        """Obey that the program sets a parameter of the control's own; return False where it is none of these.

        Raises:
            Fault: it can only be read.
        """
        if not self.set_parameters.set(key, value):
            return False
        self.warn(
            f"#{key} is set in the machine's own units, which are taken for mm, and counts from the next "
            f"{counts_from(key)} on."
        )
        return True

    def _miss_kept(self, key: int) -> None:
        """Tell of a parameter that the control keeps, where the program reads it and has not set it."""
        if self.rules.macro_b and key in _KEPT:
            self.warn(
                f"#{key} is set nowhere before; what the control keeps in it counts there, and is not known here."
            )

    def own_parameter(self, key: Key) -> float | None:
        """Return a parameter that the control itself sets, None if it is another; those of tables are in mm.

        What the machine alone knows of it is told once.
        """
        value = self._own_parameter(key)
        if key in self.requested and isinstance(key, int) and self._is_the_machines(key):
            taken = "not set" if value is None and self.rules.macro_b else f"{value or 0.0:g}"
            self.warn(f"#{key} is what the control knows when the program runs; it is taken to be {taken} here.")
        return value

    def _is_the_machines(self, key: int) -> bool:
        """Tell whether nothing that was read says what is in a parameter of the control's own."""
        if key in self.set_parameters.values or key in _IN_FORCE:
            return False
        if 5221 <= key <= 5400:
            return OFFSETS[(key - 5221) // 20] not in self.offsets.work
        if 5401 <= key <= 5413:
            return self.modal.tool not in self.tool_table
        if 5161 <= key <= 5183:
            return self.homes["G28" if key < 5180 else "G30"] == (0.0, 0.0, 0.0)
        return key in _PLACES or (self.rules.macro_b and key >= _SYSTEM)

    def _own_parameter(self, key: Key) -> float | None:
        if key in self.set_parameters.values:
            return self.set_parameters.values[key]
        self._note_request(key)
        axis = _PLACES.get(key)
        if isinstance(key, str):
            return self._named(key) if key.startswith("_") else None
        if self.rules.macro_b and key in _IN_FORCE:
            return self._in_force(key)
        if key < 5001:
            self._miss_kept(key)
            return None
        if 5420 <= key <= 5422:
            return self.program_place[key - 5420] / self.unit
        if self.rules.fanuc_flow and axis is not None:
            return self.program_place[axis] / self.unit
        if key == 5220:
            return self._offset_number()
        if 5161 <= key <= 5163 or 5181 <= key <= 5183:
            return self.homes["G28" if key < 5180 else "G30"][(key - 1) % 20]
        if 5211 <= key <= 5213:
            return self.offsets.set_here[key - 5211]
        if 5221 <= key <= 5390 and (key - 5221) % 20 in (0, 1, 2, 9):
            return self._offset_value(OFFSETS[(key - 5221) // 20], (key - 5221) % 20)
        if key == 5400:
            return float(self.modal.tool)
        if 5401 <= key <= 5403 or key == 5410:
            return self._tool_value(key - 5401)
        return None

    def _tool_value(self, item: int) -> float:
        """Return an offset (0 to 2) or the diameter (9) of the tool in the spindle, in the table's own units, mm; what
        is in force (G43.1, G43 H of another tool) says nothing of them.
        """
        tool = self.tool_table.get(self.modal.tool, ToolOffset())
        return tool.diameter if item == 9 else tool.offset[item]

    def _note_request(self, key: Key) -> None:
        """Note a parameter that the machine may tell, where the program asks for it."""
        axis = _PLACES.get(key)
        machines = isinstance(key, int) and key not in _OF_THE_PROGRAM if axis is None else self.known[axis] < 0
        if machines:
            self.requested.setdefault(key, self.line)

    def _in_force(self, key: int) -> float:
        """Return a system variable of macro B that says what is in force: the number of its G word, or a value."""
        modal, boring = self.modal, self.motion if self.motion in CYCLES else "G80"
        feeds = {FeedMode.INVERSE_TIME: 93.0, FeedMode.PER_MINUTE: 94.0, FeedMode.PER_REVOLUTION: 95.0}
        code = {
            4001: self.before_cycle[1:] if self.motion in CYCLES else self.motion[1:],
            4002: (17, 18, 19)[modal.plane],
            4003: 90 if modal.absolute else 91,
            4005: feeds[modal.feed_mode],
            4006: 20 if modal.units is Units.INCH else 21,
            4007: self.side[1:] or 40,
            4009: boring[1:],
            4010: 99 if modal.retract_to_r else 98,
            4109: 0.0 if math.isnan(self.feed) else self.feed / self.unit,
            4119: modal.speed,
            4120: modal.tool,
        }
        return float(code[key])

    def _offset_value(self, name: str, item: int) -> float:
        """Return an axis (0 to 2, mm) or the rotation (9, degrees) of a work offset."""
        if item == 9:
            return math.degrees(self.offsets.turned.get(name, 0.0))
        return self.offsets.work.get(name, (0.0, 0.0, 0.0))[item]

    def _offset_number(self) -> float:
        return float(OFFSETS.index(self.offsets.name) + 1) if self.offsets.name in OFFSETS else 0.0

    def _named(self, key: str) -> float | None:
        if key in ("_x", "_y", "_z"):
            return self.program_place["xyz".index(key[1])] / self.unit
        modal = self.modal
        own: dict[str, float] = CONTROL_NAMES | {
            "_line": float(self.line),
            "_motion_mode": 10 * float(self.motion[1:]),
            "_ccomp": 10 * math.floor(float(self.side[1:] or 40)),
            "_inverse_time": float(modal.feed_mode is FeedMode.INVERSE_TIME),
            "_units_per_minute": float(modal.feed_mode is FeedMode.PER_MINUTE),
            "_units_per_rev": float(modal.feed_mode is FeedMode.PER_REVOLUTION),
            "_tool_offset": float(self.offsets.tool != (0.0, 0.0, 0.0)),
            "_retract_r_plane": float(modal.retract_to_r),
            "_retract_old_z": float(not modal.retract_to_r),
            "_spindle_rpm_mode": float(not modal.constant_surface),
            "_spindle_css_mode": float(modal.constant_surface),
            "_ijk_absolute_mode": float(modal.arc_absolute),
            "_lathe_diameter_mode": 0.0,
            "_lathe_radius_mode": 1.0,
            "_spindle_cw": float(modal.spindle > 0),
            "_mist": float(modal.mist),
            "_flood": float(modal.flood),
            "_call_level": float(len(self.saved) - 1),
            "_metric": float(modal.units is Units.MM),
            "_imperial": float(modal.units is Units.INCH),
            "_absolute": float(modal.absolute),
            "_incremental": float(not modal.absolute),
            "_plane": (170.0, 180.0, 190.0)[modal.plane],
            "_rpm": modal.speed,
            "_feed": 0.0 if math.isnan(self.feed) else self.feed / self.unit,
            "_current_tool": float(modal.tool),
            "_selected_tool": float(self.selected),
            "_spindle_on": float(modal.spindle != 0),
            "_coord_system": 530 + 10 * self._offset_number(),
        }
        return own.get(key)
