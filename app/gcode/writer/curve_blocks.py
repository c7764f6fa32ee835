"""Lines, arcs and splines of a fitted path as the blocks of a control, after the words that are in force in a
program.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...model.motion import Floats, MotionKind, Motions, Plane
from ...model.motion_path import ArcPaths, arc_paths
from ..interpreter.program import ModalState
from ..posts import Post
from .nurbs import nurbs_blocks
from .template_fields import Position, counts, numeral
from .work_moves import ArcRules, ReferenceArc, written_pieces

_PLANE_WORDS = {Plane.XY: "G17", Plane.ZX: "G18", Plane.YZ: "G19"}
_CENTRE = "IJK"


@dataclass(frozen=True, slots=True)
class BlockFormat:
    """What blocks are written by.

    Attributes:
        post: the control's words and digits.
        state: what is in force before, and has to be behind, the blocks.
        feed: text of the F word of the first block, or "".
        resumed: whether what follows says itself how to move.
    """

    post: Post
    state: ModalState
    feed: str = ""
    resumed: bool = False


def curve_blocks(path: Motions, spelling: BlockFormat) -> tuple[str, ...]:
    """Return the blocks that drive along a path from its start, where the tool stands; G1 is in force behind them,
    unless it is said there.

    Every end is rounded once to the post's digits; what a form cannot carry is the caller's to
    avoid: `nurbs_blocks` gives None for it.

    Args:
        path: lines, arcs in any plane, splines; mm from the zero of the table of work offsets.
        spelling: words, and what is in force.
    """
    return tuple(_CurveWriter(path, spelling).lines())


class _CurveWriter:
    """A stretch of text in the making."""

    def __init__(self, path: Motions, spelling: BlockFormat) -> None:
        self._path, self._post, self._state = path, spelling.post, spelling.state
        self._unit = spelling.state.units.value
        self._digits = spelling.post.digits(spelling.state.units)
        self._shift = np.array(spelling.state.shift)
        self._arcs = arc_paths(path)
        self._feed, self._motion, self._plane = spelling.feed, "", spelling.state.plane
        self._at: Position = self._rounded(path.start[0]) if len(path) else (0, 0, 0)
        self._resumed = spelling.resumed
        self._out: list[str] = []

    def lines(self) -> list[str]:
        """Return the text, one line a block."""
        for row in range(len(self._path)):
            kind = MotionKind(self._path.kind[row])
            if kind is MotionKind.SPLINE:
                self._spline(row)
            elif kind is MotionKind.LINE:
                self._straight(self._rounded(self._path.end[row]))
            else:
                self._arc(int(np.searchsorted(self._arcs.rows, row)))
        self._into(self._state.plane)
        if not self._resumed and self._motion != self._post.words.motion[MotionKind.LINE]:
            self._out.append(self._post.words.motion[MotionKind.LINE])
        return self._out

    def _rounded(self, place: Floats) -> Position:
        own = (place - self._shift) / self._unit
        return tuple(counts(own[axis : axis + 1], self._decimals(axis))[0] for axis in range(3))  # type: ignore[return-value]

    def _decimals(self, axis: int) -> int:
        return (self._digits.X, self._digits.Y, self._digits.Z)[axis]

    def _into(self, plane: Plane) -> None:
        if plane is not self._plane:
            self._out.append(_PLANE_WORDS[plane])
            self._plane = plane

    def _straight(self, end: Position) -> None:
        self._block(MotionKind.LINE, end, {})

    def _block(self, kind: MotionKind, end: Position, words: dict[str, str]) -> None:
        zeros = self._post.words.trailing_zeros
        for axis, letter in enumerate("XYZ"):
            if letter not in words and end[axis] != self._at[axis]:
                words[letter] = numeral(end[axis], self._decimals(axis), zeros)
        if not words:
            return
        motion = self._post.words.motion[kind]
        head = [] if motion == self._motion and self._post.words.modal_motion else [motion]
        body = [letter + words[letter] for letter in "XYZIJK" if letter in words]
        tail = [f"F{self._feed}"] if self._feed else []
        self._out.append(" ".join(head + body + tail))
        self._feed, self._motion, self._at = "", motion, end

    def _arc(self, k: int) -> None:
        """Write an arc or a helix: in its plane as the rounding of both ends allows, along the normal in step with
        it.
        """
        arcs, (u, v, w) = self._arcs, arc_axes(self._arcs, k)
        zero = complex(self._shift[u], self._shift[v])
        exact = ReferenceArc(
            (complex(*arcs.centre[k]) - zero) / self._unit,
            arcs.start_radius[k] / self._unit,
            arcs.end_radius[k] / self._unit,
            float(arcs.angle[k]),
            float(arcs.sweep[k]),
        )
        row = int(arcs.rows[k])
        end, start = self._rounded(self._path.end[row]), self._at
        kind = MotionKind(self._path.kind[row])
        rules = ArcRules.of(self._post, self._state.units)
        for piece in written_pieces(exact, (start[u], start[v]), (end[u], end[v]), rules):
            height = arcs.height[k] + arcs.rise[k] * piece.fraction
            to = [0, 0, 0]
            to[u], to[v] = piece.end
            to[w] = (
                end[w]
                if piece.fraction == 1.0
                else counts(np.array([(height - self._shift[w]) / self._unit]), self._decimals(w))[0]
            )
            place: Position = (to[0], to[1], to[2])
            if piece.centre is None:
                self._straight(place)
            else:
                self._into(Plane([plane.axes for plane in Plane].index((u, v, w))))
                self._turn(kind, place, (u, v), piece.centre)

    def _turn(self, kind: MotionKind, end: Position, axes: tuple[int, int], centre: tuple[int, int]) -> None:
        words, zeros = {}, self._post.words.trailing_zeros
        for axis, offset in zip(axes, centre, strict=True):
            words["XYZ"[axis]] = numeral(end[axis], self._decimals(axis), zeros)
            if self._state.arc_absolute:
                offset += self._at[axis] * 10 ** (self._digits.I - self._decimals(axis))
            words[_CENTRE[axis]] = numeral(offset, self._digits.I, zeros)
        self._block(kind, end, words)

    def _spline(self, row: int) -> None:
        spline = self._path.splines[row]
        blocks = nurbs_blocks(replace(spline, points=spline.points - self._shift), self._post, self._state.units)
        assert blocks is not None, "the form cannot carry this spline"
        if self._feed:
            self._out.append(f"F{self._feed}")
            self._feed = ""
        self._into(Plane.XY)
        self._out += blocks
        self._motion, self._at = "", self._rounded(self._path.end[row])


def arc_axes(arcs: ArcPaths, k: int) -> tuple[int, int, int]:
    """Return the columns of an arc's plane and of its normal."""
    u, v, w = arcs.axes[k].tolist()
    return u, v, w
