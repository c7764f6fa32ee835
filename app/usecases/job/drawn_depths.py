"""A job cut to the depths that its drawing tells, and what there is to say about them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ...core.errors import InputError
from ...core.options import option
from ...core.wording import in_plane
from ...model.curves import Point
from ...model.drawn_depths import DepthSource
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...toolpath.told_depths import ToldDepth, ToldDepths, told_depths

Json = dict[str, Any]

_NAMED = 8
"""Shapes that a sentence names."""


@dataclass(frozen=True)
class JobToDepths:
    """A job whose operations are cut to the depths that its drawing tells.

    Attributes:
        job: with an operation for each depth. read: what was read of which shape, and what was not understood.
        findings: what was not understood, and what tells no depth.
    """

    job: Job
    read: ToldDepths
    findings: tuple[Finding, ...]

    def lines(self) -> list[str]:
        """Return what was read, for people: a line each depth and source."""
        alike: defaultdict[tuple[DepthSource, str, float], list[Point]] = defaultdict(list)
        for each in self.read.told:
            words = " ".join(each.told.words.split())
            alike[each.told.source, words, each.depth].append(each.contour.primitives[0].start)
        return [
            f"  {source.value} '{words}': {depth:g} mm deep, {_shapes(places)}"
            for (source, words, depth), places in alike.items()
        ]

    def report(self) -> Json:
        """Return every depth that was read, and every one that was not understood."""
        return {
            "read": [_row(each) for each in self.read.told],
            "not_understood": [
                {"source": each.told.source.value, "words": each.told.words, "at": [*each.told.at], "why": each.why}
                for each in self.read.unclear
            ],
            "untold": [list(each.entity_ids) for each in self.read.untold],
        }


def with_drawn_depths(job: Job) -> JobToDepths:
    """Return a job with its operations cut to the depths that its drawing tells.

    Raises:
        InputError: the drawing tells none.
        ParameterError: an operation's parameters do not go with a depth.
    """
    read = told_depths(job)
    if not read.told:
        why = "".join(f" {each.text}" for each in _findings(read) if each.counts)
        raise InputError(
            f"{job.part.name}: the drawing tells no depth of a shape that is machined: no curve lies below the others, "
            f"and no text such as 't=4' or 'depth 4' stands beside one.{why} Leave "
            f"{option('depths', 'drawing')} away, or add them."
        )
    return JobToDepths(read.job, read, (*_findings(read),))


def _shapes(places: list[Point]) -> str:
    """Return how many shapes there are, and where the first begins."""
    x, y = places[0]
    if len(places) == 1:
        return f"the shape that begins at {in_plane(x, y)}"
    return f"{len(places)} shapes, of which the first begins at {in_plane(x, y)}"


def _row(each: ToldDepth) -> Json:
    return {
        "curves": list(each.contour.entity_ids),
        "depth_mm": each.depth,
        "source": each.told.source.value,
        "words": each.told.words,
        "at": [*each.told.at],
    }


def _findings(read: ToldDepths) -> Iterator[Finding]:
    for each in read.unclear:
        told, (x, y) = each.told, each.told.at
        what = "Text" if told.source is DepthSource.TEXT else told.source.value.capitalize()
        text = (
            f"{what} '{' '.join(told.words.split())}' at {in_plane(x, y)} is read as no depth: {each.why}; "
            "what it is of is cut as deep as the operation says."
        )
        yield Finding(FindingKind.LEFT_OUT, text, x, y, entity_ids=told.curves)
    if read.untold:
        places = ", ".join(f"{in_plane(x, y)}" for x, y in (each.primitives[0].start for each in read.untold[:_NAMED]))
        more = f" and {len(read.untold) - _NAMED} more" if len(read.untold) > _NAMED else ""
        what = "1 shape tells" if len(read.untold) == 1 else f"{len(read.untold)} shapes tell"
        cut = "is cut" if len(read.untold) == 1 else "are cut"
        text = f"{what} no depth and {cut} as deep as the operation says: {places}{more}."
        ids = tuple(number for each in read.untold for number in each.entity_ids)
        yield Finding(FindingKind.ASSUMED, text, counts=False, entity_ids=ids, amount=float(len(read.untold)))
