"""What the program has to say about a drawing or a path: named, located, counted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from ..core.errors import printable


class FindingKind(Enum):
    """What was found. The value is the key in reports."""

    OPEN_CONTOUR = "open_contour"
    SELF_INTERSECTION = "self_intersection"
    OVERLAP = "overlap"
    GAP_CLOSED = "gap_closed"
    UNITS_ASSUMED = "units_assumed"
    LEFT_OUT = "left_out"
    TINY_ENTITY = "tiny_entity"
    REGION_TOO_SMALL = "region_too_small"
    NECK_TOO_NARROW = "neck_too_narrow"
    GOUGE = "gouge"
    LEFT_REACHABLE = "left_reachable"
    LEFT_UNREACHABLE = "left_unreachable"
    RAPID_IN_MATERIAL = "rapid_in_material"
    TOLERANCE = "tolerance"
    ENGAGEMENT = "engagement"
    MACHINE = "machine"
    TOOL_SHAPE = "tool_shape"
    START_IN_STOCK = "start_in_stock"
    PLUNGE = "plunge"
    HOLDER_CONTACT = "holder_contact"
    SHANK_CONTACT = "shank_contact"
    BELOW_TABLE = "below_table"
    ASSUMED = "assumed"
    HIDDEN = "hidden"
    BEYOND_STOCK = "beyond_stock"
    AMBIGUOUS = "ambiguous"
    SKIN = "skin"
    ENTRY = "entry"
    CLAMP = "clamp"
    AREA = "area"
    HOLE = "hole"
    SIZE = "size"
    FEED = "feed"
    RIDGE = "ridge"


@dataclass(frozen=True, slots=True)
class Finding:
    """One sentence about one place.

    Attributes:
        text: a sentence: what, where with coordinates in mm, what to do.
        x, y: the place, mm, or None where there is none.
        counts: True when it makes the job "done, with findings" (exit status 1); False for a remark.
        entity_ids: entities concerned, so that the window can mark them.
        amount: the measured length (mm) or area (mm2) or number, if there is one.
        line: of the NC program, 1-based; 0 = it is about none.
        layer: that can be left out to mend it; "" = none.
    """

    kind: FindingKind
    text: str
    x: float | None = None
    y: float | None = None
    counts: bool = True
    entity_ids: tuple[int, ...] = ()
    amount: float | None = None
    line: int = 0
    layer: str = ""

    def __post_init__(self) -> None:
        """Let names that a file gives do nothing to who shows them."""
        object.__setattr__(self, "text", printable(self.text))


def worst_first(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return each finding once, those that count first, otherwise in order."""
    return tuple(sorted(dict.fromkeys(findings), key=lambda finding: not finding.counts))
