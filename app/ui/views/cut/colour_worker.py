"""Gives the cells of a cut their colours: worked out on another thread, for there may be many."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from ....core.progress import Progress
from ...framework.theme import LIGHT, Theme
from ...framework.worker import Worker
from .cell_colours import CellColours, ColourKey, CutColourBy, key_of, values_of
from .cut_picture import CutPicture
from .model import CutModel
from .theme_colours import colormap_of


def work_out(pictures: tuple[CutPicture, ...], colour: CutColourBy, progress: Progress) -> None:
    """Have every picture keep its values; the first one is the whole cut, whose scales hold for all."""
    for picture in pictures:
        progress.step(0.0, "Colouring")
        values_of(picture, colour, pictures[0].span)


class ColourWorker(QObject):
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
        colour = self._model.colour_shown
        pictures = (whole,) if detail is None else (whole, detail)
        if all(colour in picture.values for picture in pictures):
            self.known.emit()
        else:
            self.worker.start(lambda progress: work_out(pictures, colour, progress), 0)

    def of_whole(self, picture: CutPicture) -> CellColours:
        """Return the colours of the whole cut, once they are known."""
        return CellColours(picture.values[self._model.colour_shown], self.key(picture))

    def key(self, picture: CutPicture) -> ColourKey:
        """Return what they mean."""
        return key_of(picture, self._model.colour_shown, colormap_of(self.theme), picture.span)

    def set_theme(self, theme: Theme) -> None:
        """Paint by day or by night; what the cells tell stays."""
        self.theme = theme
        self.refresh()
