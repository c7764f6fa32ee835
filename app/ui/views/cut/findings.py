"""What is wrong with a cut, place by place, and the verdict in words. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from ....model.finding import Finding, FindingKind
from ...framework.figures import counted
from ...framework.verdict import VerdictLevel, VerdictSummary, area_words
from .overlay_text import number

if TYPE_CHECKING:
    from ....verify.judgement import Certificate, Judgement, Spot
    from .shown_cut import ShownCut

MOST = 200
"""Places that are listed."""

_FIELD, _LEAST_FIELD = 8.0, 1.0
"""A place is shown in a field so many times as wide as it is; and mm."""

_NEAR = 4.0
"""Beside an upright wall cells alone cannot tell that nothing is left; a bound of more cells than these says no more
than that.
"""

_NAMES = {
    FindingKind.RAPID_IN_MATERIAL: "rapid",
    FindingKind.START_IN_STOCK: "start in stock",
    FindingKind.PLUNGE: "plunge",
    FindingKind.BELOW_TABLE: "table",
    FindingKind.HOLDER_CONTACT: "holder",
    FindingKind.SHANK_CONTACT: "shank",
}
_SPOT_KINDS = {
    "gouge": FindingKind.GOUGE,
    "left": FindingKind.LEFT_REACHABLE,
    "unreachable": FindingKind.LEFT_UNREACHABLE,
}
"""By the value of `verify.judgement.SpotKind`."""

_SPOTS = (FindingKind.GOUGE, FindingKind.LEFT_REACHABLE, FindingKind.LEFT_UNREACHABLE)


class FindingColour(Enum):
    """Which colour of the theme an entry has; the value is its name there."""

    GOUGE = "gouge"
    LEFT = "left"
    UNREACHABLE = "unreachable"
    ACCIDENT = "plunge"
    REMARK = "muted"


@dataclass(frozen=True, slots=True)
class CutFinding:
    """One place.

    Attributes:
        title: what, "gouge 0.050 mm". sentence: all there is to say.
        colour: which one. counts: it is wrong; else a remark.
        place: x, y, z, mm; None = there is none. field: mm that should be seen round it.
        motion: row of the motion that did it, -1 = nobody knows. line: of its NC line, 0 = none.
        kind: of what is wrong. amount: how deep, mm, or how large; None = nobody has said.
        disc: diameter of what fits where metal is left, mm; None = it is of no place where some is.
    """

    title: str
    sentence: str
    colour: FindingColour
    counts: bool
    place: tuple[float, float, float] | None
    field: float = _LEAST_FIELD
    motion: int = -1
    line: int = 0
    kind: FindingKind = FindingKind.ASSUMED
    amount: float | None = None
    disc: float | None = None

    @property
    def words(self) -> str:
        """Place in the plane, and line."""
        return " · ".join(self.where)

    @property
    def where(self) -> tuple[str, ...]:
        """Place in the plane, and line, as far as they are known."""
        parts = [] if self.place is None else [f"({self.place[0]:.1f}, {self.place[1]:.1f})".replace("-", "\u2212")]
        return (*parts, *([f"line {self.line}"] if self.line else []))


def findings_of(shown: ShownCut) -> tuple[CutFinding, ...]:
    """Return every place, what counts first; the first 200 of them."""
    judgement = shown.cut.judgement
    told = [
        _of_finding(shown, finding) for finding in shown.cut.findings if judgement is None or finding.kind not in _SPOTS
    ]
    spots = [_of_spot(spot) for spot in judgement.spots] if judgement is not None else []
    made = [*told, *spots, *(_of_finding(shown, finding) for finding in shown.assumed)]
    return tuple(sorted(made, key=lambda entry: not entry.counts)[:MOST])


def level_of(shown: ShownCut, told: VerdictSummary | None = None) -> VerdictLevel:
    """Return the colour of the verdict; `told` is the badge's on the same program, if it has one."""
    if told is not None and told.level is not VerdictLevel.OK:
        return told.level
    if any(entry.counts for entry in findings_of(shown)):
        return VerdictLevel.BAD
    return VerdictLevel.OK if shown.cut.judgement is not None else VerdictLevel.NONE


def title_of(shown: ShownCut, told: VerdictSummary | None = None) -> str:
    """Return the verdict in one line; `told` is the badge's on the same program, if it has one."""
    if told is not None and told.level is not VerdictLevel.OK:
        return told.text
    counting = sum(entry.counts for entry in findings_of(shown))
    if counting:
        return f"{counted(counting, 'place')} to look at"
    return "Clean" if shown.cut.judgement is not None else "No accident on the way"


def sentences_of(shown: ShownCut) -> str:
    """Return what was found out, and how surely."""
    judgement = shown.cut.judgement
    if judgement is None:
        return "Nobody has said what the part is, so nothing is known of gouges and of metal left."
    proven = certified(judgement.certificate, _depth(shown)) if not judgement.gouge.count else ""
    return " ".join(filter(None, (measured(judgement), proven)))


def measured(judgement: Judgement) -> str:
    """Return what was measured against the part."""
    how = "On the moves themselves" if judgement.exact else "On the cells"
    gouge = judgement.gouge
    cut = f"the worst gouge is {number(gouge.max_mm)} mm" if gouge.count else "no gouge"
    left = (
        f"{area_words(judgement.reachable_mm2)} mm² left within reach"
        if judgement.reachable_mm2
        else "nothing left within reach"
    )
    return f"{how}: {cut}, {left}."


def _depth(shown: ShownCut) -> float:
    """Return how deep the deepest cell was cut, mm."""
    return shown.cut.top - float(np.min(shown.cut.cut.heights))


def certified(certificate: Certificate | None, depth: float) -> str:
    """Return what holds between the cells too; a bound as large as the `depth` of the cut, mm, or as many cells is
    none.
    """
    if certificate is None:
        return ""
    if certificate.gouge_mm >= depth - 1e-6 or not certificate.telling:
        return "Between the cells little is proven; zoom in to look closer."
    near = certificate.left_mm < _NEAR * certificate.pitch_mm
    left = f", and no metal within reach stands more than {number(certificate.left_mm)} mm out of it" if near else ""
    return f"No point is cut deeper than {number(certificate.gouge_mm)} mm into the part{left}; finer when zoomed in."


def _of_spot(spot: Spot) -> CutFinding:
    from ....verify.judgement import SpotKind

    size = max(spot.disc_mm, float(np.sqrt(spot.area_mm2)), spot.depth_mm)
    at = f"at ({number(spot.x)}, {number(spot.y)}, {number(spot.z)})"
    area = f"{area_words(spot.area_mm2)} mm²"
    made = {
        SpotKind.GOUGE: (
            f"Gouge {number(spot.depth_mm)} mm",
            FindingColour.GOUGE,
            f"The part is cut {spot.depth_mm:.4f} mm too deep {at}; do not run this program.",
        ),
        SpotKind.LEFT: (
            f"Left {area}",
            FindingColour.LEFT,
            f"{area} of metal that a tool reaches is left {at}, up to {number(spot.depth_mm)} mm high; add a pass "
            "there.",
        ),
        SpotKind.UNREACHABLE: (
            f"Out of reach {area}",
            FindingColour.UNREACHABLE,
            f"{area} {at} is out of reach of every tool; a disc of {number(spot.disc_mm)} mm would fit. "
            "A smaller tool reaches farther.",
        ),
    }
    title, colour, sentence = made[spot.kind]
    return CutFinding(
        title,
        sentence,
        colour,
        spot.kind is not SpotKind.UNREACHABLE,
        (spot.x, spot.y, spot.z),
        max(_FIELD * size, _LEAST_FIELD),
        spot.motion,
        spot.line,
        _SPOT_KINDS[spot.kind.value],
        spot.depth_mm,
        spot.disc_mm,
    )


def _of_finding(shown: ShownCut, finding: Finding) -> CutFinding:
    title = _NAMES.get(finding.kind, finding.kind.words)
    colour = FindingColour.ACCIDENT if finding.counts else FindingColour.REMARK
    depth = (
        f", {number(finding.amount)} deep"
        if finding.amount is not None and finding.counts and finding.x is not None
        else ""
    )
    place = None
    if finding.x is not None and finding.y is not None:
        place = (finding.x, finding.y, shown.picture.height_at(finding.x, finding.y))
    motion = shown.motion_of_line(finding.line, place)
    return CutFinding(
        f"{title[0].upper()}{title[1:]}{depth}",
        finding.text,
        colour,
        finding.counts,
        place,
        2 * _FIELD,
        motion,
        finding.line,
        finding.kind,
        finding.amount,
    )
