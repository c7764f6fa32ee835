"""Which contours of a drawing an operation works on, by its selectors, and what to say of those that find nothing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum

from ..geometry.as_circle import as_circle
from ..model.curve_selectors import CirclesOf, ContourKind, CurveNumber, OnLayer, Selector
from ..model.fields import parameters_of
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.operation import Operation, Side
from ..model.part import Contour
from .drawn_contours import DrawnContours

SAME_DIAMETER = 0.005
"""mm by which a circle may be wider or narrower than asked for: drawings in inches, and their last digits."""

_NAMED = 8
"""Diameters, numbers or layers that a finding names."""


@dataclass(frozen=True, eq=False)
class SelectedCurves:
    """Contours of a drawing that an operation works on.

    Attributes:
        closed, open: in the order of the drawing, copies and all.
    """

    closed: tuple[Contour, ...]
    open: tuple[Contour, ...]


def selected(drawn: DrawnContours, curves: Sequence[Selector]) -> SelectedCurves:
    """Return the contours that any of some selectors selects; without one all that the job machines."""
    if not curves:
        return SelectedCurves(drawn.closed, drawn.open)
    placed = any(each in (ContourKind.OUTER, ContourKind.INNER) for each in curves)
    inner = drawn.inner if placed else frozenset()
    return SelectedCurves(
        tuple(c for c in drawn.closed if any(_selects(each, c, id(c) in inner) for each in curves)),
        tuple(c for c in drawn.open if any(_selects(each, c, False) for each in curves)),
    )


def _selects(selector: Selector, contour: Contour, is_inner: bool) -> bool:
    match selector:
        case CurveNumber(number):
            return number in contour.entity_ids
        case OnLayer(name):
            return contour.layer == name
        case CirclesOf(least, most):
            circle = as_circle(contour)
            return circle is not None and least - SAME_DIAMETER <= 2 * circle.radius <= most + SAME_DIAMETER
        case ContourKind.OPEN:
            return not contour.closed
        case _:
            return contour.closed and is_inner is (selector is ContourKind.INNER)


def selection_findings(job: Job, drawn: DrawnContours) -> list[Finding]:
    """Return a finding that counts for each selector of an operation that selects nothing which that can machine."""
    return [
        _about(operation, selector, drawn, job)
        for operation in job.operations
        if operation.cut.enabled
        for selector in operation.cut.curves
        if not _usable(operation, selected(drawn, (selector,)))
        # an empty layer was never a fault: nothing is asked for that could be missing
        if not isinstance(selector, OnLayer)
    ]


def _not_taken(operation: Operation) -> tuple[Enum, ...]:
    """Return the sides that an operation refuses."""
    side = parameters_of(type(operation)).get("side")
    return () if side is None else side.parameter.not_taken


def _usable(operation: Operation, found: SelectedCurves) -> bool:
    """Tell whether an operation can machine something of what was found."""
    if operation.takes_open:
        return bool(found.open or (found.closed and operation.wall_side is Side.ON))
    if operation.HOLES:
        return any(as_circle(each) is not None for each in found.closed)
    return bool(found.closed)


def _about(operation: Operation, selector: Selector, drawn: DrawnContours, job: Job) -> Finding:
    who = f"{operation.WORD.capitalize()} T{operation.cut.tool} asks for {selector.text}"
    found = selected(drawn, (selector,))
    x, y = (found.closed or found.open)[0].primitives[0].start if found.closed or found.open else (None, None)
    ids = tuple(number for each in (*found.closed, *found.open) for number in each.entity_ids)
    if found.closed:
        why = "which is no circle to drill"
    elif found.open:
        on = Side.ON not in _not_taken(operation)
        why = f"which is open, beginning at ({x:.3f}, {y:.3f}): close it{', or follow it with side = on' if on else ''}"
    else:
        why = f"and there is none; {_there(selector, drawn, job)}"
    return Finding(FindingKind.LEFT_OUT, f"{who}, {why}.", x, y, entity_ids=ids)


def _there(selector: Selector, drawn: DrawnContours, job: Job) -> str:
    """Return what the drawing has in the place of what a selector does not find."""
    match selector:
        case CurveNumber(number):
            if (entity := next((each for each in job.part.entities if each.id == number), None)) is not None:
                return f"that curve is on layer '{entity.layer}', which the job does not machine or keeps off"
            numbers = sorted({each.id for each in job.part.entities})
            return f"the drawing has {_listed(_runs(numbers))}"
        case CirclesOf():
            circles = (as_circle(each) for each in drawn.closed)
            sizes = sorted({round(2 * circle.radius, 3) for circle in circles if circle is not None})
            return f"the drawing has {_listed(f'circles:{size:g}' for size in sizes)}"
        case _:
            outer, inner = len(drawn.closed) - len(drawn.inner), len(drawn.inner)
            return (
                f"the drawing has {_counted(outer, 'outer')}, {_counted(inner, 'inner')} and "
                f"{_counted(len(drawn.open), 'open')} contours"
            )


def _counted(count: int, what: str) -> str:
    return f"{count or 'no'} {what}"


def _listed(words: Iterable[str]) -> str:
    """Return the first of some words, and how many more there are."""
    every = list(words)
    more = [f"{len(every) - _NAMED} more"] if len(every) > _NAMED else []
    return ", ".join([*every[:_NAMED], *more]) or "none"


def _runs(numbers: Sequence[int]) -> Iterator[str]:
    """Yield numbers, from the first to the last where there is no gap between them."""
    first = None
    for k, number in enumerate(numbers):
        first = number if first is None else first
        if k + 1 == len(numbers) or numbers[k + 1] != number + 1:
            yield f"#{first}" if first == number else f"#{first} to #{number}"
            first = None
