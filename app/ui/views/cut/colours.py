"""Gives the cells of a cut their colours: worked out on another thread, for there may be many."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from ....core.progress import Progress
from ...framework.theme import LIGHT, Theme
from ...framework.worker import Worker
from .colouring import Colouring, ColourKey, CutColour, key_of, values_of
from .cut_model import CutModel
from .inks import inks_of
from .picture import CutPicture


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
        theme: by day or by night.
    """

    known = Signal()

    def __init__(self, model: CutModel, parent: QObject) -> None:
        super().__init__(parent)
        self._model, self.theme = model, LIGHT
        self.worker = Worker(self, head_start_s=0.0)
        self.worker.done.connect(lambda _: self.refresh())
        parent.destroyed.connect(lambda: self.worker.finish())

    def refresh(self) -> None:
        """Tell that the colours are known, or work them out first."""
        whole, detail = self._model.picture, self._model.detail
        if whole is None:
            return
        colour = self._model.told
        pictures = (whole,) if detail is None else (whole, detail)
        if all(colour in picture.values for picture in pictures):
            self.known.emit()
        else:
            self.worker.start(lambda progress: work_out(pictures, colour, progress), 0)

    def of_whole(self, picture: CutPicture) -> Colouring:
        """Return the colours of the whole cut, once they are known."""
        return Colouring(picture.values[self._model.told], self.key(picture))

    def key(self, picture: CutPicture) -> ColourKey:
        """Return what they mean."""
        return key_of(picture, self._model.told, inks_of(self.theme), picture.span)

    def set_theme(self, theme: Theme) -> None:
        """Paint by day or by night; what the cells tell stays."""
        self.theme = theme
        self.refresh()
