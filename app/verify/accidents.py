"""What goes wrong on the way, whatever the part is: rapids, holders and plunges in metal, a start in it, unknown
places, the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..core.options import option
from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..core.wording import in_plane, together
from ..model.finding import Finding, FindingKind
from ..model.motion import MotionKind, Motions
from ..model.motion_path import reach
from ..model.tool import Tool
from ..simulation.bodies.bodies import HolderPart
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Workpiece
from ..simulation.sweeps.course import Course
from ..simulation.sweeps.trim import CutResult, RapidHit
from .bent_rapids import bent_rapids
from .course import MOST, NARROW, CutterTravel, FineStock, KnownCourse
from .holder_contacts import HolderContact, HolderReport, holder_contacts
from .plunges import fast_plunges, plunges
from .standing_spindle import StandingCut

NAMED = 50
"""Accidents of one kind that are told one by one."""

ALMOST = 1e-3
"""mm sideways, up to which a tool goes straight down."""


@dataclass(frozen=True, eq=False)
class ProgramStage:
    """One program of a setup: what it is cut along, out of what, with what, and what it leaves.

    Attributes:
        metal: of the setup, as it is at any time of this program. tools: by T number.
        where: words for the place of a motion in the text, such as "NC line 7", by its row.
        plunge_rates: that the program's header names, mm/min, by T number.
        under: thickness of the waste below the stock that its header tells of, mm.
        rapids_bend: its control may move each axis of a rapid at its own rate.
        standing: what it cuts while the spindle stands.
    """

    known: KnownCourse
    before: Workpiece
    cut: CutResult
    metal: FineStock
    tools: Mapping[int, Tool]
    where: Callable[[int], str]
    plunge_rates: Mapping[int, float]
    under: float = 0.0
    rapids_bend: bool = False
    standing: StandingCut | None = None

    @property
    def motions(self) -> Motions:
        """Of the program."""
        return self.known.course.motions

    @property
    def cutters(self) -> Mapping[int, Cutter]:
        """By T number."""
        return self.metal.cutters

    @property
    def top(self) -> float:
        """No metal is higher before the program, mm."""
        return float(self.before.heights.max())

    def finding(self, kind: FindingKind, text: str, row: int, place: tuple[float, float], amount: float) -> Finding:
        """Return an accident of a motion."""
        x, y = place
        return Finding(kind, text, x, y, amount=amount, line=int(self.motions.line[row]))


@dataclass(frozen=True)
class Accidents:
    """What goes wrong in a program.

    Attributes:
        findings: in words; places in program coordinates.
        rapids: that go through metal, also those that no cell has seen.
        holders: shanks and holders in metal, and how far tools must stick out.
    """

    findings: tuple[Finding, ...]
    rapids: tuple[RapidHit, ...]
    holders: HolderReport


def accidents(stage: ProgramStage, progress: Progress = NO_PROGRESS) -> Accidents:
    """Return what goes wrong while a program is cut.

    Raises:
        Cancelled: the job was asked to stop.
    """
    looked = narrow_rapids(stage.known.course, stage.metal, stage.before, stage.cut.rapids, progress.part(0.0, 0.3))
    holders = holder_contacts(stage.known.course, stage.before, stage.cutters, stage.tools, progress.part(0.3, 0.6))
    findings = (
        *_start(stage),
        *_rapids(stage, looked),
        *_bent_rapids(stage, looked, progress.part(0.6, 0.7)),
        *_standing_spindle(stage),
        *_sideways_out(stage),
        *_at_unknown_places(stage),
        *_plunges(stage, progress.part(0.7, 0.85)),
        *_fast_plunges(stage, progress.part(0.85, 1.0)),
        *_holders(stage, holders),
        *_below_table(stage),
    )
    return Accidents(findings, looked.rapids, holders)


def _start(stage: ProgramStage) -> Iterator[Finding]:
    """Yield that the program begins with the tool in the metal."""
    first, course = stage.known.first, stage.known.course
    cutter = stage.cutters.get(int(course.tool[first])) if first < len(stage.motions) else None
    if cutter is None:
        return
    places = stage.motions.start if stage.known.begins else stage.motions.end
    hit = stage.metal.met(CutterTravel(first, places[first : first + 1], cutter), stage.top, stage.before.grid.pitch)
    if hit is not None:
        x, y, z = places[first].tolist()
        text = (
            f"The first place that the program names, X {x:.3f} Y {y:.3f} Z {z:.3f} in {stage.where(first)}, is "
            f"{hit.depth:.3f} mm deep in the stock; go above the stock first (G0 Z...), or tell the stock as it is."
        )
        yield stage.finding(FindingKind.START_IN_STOCK, text, first, (x, y), hit.depth)


def _rapids(stage: ProgramStage, looked: NarrowRapids) -> Iterator[Finding]:
    """Yield the rapids that go through metal, the first ones one by one."""
    hits = looked.rapids
    for hit in hits[:NAMED]:
        text = (
            f"A rapid goes through metal, {hit.depth:.3f} mm deep at ({hit.x:.3f}, {hit.y:.3f}, {hit.z:.3f}), "
            f"{stage.where(hit.motion)}; do not run this program."
        )
        yield stage.finding(FindingKind.RAPID_IN_MATERIAL, text, hit.motion, (hit.x, hit.y), hit.depth)
    if len(hits) > NAMED:
        yield Finding(
            FindingKind.RAPID_IN_MATERIAL,
            f"{len(hits) - NAMED} more rapids go through metal; do not run this program.",
            amount=float(len(hits) - NAMED),
        )
    yield from _unseen(stage, looked.unseen, "rapids")


def _bent_rapids(stage: ProgramStage, looked: NarrowRapids, progress: Progress) -> Iterator[Finding]:
    """Yield the rapids that pass metal where they go straight, and may meet it where they do not."""
    if not stage.rapids_bend:
        return
    told = {hit.motion for hit in looked.rapids}
    found = bent_rapids(stage.known.course, stage.before, stage.cutters, progress)
    hits = [hit for hit in found if hit.motion not in told]
    for hit in hits[:NAMED]:
        text = (
            f"The rapid in {stage.where(hit.motion)} passes the metal on a straight way alone; where the control moves "
            f"each axis at its own rate it goes {hit.depth:.3f} mm deep into it at ({hit.x:.3f}, {hit.y:.3f}, "
            f"{hit.z:.3f}); lift it first, go along one axis at a time, or use G1."
        )
        yield stage.finding(FindingKind.RAPID_IN_MATERIAL, text, hit.motion, (hit.x, hit.y), hit.depth)
    if len(hits) > NAMED:
        text = (
            f"{len(hits) - NAMED} more rapids may go through metal where the control moves each axis at its own rate."
        )
        yield Finding(FindingKind.RAPID_IN_MATERIAL, text, amount=float(len(hits) - NAMED))


def _unseen(stage: ProgramStage, count: int, what: str) -> Iterator[Finding]:
    """Yield a remark where there was too much to look at between the cells."""
    if count:
        text = (
            f"{count} {what} of narrow cutters were not, or not all along, looked at between the cells, "
            f"{stage.before.grid.pitch:.3g} mm wide; use more cells ({option('grid')})."
        )
        yield Finding(FindingKind.TOLERANCE, text, counts=False, amount=float(count))


def _standing_spindle(stage: ProgramStage) -> Iterator[Finding]:
    """Yield that metal is cut while the spindle stands; a remark where the program leaves it to somebody else."""
    standing = stage.standing
    if standing is None:
        return
    x, y, _ = stage.motions.end[standing.row].tolist()
    if standing.starts:
        others = "" if standing.motions == 1 else f", the first of {standing.motions} motions that do"
        tool = int(stage.known.course.tool[standing.row])
        text = (
            f"{stage.where(standing.row)} cuts metal with {f'T{tool}' if tool else 'the tool'} while the spindle "
            f"stands{others}; start it (M3) behind the tool change or M5 before."
        )
    else:
        text = "The program never starts the spindle (M3), and cuts metal; switch it on by hand, or write M3 into it."
    line = int(stage.motions.line[standing.row])
    yield Finding(FindingKind.SPINDLE, text, x, y, counts=standing.starts, line=line)


def _sideways_out(stage: ProgramStage) -> Iterator[Finding]:
    """Yield the rapids that set out for a place of the machine beside while metal stands higher than the tool."""
    motions, nowhere = stage.motions, stage.known.nowhere
    known_before = np.concatenate([[False], ~nowhere[:-1].any(axis=1)])
    rows = np.flatnonzero((motions.kind == MotionKind.RAPID) & nowhere[:, :2].any(axis=1) & known_before)
    for row in rows.tolist():
        cutter, place = stage.cutters.get(int(stage.known.course.tool[row])), motions.end[row - 1]
        depth = 0.0 if cutter is None or place[2] >= stage.top - LEVEL else _beside(stage, row, place, cutter)
        if depth > LEVEL:
            x, y, z = place.tolist()
            text = (
                f"The rapid in {stage.where(row)} sets out sideways from ({x:.3f}, {y:.3f}, {z:.3f}) for a place that "
                f"nobody knows, and the metal there stands {depth:.3f} mm higher than the tool; lift it first, such "
                "as by G53 G0 Z0."
            )
            yield stage.finding(FindingKind.RAPID_IN_MATERIAL, text, row, (x, y), depth)


def _beside(stage: ProgramStage, row: int, place: np.ndarray, cutter: Cutter) -> float:
    """Return how much higher than a tool over the stock the metal stands that it may meet on its way, mm."""
    x0, y0, x1, y1 = stage.metal.stock.box
    if not (x0 - cutter.radius < place[0] < x1 + cutter.radius and y0 - cutter.radius < place[1] < y1 + cutter.radius):
        return 0.0
    free = stage.known.nowhere[row, :2]
    if free.all():
        return float(stage.metal.over(stage.before.grid, row).heights.max()) - float(place[2])
    ends = np.array([place, place])
    ends[:, 0 if free[0] else 1] = (x0, x1) if free[0] else (y0, y1)
    hit = stage.metal.met(CutterTravel(row, ends, cutter), stage.top, stage.before.grid.pitch)
    return hit.depth if hit is not None else 0.0


def _at_unknown_places(stage: ProgramStage) -> Iterator[Finding]:
    """Yield that motions at feed rate are not cut as nobody knows where they are, unless they surely stay above the
    stock.
    """
    motions, known = stage.motions, stage.known
    left_out = np.isin(np.arange(len(motions)), known.course.left_out) & (motions.kind != MotionKind.RAPID)
    above = ~known.nowhere[:, 2] & (reach(motions)[0][:, 2] >= stage.top - LEVEL)
    lifts = (
        known.home[:, 2]
        & ~known.nowhere[:, :2].any(axis=1)
        & np.all(motions.start[:, :2] == motions.end[:, :2], axis=1)
    )
    rows = np.flatnonzero(left_out & ~above & ~lifts)
    if not len(rows):
        return
    row = int(rows[0])
    unknown = known.nowhere[row] | known.nowhere[max(row - 1, 0)]
    axes = together(name for name, one in zip("XYZ", unknown.tolist(), strict=True) if one)
    others = "" if len(rows) == 1 else f", the first of {len(rows)} such motions"
    text = (
        f"{stage.where(row)} cuts at a place that the program has not told{others}: {axes} "
        f"{'is' if len(axes) == 1 else 'are'} not known there, so it is not cut here; go to a place that is told "
        "first (G0 X... Y... Z...)."
    )
    yield Finding(FindingKind.LEFT_OUT, text, amount=float(len(rows)), line=int(motions.line[row]))


def _plunges(stage: ProgramStage, progress: Progress) -> Iterator[Finding]:
    """Yield the ways down into metal of mills that do not cut at their centre, the first ones one by one."""
    all_found = plunges(stage.metal, stage.before, progress)
    found = all_found.found
    for each in found[:NAMED]:
        aside = "straight down" if each.aside <= ALMOST else f"down, sideways by only {each.aside:.3f} mm,"
        text = (
            f"T{each.tool} goes {aside} into metal at ({each.x:.3f}, {each.y:.3f}), {stage.where(each.motion)}, and "
            "does not cut at its centre; ramp in, or use a cutter that does."
        )
        yield stage.finding(FindingKind.PLUNGE, text, each.motion, (each.x, each.y), each.depth)
    if len(found) > NAMED:
        yield Finding(
            FindingKind.PLUNGE,
            f"{len(found) - NAMED} more times a mill goes down into metal that does not cut at its centre.",
            amount=float(len(found) - NAMED),
        )
    yield from _unseen(stage, all_found.unseen, "ways down")


def _fast_plunges(stage: ProgramStage, progress: Progress) -> Iterator[Finding]:
    """Yield, for each tool, its descents into metal at the feed for going sideways."""
    looked = fast_plunges(stage.metal, stage.before, stage.tools, stage.plunge_rates, progress)
    for each in looked.found:
        others = "" if each.count == 1 else f", the deepest of {each.count} such descents"
        said = (
            "which is how fast it cuts sideways, too"
            if each.rate is None
            else f"where its plunge rate is {each.rate:.0f} mm/min"
        )
        remedy = "slow it down, or ramp in" if each.rate is not None else "see that it may, or slow it down"
        text = (
            f"T{each.tool} goes straight down into metal at {each.feed:.0f} mm/min, {said}: {each.depth:.3f} mm deep "
            f"at ({each.x:.3f}, {each.y:.3f}), {stage.where(each.motion)}{others}; {remedy}."
        )
        found = stage.finding(FindingKind.FEED, text, each.motion, (each.x, each.y), each.depth)
        yield replace(found, counts=each.rate is not None)
    yield from _unseen(stage, looked.unseen, "fast ways down")


def _holders(stage: ProgramStage, looked: HolderReport) -> Iterator[Finding]:
    """Yield the shanks and holders that meet metal, the first ones of each one by one."""
    for part, kind in ((HolderPart.HOLDER, FindingKind.HOLDER_CONTACT), (HolderPart.SHANK, FindingKind.SHANK_CONTACT)):
        contacts = [each for each in looked.contacts if each.part is part]
        for contact in contacts[:NAMED]:
            text = (
                f"The {part.value} of T{contact.tool} goes into metal, {contact.depth:.3f} mm deep at "
                f"({contact.x:.3f}, {contact.y:.3f}, {contact.z:.3f}), "
                f"{stage.where(contact.motion)}{_through(contact)}; {_remedy(stage, contact, looked)}"
            )
            yield stage.finding(kind, text, contact.motion, (contact.x, contact.y), contact.depth)
        if len(contacts) > NAMED:
            more = len(contacts) - NAMED
            text = (
                f"{part.value.capitalize()}s go into metal at {more} more place{'' if more == 1 else 's'}; do not "
                "run this program."
            )
            yield Finding(kind, text, amount=float(more))
    if looked.unseen:
        text = (
            f"{looked.unseen} motions of which it is not sure whether shank or holder meets metal were not looked at "
            f"one by one; use fewer cells ({option('grid')}), or cut less deep."
        )
        yield Finding(FindingKind.TOLERANCE, text, counts=False, amount=float(looked.unseen))


def _through(contact: HolderContact) -> str:
    return f", the deepest of {contact.count} motions" if contact.count > 1 else ""


def _remedy(stage: ProgramStage, contact: HolderContact, looked: HolderReport) -> str:
    """Return what to do against a contact."""
    tool = stage.tools[contact.tool]
    if contact.part is HolderPart.HOLDER:
        return f"stick it out {looked.least[contact.tool]:.1f} mm or more, it has {tool.stick_out:g}."
    wider = (
        f"the shank, {tool.shank_diameter:g} mm wide, begins"
        if tool.shank_diameter > tool.diameter
        else "its flutes end"
    )
    return f"{wider} {tool.flute_length:g} mm over the tip; use longer flutes, or clear the metal above first."


def _below_table(stage: ProgramStage) -> Iterator[Finding]:
    """Yield that the tool goes below the stock, where the table is; place and line are those of the deepest motion."""
    low = reach(stage.motions)[0][:, 2].copy()
    low[list(stage.known.course.left_out)] = np.inf
    floor = stage.before.floor
    below = np.flatnonzero(low < floor - stage.under - LEVEL)
    if not len(below):
        return
    row, first = int(np.argmin(low)), int(below[0])
    x, y, _ = stage.motions.end[row].tolist()
    depth = floor - float(low[row])
    motions = "A motion goes" if len(below) == 1 else f"{len(below)} motions, the first in {stage.where(first)}, go"
    text = (
        f"{motions} below the stock's underside, Z {floor:.3f}, where the table "
        f"is{'' if len(below) == 1 else ', the deepest'} {depth:.3f} mm at {in_plane(x, y)}, {stage.where(row)}; "
        "put something under the stock, or cut less deep."
    )
    yield stage.finding(FindingKind.BELOW_TABLE, text, row, (x, y), depth)


# Rapids of cutters that are narrower than the cells: what the cells' centres have not seen is looked at closer.


Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class NarrowRapids:
    """The rapids of a program that go through metal, in their order, and how many could not, or not wholly, be looked
    at closer.
    """

    rapids: tuple[RapidHit, ...]
    unseen: int = 0


def narrow_rapids(
    course: Course, stock: FineStock, before: Workpiece, seen: tuple[RapidHit, ...], progress: Progress = NO_PROGRESS
) -> NarrowRapids:
    """Return the rapids that go through metal.

    Args:
        course: of the last program of `stock`. before: the metal before it. seen: those that the cells have shown.

    Raises:
        Cancelled: the job was asked to stop.
    """
    top, pitch = float(before.heights.max()), before.grid.pitch
    rows = np.flatnonzero(
        _in_question(course, stock, top, pitch) & ~np.isin(np.arange(len(course.motions)), [hit.motion for hit in seen])
    )
    rows = rows[~_goes_where_it_was(course, rows)]
    hits, unseen = list(seen), max(0, len(rows) - MOST)
    for k, row in enumerate(rows[:MOST].tolist()):
        progress.step(k / len(rows), "Looking at rapids")
        ends = np.array([course.motions.start[row], course.motions.end[row]])
        way = CutterTravel(row, ends, stock.cutters[int(course.tool[row])])
        hit = stock.met(way, top, pitch)
        hits += [hit] if hit is not None else []
        unseen += hit is None and not stock.wholly(way, top, pitch)
    return NarrowRapids(tuple(sorted(hits, key=lambda hit: hit.motion)), unseen)


def _in_question(course: Course, stock: FineStock, top: float, pitch: float) -> Mask:
    """Return which motions are rapids below the top, over the stock, of cutters that are narrow down there."""
    motions, (x0, y0, x1, y1) = course.motions, stock.stock.box
    low, high = reach(motions)
    radius, up_to = _widths(course, stock.cutters, pitch)
    over = (
        (low[:, 0] - radius < x1) & (low[:, 1] - radius < y1) & (high[:, 0] + radius > x0) & (high[:, 1] + radius > y0)
    )
    below = top - low[:, 2]
    requested = (motions.kind == MotionKind.RAPID) & over & (below > LEVEL) & (below < up_to)
    requested[list(course.left_out)] = False
    return np.asarray(requested)


def _widths(
    course: Course, cutters: Mapping[int, Cutter], pitch: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return of each motion's cutter the radius, and the height over the tip up to which it is narrow, mm; without one:
    none.
    """
    radius, up_to = np.zeros(len(course.motions)), np.zeros(len(course.motions))
    for number, cutter in cutters.items():
        mine = course.tool == number
        radius[mine], up_to[mine] = cutter.radius, float(cutter.heights(np.array([NARROW * pitch]))[0]) + cutter.lift
    return radius, up_to


def _goes_where_it_was(course: Course, rows: NDArray[np.intp]) -> Mask:
    """Return which rapids go upright over a place where their cutter has cut as deep before."""
    motions = course.motions
    upright = np.all(motions.start[:, :2] == motions.end[:, :2], axis=1)
    requested = rows[upright[rows]]
    if not len(requested):
        return np.zeros(len(rows), np.bool_)
    cuts = motions.kind != MotionKind.RAPID
    cuts[list(course.left_out)] = False
    cuts &= upright | np.append(~cuts[1:], True)
    cuts[requested] = True
    asked, looked_at = np.isin(np.arange(len(motions)), requested), np.flatnonzero(cuts)
    deepest: dict[tuple[int, float, float], float] = {}
    clear: list[int] = []
    low = np.minimum(motions.start[looked_at, 2], motions.end[looked_at, 2])
    each = (looked_at, asked[looked_at], course.tool[looked_at], *motions.end[looked_at].T, low)
    for row, question, tool, x, y, z, lower in zip(*(values.tolist() for values in each), strict=True):
        if not question:
            deepest[tool, x, y] = min(deepest.get((tool, x, y), np.inf), z)
        elif deepest.get((tool, x, y), np.inf) <= lower:
            clear.append(row)
    return np.isin(rows, clear)
