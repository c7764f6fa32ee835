"""What follows the mouse: rubber band, measures, snap mark, selection window, highlight, places of findings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from .....drafting.difference import DrawingDifference
from .....model.curves import Point
from .....model.finding import Finding
from ....framework.theme import Theme
from ..drawing_tool import ToolPreview
from ..tracking import AcquiredPoint, TrackedPoint
from ..view_transform import ViewTransform
from .annotation_layer import NoteLook, paint_notes
from .curve_path import MANY, curve_path
from .pens import FINE, screen_pen

_GRIP_HALF = 3.5
_SMALL_GRIP_HALF, _MANY_GRIPS = 1.5, 60
_OWNED_PX, _OWNED_ALPHA = 7.0, 0.35


def paint_preview(painter: QPainter, view: ViewTransform, preview: ToolPreview, theme: Theme) -> None:
    """Paint the shape that is being drawn and its lines of construction."""
    painter.save()
    painter.setTransform(view.transform(), True)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    if preview.helpers:
        painter.setPen(screen_pen(painter, theme.muted, 1.0, (4.0, 4.0)))
        painter.drawPath(curve_path(*preview.helpers))
    if preview.curves:
        painter.setPen(screen_pen(painter, theme.selection, 1.8))
        painter.drawPath(curve_path(*preview.curves))
    painter.restore()


_MANY_TRIED = 500
"""More curves than these are tried with pens of one px, which Qt strokes far faster."""


class TrialLayer:
    """What a command would make, ready to paint: its paths are built once, not at every move of the mouse."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._trial = DrawingDifference()
        self._gone, self._added = QPainterPath(), QPainterPath()

    def paths(self, trial: DrawingDifference) -> tuple[QPainterPath, QPainterPath]:
        """Return the paths of what goes and of what comes, mm."""
        if trial is not self._trial:
            self._trial = trial
            self._gone, self._added = (
                curve_path(*(entity.curve for entity in some)) for some in (trial.gone, trial.added)
            )
        return self._gone, self._added

    def paint(self, painter: QPainter, view: ViewTransform, trial: DrawingDifference, theme: Theme) -> None:
        """Paint what comes in the accent, what goes in the colour of errors."""
        paint_notes(painter, view, trial.notes, NoteLook(theme.accent_text, 1.4), QRectF(painter.viewport()))
        if not (trial.added or trial.gone):
            return
        painter.save()
        painter.setTransform(view.transform(), True)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        fine = len(trial.gone) + len(trial.added) > _MANY_TRIED
        for path, colour, width in zip(self.paths(trial), (theme.error, theme.selection), (2.2, 1.8), strict=True):
            painter.setPen(screen_pen(painter, colour, FINE if fine else width))
            painter.drawPath(path)
        painter.restore()


def paint_owned(painter: QPainter, view: ViewTransform, path: QPainterPath, theme: Theme) -> None:
    """Paint curves of an operation, mm: a broad, faint band of the accent beside which their own colour stays."""
    if path.isEmpty():
        return
    band = QColor(theme.accent)
    band.setAlphaF(_OWNED_ALPHA)
    painter.save()
    painter.setTransform(view.transform(), True)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    pen = screen_pen(painter, band, FINE if path.elementCount() > MANY else _OWNED_PX)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    painter.setPen(pen)
    painter.drawPath(path)
    painter.restore()


def paint_points(painter: QPainter, view: ViewTransform, points: list[tuple[float, float]], theme: Theme) -> None:
    """Paint points that were given."""
    painter.setPen(QPen(theme.selection, 1.5))
    painter.setBrush(theme.canvas)
    for point in points:
        painter.drawEllipse(view.to_screen(point), 3.0, 3.0)


def paint_grips(
    painter: QPainter, view: ViewTransform, points: Sequence[Point], hot: Point | None, theme: Theme
) -> None:
    """Paint squares to pull at, small ones where they are many; the hot one is full."""
    half = _GRIP_HALF if len(points) <= _MANY_GRIPS else _SMALL_GRIP_HALF
    painter.setPen(QPen(theme.accent_text, 1.2))
    for point in points:
        painter.setBrush(theme.accent if point == hot else theme.canvas)
        at = view.to_screen(point)
        painter.drawRect(QRectF(at.x() - half, at.y() - half, 2 * half, 2 * half))


class TrackingAids(NamedTuple):
    """What draws the mouse: the rays that it is on, and the points that it has rested on."""

    tracked: TrackedPoint | None
    acquired: Sequence[AcquiredPoint]


def paint_tracking(
    painter: QPainter,
    view: ViewTransform,
    aids: TrackingAids,
    area: QRectF,
    theme: Theme,
) -> None:
    """Paint the rays that draw the mouse, dotted from edge to edge, and small crosses at the points that were rested
    on.
    """
    tracked, acquired = aids
    painter.setPen(screen_pen(painter, theme.accent_text, 1.2))
    for known in acquired:
        at = view.to_screen(known.point)
        painter.drawLine(at + QPointF(-4, 0), at + QPointF(4, 0))
        painter.drawLine(at + QPointF(0, -4), at + QPointF(0, 4))
    painter.setPen(screen_pen(painter, theme.accent_text, 1.2, (2.0, 4.0)))
    reach = (area.width() + area.height()) / view.scale
    for ray in tracked.rays if tracked is not None else ():
        along, _ = ray.seen_from(view.to_world(area.center()))
        painter.drawLine(view.to_screen(ray.start), view.to_screen(ray.at(max(along, 0.0) + reach)))


def paint_band(painter: QPainter, start: QPointF, end: QPointF, theme: Theme) -> None:
    """Paint the selection window: solid to the right (what lies inside), dashed to the left (also what it crosses)."""
    fill = QColor(theme.selection)
    fill.setAlphaF(0.10)
    painter.setBrush(fill)
    painter.setPen(screen_pen(painter, theme.accent_text, 1.0, () if end.x() >= start.x() else (4.0, 3.0)))
    painter.drawRect(QRectF(start, end).normalized())


def paint_highlight(
    painter: QPainter, view: ViewTransform, path: QPainterPath, colours: tuple[QColor, QColor], width: float = 2.5
) -> None:
    """Paint a path in mm as the thing under the mouse: a broad band of the first colour with a fine line of the second
    in it.
    """
    glow = QColor(colours[0])
    glow.setAlphaF(0.35)
    painter.save()
    painter.setTransform(view.transform(), True)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for hue, broad in ((glow, width + 4), (colours[1], width - 0.7)):
        pen = screen_pen(painter, hue, broad)
        pen.setCapStyle(Qt.PenCapStyle.RoundCap)
        pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        painter.setPen(pen)
        painter.drawPath(path)
    painter.restore()


def paint_findings(painter: QPainter, view: ViewTransform, findings: tuple[Finding, ...], theme: Theme) -> None:
    """Paint a ring with a cross at the place of each finding; remarks are quieter."""
    for finding in findings:
        if finding.x is None or finding.y is None:
            continue
        at = view.to_screen((finding.x, finding.y))
        paint_place(painter, at, theme.error if finding.counts else theme.warning, 1.8 if finding.counts else 1.2)


def paint_place(painter: QPainter, at: QPointF, colour: QColor, width: float = 1.8) -> None:
    """Paint a ring with a cross round a place on the screen."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(colour, width))
    painter.drawEllipse(at, 8.0, 8.0)
    for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        painter.drawLine(QPointF(at.x() + 5 * dx, at.y() + 5 * dy), QPointF(at.x() + 11 * dx, at.y() + 11 * dy))
