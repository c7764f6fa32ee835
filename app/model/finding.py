"""What the program has to say about a drawing or a path: named, located, counted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from ..core.errors import printable


class FindingKind(Enum):
    """What was found. The value is the key in reports.

    Attributes:
        words: how people are told of it.
    """

    words: str

    def __new__(cls, key: str, words: str) -> FindingKind:
        """Keep the words beside the key."""
        kind = object.__new__(cls)
        kind._value_ = key
        kind.words = words
        return kind

    OPEN_CONTOUR = "open_contour", "open contour"
    SELF_INTERSECTION = "self_intersection", "crossing contours"
    OVERLAP = "overlap", "overlap"
    GAP_CLOSED = "gap_closed", "gap closed"
    UNITS_ASSUMED = "units_assumed", "units assumed"
    LEFT_OUT = "left_out", "left out"
    TINY_ENTITY = "tiny_entity", "tiny entity"
    REGION_TOO_SMALL = "region_too_small", "region too small"
    NECK_TOO_NARROW = "neck_too_narrow", "neck too narrow"
    GOUGE = "gouge", "gouge"
    LEFT_REACHABLE = "left_reachable", "material left"
    LEFT_UNREACHABLE = "left_unreachable", "corners out of reach"
    RAPID_IN_MATERIAL = "rapid_in_material", "rapid in material"
    TOLERANCE = "tolerance", "tolerance not met"
    ENGAGEMENT = "engagement", "full slot"
    MACHINE = "machine", "beyond the machine"
    TOOL_SHAPE = "tool_shape", "a tool of another shape"
    START_IN_STOCK = "start_in_stock", "start in the stock"
    PLUNGE = "plunge", "plunge in metal"
    HOLDER_CONTACT = "holder_contact", "holder in metal"
    SHANK_CONTACT = "shank_contact", "shank in metal"
    BELOW_TABLE = "below_table", "cut into the table"
    ASSUMED = "assumed", "assumed"
    HIDDEN = "hidden", "metal below metal"
    BEYOND_STOCK = "beyond_stock", "part beyond the stock"
    AMBIGUOUS = "ambiguous", "doubtful place in the picture"
    SKIN = "skin", "skin along the walls"
    ENTRY = "entry", "another entry"
    CLAMP = "clamp", "clamp hit"
    AREA = "area", "area lost or gained"
    HOLE = "hole", "hole in a surface"
    SIZE = "size", "doubtful size"
    FEED = "feed", "plunge at full feed"
    SPINDLE = "spindle", "cut with a standing spindle"
    TAB = "tab", "tab cut off"
    RIDGE = "ridge", "ridges between passes"
    PROGRAM = "program", "error in the program"


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
