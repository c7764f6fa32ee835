"""A job: a part, its stock, tools and operations. What is saved, computed and exported."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from ..core.errors import ParameterError
from .contour_operation import ContourOperation
from .fields import Unit, parameter
from .fields import part as whole
from .operation import LEAST_LENGTH, CutParameters, Operation, Order, PocketOperation, RestOperation
from .part import Part, Units
from .tool import Tool
from .tool_kind import ToolKind

LARGEST_JOIN = 10.0
"""mm; a wider gap is no loose end any more."""


class OriginXY(Enum):
    """Where the work origin is in the plane."""

    DRAWING = "drawing zero"
    LOWER_LEFT = "lower left of stock"
    CENTRE = "centre of stock"


class OriginZ(Enum):
    """Where the work origin is along the tool axis."""

    TOP = "top of stock"
    BOTTOM = "bottom of stock"


@dataclass(frozen=True, slots=True)
class Stock:
    """A box of metal. Z 0 is its top, once it is faced.

    Attributes:
        margin: how far it reaches beyond the part's extent on every side, mm, >= 0.
        thickness: below Z 0, mm, > 0.
        above: what more of it stands above Z 0 at first, mm, >= 0.
        under: thickness of the waste that it lies on, mm, >= 0: so far below it may tools cut, as points of drills do.
        material: what it is made of, a word of `StockMaterial`; "" = not known.
    """

    margin: float = parameter(
        0.0,
        "margin",
        "Margin",
        "how far it reaches beyond the part on every side",
        Unit.LENGTH,
        high=1e5,
        table="stock",
    )
    thickness: float = parameter(
        10.0, "thickness", "Thickness", "from its top down", Unit.LENGTH, high=1e5, table="stock"
    )
    above: float = parameter(
        0.0,
        "above",
        "Above Z 0",
        "what more of it stands above Z 0, to be faced off",
        Unit.LENGTH,
        high=1e4,
        table="stock",
    )
    under: float = parameter(
        0.0, "under", "Waste below", "thickness of the waste that it lies on", Unit.LENGTH, high=1e5, table="stock"
    )
    material: str = parameter("", "material", "Material", "what it is made of", Unit.TEXT, table="stock")

    def __post_init__(self) -> None:
        if not 0 <= self.margin < 1e5 or not 0 < self.thickness < 1e5:
            raise ParameterError(
                f"Stock margin is {self.margin:g} mm and thickness {self.thickness:g} mm; "
                "the margin must be 0 or more and the thickness greater than 0."
            )
        if not 0 <= self.above < 1e4:
            raise ParameterError(f"The stock stands {self.above:g} mm above Z 0; it must be 0 or more.")
        if not 0 <= self.under < 1e5:
            raise ParameterError(f"Waste under the stock is {self.under:g} mm thick; it must be 0 or more.")


@dataclass(frozen=True, slots=True)
class Copies:
    """A part in a grid: how often, and how far apart.

    Attributes:
        columns, rows: along X and Y, 1 ... 1,000, at most 10,000 in all.
        dx, dy: from each to the next, mm, less than 1e6; not 0 where there is more than one.
    """

    columns: int = parameter(1, "columns", "Columns", "along X", Unit.COUNT, low=1, high=1000, table="copies")
    rows: int = parameter(1, "rows", "Rows", "along Y", Unit.COUNT, low=1, high=1000, table="copies")
    dx: float = parameter(
        0.0, "dx", "Step along X", "from each to the next", Unit.LENGTH, low=-1e6, high=1e6, table="copies"
    )
    dy: float = parameter(
        0.0, "dy", "Step along Y", "from each to the next", Unit.LENGTH, low=-1e6, high=1e6, table="copies"
    )

    def __post_init__(self) -> None:
        if not (1 <= self.columns <= 1000 and 1 <= self.rows <= 1000 and self.columns * self.rows <= 10_000):
            raise ParameterError(
                f"{self.columns} x {self.rows} copies are asked for; use 1 to 1000 each way and 10000 in all."
            )
        for count, step, axis in ((self.columns, self.dx, "X"), (self.rows, self.dy, "Y")):
            if not abs(step) < 1e6 or (count > 1 and abs(step) < LEAST_LENGTH):
                raise ParameterError(
                    f"Copies along {axis} are {step:g} mm apart; give the distance from each to the next, "
                    "not 0 and less than 1000000 mm."
                )

    @property
    def shifts(self) -> tuple[tuple[float, float], ...]:
        """Where each copy lies, mm; (0, 0) first, row by row."""
        return tuple((column * self.dx, row * self.dy) for row in range(self.rows) for column in range(self.columns))


@dataclass(frozen=True)
class Job:
    """Everything that a program of tool paths is computed from.

    Attributes:
        operations: in the order of cutting, unless `order` puts contours first.
        safe_z: clearance height, mm above the stock's top, in [0.001, 1e5).
        retract_z: height from which plunges go at plunge rate, mm above the top, in [0.001, safe_z].
        join_tolerance: loose ends nearer than this are joined, mm, in [0, 10].
        layer_names: layers to machine; empty = all visible ones but those of keep-out areas.
        copies: the part in a grid, cut out of one stock.
        keep_out_layers: layers whose closed contours are clamps and the like: no tool comes over them below their
            height.
        keep_out_height: of these above the stock's top, mm, in [0, 1e5).
        clamping_note, zero_note: what the sheet that goes to the machine says of how the stock is held, and of how the
            zero is set, beside what is computed; "" = nothing.
        post: name of the post that writes the NC text.
        out_units: units of the NC text, MM or INCH.
    """

    part: Part
    tools: tuple[Tool, ...] = (Tool(1, 6.0), Tool(2, 3.0, spindle_speed=18000.0))
    operations: tuple[Operation, ...] = (
        PocketOperation(CutParameters(tool=1)),
        RestOperation(CutParameters(tool=2)),
        ContourOperation(CutParameters(tool=2)),
    )
    stock: Stock = whole(Stock)
    origin_xy: OriginXY = parameter(
        OriginXY.DRAWING, "origin_xy", "Origin", "in the plane", Unit.CHOICE, table="origin", word="xy"
    )
    origin_z: OriginZ = parameter(
        OriginZ.TOP, "origin_z", "Z zero", "along the tool axis", Unit.CHOICE, table="origin", word="z"
    )
    safe_z: float = parameter(
        5.0,
        "safe_z",
        "Safe Z",
        "clearance height above the stock's top",
        Unit.LENGTH,
        low=LEAST_LENGTH,
        high=1e5,
        table="heights",
    )
    retract_z: float = parameter(
        1.0,
        "retract_z",
        "Retract Z",
        "from which plunges go slowly",
        Unit.LENGTH,
        low=LEAST_LENGTH,
        high=1e5,
        table="heights",
    )
    layer_names: tuple[str, ...] = parameter(
        (), "layer_names", "Layers", "to machine; none named: all visible", Unit.NAMES, table="drawing", word="layers"
    )
    join_tolerance: float = parameter(
        0.01,
        "join_tolerance",
        "Join tolerance",
        "loose ends nearer than this are joined",
        Unit.LENGTH,
        high=LARGEST_JOIN,
        table="drawing",
    )
    post: str = parameter("linuxcnc", "post", "Post", "that writes the NC text", Unit.TEXT, table="output")
    out_units: Units = parameter(
        Units.MM, "out_units", "Units", "of the NC text", Unit.CHOICE, table="output", word="units"
    )
    order: Order = parameter(Order.POCKET_FIRST, "order", "Order", "which tool cuts first", Unit.CHOICE, table="output")
    exact_path: bool = parameter(
        False, "exact_path", "Exact path", "the control never rounds a corner", Unit.FLAG, table="output"
    )
    copies: Copies = whole(Copies)
    keep_out_layers: tuple[str, ...] = parameter(
        (), "keep_out_layers", "Keep-out layers", "of clamps and the like", Unit.NAMES, table="keep_out", word="layers"
    )
    keep_out_height: float = parameter(
        0.0,
        "keep_out_height",
        "Keep-out height",
        "of these above the stock's top",
        Unit.LENGTH,
        high=1e5,
        table="keep_out",
        word="height",
    )
    clamping_note: str = parameter(
        "",
        "clamping_note",
        "Clamping",
        "how the stock is held, for the sheet",
        Unit.TEXT,
        table="sheet",
        word="clamping",
    )
    zero_note: str = parameter(
        "", "zero_note", "Zero", "how the zero is set, for the sheet", Unit.TEXT, table="sheet", word="zero"
    )

    def __post_init__(self) -> None:
        if not LEAST_LENGTH <= self.retract_z <= self.safe_z < 1e5:
            raise ParameterError(
                f"Safe Z is {self.safe_z:g} mm and retract Z {self.retract_z:g} mm; "
                f"both must be {LEAST_LENGTH:g} mm or more and retract not above safe Z."
            )
        if self.stock.above and not self.stock.above + LEAST_LENGTH <= self.retract_z:
            raise ParameterError(
                f"The stock stands {self.stock.above:g} mm above Z 0, and retract Z is only {self.retract_z:g} mm "
                "above it; raise safe Z and retract Z, which count from Z 0."
            )
        if not 0 <= self.join_tolerance <= LARGEST_JOIN:
            raise ParameterError(f"Join tolerance is {self.join_tolerance:g} mm; use 0 to {LARGEST_JOIN:g} mm.")
        if not 0 <= self.keep_out_height < 1e5:
            raise ParameterError(
                f"Keep-out areas are {self.keep_out_height:g} mm high; use 0 or more above the stock's top."
            )

    @property
    def makes_holes(self) -> bool:
        """Whether some operation works on circles, each by itself; whether that is enabled or not."""
        return any(operation.HOLES for operation in self.operations)

    @property
    def travel_z(self) -> float:
        """Height at which the tool travels, mm above the top: clear of stock and keep-out areas."""
        return max(self.safe_z, self.keep_out_height + self.retract_z) if self.keep_out_layers else self.safe_z

    def tool(self, number: int) -> Tool:
        """Return the tool with this T number.

        Raises:
            ParameterError: the job has no such tool.
        """
        for tool in self.tools:
            if tool.number == number:
                return tool
        raise ParameterError(f"The job has no tool T{number}; add it to the tools or choose another.")

    def cutter(self, operation: Operation) -> Tool:
        """Return the tool of an operation.

        Raises:
            ParameterError: the job has no such tool, or one that cannot do it: a drill is to mill, or what has no cone
                is to carve.
        """
        tool = self.tool(operation.cut.tool)
        if tool.kind.value != operation.TOOL and (operation.TOOL or tool.kind.work):
            needs = f"needs a {operation.TOOL}" if operation.TOOL else "needs a drill or a mill"
            raise ParameterError(
                f"T{tool.number} {tool.label} is a {tool.kind.value}; a {operation.WORD} operation {needs}: choose "
                "another tool, or give it another kind."
            )
        if tool.kind.drills and not operation.DRILLS:
            raise ParameterError(
                f"T{tool.number} is a drill, which cannot cut sideways; a {operation.WORD} operation needs a mill: "
                "choose another tool, or make it a drill operation."
            )
        round_one = operation.CARVES_ROUND and tool.kind is ToolKind.BALL
        if operation.CARVES and tool.kind is not ToolKind.V and not round_one:
            either = " or a ball" if operation.CARVES_ROUND else ""
            raise ParameterError(
                f"T{tool.number} {tool.label} is a {tool.kind.value} cutter; a {operation.WORD} operation needs a V "
                f"cutter with its angle{either}: choose another tool, or make this one a V cutter."
            )
        return tool

    def prepared(self) -> Job:
        """Return the job with what operations ask to come before them, behind all others in the list, so that these
        keep their places; what is there already is not added.

        Raises:
            ParameterError: an operation has no tool, or none that can do it.
        """
        operations = list(self.operations)
        for operation in self.operations:
            if operation.cut.enabled:
                for wanted in operation.prepared_by(self.cutter(operation)):
                    if not any(_alike(wanted, each) for each in operations):
                        operations.append(wanted)
        return self if len(operations) == len(self.operations) else replace(self, operations=tuple(operations))

    def prepares(self, index: int) -> int | None:
        """Return the index of the first operation that asks for another one, by its index; None where none does."""
        asked = self.operations[index]
        for k, operation in enumerate(self.operations):
            if k != index and operation.cut.enabled:
                wanted = operation.prepared_by(self.tool(operation.cut.tool))
                if any(_alike(each, asked) for each in wanted):
                    return k
        return None

    def needed_tools(self) -> tuple[Tool, ...]:
        """Return the tools that operations have, or ask to come before them, switched on or not; in the job's order."""
        pairs = [(each, tool) for each in self.operations for tool in self.tools if tool.number == each.cut.tool]
        before = (wanted.cut.tool for operation, tool in pairs for wanted in operation.prepared_by(tool))
        numbers = {*(tool.number for _, tool in pairs), *before}
        return tuple(tool for tool in self.tools if tool.number in numbers)

    def same_paths(self, other: Job) -> bool:
        """Return whether another job comes to the same paths: layers that hold nothing, colours, locks, depths that
        the drawing tells, what the stock is made of, and tools that no operation has make none.
        """
        if self is other:
            return True
        mine, theirs = self.part, other.part
        stock = replace(self.stock, material=other.stock.material)
        if self.needed_tools() != other.needed_tools():
            return False
        return replace(self, part=theirs, stock=stock, tools=other.tools) == other and replace(
            mine, layers=mine.machined_layers, depths=()
        ) == replace(theirs, layers=theirs.machined_layers, depths=())

    def check_operations(self) -> None:
        """Refuse a job that cannot be computed, whichever way.

        Raises:
            ParameterError: no operation is switched on, or one that is has no tool that can do it.
        """
        if not any(operation.cut.enabled for operation in self.operations):
            what = (
                "every operation of the job is switched off, so nothing is cut; switch one on"
                if self.operations
                else "the job has no operation, so nothing is cut; add one"
            )
            raise ParameterError(f"{self.part.name}: {what}.")
        for operation in self.operations:
            if operation.cut.enabled:
                self.cutter(operation)
                self.turns_left(operation.cut.tool)

    def turns_left(self, number: int) -> bool:
        """Return whether a tool turns counter-clockwise (M4).

        Raises:
            ParameterError: some operations want it to, and others do not.
        """
        ways = {each.turns_left for each in self.operations if each.cut.enabled and each.cut.tool == number}
        if len(ways) > 1:
            raise ParameterError(
                f"T{number} is to cut left-handed threads and others too; a tap turns one way alone: give each its own "
                "tool."
            )
        return True in ways


def _alike(wanted: Operation, operation: Operation) -> bool:
    """Tell whether an operation does what is wanted; digits of a file may have moved its lengths."""
    mine, theirs = wanted.cut, operation.cut
    return (
        type(wanted) is type(operation)
        and theirs.enabled
        and (mine.tool, mine.curves) == (theirs.tool, theirs.curves)
        and abs(mine.depth - theirs.depth) < LEAST_LENGTH
        and abs(mine.stock_to_leave - theirs.stock_to_leave) < LEAST_LENGTH
    )
