"""A job: a part, its stock, tools and operations. What is saved, computed and exported."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from app.errors import ParameterError
from app.model.operation import LEAST_LENGTH, ContourOperation, Cut, Operation, Order, PocketOperation
from app.model.part import Part, Units
from app.model.tool import Tool

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
    """A box of metal. Z 0 is its top.

    Attributes:
        margin: how far it reaches beyond the part's extent on every side, mm, >= 0.
        thickness: mm, > 0.
    """

    margin: float = 0.0
    thickness: float = 10.0

    def __post_init__(self) -> None:
        if not 0 <= self.margin < 1e5 or not 0 < self.thickness < 1e5:
            raise ParameterError(f"Stock margin is {self.margin:g} mm and thickness {self.thickness:g} mm; "
                                 "the margin must be 0 or more and the thickness greater than 0.")


@dataclass(frozen=True)
class Job:
    """Everything that a program of tool paths is computed from.

    Attributes:
        operations: in the order of the list; `order` decides which kind cuts first.
        safe_z: clearance height, mm above the stock's top, in [0.001, 1e5).
        retract_z: height from which plunges go at plunge rate, mm above the top, in [0.001, safe_z].
        join_tolerance: loose ends nearer than this are joined, mm, in [0, 10].
        layer_names: layers to machine; empty = all visible ones.
        post: name of the post that writes the NC text.
        out_units: units of the NC text, MM or INCH.
    """

    part: Part
    tools: tuple[Tool, ...] = (Tool(1, 6.0), Tool(2, 3.0, spindle_speed=18000.0))
    operations: tuple[Operation, ...] = (PocketOperation(Cut(tool=1)), ContourOperation(Cut(tool=2)))
    stock: Stock = Stock()
    origin_xy: OriginXY = OriginXY.DRAWING
    origin_z: OriginZ = OriginZ.TOP
    safe_z: float = 5.0
    retract_z: float = 1.0
    order: Order = Order.POCKET_FIRST
    join_tolerance: float = 0.01
    layer_names: tuple[str, ...] = ()
    post: str = "linuxcnc"
    out_units: Units = Units.MM
    exact_path: bool = False

    def __post_init__(self) -> None:
        if not LEAST_LENGTH <= self.retract_z <= self.safe_z < 1e5:
            raise ParameterError(f"Safe Z is {self.safe_z:g} mm and retract Z {self.retract_z:g} mm; "
                                 f"both must be {LEAST_LENGTH:g} mm or more and retract not above safe Z.")
        if not 0 <= self.join_tolerance <= LARGEST_JOIN:
            raise ParameterError(f"Join tolerance is {self.join_tolerance:g} mm; use 0 to {LARGEST_JOIN:g} mm.")

    def tool(self, number: int) -> Tool:
        """Return the tool with this T number.

        Raises:
            ParameterError: the job has no such tool.
        """
        for tool in self.tools:
            if tool.number == number:
                return tool
        raise ParameterError(f"The job has no tool T{number}; add it to the tools or choose another.")
