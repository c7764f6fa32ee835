"""Connects the views of the plane, so that they look at the same place."""

from __future__ import annotations

from functools import partial

from ...model.curves import Point
from ...model.stock_box import program_origin
from ..framework.view import View
from ..views.curves.controller import SmoothingController
from ..views.nc.controller import NcController
from ..views.nc.motion_shapes import ViewSide
from ..views.nc.path_view import PathView
from .display_controller import DisplayController
from .main_window import MainWindow
from .same_zoom import FollowedPicture, SameZoom


class ZoomCoordinator:
    """Has Draw and Paths, NC and Curves look at the same place of the job."""

    def __init__(
        self, window: MainWindow, display: DisplayController, nc: NcController, curves: SmoothingController
    ) -> None:
        self._computation, self._nc = window.computation, nc
        canvas = window.canvas
        drawing = FollowedPicture(canvas, lambda: (0.0, 0.0), canvas.fit)
        program, curved = map(self._followed, (window.views.nc.path, window.views.curves.path))
        views = {View.DRAW: drawing, View.PATHS: drawing, View.NC: program, View.CURVES: curved}
        self.zoom = SameZoom(views, window)
        display.view_changed.connect(self.zoom.follow)
        for controller in (nc, curves):  # each shows its program when it is there, fitted
            controller.changed.connect(self.zoom.take)

    def _followed(self, path: PathView) -> FollowedPicture:
        return FollowedPicture(path, partial(self._zero_of, path), path.fit_now)

    def _zero_of(self, path: PathView) -> Point | None:
        """Return where zero of a path seen from above lies in the drawing, mm; None of another program, or side."""
        made, picture = self._computation.made, path.picture
        if made is None or picture is None or picture.side is not ViewSide.XY or self._nc.foreign:
            return None
        return program_origin(made.job, made.program)[:2]
