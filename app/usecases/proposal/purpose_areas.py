"""What the curves of a drawing are to become, place by place: which operation has them, and the job without that."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from ...geometry.outlines import holders
from ...model.curve_selectors import CurveNumber, Selector
from ...model.job import Job
from ...model.operation import Operation
from ...model.part import Contour
from ...toolpath.drawn_contours import DrawnContours, selected
from ...toolpath.drill_holes import CircleHole, made_by_drills, without_drilled

MOST_AREAS = 4
"""An operation with more places has them told as one."""


@dataclass(frozen=True)
class PurposeArea:
    """A place of the drawing that an operation has of its own.

    Attributes:
        index: of the operation in the job. contours: its outline with what lies in it, or several such, or open lines.
        places: how many these are. kept: the curves that the operation has besides.
    """

    index: int
    contours: tuple[Contour, ...]
    places: int
    kept: tuple[Selector, ...]

    @property
    def numbers(self) -> frozenset[int]:
        """The numbers of its curves in the drawing."""
        return frozenset(number for each in self.contours for number in each.entity_ids)


def purpose_areas(job: Job, seen: DrawnContours) -> tuple[PurposeArea, ...]:
    """Return the places of all operations that are switched on and have curves of their own, as they are listed.

    Args:
        job: its drawing and operations. seen: its contours, without copies.
    """
    drilled = made_by_drills(job, seen)
    return tuple(
        area
        for index, operation in enumerate(job.operations)
        if operation.cut.enabled and operation.cut.curves
        for area in _areas_of(index, _machined(operation, seen, drilled))
    )


def left_standing(job: Job, seen: DrawnContours, area: PurposeArea) -> Job:
    """Return the job without what an operation does at a place; one that has no curves any more is gone.

    No other operation takes over what a drill leaves: each keeps the curves that it has.
    """
    drilled = made_by_drills(job, seen)
    kept = [
        _with_curves(operation, area.kept) if index == area.index else _holding(operation, seen, drilled, area)
        for index, operation in enumerate(job.operations)
    ]
    return replace(job, operations=tuple(each for each in kept if each is not None))


def _holding(
    operation: Operation, seen: DrawnContours, drilled: frozenset[CircleHole], area: PurposeArea
) -> Operation | None:
    """Return an operation with the curves that it has, by their numbers if it would take circles of an area else."""
    mine = _machined(operation, seen, drilled)
    known = {id(each) for each in mine}
    taken = [each for each in selected(seen, operation.cut.curves).closed if id(each) not in known]
    if not any(area.numbers.intersection(each.entity_ids) for each in taken):
        return operation
    return _with_curves(operation, _selectors(mine))


def _with_curves(operation: Operation, curves: tuple[Selector, ...]) -> Operation | None:
    return replace(operation, cut=replace(operation.cut, curves=curves)) if curves else None


def _machined(operation: Operation, seen: DrawnContours, drilled: frozenset[CircleHole]) -> list[Contour]:
    """Return the contours of an operation, without the circles that drills make unless it drills."""
    found = selected(seen, operation.cut.curves)
    return [*without_drilled(found.closed, frozenset() if operation.HOLES else drilled), *found.open]


def _areas_of(index: int, contours: Sequence[Contour]) -> list[PurposeArea]:
    """Return the places of the operation with an index, which has these contours."""
    groups = [*_nested([each for each in contours if each.closed]), *([each] for each in contours if not each.closed)]
    if len(groups) > MOST_AREAS:
        return [PurposeArea(index, tuple(each for some in groups for each in some), len(groups), ())]
    return [
        PurposeArea(index, tuple(group), 1, _selectors(each for some in groups if some is not group for each in some))
        for group in groups
    ]


def _nested(closed: Sequence[Contour]) -> list[list[Contour]]:
    """Return closed contours by the outermost of them that holds them."""
    held = holders(closed)
    groups = {k: [contour] for k, contour in enumerate(closed) if not held[k]}
    for contour, by in zip(closed, held, strict=True):
        if by:
            groups[next(k for k in by if k in groups)].append(contour)
    return list(groups.values())


def _selectors(contours: Iterable[Contour]) -> tuple[Selector, ...]:
    return tuple(CurveNumber(number) for number in sorted(min(each.entity_ids) for each in contours))
