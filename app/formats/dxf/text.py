"""TEXT, and the attributes of inserted blocks, to curves: one line of letters, beside or below one another, aligned,
stretched, leaning, mirrored as the entity says.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from ...geometry.affine import Affine
from ...model.curves import Point
from ..drawing import MOST_LETTERS, LeftOutReason
from .curves import NoLengthError, plane_of
from .fonts import Fonts, style_font
from .letter_boxes import LetterBox
from .letters import LeftOutError, LetterRun, LetterStyle, TextCurves, lettered, run_of, stretches
from .vertical import is_vertical, stacked

_BACKWARD, _UPSIDE_DOWN = 2, 4
"""Flags of how a text is mirrored (group 71)."""
_LEFT, _CENTRE, _RIGHT, _ALIGNED, _MIDDLE, _FIT = range(6)
"""How a text lies across its place (group 72)."""
_BASELINE, _BOTTOM, _HALF, _TOP = range(4)
"""What of a text lies at the height of its place (group 73)."""


def text_lettering(entity: Any, fonts: Fonts) -> TextCurves:
    """Return what a TEXT or an ATTRIB draws, drawing units, seen from above.

    Raises:
        NoLengthError: its height is none.
        LeftOutError: its letters are too many, or stand below one another and are to fill a length.
    """
    dxf, kind = entity.dxf, entity.dxftype()
    style = fonts.style(entity.dxf.style)
    if len(dxf.text) > MOST_LETTERS:
        raise LeftOutError(kind, LeftOutReason.TOO_LONG)
    place = _Baseline.of(dxf)
    if not (dxf.height > 0 and dxf.width > 0):
        raise NoLengthError(place.at)
    look = LetterStyle(style_font(style), float(dxf.height), float(dxf.width), float(dxf.oblique))
    runs = [run_of(words, replace(look, bars=bars), fonts) for words, bars in stretches(dxf.text)]
    flags, plane = int(dxf.text_generation_flag), plane_of(entity, dxf.insert.z)
    if is_vertical(style):
        if place.length:
            raise LeftOutError(kind, LeftOutReason.FILLS_LENGTH)
        cells = stacked([LetterBox.of(run) for run in runs], fonts)
        drawn = [pair for cell in cells for pair in cell.box.curves(cell.x, cell.y)]
        frame = _frame_down(place, min((cell.y for cell in cells), default=0.0), flags)
    else:
        runs = place.stretched(runs)
        drawn = [pair for run, x in zip(runs, _starts(runs), strict=True) for pair in run.curves(x, 0.0)]
        frame = _frame(place, runs, flags)
    made = lettered(drawn, runs, plane.after(frame))
    return replace(made, layer=dxf.layer, kind=kind, at=plane.point(place.at))


@dataclass(frozen=True, slots=True)
class _Baseline:
    """Where a line of letters stands.

    Attributes:
        at: the point that it is aligned to. turn: of its baseline, radians.
        across: _LEFT, _CENTRE or _RIGHT of it, or stretched as _ALIGNED or _FIT. up: what lies at its height, as of
            DXF, or _MIDDLE.
        length: to which it is stretched, 0 = not.
    """

    at: Point
    turn: float
    across: int
    up: int
    length: float = 0.0

    @staticmethod
    def of(dxf: Any) -> _Baseline:
        first = (float(dxf.insert.x), float(dxf.insert.y))
        second = (float(dxf.align_point.x), float(dxf.align_point.y)) if dxf.hasattr("align_point") else first
        across, up, turn = int(dxf.halign), int(dxf.get("valign", 0)), math.radians(dxf.rotation)
        if across in (_ALIGNED, _FIT):
            length = math.dist(first, second)
            turn = math.atan2(second[1] - first[1], second[0] - first[0]) if length else turn
            return _Baseline(first, turn, across, _BASELINE, length)
        if across == _MIDDLE:
            return _Baseline(second, turn, _CENTRE, _MIDDLE)
        return _Baseline(first if across == _LEFT and up == _BASELINE else second, turn, across, up)

    def stretched(self, runs: list[LetterRun]) -> list[LetterRun]:
        """Return runs that fill the length between two points: wider, or larger altogether."""
        ink = _ink(runs)
        if not self.length or not ink:
            return runs
        factor = self.length / ink
        return [
            replace(
                run,
                look=replace(run.look, width=run.look.width * factor)
                if self.across == _FIT
                else replace(run.look, height=run.look.height * factor),
            )
            for run in runs
        ]


def _starts(runs: list[LetterRun]) -> list[float]:
    starts = [0.0]
    for run in runs:
        starts.append(starts[-1] + run.advance)
    return starts[:-1]


def _ink(runs: list[LetterRun]) -> float:
    return _starts(runs)[-1] + runs[-1].ink if runs else 0.0


def _frame(place: _Baseline, runs: list[LetterRun], flags: int) -> Affine:
    """Return the map from a line that begins in zero to its place in the plane of the entity."""
    height = max((run.look.height for run in runs), default=0.0)
    below = max((run.letters.face.below * run.unit for run in runs), default=0.0)
    right = {_CENTRE: _ink(runs) / 2, _RIGHT: _ink(runs)}.get(place.across, 0.0)
    down = {_BOTTOM: -below, _HALF: height / 2, _TOP: height, _MIDDLE: (height - below) / 2}.get(place.up, 0.0)
    return _turned(place, place.turn, Affine(x0=-right, y0=-down), flags)


def _frame_down(place: _Baseline, low: float, flags: int) -> Affine:
    """Return the map from a line that runs down from zero to `low` to its place: its letters stand upright where the
    line is turned by 270 degrees, as it is drawn downwards.
    """
    down = {_CENTRE: low / 2, _RIGHT: low}.get(place.across, 0.0)
    return _turned(place, place.turn + math.pi / 2, Affine(y0=-down), flags)


def _turned(place: _Baseline, turn: float, to: Affine, flags: int) -> Affine:
    """Return a map about the point that a line is aligned to: `to`, then mirrored, then turned, radians."""
    along, up = -1.0 if flags & _BACKWARD else 1.0, -1.0 if flags & _UPSIDE_DOWN else 1.0
    c, s = math.cos(turn), math.sin(turn)
    return Affine(c, -s, s, c, *place.at).after(Affine(along, 0.0, 0.0, up).after(to))
