"""What a made program looks like: part, paths by what they are for, what is left."""

from __future__ import annotations

import numpy as np

from ...formats.plot.picture import CONTOUR, LINK, POCKET, RAPID, PathPicture, Points, StyledPath
from ...geometry.primitives import contour_rows
from ...model.moves import MoveKind, Moves, Program, Purpose
from ...toolpath.coverage.areas import move_rows
from ...toolpath.coverage.coverage import Coverage

_STYLES = {
    Purpose.RAPID: RAPID,
    Purpose.LINK: LINK,
    Purpose.LEAD: LINK,
    Purpose.POCKET: POCKET,
    Purpose.CONTOUR: CONTOUR,
    Purpose.TAB: CONTOUR,
    Purpose.DOG_BONE: CONTOUR,
    Purpose.PLUNGE: LINK,
    Purpose.DRILL: LINK,
}
_ORDER = (RAPID, LINK, POCKET, CONTOUR)


def picture_of(name: str, program: Program, coverage: Coverage) -> PathPicture:
    """Return the picture of a program, seen from above."""
    moves = program.moves
    down = np.isin(moves.purpose, (Purpose.PLUNGE, Purpose.DRILL)) & (moves.end[:, 2] < moves.start[:, 2])
    straight = np.all(moves.end[:, :2] == moves.start[:, :2], axis=1)
    plunge = down & straight
    return PathPicture(
        title=name,
        contours=tuple(contour_rows(contour) for region in program.regions for contour in region.contours),
        paths=tuple(sorted(_runs(moves), key=lambda run: _ORDER.index(run.style))),
        plunges=np.unique(moves.end[plunge, :2], axis=0),
        left=_rings(coverage, reachable=True),
        unreachable=_rings(coverage, reachable=False),
    )


def _rings(coverage: Coverage, reachable: bool) -> tuple[Points, ...]:
    """Return outlines and holes of the pieces of one sort."""
    places = [place for place in coverage.places if place.reachable is reachable]
    return tuple(ring for place in places for ring in (place.outline, *place.holes))


def _runs(moves: Moves) -> list[StyledPath]:
    """Return each run of moves of one purpose; moves straight up or down are left out."""
    if not len(moves):
        return []
    rows, purpose = move_rows(moves), np.where(moves.kind == MoveKind.RAPID, Purpose.RAPID, moves.purpose)
    arc = rows[:, 7] != 0
    shown = (rows[:, 0] != rows[:, 2]) | (rows[:, 1] != rows[:, 3]) | arc
    cuts = np.flatnonzero((np.diff(purpose) != 0) | (np.diff(shown.astype(int)) != 0)) + 1
    runs = np.split(np.arange(len(moves)), cuts)
    return [StyledPath(_STYLES[Purpose(int(purpose[run[0]]))], rows[run]) for run in runs if shown[run[0]]]
