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
        zero: where its zero lies in the drawing, mm; None where it shows something else.
        content: what it shows: another thing is fitted when it comes.
        fit: shows all of it at once.
    """

    viewport: Viewport
    zero: Callable[[], Point | None]
    content: Callable[[], object]
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
        self._wanted: ViewedPlace | None = None
        self._given: object = None

    def follow(self, view: View) -> None:
        """Another view came to the front."""
        picture = self._pictures.get(view)
        if picture is None:
            return
        before, self._last, self._given = self._last, picture, None
        if before is None or before.viewport is picture.viewport or before.zero() is None:
            self._wanted = None
            return
        self._wanted = _look_of(before)
        if self._wanted is not None:
            self.take()
        elif picture.zero() is not None and picture.viewport.moved:
            picture.fit()

    def take(self) -> None:
        """Look at what is wanted; again where something else is shown since, which was fitted."""
        picture, wanted = self._last, self._wanted
        zero = picture.zero() if picture is not None else None
        if picture is None or wanted is None or zero is None or picture.content() is self._given:
            return
        self._given, viewport = picture.content(), picture.viewport
        place = (wanted.middle[0] - zero[0], wanted.middle[1] - zero[1])
        viewport.set_view(replace(viewport.view, scale=wanted.scale).centred(place, viewport.area))


def _look_of(picture: FollowedPicture) -> ViewedPlace | None:
    """Return what is looked at in a picture of the job; None where it shows everything."""
    viewport, zero = picture.viewport, picture.zero()
    if not viewport.moved or zero is None:
        return None
    x, y = viewport.view.to_world(viewport.area.center())
    return ViewedPlace((x + zero[0], y + zero[1]), viewport.view.scale)
