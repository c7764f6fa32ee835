"""What there is to know about a control's dialect: the shape of a post's data file."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ...model.part import Units
from ..interpreter.dialect import Dialect


class ArcCentre(Enum):
    """What the I and J words of an arc count from."""

    INCREMENTAL = "incremental"
    ABSOLUTE = "absolute"


class NurbsForm(Enum):
    """How the control is told of a NURBS.

    NONE: not at all. BEZIER: planar polynomial pieces of degree 3, four control points each, without knots (LinuxCNC).
    KNOTS: every control point with its knot and its weight, the last knots alone (Fanuc).
    """

    NONE = "none"
    BEZIER = "bezier"
    KNOTS = "knots"


class Coolant(Enum):
    """What the coolant does while a tool cuts."""

    NONE = "none"
    FLOOD = "flood"
    MIST = "mist"


@dataclass(frozen=True, slots=True)
class UnitWords:
    """G words of the length units."""

    mm: str
    inch: str


@dataclass(frozen=True, slots=True)
class WordRules:
    """How a block is spelled.

    Attributes:
        order: letters of a motion block in the order of writing.
        motion: G words of rapid, line, clockwise arc, counter-clockwise arc.
        modal_motion: leave the G word out where it is that of the block before.
        trailing_zeros: write every decimal, "X10.0000"; else only those that count, and the point: "X10.".
        feed_point: F has a decimal point always: controls that count whole numbers in thousandths need it.
    """

    order: tuple[str, ...]
    motion: tuple[str, ...]
    modal_motion: bool
    trailing_zeros: bool
    feed_point: bool


@dataclass(frozen=True, slots=True)
class WordDecimals:
    """Digits after the decimal point of each word; every word but F keeps its point.

    Attributes:
        X, Y, Z: positions, out units; X and Y alike.
        I, J: arc centres, out units; alike.
        F: feed rate, out units a minute.
    """

    X: int
    Y: int
    Z: int
    I: int  # noqa: E741 - the word's own letter
    J: int
    F: int


@dataclass(frozen=True, slots=True)
class Decimals:
    """Digits of each word, by the program's units."""

    mm: WordDecimals
    inch: WordDecimals


@dataclass(frozen=True, slots=True)
class CommentRules:
    """How a comment is marked.

    Attributes:
        open, close: what stands before and behind; close may be "".
        width: longest text between the two, characters; longer text goes on in another comment.
        capitals: the control knows capital letters alone.
        signs: what it takes beside letters and digits; a comma stands for any other.
    """

    open: str
    close: str
    width: int
    capitals: bool
    signs: str


@dataclass(frozen=True, slots=True)
class Numbers:
    """N words: whether, from where, and how far apart."""

    use: bool
    start: int
    step: int


@dataclass(frozen=True, slots=True)
class Arcs:
    """Which arcs the control takes.

    Attributes:
        centre: what I and J count from.
        largest_sweep_deg: longer arcs are split into equal pieces, in [60, 359]; full circles always are.
        smallest_radius_mm, largest_radius_mm: arcs of other radii become lines.
        radius_mismatch_mm: the control refuses arcs whose two radii differ by more.
    """

    centre: ArcCentre
    largest_sweep_deg: float
    smallest_radius_mm: float
    largest_radius_mm: float
    radius_mismatch_mm: float


@dataclass(frozen=True, slots=True)
class BlendingWords:
    """How the control may round corners.

    Attributes:
        tolerance_mm: the farthest it may leave the path where it blends; where no word says so, what its own setting is
            taken as. 0: it never leaves the path.
        blend: template of the block that says so, with the field {blend} in out units; without the field, or "", the
            control blends by its own setting, if it does.
        exact: block that forbids it, or "" where the control has none.
    """

    tolerance_mm: float
    blend: str
    exact: str


@dataclass(frozen=True, slots=True)
class SpindleRules:
    """How long the spindle takes to reach its speed, s."""

    dwell_s: float


@dataclass(frozen=True, slots=True)
class CoolantWords:
    """What the coolant does, and its M words."""

    use: Coolant
    flood: str
    mist: str
    off: str


@dataclass(frozen=True, slots=True)
class ProgramLines:
    """Blocks round the motion, as templates; a block whose text comes out empty is left out.

    Fields: {units} {blending} {program} in every block; in `tool` and `leave` also {tool} {speed} {dwell_s} {dwell_ms}
    {coolant_on} {coolant_off} {preselect}; in `tool` {clearance}. {program} is the program's number: the digits at the
    end of the part's name where they are one from 1 to 7999, else `number`. "{program:04}" puts zeros before it; so it
    goes with {tool}, {speed} and {dwell_ms}. {preselect} is the T word of the tool that comes next, and after the last
    one that of the first; nothing where the program has one tool. A block with {clearance} is the rapid to clearance
    height, as in "G0 G43 H{tool} Z{clearance}".

    Attributes:
        number: of the program, where the part's name has none.
        top: above the header's comments, such as "%" and an O word, which get no N word.
        start: before the first tool.
        tool: change to a tool, its length, spindle on; the tool stands at clearance.
        leave: after the last move of a tool, at clearance height.
        home: goes to the machine's own home along Z; before each tool change, the first one too, and at the end.
        end: behind everything.
    """

    number: int
    top: tuple[str, ...]
    start: tuple[str, ...]
    tool: tuple[str, ...]
    leave: tuple[str, ...]
    home: tuple[str, ...]
    end: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class DrillingWords:
    """Canned cycles; "" where the control has none, or does it in a way that only its own settings tell.

    Attributes:
        drill: down at feed, up at rapid rate.
        peck: the same in steps of Q, each followed by a rapid up to R and down again to `peck_gap_mm` above the last
            one.
        chip_break: the same in steps of Q, each followed by a rapid up by `chip_gap_mm`.
        dwell: as drill, with a wait at the bottom, whose P is that of `wait`. wait: template of a wait, fields
            {dwell_s}, {dwell_ms}.
        feed_out: down at feed, up to R at feed.
        tap: down at feed, up at the same feed with the spindle turning back; "" = the control cannot.
        tap_left: the same with the spindle turning counter-clockwise on the way in.
        tap_start: template of the block before either, fields {tool}, {speed}; "" = none.
        tap_to_initial: it taps out to R and goes up from there at rapid rate, if it is to; else it taps all the way
        out.
        to_initial, to_r: whether holes end at the height where the first one began, or at R.
        cancel: ends the cycle.
        peck_gap_mm, chip_gap_mm: what the control's own settings are.
    """

    drill: str
    peck: str
    chip_break: str
    dwell: str
    wait: str
    feed_out: str
    tap: str
    tap_start: str
    tap_to_initial: bool
    to_initial: str
    to_r: str
    cancel: str
    peck_gap_mm: float
    chip_gap_mm: float
    tap_left: str = ""


@dataclass(frozen=True, slots=True)
class NurbsWords:
    """How a NURBS is written: its form, the G word that begins it, the block that ends it, "" where the next G word
    does.
    """

    form: NurbsForm
    word: str
    end: str


@dataclass(frozen=True, slots=True)
class CompensationWords:
    """Blocks that let the control offset the path by what stands in the tool's register; "" = it cannot.

    Attributes:
        left, right: templates with the field {tool}: the tool is at the left of the contour, at its right.
        off: block that ends it.
        register: comment for the operator: what stands in the register of a tool by whose whole radius the control
            offsets, with the fields {tool} {radius} {diameter}, lengths with their unit.
    """

    left: str = ""
    right: str = ""
    off: str = ""
    register: str = "Register D{tool}: radius {radius}, or diameter {diameter} where the control takes that"


@dataclass(frozen=True, slots=True)
class Post:
    """One control's dialect.

    Attributes:
        title: the control's name for people.
        extension: of its program files, with the dot.
        dialect: in which its programs are read.
        file_per_tool: it changes no tools, so each tool has a program of its own.
    """

    title: str
    extension: str
    dialect: Dialect
    file_per_tool: bool
    units: UnitWords
    words: WordRules
    decimals: Decimals
    comments: CommentRules
    numbers: Numbers
    arcs: Arcs
    blending: BlendingWords
    spindle: SpindleRules
    coolant: CoolantWords
    program: ProgramLines
    drilling: DrillingWords
    nurbs: NurbsWords
    compensation: CompensationWords = CompensationWords()

    def digits(self, units: Units) -> WordDecimals:
        """Return the digits of each word in a program of these units."""
        return self.decimals.inch if units is Units.INCH else self.decimals.mm
