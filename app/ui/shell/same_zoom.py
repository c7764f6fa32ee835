"""What is looked at closely in the drawing or its paths is looked at closely in the NC program, and the other way."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from PySide6.QtCore import QObject

from ...model.curves import Point
from ..framework.view import View
from ..views.canvas.viewport import Viewport


@dataclass(frozen=True, eq=False)
class FollowedPicture:
    """A picture of the plane that others follow, and which follows them.

    Attributes:
        zero: where its zero lies in the drawing, mm; None where it shows something else, or nothing yet.
        fit: shows all of it at once.
    """

    viewport: Viewport
    zero: Callable[[], Point | None]
    fit: Callable[[], None]


@dataclass(frozen=True, slots=True)
class ViewedPlace:
    """What was looked at: the middle in the drawing, mm, and px for each mm."""

    middle: Point
    scale: float


class SameZoom(QObject):
    """Carries on from view to view where one has zoomed in, or that all is seen."""

    def __init__(self, pictures: Mapping[View, FollowedPicture], parent: QObject) -> None:
        super().__init__(parent)
        self._pictures = pictures
        self._last: FollowedPicture | None = None
        self._requested: ViewedPlace | None = None

    def follow(self, view: View) -> None:
        """Another view came to the front."""
        picture = self._pictures.get(view)
        if picture is None:
            return
        before, self._last, self._requested = self._last, picture, None
        if before is None or before.viewport is picture.viewport or before.zero() is None:
            return
        self._requested = _look_of(before)
        if self._requested is not None:
            self.take()
        elif picture.zero() is not None and picture.viewport.moved:
            picture.fit()

    def take(self) -> None:
        """Look at what is requested, once there is a picture of the job; afterwards the view is the user's."""
        picture, requested = self._last, self._requested
        if picture is None or requested is None or (zero := picture.zero()) is None:
            return
        self._requested = None
        viewport, place = picture.viewport, (requested.middle[0] - zero[0], requested.middle[1] - zero[1])
        viewport.set_view(replace(viewport.view, scale=requested.scale).centred(place, viewport.area))


def _look_of(picture: FollowedPicture) -> ViewedPlace | None:
    """Return what is looked at in a picture of the job; None where it shows everything."""
    viewport, zero = picture.viewport, picture.zero()
    if not viewport.moved or zero is None:
        return None
    x, y = viewport.view.to_world(viewport.area.center())
    return ViewedPlace((x + zero[0], y + zero[1]), viewport.view.scale)
