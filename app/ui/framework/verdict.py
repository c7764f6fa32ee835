"""The verdict in one line: figures that were measured, or the worst finding. No Qt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

from ...model.finding import Finding, FindingKind
from .figures import clock, counted, grouped


class VerdictLevel(Enum):
    """How a verdict is coloured; the value is what the style sheet looks at."""

    NONE = "none"
    OK = "ok"
    REMARK = "remark"
    BAD = "bad"


_RED = (
    FindingKind.PROGRAM,
    FindingKind.AREA,
    FindingKind.GOUGE,
    FindingKind.CLAMP,
    FindingKind.RAPID_IN_MATERIAL,
    FindingKind.START_IN_STOCK,
    FindingKind.PLUNGE,
    FindingKind.SPINDLE,
    FindingKind.TAB,
    FindingKind.HOLDER_CONTACT,
    FindingKind.SHANK_CONTACT,
    FindingKind.BELOW_TABLE,
    FindingKind.LEFT_REACHABLE,
)
_WORST_FIRST = (
    *_RED,
    FindingKind.BEYOND_STOCK,
    FindingKind.HOLE,
    FindingKind.SIZE,
    FindingKind.FEED,
    FindingKind.TOLERANCE,
    FindingKind.MACHINE,
    FindingKind.TOOL_SHAPE,
    FindingKind.OPEN_CONTOUR,
    FindingKind.SELF_INTERSECTION,
    FindingKind.OVERLAP,
    FindingKind.REGION_TOO_SMALL,
    FindingKind.NECK_TOO_NARROW,
    FindingKind.ENGAGEMENT,
    FindingKind.AMBIGUOUS,
    FindingKind.UNITS_ASSUMED,
    FindingKind.GAP_CLOSED,
    FindingKind.TINY_ENTITY,
    FindingKind.LEFT_OUT,
    FindingKind.ASSUMED,
    FindingKind.HIDDEN,
    FindingKind.LEFT_UNREACHABLE,
    FindingKind.SKIN,
    FindingKind.RIDGE,
    FindingKind.ENTRY,
)


@dataclass(frozen=True, slots=True)
class VerdictSummary:
    """A level, the line that the badge shows, and what the time is made of."""

    level: VerdictLevel
    text: str
    tip: str = ""


def worst_first(findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return the findings in the order in which they matter: those that count, then remarks."""
    return tuple(sorted(findings, key=lambda f: (not f.counts, _WORST_FIRST.index(f.kind))))


def finding_level(finding: Finding) -> VerdictLevel:
    """Return the colour of one finding."""
    if not finding.counts:
        return VerdictLevel.NONE
    return VerdictLevel.BAD if finding.kind in _RED else VerdictLevel.REMARK


def short(finding: Finding) -> str:
    """Return what was found and where, without the sentence: "gouge 0.120 mm at (41.2, 8.0)"."""
    amount = ""
    if finding.amount is not None and finding.kind is FindingKind.LEFT_REACHABLE:
        amount = f" {area_words(finding.amount)} mm²"
    elif finding.amount is not None and finding.kind in (FindingKind.GOUGE, FindingKind.OPEN_CONTOUR):
        amount = f" {finding.amount:.3f} mm"
    place = "" if finding.x is None or finding.y is None else f" at ({finding.x:.1f}, {finding.y:.1f})"
    return f"{finding.kind.words}{amount}{place}"


def area_words(mm2: float) -> str:
    """Return an area, mm², to three digits, and a large one whole: "6 710"."""
    return grouped(mm2, 0) if mm2 >= 100 else f"{mm2:.3g}"


def _sentence(finding: Finding) -> str:
    text = short(finding)
    return text[0].upper() + text[1:]


def figures(data: Mapping[str, Any]) -> str:
    """Return the measured figures of a report: "0 gouge · 0 left · 15 places out of reach · 2 strokes · 4:12". What was
    not measured is not said.
    """
    parts = []
    gouge, left = data.get("gouge"), data.get("left")
    if gouge is not None:
        parts.append(f"{gouge.get('count', 0)} gouge")
    if left is not None and left.get("reachable_mm2") is not None:
        area = left["reachable_mm2"]
        parts.append("0 left" if area < 5e-4 else f"{area:.3f} mm² left")
        if beyond := left.get("out_of_reach_places"):
            parts.append(f"{counted(beyond, 'place')} out of reach")
    if data.get("strokes"):  # a job without a pocket has none to count
        parts.append(counted(data["strokes"], "stroke"))
    if data.get("time_s") is not None:
        parts.append(clock(data["time_s"]))
    return " · ".join(parts)


def times(data: Mapping[str, Any]) -> str:
    """Return what the time of a report is made of: the operations' own times do not hold the waiting."""
    parts = data.get("time_parts_s")
    if parts is None:
        return ""
    return f"Cutting and rapids {clock(parts['cut'] + parts['rapid'])}, tool changes and waiting {clock(parts['wait'])}"


def verdict_summary(findings: tuple[Finding, ...], data: Mapping[str, Any]) -> VerdictSummary:
    """Return the verdict on a computed program from its findings and its report."""
    counting = [f for f in worst_first(findings) if f.counts]
    more = f" · {len(counting) - 1} more" if len(counting) > 1 else ""
    if not any(data.get("moves", {}).values()):
        return VerdictSummary(
            VerdictLevel.REMARK, _sentence(counting[0]) + more if counting else "No closed contour to machine"
        )
    if not counting:
        return VerdictSummary(VerdictLevel.OK, f"✓ {figures(data)}", times(data))
    return VerdictSummary(finding_level(counting[0]), _sentence(counting[0]) + more, times(data))
