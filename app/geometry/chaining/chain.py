"""Chain loose curves, in any order and direction, into contours; say where they do not meet, overlap or cross."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ...core import tolerances
from ...model.finding import Finding
from ...model.part import Contour, Entity
from .crossings import crossings
from .findings import SharedPiece, gap_findings, junction_findings, overlap_findings, repeat_findings
from .join import Nodes, join_ends, nodes_of
from .near_duplicates import reach_of
from .open_contours import open_findings
from .overlap import Overlap, covered, repeated, shared_stretches, twin_contours
from .pieces import ChainPiece, pieces_from
from .trace import PiecePath, paths
from .trim import trimmed


@dataclass(frozen=True, slots=True)
class ChainingResult:
    """What a drawing's curves chain into.

    Attributes:
        contours: closed and open ones, by their first curve; not turned to any orientation.
        findings: what was removed, joined, left open, or crosses.
    """

    contours: tuple[Contour, ...] = ()
    findings: tuple[Finding, ...] = ()


def chain(entities: Sequence[Entity], join_tolerance: float = tolerances.JOIN) -> ChainingResult:
    """Return the contours that some curves form.

    Ellipses and splines become lines and arcs within 1 um. Curves drawn twice, and curves that lie wholly on another,
    are removed unless an outline needs them; drawn twice means within the join tolerance all along, of which at most
    the default counts here. Ends nearer than the join tolerance are moved to meet exactly; arcs stay
    true arcs. Where three or more ends meet, loops are closed first, then the smallest turn wins.

    Args:
        entities: curves in any order and direction.
        join_tolerance: loose ends within this distance are joined, mm, >= 0.

    Returns:
        Closed contours end exactly where they begin, and every primitive begins exactly where the one before ends.
        Overlaps that are longer than the tolerance are left as they are and reported, but for arcs of one circle whose
        loose ends lie on one another: these are cut to meet.
    """
    drawn = pieces_from(entities)
    nodes = nodes_of(drawn.pieces, join_tolerance)
    thinned = _thinned(drawn.pieces, nodes, join_tolerance)
    pieces, nodes, gaps = join_ends(thinned.pieces, thinned.nodes)
    found, branches = paths(pieces, nodes)
    contours, doubles = _once([_contour(pieces, path) for path in found], join_tolerance)
    odd = [branch.place for branch in branches if branch.odd]
    findings = [
        *drawn.findings,
        *overlap_findings(thinned.overlaps, contours, join_tolerance),
        *repeat_findings(doubles),
        *gap_findings(gaps),
        *junction_findings(branches),
        *open_findings(contours, join_tolerance),
        *crossings(contours, odd),
    ]
    return ChainingResult(tuple(contours), tuple(findings))


class _PiecesWithNodes(NamedTuple):
    """Pieces, and (n, 2) the points where they begin and end."""

    pieces: list[ChainPiece]
    nodes: Nodes


class _ThinnedPieces(NamedTuple):
    """Pieces without those that only repeat others, their nodes, and all overlaps that were found on the way."""

    pieces: list[ChainPiece]
    nodes: Nodes
    overlaps: list[SharedPiece]


class _SingleContours(NamedTuple):
    """Contours, and pairs of one that was kept and one that repeated it."""

    contours: list[Contour]
    doubles: list[tuple[Contour, Contour]]


def _thinned(pieces: list[ChainPiece], nodes: Nodes, join_tolerance: float) -> _ThinnedPieces:
    """Return what is left without curves that only repeat others."""
    reach = min(tolerances.CURVE, max(join_tolerance, tolerances.WELD))
    repeats = repeated(pieces, nodes, reach_of(join_tolerance))
    shared = [SharedPiece(pieces[o.first], pieces[o.second], o) for o in repeats]
    known = {(s.first.entity, s.second.entity) for s in shared}
    pieces, nodes = _without(pieces, nodes, repeats)
    stretches = shared_stretches(pieces, reach)
    new = [o for o in stretches if (pieces[o.first].entity, pieces[o.second].entity) not in known]
    overlaps = covered(pieces, nodes, new, reach)
    drawn = pieces
    pieces, nodes, overlaps = trimmed(pieces, nodes, overlaps)
    shared += [SharedPiece(drawn[o.first], drawn[o.second], o) for o in overlaps]
    return _ThinnedPieces(*_without(pieces, nodes, overlaps), shared)


def _without(pieces: list[ChainPiece], nodes: Nodes, overlaps: Sequence[Overlap]) -> _PiecesWithNodes:
    gone = {overlap.second for overlap in overlaps if overlap.removed}
    kept = [k for k in range(len(pieces)) if k not in gone]
    return _PiecesWithNodes([pieces[k] for k in kept], nodes[kept] if len(nodes) else nodes)


def _contour(pieces: Sequence[ChainPiece], path: PiecePath) -> Contour:
    members = [pieces[k] if forward else pieces[k].reversed() for k, forward in path.steps]
    return Contour(
        tuple(p for piece in members for p in piece.primitives),
        path.closed,
        pieces[min(path.steps).piece].layer,
        tuple(piece.entity for piece in members),
        max(piece.deviation for piece in members),
    )


def _once(contours: list[Contour], join_tolerance: float) -> _SingleContours:
    """Return the contours without closed ones that repeat another."""
    twins = twin_contours(contours, max(reach_of(join_tolerance), tolerances.CURVE))
    kept = [c for k, c in enumerate(contours) if k not in twins]
    return _SingleContours(kept, [(contours[j], contours[k]) for k, j in twins.items()])
