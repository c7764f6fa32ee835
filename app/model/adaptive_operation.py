"""Clearing with a cutter that is nowhere engaged by more than an angle."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .fields import Unit, check_ranges, parameter
from .operation import LIFT, MOST_ENGAGED, OPEN_EDGES, Operation


@dataclass(frozen=True, slots=True)
class AdaptiveOperation(Operation):
    """Clear the area inside with a cutter whose rim is nowhere engaged by more than an angle."""

    most_engaged_deg: float = parameter(
        math.radians(60), *MOST_ENGAGED, low=math.radians(15), high=math.radians(90), option=True, short="Most engaged"
    )
    lift: float = parameter(0.2, *LIFT, high=100.0, option=True)
    feed_up_to: float = parameter(
        1.0,
        "feed_up_to",
        "Feed up to",
        "of the feed rate, along arcs where so little is engaged that chips are no thicker than at the angle; 100 %: "
        "never faster",
        Unit.SHARE,
        low=1.0,
        high=3.0,
        option=True,
    )

    open_edges: bool = parameter(False, *OPEN_EDGES, option=True)

    WORD = "adaptive"
    CLEARS = True
    COARSE = True

    def __post_init__(self) -> None:
        check_ranges(self)

    @property
    def proven_angle(self) -> float | None:
        """Engaged angle, radians, that the written program must not exceed anywhere."""
        return self.most_engaged_deg

    @property
    def opens_edges(self) -> bool:
        """Whether its area goes on past the stock's edges, where walls lie on them."""
        return self.open_edges

    @property
    def fastest_cut(self) -> float:
        """Times the feed rate at which the tool goes at most, where less is engaged than at the angle."""
        return self.feed_up_to

    @property
    def lift_between(self) -> float:
        """How high the tool goes on its way back over ground that is cut, mm."""
        return self.lift
