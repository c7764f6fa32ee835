"""Gives the cells of a cut their colours: worked out on another thread, for there may be many."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ....core.progress import Progress
from ...framework.theme import LIGHT, Theme
from ...framework.worker import Worker
from .colouring import Colouring, ColourKey, CutColour, key_of, told, values_of
from .inks import inks_of
from .picture import CutPicture

if TYPE_CHECKING:
    from .cut_view import CutView


def work_out(pictures: tuple[CutPicture, ...], colour: CutColour, progress: Progress) -> None:
    """Have every picture keep its values; the first one is the whole cut, whose scales hold for all."""
    for picture in pictures:
        progress.step(0.0, "Colouring")
        values_of(picture, colour, pictures[0].span)


class Colours(QObject):
    """The colours of what a view shows.

    Signals:
        known(): they are those that were asked for.

    Attributes:
        asked: what the colours shall tell. theme: by day or by night.
    """

    known = Signal()

    def __init__(self, view: CutView) -> None:
        super().__init__(view)
        self._view = view
        self.asked, self.theme = CutColour.METAL, LIGHT
        self.worker = Worker(self, head_start_s=0.0)
        self.worker.done.connect(lambda _: self.refresh())
        view.destroyed.connect(lambda: self.worker.finish())

    @property
    def told(self) -> CutColour:
        """What they tell: METAL where what is asked for is not known."""
        return told(self._view.picture, self.asked) if self._view.picture is not None else CutColour.METAL

    def refresh(self) -> None:
        """Tell that the colours are known, or work them out first."""
        whole, detail = self._view.picture, self._view.detail
        if whole is None:
            return
        colour = self.told
        pictures = (whole,) if detail is None else (whole, detail)
        if all(colour in picture.values for picture in pictures):
            self.known.emit()
        else:
            self.worker.start(lambda progress: work_out(pictures, colour, progress), 0)

    def of_whole(self, picture: CutPicture) -> Colouring:
        """Return the colours of the whole cut, once they are known."""
        return Colouring(picture.values[self.told], self.key(picture))

    def key(self, picture: CutPicture) -> ColourKey:
        """Return what they mean."""
        return key_of(picture, self.told, inks_of(self.theme), picture.span)

    def set_theme(self, theme: Theme) -> None:
        """Paint by day or by night; what the cells tell stays."""
        self.theme = theme
        self.refresh()
