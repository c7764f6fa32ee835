"""Operations for a drawing, proposed from how its curves lie in one another: an ordinary job, with a word for each.

The rule of 1986, everything between the lines is a pocket, stays what a job begins with; here it is one proposal of
two, and has a name.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

from ...core.errors import GeometryError
from ...core.progress import NO_PROGRESS, Progress
from ...core.resources import resource
from ...core.wording import together
from ...formats.tools.library import read_library
from ...geometry.outlines import nest, polygon_contour
from ...geometry.overlay.overlay import without_crossings
from ...geometry.primitives import contour_rows, lengths, signed_area
from ...model.contour_operation import ContourOperation
from ...model.curve_selectors import Selector
from ...model.entry import Entry, EntryKind, Lead, Tabs
from ...model.finding import Finding
from ...model.hole_operations import BoreOperation, DrillOperation
from ...model.job import Copies, Job, Stock
from ...model.operation import CutParameters, Operation, PocketOperation, RestOperation, Side
from ...model.part import Contour, Region
from ...model.stock_box import extent
from ...model.tool import Tool
from ...toolpath.advice.advise import CuttingPlan, advise
from ...toolpath.drawn_contours import DrawnContours, drawn_contours
from ...toolpath.drill_holes import tip_length
from .contour_sorts import HolesOfSize, SortedContours, selectors_for, sorted_contours
from .rack import Rack, room

ENGRAVED = 0.3
"""mm; depth of lines and letters."""

SPARE = 2.0
"""mm of stock beyond the slot round a part."""

WIDEST = 6.0
"""mm; no wider mill is proposed to cut a part out, for its slot is waste."""

_TABS, _FEWER = 4, 3
"""Tabs round an outline, and round one that is small."""
_SMALL = 100.0
"""mm; an outline shorter than this has fewer and narrower tabs."""

Json = dict[str, Any]


class ProposalRule(Enum):
    """What a proposal goes by."""

    NESTING = "nesting"
    PATENT_1986 = "1986"


@dataclass(frozen=True)
class ProposedOperation:
    """An operation of a proposal.

    Attributes:
        operation: with its curves and its tool.
        why: what it is for and why so, without a full stop.
    """

    operation: Operation
    why: str


@dataclass(frozen=True)
class Proposal:
    """Operations for a drawing.

    Attributes:
        rule: that it goes by.
        job: with the operations, their tools, and the stock that they need.
        operations: those of the job, each with a word of explanation.
        findings: what no operation is proposed for.
    """

    rule: ProposalRule
    job: Job
    operations: tuple[ProposedOperation, ...]
    findings: tuple[Finding, ...] = ()

    def lines(self) -> list[str]:
        """Return it in words, a line an operation."""
        return [
            f"  {number} {each.operation.WORD} T{each.operation.cut.tool} "
            f"[{', '.join(curve.text for curve in each.operation.cut.curves) or 'all'}]: {each.why}"
            for number, each in enumerate(self.operations, 1)
        ]

    def report(self) -> Json:
        """Return it as plain values."""
        return {
            "rule": self.rule.value,
            "stock_margin_mm": self.job.stock.margin,
            "waste_under_mm": self.job.stock.under,
            "operations": [
                {
                    "kind": each.operation.WORD,
                    "tool": each.operation.cut.tool,
                    "curves": [curve.text for curve in each.operation.cut.curves],
                    "why": each.why,
                }
                for each in self.operations
            ],
        }


@dataclass(frozen=True)
class ProposalOptions:
    """What a proposal is made from beside the drawing.

    Attributes:
        tools: to choose from; none = the libraries of mills and drills that come with the program.
        thickness: of the stock, mm; None = as the job has it.
        depth: of pockets, mm, not deeper than the stock.
    """

    tools: tuple[Tool, ...] = ()
    thickness: float | None = None
    depth: float = field(default_factory=lambda: CutParameters(1).depth)


def shipped_tools() -> tuple[Tool, ...]:
    """Return the mills and drills that come with the program."""
    files = sorted(resource("tools").glob("*.toml"))
    return tuple(tool for path in files for tool in read_library(path.name, path.read_bytes()).tools)


def as_in_1986(job: Job) -> Proposal:
    """Return the rule of 1986 as a proposal: all that the lines bound even-odd is a pocket, whatever they are."""
    usual = replace(Job(job.part), stock=job.stock, layer_names=job.layer_names)
    words = {
        PocketOperation: "the area between the lines, by the rule of 1986",
        RestOperation: "what the wide tool does not reach of it",
        ContourOperation: "along all its walls",
    }
    return Proposal(
        ProposalRule.PATENT_1986,
        replace(job, tools=usual.tools, operations=usual.operations),
        tuple(ProposedOperation(each, words[type(each)]) for each in usual.operations),
    )


def propose(job: Job, options: ProposalOptions | None = None, progress: Progress = NO_PROGRESS) -> Proposal:
    """Return operations for a drawing from how its contours lie in one another.

    Holes first, then pockets, holes that are milled, lines; the outlines come last, since they free the parts.

    Args:
        job: its part, layers, join tolerance and stock count; its operations do not.
        options: tools, thickness and depth.

    Raises:
        GeometryError: there is no curve that anything could be proposed for.
        ParameterError: no tool can be had.
        Cancelled: by progress.
    """
    options = options or ProposalOptions()
    thickness = options.thickness or job.stock.thickness
    job = replace(job, operations=(), stock=replace(job.stock, thickness=thickness))
    progress.step(0.0, "Sorting contours")
    seen = drawn_contours(replace(job, copies=Copies()))
    found = sorted_contours(job.part, seen)
    rack = Rack(options.tools or shipped_tools())
    work = ProposalWork(seen, found, rack, thickness, min(options.depth, thickness))
    made = [
        *work.drills(),
        *work.pockets(progress.part(0.1, 0.5)),
        *work.milled_holes(),
        *work.bores(progress.part(0.5, 0.8)),
        *work.lines(),
    ]
    progress.step(0.8, "A tool for the outlines")
    outlines = work.outlines()
    made += outlines
    if not made:
        said = " ".join(each.text for each in (*found.gaps, *seen.findings)[:3])
        raise GeometryError(
            f"{job.part.name}: there is no curve that an operation could be proposed for. {said}".strip()
        )
    progress.step(1.0)
    return Proposal(
        ProposalRule.NESTING,
        replace(
            job,
            tools=tuple(sorted(rack.taken, key=lambda tool: tool.number)),
            operations=tuple(each.operation for each in made),
            stock=work.stock(job.stock),
        ),
        tuple(made),
        found.gaps,
    )


@dataclass(frozen=True)
class _Milling:
    """How holes are milled: bored, or along their walls, so that what is within them may be loose and fall out."""

    cut: CutParameters
    bores: bool
    loose: bool


@dataclass
class ProposalWork:
    """What is proposed for each sort of contour.

    Attributes:
        thickness: of the stock, mm. depth: of pockets, mm.
        drilled: circles that are drilled.
        round_tools: that go round parts.
    """

    seen: DrawnContours
    found: SortedContours
    rack: Rack
    thickness: float
    depth: float
    drilled: list[Contour] = field(default_factory=list)
    round_tools: list[Tool] = field(default_factory=list)

    def _curves(self, contours: Sequence[Contour]) -> tuple[Selector, ...]:
        return selectors_for(contours, self.seen, self.drilled)

    def cut(self, tool: Tool, depth: float, curves: tuple[Selector, ...]) -> CutParameters:
        """Return depth and steps: no step deeper than half the tool is wide."""
        step = min(CutParameters(1).stepdown, max(tool.diameter / 2, depth / 500))
        return CutParameters(self.rack.take(tool).number, depth, step, curves=curves)

    def _named(self, tool: Tool) -> str:
        """Return a tool, and whether one has to be had that the library lacks."""
        long = " (a longer one than the library has)" if self.rack.is_long(tool) else ""
        return f"T{tool.number} {tool.kind.value} {tool.diameter:g} mm{long}"

    def stock(self, stock: Stock) -> Stock:
        """Return the stock with room round it for what cuts parts out, and below it for the points of drills."""
        under = max([stock.under, *(math.ceil(tip_length(tool)) for tool in self.rack.taken)])
        margin = max([stock.margin, *(tool.diameter + SPARE for tool in self.round_tools)])
        return replace(stock, margin=margin, under=under)

    def drills(self) -> list[ProposedOperation]:
        """Return the holes for which there is a drill of their size."""
        made = []
        for size, circles in self.found.holes:
            drill = self.rack.drill(size)
            if drill is not None:
                curves = selectors_for(circles, self.seen, as_circles=True)
                cut = CutParameters(self.rack.take(drill).number, self.thickness, curves=curves)
                why = f"{_counted(len(circles), 'hole')} of {size:g} mm, through, with a drill of that size"
                made.append(ProposedOperation(DrillOperation(cut), why))
                self.drilled.extend(circles)
        return made

    def milled_holes(self) -> list[ProposedOperation]:
        """Return the holes for which there is no drill, milled along their walls, down on a helix: those that differ in
        their diameter alone in one operation, so that the tool crosses the part once.
        """
        groups: dict[_Milling, list[HolesOfSize]] = {}
        for holes in self.found.holes:
            if self.rack.drill(holes.size) is None:
                groups.setdefault(self._milling(holes.size), []).append(holes)
        return [self._holes_milled(milling, sizes) for milling, sizes in groups.items()]

    def _milling(self, size: float) -> _Milling:
        """Return how holes of one size are milled."""
        tool = self.rack.boring(size, self.thickness)
        cut, loose = self.cut(tool, self.thickness, ()), size > 2 * tool.diameter
        return _Milling(cut, BoreOperation(cut).takes(size, tool) and not loose, loose)

    def _holes_milled(self, milling: _Milling, sizes: Sequence[HolesOfSize]) -> ProposedOperation:
        """Return an operation that mills holes of some sizes."""
        circles = [circle for each in sizes for circle in each.circles]
        curves = [curve for each in sizes for curve in selectors_for(each.circles, self.seen, as_circles=True)]
        (tool,) = (each for each in self.rack.taken if each.number == milling.cut.tool)
        named = [f"{each.size:g}" for each in sizes]
        why = (
            f"{_counted(len(circles), 'hole')} of {together(named)} mm, through: the library has no "
            f"{'drills of these sizes' if len(sizes) > 1 else 'drill of that size'}, so {self._named(tool)} mills "
            f"{'them' if len(circles) > 1 else 'it'}"
        )
        if len(sizes) > 1:
            why += ", by short ways over all diameters"
        cut = replace(milling.cut, curves=tuple(dict.fromkeys(curves)))
        if milling.bores:
            return ProposedOperation(BoreOperation(cut), why)
        tabs = Tabs()
        if milling.loose:
            tabs = tabs_for(circles, math.pi * tool.diameter)
            why += f", with {tabs.count} tabs to hold what falls out"
        return ProposedOperation(ContourOperation(cut, Side.INSIDE, tabs=tabs), why)

    def pockets(self, progress: Progress) -> list[ProposedOperation]:
        """Return the pockets with their islands."""
        pockets, islands = self.found.pockets, self.found.islands
        what = _counted(len(pockets), "inner contour")
        standing = (
            f", {_counted(len(islands), 'island')} in {'them' if len(pockets) > 1 else 'it'} left standing"
            * bool(islands)
        )
        return self._cleared(
            (*pockets, *islands), self.depth, f"{what}: pocket {self.depth:g} mm deep{standing}", progress
        )

    def bores(self, progress: Progress) -> list[ProposedOperation]:
        """Return slots and bores that are no circles, through."""
        bores = self.found.bores
        return self._cleared(bores, self.thickness, f"{_counted(len(bores), 'slot or bore')}, through", progress)

    def _cleared(
        self, contours: Sequence[Contour], depth: float, what: str, progress: Progress
    ) -> list[ProposedOperation]:
        """Return the operations that clear what contours bound: one tool, or a wide one and one for what it leaves."""
        if not contours:
            return []
        regions = regions_within(contours)
        # the larger the area, the wider the tool that pays for its change, and for the corners that it leaves
        widest = max(WIDEST, math.sqrt(sum(map(_area, regions))) / 10)
        mills = self.rack.mills(depth)
        usable = [tool for tool in mills if tool.diameter <= widest] or mills[:1]
        advice = advise(regions, usable, CuttingPlan(depth, min(2.0, depth)), progress)
        curves = self._curves(contours)
        wide, fine = advice.pocket, advice.contour
        made = [ProposedOperation(PocketOperation(self.cut(wide, depth, curves)), f"{what}. {advice.why.rstrip('.')}")]
        if fine is not wide:
            named, cut = self._named(fine), self.cut(fine, depth, curves)
            made.append(ProposedOperation(RestOperation(cut), f"what T{wide.number} does not reach, with {named}"))
            made.append(ProposedOperation(ContourOperation(cut), f"along the walls of the same, with {named}"))
        return made

    def lines(self) -> list[ProposedOperation]:
        """Return open lines and letters, engraved."""
        lines = (*self.found.lines, *self.found.strokes)
        if not lines:
            return []
        tool, depth = self.rack.engraver(), min(ENGRAVED, self.thickness)
        parts = [
            _counted(len(some), what)
            for some, what in ((self.found.lines, "open line"), (self.found.strokes, "stroke of letters"))
            if some
        ]
        cut = self.cut(tool, depth, self._curves(lines))
        why = f"{together(parts)}: engraved {depth:g} mm deep with {self._named(tool)}"
        return [ProposedOperation(ContourOperation(cut, Side.ON), why)]

    def outlines(self) -> list[ProposedOperation]:
        """Return the outlines, cut out of the stock."""
        outlines = self.found.outlines
        if not outlines:
            return []
        least = room(space_round(outlines))
        tool = self.rack.fitting(least, WIDEST, self.thickness)
        self.round_tools.append(tool)
        tabs = replace(tabs_for(outlines), height=min(Tabs().height, self.thickness / 2))
        narrow = f"; its narrowest place has room for {least:.3g} mm alone" if tool.diameter > least + 0.01 else ""
        why = (
            f"{_counted(len(outlines), 'outline')}: cut out outside, through {self.thickness:g} mm, last, by "
            f"{self._named(tool)}, with {tabs.count} tabs each and {tool.diameter + SPARE:g} mm of stock round{narrow}"
        )
        # a helix or a wide arc beside the path would break through the narrow frame of stock round it
        cut = replace(self.cut(tool, self.thickness, self._curves(outlines)), entry=Entry(EntryKind.RAMP))
        lead = Lead(radius=SPARE / 2)
        return [ProposedOperation(ContourOperation(cut, Side.OUTSIDE, tabs=tabs, lead=lead), why)]


def _area(region: Region) -> float:
    """Return the area of a region, mm2."""
    return sum(signed_area(contour_rows(each)) for each in region.contours)


def regions_within(contours: Sequence[Contour]) -> tuple[Region, ...]:
    """Return what closed contours bound, even-odd."""
    return nest(without_crossings(contours).contours)


def space_round(outlines: Sequence[Contour]) -> tuple[Region, ...]:
    """Return what lies round outlines, with room for every tool."""
    x0, y0, x1, y1 = extent(outlines) or (0.0, 0.0, 0.0, 0.0)
    far = 4 * WIDEST
    frame = polygon_contour([(x0 - far, y0 - far), (x1 + far, y0 - far), (x1 + far, y1 + far), (x0 - far, y1 + far)])
    return regions_within((frame, *outlines))


def tabs_for(contours: Sequence[Contour], shorter: float = 0.0) -> Tabs:
    """Return tabs that the shortest of some contours has room for, whose path is so much shorter than it, mm."""
    shortest = min(float(lengths(contour_rows(each)).sum()) for each in contours) - shorter
    return Tabs(_TABS) if shortest >= _SMALL else Tabs(_FEWER, width=max(0.5, min(Tabs().width, shortest / 20)))


def _counted(count: int, what: str) -> str:
    """Return how many things there are, of which the first word of "stroke of letters" or "slot or bore" is one."""
    one, or_, other = what.partition(" or ")
    many = f"{one}s or {other}s" if or_ else what.replace("stroke", "strokes") if " of " in what else f"{what}s"
    return f"1 {what}" if count == 1 else f"{count} {many}"
