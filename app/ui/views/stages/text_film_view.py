"""A film of one of the texts B to E: its steps at the left, the picture of one in the middle, the player under it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from PySide6.QtCore import QByteArray, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QAbstractItemView, QListWidget, QListWidgetItem, QWidget

from ...framework.boxes import h_box, v_box
from ...framework.figures import counted
from ...framework.section import upright_hairline
from ...framework.translated_items import TranslatedItems
from .film_player import FilmPlayer
from .step_list import WIDTH

if TYPE_CHECKING:
    from ....exhibits.films.step import FilmStep, TextFilm

_CLIP = re.compile(rb"<clipPath.*?</clipPath>", re.DOTALL)
_ROW_PX = 26
_EDGE_PX = 12


class SheetPicture(QWidget):
    """A sheet of paper with a step's picture, as large as there is room."""

    def __init__(self) -> None:
        super().__init__()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("Picture of the step")
        self._renderer = QSvgRenderer()

    def show_svg(self, data: bytes) -> None:
        """Show another picture; b"" = none."""
        plain = _CLIP.sub(b"", data)  # Qt's renderer knows no clip paths, and paints their shapes
        self._renderer = QSvgRenderer(QByteArray(plain)) if data else QSvgRenderer()
        self.update()

    @property
    def shows(self) -> bool:
        """Whether there is a picture."""
        return self._renderer.isValid()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the sheet in the middle."""
        painter = QPainter(self)
        if not self._renderer.isValid():
            return
        room = QRectF(self.rect()).adjusted(_EDGE_PX, _EDGE_PX, -_EDGE_PX, -_EDGE_PX)
        size = self._renderer.viewBoxF().size().scaled(room.size(), Qt.AspectRatioMode.KeepAspectRatio)
        sheet = QRectF(0, 0, size.width(), size.height())
        sheet.moveCenter(room.center())
        painter.fillRect(sheet, QColor("white"))
        self._renderer.render(painter, sheet)


class TextFilmView(QWidget):
    """Shows one film.

    Signals:
        shown(): another step is shown, or none.

    Attributes:
        film: what is shown; None = nothing. at: number of the step.
    """

    shown = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.film: TextFilm | None = None
        self.at = 0
        self.rail, self.picture, self.player = QListWidget(), SheetPicture(), FilmPlayer()
        self.rail.setObjectName("stageRail")
        self.rail.setFixedWidth(WIDTH)
        self.rail.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.rail.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.rail.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.rail.setAccessibleName("Steps of the text")
        self.rail.setItemDelegate(TranslatedItems(self.rail))
        line = upright_hairline()
        middle = v_box(spacing=0)
        middle.addWidget(self.picture, 1)
        middle.addWidget(self.player)
        row = h_box(self, spacing=0)
        row.addWidget(self.rail)
        row.addWidget(line)
        row.addLayout(middle, 1)
        self.setFocusProxy(self.picture)
        self.player.requested.connect(self.show_step)
        self.player.part_requested.connect(lambda way: self.show_step(self.at + way))
        self.rail.itemClicked.connect(lambda item: self.show_step(self.rail.row(item)))

    @property
    def step(self) -> FilmStep | None:
        """The step that is shown."""
        return self.film.steps[self.at] if self.film is not None else None

    @property
    def summary(self) -> str:
        """What there is to say about the film as a whole, or ""."""
        return f"{counted(len(self.film.steps), 'step')} on {self.film.source}" if self.film is not None else ""

    def show_film(self, film: TextFilm | None) -> None:
        """Show another film from its first step on, or none."""
        self.player.pause()
        self.film, self.at = film, 0
        self.rail.clear()
        for step in film.steps if film is not None else ():
            item = QListWidgetItem(f"{step.number}  {step.name}")
            item.setToolTip(item.text())
            item.setSizeHint(QSize(0, _ROW_PX))
            self.rail.addItem(item)
        if film is not None:
            self.show_step(0)
            return
        self.picture.show_svg(b"")
        self.player.show_place(0, 0)
        self.shown.emit()

    def show_step(self, at: int) -> None:
        """Show a step by its number; the first or the last one where there is none."""
        if self.film is None:
            return
        from ....formats.plot.page_svg import page_svg

        self.at = min(max(at, 0), len(self.film.steps) - 1)
        step = self.film.steps[self.at]
        self.picture.show_svg(page_svg(step.page, step.name))
        self.rail.setCurrentRow(self.at)
        self.player.show_place(self.at, len(self.film.steps))
        self.shown.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Space plays, arrows step, Home and End go to the ends."""
        if event.modifiers() or not self.player.takes_key(event.key()):
            super().keyPressEvent(event)
