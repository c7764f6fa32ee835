"""What helps the mouse to aim, as it is switched now, and the points that it has rested on."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject, QTimer, Signal

from ....model.curves import Point
from .drawing_tool import DrawingTool
from .painting.part_layer import PartLayer
from .snap import SNAP_NAMES, USUAL, SnapKind
from .snapped_point import REACH_PX, SnappedPoint, SnapRules, snapped_point
from .tracking import AcquiredPoint, acquired, with_acquired

REST_MS = 300
"""A point of the drawing that the mouse rests on for so long is tracked from then on, or no longer."""


class SnapState(QObject):
    """The switches of aiming.

    Signals:
        changed(): the mouse may aim elsewhere now.

    Attributes:
        snap: to points of the drawing. grid: to the raster. ortho: only across and up; Shift is the opposite while it
            is held.
        kinds: of points of the drawing that count. forced: the one kind that the next click takes, or None.
        polar: degrees between rays that draw the mouse, or None. tracking: whether points rested on draw it.
        acquired: those points.
    """

    changed = Signal()

    def __init__(self, picture: PartLayer, parent: QObject | None = None) -> None:
        """Begin with snapping to points, and nothing else."""
        super().__init__(parent)
        self._picture = picture
        self.snap, self.grid, self.ortho, self.shift = True, False, False, False
        self.kinds, self.forced = USUAL, None
        self.polar: float | None = None
        self.tracking = True
        self.acquired: tuple[AcquiredPoint, ...] = ()
        self._rest = QTimer(self, singleShot=True, interval=REST_MS)
        self._rest.timeout.connect(self._acquire)
        self._resting: tuple[Point, float] | None = None

    forced: SnapKind | None

    def switch(self, **what: object) -> None:
        """Set attributes by their names."""
        for name, value in what.items():
            setattr(self, name, value)
        if not self.tracking:
            self.acquired = ()
        self.changed.emit()

    def aim(self, at: Point, tool: DrawingTool, grid_step: float, scale: float) -> SnappedPoint:
        """Return where a tool aims with the mouse at a point, mm; grid_step in mm, scale in px per mm."""
        found = snapped_point(at, tool, self._picture, self._rules(grid_step, scale))
        self._watch(found, scale)
        return found

    def click(self, found: SnappedPoint) -> str:
        """See the mouse give a point; return why it is not taken, or ""."""
        if self.forced is not None and found.snap is None:
            return f"There is no {SNAP_NAMES[self.forced].lower()} here; point at a curve that has one, or Esc."
        self.forget()
        return ""

    def forget(self) -> bool:
        """Forget the forced kind and the points rested on; return whether there was any."""
        some = self.forced is not None or bool(self.acquired)
        self.forced, self.acquired, self._resting = None, (), None
        self._rest.stop()
        return some

    def _rules(self, grid_step: float, scale: float) -> SnapRules:
        rules = SnapRules(grid_step, scale, self.snap, self.grid, self.ortho != self.shift, self.kinds, self.forced)
        return replace(rules, polar=self.polar, acquired=self.acquired)

    def _watch(self, found: SnappedPoint, scale: float) -> None:
        """Begin to count the rest on a point, or go on counting."""
        point = found.snap.point if found.snap is not None and found.snap.kind is not SnapKind.GRID else None
        if point is None or not self.tracking:
            self._rest.stop()
            self._resting = None
        elif self._resting is None or self._resting[0] != point:
            self._resting = (point, scale)
            self._rest.start()

    def _acquire(self) -> None:
        if self._resting is not None:
            point, scale = self._resting
            curves = self._picture.near_curves(point, REACH_PX / scale)
            self.acquired = with_acquired(self.acquired, acquired(point, curves))
            self.changed.emit()
