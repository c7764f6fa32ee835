"""Paints sheets: on the screen, into PDF and PNG, and for the printer, all from the same paths."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QPolygonF, QTransform

from ....core import tolerances
from ....formats.plot.layout import Plot
from ....formats.plot.page import (
    FilledPolygon,
    PageContent,
    Pen,
    PenStroke,
    PlotPage,
    TextLine,
    TracedPolyline,
    chains,
    segments,
)
from ....geometry.transform import Similarity
from ....model.curves import Curve

_FONT_PX = 100
_LONG = 96


@dataclass(frozen=True)
class InkPaths:
    """Ink as painter paths, in its own mm."""

    strokes: tuple[tuple[Pen, QPainterPath], ...]
    patches: tuple[FilledPolygon, ...]
    words: tuple[TextLine, ...]


@dataclass(frozen=True)
class PlotSheet:
    """A page ready to be painted."""

    page: PlotPage
    drawing: InkPaths
    frame: InkPaths


def sheets(plot: Plot) -> tuple[PlotSheet, ...]:
    """Return every page of a plot ready to be painted; takes its time, and needs no window.

    Raises:
        GeometryError: a spline cannot be followed.
    """
    return tuple(PlotSheet(page, _painted(page.drawing, plot.scale), _painted(page.frame, 1.0)) for page in plot.pages)


def _painted(ink: PageContent, scale: float) -> InkPaths:
    traces = [(trace.pen, path) for trace in ink.traces for path in _along(trace)]
    strokes = ((stroke.pen, path) for stroke in ink.strokes for path in _paths(stroke, tolerances.CURVE / scale))
    return InkPaths((*traces, *strokes), ink.patches, ink.words)


def _paths(stroke: PenStroke, tolerance: float) -> Iterator[QPainterPath]:
    """Yield a stroke in pieces: the time that Qt takes for a path grows with the square of its length."""
    path = QPainterPath()
    for run in chains(stroke.curves):
        if path.elementCount() > _LONG:
            yield path
            path = QPainterPath()
        path.moveTo(*run[0].start)
        for curve in run:
            if path.elementCount() > _LONG and not stroke.pen.dash:
                yield path
                path = QPainterPath()
                path.moveTo(*curve.start)
            _add(path, curve, tolerance)
    yield path


def _along(trace: TracedPolyline) -> Iterator[QPainterPath]:
    """Yield a trace in pieces, or whole where it is dashed."""
    step = len(trace.points) if trace.pen.dash else _LONG
    for at in range(0, len(trace.points) - 1, step):
        path = QPainterPath()
        path.addPolygon(QPolygonF([QPointF(x, y) for x, y in trace.points[at : at + step + 1].tolist()]))
        yield path


def _add(path: QPainterPath, curve: Curve, tolerance: float) -> None:
    for points in segments(curve, tolerance):
        if len(points) == 1:
            path.lineTo(*points[0])
        else:
            path.cubicTo(*(each for point in points for each in point))


def paint(painter: QPainter, sheet: PlotSheet) -> None:
    """Paint a sheet with a painter in mm, y down, whose zero is the paper's upper left corner."""
    page = sheet.page
    painter.save()
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.translate(0.0, page.height)
    painter.scale(1.0, -1.0)
    painter.save()
    x0, y0, x1, y1 = page.window
    painter.setClipRect(QRectF(x0, y0, x1 - x0, y1 - y0))
    _paint(painter, sheet.drawing, page.place)
    painter.restore()
    _paint(painter, sheet.frame, Similarity())
    painter.restore()


def _paint(painter: QPainter, painted: InkPaths, place: Similarity) -> None:
    painter.save()
    a, b = place.a, place.b
    painter.setTransform(QTransform(a.real, a.imag, -a.imag, a.real, b.real, b.imag), True)
    for pen, path in painted.strokes:
        painter.strokePath(path, _pen(pen, place.scale))
    painter.setPen(Qt.PenStyle.NoPen)
    for patch in painted.patches:
        painter.setBrush(QColor(patch.pen.colour))
        painter.drawPolygon(QPolygonF([QPointF(*corner) for corner in patch.corners]))
    painter.restore()
    for words in painted.words:
        _write(painter, words, place)


def _pen(pen: Pen, scale: float) -> QPen:
    made = QPen(
        QColor(pen.colour), pen.width / scale, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin
    )
    if pen.dash:
        if min(pen.dash) > pen.width:
            made.setCapStyle(Qt.PenCapStyle.FlatCap)
        made.setDashPattern([length / pen.width for length in pen.dash])
    return made


def _write(painter: QPainter, words: TextLine, place: Similarity) -> None:
    font = QFont("sans-serif")
    font.setStyleHint(QFont.StyleHint.SansSerif)
    font.setPixelSize(_FONT_PX)
    font.setBold(words.bold)
    size = words.height / _FONT_PX
    painter.save()
    painter.translate(*place(words.at))
    painter.rotate(math.degrees(words.angle))
    painter.translate(0.0, words.lift)
    painter.scale(size, -size)
    painter.setFont(font)
    painter.setPen(QColor(words.pen.colour))
    painter.drawText(QPointF(-words.anchor * QFontMetricsF(font).horizontalAdvance(words.text), 0.0), words.text)
    painter.restore()
