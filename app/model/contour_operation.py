"""Contours along walls, inside or outside, or on the lines."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.errors import ParameterError
from ..core.options import option
from .entry import Lead, LeadKind, Tabs
from .fields import Condition, Unit, check_ranges, parameter, part
from .operation import (
    ENGAGED,
    LEAST_ENGAGED,
    LEAST_LENGTH,
    MOST_SPRING_PASSES,
    OPEN_EDGES,
    SIDE,
    CutterCompensation,
    Operation,
    Side,
)

_WITHIN = Condition(lambda operation: operation.side is Side.INSIDE, "a path inside", 'write side = "inside"')
_FINISHED = Condition(lambda operation: operation.finish_width > 0, "a finish pass", "add finish_width = 0.2")
_WORN = Condition(
    lambda operation: operation.compensation is not CutterCompensation.COMPUTER,
    "the wear word",
    'add compensation = "wear"',
    lambda: option("compensation", "wear"),
)

_LEAST_LEFT = 0.1
"""mm; of less stock to leave the contour's outer corners are arcs so small that rounding turns them anywhere."""


@dataclass(frozen=True, slots=True)
class ContourOperation(Operation):
    """Follow the walls with the contour tool (step 120); on the line it also follows open lines (engraving, slots)."""

    side: Side = parameter(Side.INSIDE, *SIDE, option=True, choices=("Inside", "Outside", "On line"))
    lead: Lead = part(Lead)
    tabs: Tabs = part(Tabs)
    spring_passes: int = parameter(
        0,
        "spring_passes",
        "Spring passes",
        "times the last pass is run again, so that a bent cutter straightens",
        Unit.COUNT,
        high=MOST_SPRING_PASSES,
        option=True,
        group="Walls",
    )
    dog_bones: bool = parameter(
        False,
        "dog_bones",
        "Dog-bones",
        "cut on into inner corners, and so into the walls, for a sharp counterpart to fit",
        Unit.FLAG,
        option=True,
        group="Walls",
    )
    finish_width: float = parameter(
        0.0,
        "finish_width",
        "Finish width",
        "metal that the passes leave on walls for a finish pass; 0: none",
        Unit.LENGTH,
        high=100.0,
        option=True,
        group="Walls",
    )
    finish_each_pass: bool = parameter(
        False,
        "finish_each_pass",
        "Finish each pass",
        "the finish pass is run at every depth before going deeper; else once, at the floor",
        Unit.FLAG,
        option=True,
        group="Walls",
        short="Finish",
        needs=_FINISHED,
        choices=("Once", "Each depth"),
    )
    most_engaged: float = parameter(
        1.0, *ENGAGED, low=LEAST_ENGAGED, high=1.0, option=True, group="Feed and layers", short="Slow beyond"
    )
    compensation: CutterCompensation = parameter(
        CutterCompensation.COMPUTER,
        "compensation",
        "Compensation",
        "who offsets the path: the computer; by a wear word (G41, G42) also the control, from 0 on; or the control "
        "alone, by the tool's radius",
        Unit.CHOICE,
        option=True,
        group="Walls",
        choices=("Computer", "Wear", "Control"),
    )
    wear_range: float = parameter(
        0.1,
        "wear_range",
        "Wear range",
        "of the radius that the operator may enter, either way; the path is proven at 0 and at both ends",
        Unit.LENGTH,
        low=LEAST_LENGTH,
        high=5.0,
        option=True,
        group="Walls",
        needs=_WORN,
    )

    open_edges: bool = parameter(False, *OPEN_EDGES, option=True, needs=_WITHIN)

    WORD = "contour"
    FOLLOWS_WALLS = True

    def __post_init__(self) -> None:
        check_ranges(self)
        if self.side is Side.ON and (self.dog_bones or self.finish_width or self.cut.stock_to_leave):
            raise ParameterError(
                "A path on the line has no wall: dog-bones, finish width and stock to leave do not go with it; "
                "take them out."
            )

        if self.compensation is not CutterCompensation.COMPUTER:
            self._check_compensated()

    def _check_compensated(self) -> None:
        """Refuse what a control cannot offset."""
        if self.side is Side.ON:
            raise ParameterError("A path on the line has no side to offset it to; take compensation out.")
        if self.dog_bones:
            raise ParameterError(
                "A control cannot offset dog-bones, where the path turns straight back; take them out, or compensation."
            )
        if self.compensation is CutterCompensation.CONTROL:
            self._check_control()
        elif self.lead.kind is not LeadKind.LINE:
            raise ParameterError(
                'A control begins and ends compensation on a straight way; with compensation = "wear" the lead must be '
                'straight: lead = "line".'
            )
        if min(self.lead.overlap, self.lead.radius or self.wear_range * 2) < self.wear_range:
            raise ParameterError(
                f"Lead radius and lead overlap must be no less than the wear range, {self.wear_range:g} mm."
            )

    def _check_control(self) -> None:
        """Refuse what a control cannot offset by the whole radius."""
        if self.lead.kind is not LeadKind.ARC:
            raise ParameterError(
                'With compensation = "control" the tool comes to the wall and leaves it by an arc, with a straight way '
                'before and behind it for the control: lead = "arc".'
            )
        if self.most_engaged < 1:
            raise ParameterError(
                "The feed cannot be slowed by what is engaged where the control turns round corners by itself; with "
                'compensation = "control" take most_engaged out.'
            )
        for name, left in (("stock to leave", self.cut.stock_to_leave), ("finish width", self.finish_width)):
            if left and left < _LEAST_LEFT:
                raise ParameterError(
                    f'With compensation = "control" {name} is 0 or at least {_LEAST_LEFT:g} mm, not {left:g} mm: '
                    "the contour is written that far from the wall, round its corners too."
                )

    @property
    def wear(self) -> float:
        """How far the operator may offset its paths in the control, mm, either way; 0 = there is no word for it."""
        return 0.0 if self.compensation is CutterCompensation.COMPUTER else self.wear_range

    @property
    def offset_by_control(self) -> bool:
        """Whether its drawn contour is written, for the control to offset by the tool's whole radius."""
        return self.compensation is CutterCompensation.CONTROL

    @property
    def wall_side(self) -> Side | None:
        """On which side of the drawn lines its cutter is."""
        return self.side

    @property
    def engagement_limit(self) -> float:
        """Share of the diameter beyond which the feed is slowed."""
        return self.most_engaged

    @property
    def opens_edges(self) -> bool:
        """Whether its paths go on past the stock's edges, where walls lie on them."""
        return self.open_edges and self.side is Side.INSIDE

    @property
    def outer_lead(self) -> Lead | None:
        """How it comes to the walls where it runs outside of them."""
        return self.lead if self.side is Side.OUTSIDE else None

    @property
    def roughed_allowance(self) -> float:
        """Metal that it leaves on the walls before its finish pass, mm."""
        return self.cut.stock_to_leave + self.finish_width

    @property
    def on_pixels(self) -> bool:
        """Whether it runs inside the walls."""
        return self.side is Side.INSIDE
