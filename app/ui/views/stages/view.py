"""The Stages view: which of the five texts at its head, below its steps at the left, the display memory or a picture in
the middle, the player under it.
"""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent
from PySide6.QtWidgets import QStackedWidget, QWidget

from ....raster.code_words import WRONG, word
from ....raster.frame import BitmapFrame, Plane
from ....raster.trace import dashed
from ...framework.boxes import give_ground, h_box, v_box
from ...framework.fields import ChoiceField
from ...framework.figures import counted
from ...framework.section import upright_hairline
from ...framework.theme import LIGHT, Theme
from . import code_colours
from .film import Film, FilmFrame, Projector, chain_at
from .film_player import FilmPlayer
from .painting.code_key import CodeRow
from .painting.pixel_painter import PixelPaint
from .pixel_view import PixelView
from .step_list import StepList
from .text_film_view import TextFilmView

TEXTS = tuple((letter, letter) for letter in "ABCDE")
TIPS = {
    "A": "Tool paths from a line drawing",
    "B": "Seeing the cut before cutting",
    "C": "A compound surface, told apart by surface",
    "D": "A smooth curve from approximate points",
    "E": "A curve with a proven shape error",
}
HEAD_PX = 36


class StagesView(QWidget):
    """Shows one film, or the preview of a picture.

    Signals:
        shown(): another stage is shown, or none. hovered(words): what the pixel under the mouse is, or "".
        chain_picked(index): a chain of the stage was clicked; -1 = none of them.
        preview_clicked(x, y): a place of the preview was clicked, mm. theme_changed(Theme). text_chosen(letter): steps
            of this text are wished for.

    Attributes:
        films: what is shown of the texts B to E.
        film: what is shown, when no picture is; None = nothing. theme: in which it is painted.
    """

    shown = Signal()
    hovered = Signal(str)
    chain_picked = Signal(int)
    preview_clicked = Signal(float, float)
    theme_changed = Signal(Theme)
    text_chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.theme = LIGHT
        self.rail, self.pixels, self.player, self._line = StepList(), PixelView(), FilmPlayer(), upright_hairline()
        self.film: Film | None = None
        self._projector: Projector | None = None
        self._frame = BitmapFrame()
        self._preview: PixelPaint | None = None
        self.texts, self.films, self._stack = ChoiceField("Text", TEXTS, 60), TextFilmView(), QStackedWidget()
        self._head = QWidget()
        self.texts.show_value("A")
        self._lay_out()
        self.setFocusProxy(self.pixels)
        self.texts.chosen.connect(lambda letter: self.show_text(str(letter)))
        self.player.requested.connect(self.show_stage)
        self.player.part_requested.connect(self.go_part)
        self.rail.step_requested.connect(self.go_step)
        self.pixels.hovered.connect(self._tell_pixel)
        self.pixels.clicked.connect(self._click)

    def _lay_out(self) -> None:
        middle = v_box(spacing=0)
        middle.addWidget(self.pixels, 1)
        middle.addWidget(self.player)
        bitmap = QWidget()
        row = h_box(bitmap, spacing=0)
        row.addWidget(self.rail)
        row.addWidget(self._line)
        row.addLayout(middle, 1)
        for page in (bitmap, self.films):
            self._stack.addWidget(page)
        for letter, tip in TIPS.items():
            self.texts.buttons[letter].setToolTip(tip)
            self.texts.buttons[letter].setAccessibleName(tip)
        give_ground(self._head, "ncBar")
        self._head.setFixedHeight(HEAD_PX)
        head = h_box(self._head, (12, 0, 8, 0))
        head.addWidget(self.texts)
        column = v_box(self, spacing=0)
        column.addWidget(self._head)
        column.addWidget(self._stack, 1)

    @property
    def text(self) -> str:
        """Letter of the text whose steps are shown."""
        return str(self.texts.value)

    @property
    def picture(self) -> QWidget:
        """Where a step of the text is shown."""
        return self.pixels if self.text == "A" else self.films.picture

    def show_text(self, letter: str) -> None:
        """Show the steps of another text: of A the display memory."""
        self.texts.show_value(letter)
        self.player.pause()
        self._stack.setCurrentIndex(0 if letter == "A" else 1)
        self.setFocusProxy(self.picture)
        self.text_chosen.emit(letter)

    @property
    def at(self) -> int:
        """Number of the stage that is shown."""
        return self._projector.at if self._projector is not None else 0

    @property
    def still(self) -> FilmFrame | None:
        """The stage that is shown."""
        return self.film.stills[self.at] if self.film is not None else None

    @property
    def plane(self) -> Plane | None:
        """Its codes (rows, cols)."""
        return self._projector.plane if self._projector is not None else None

    @property
    def summary(self) -> str:
        """What there is to say about the film as a whole, or ""."""
        if self.text != "A":
            return self.films.summary
        return (
            f"{counted(len(self.film), 'stage')} of {counted(len(self.film.numbers), 'step')}"
            if self.film is not None
            else ""
        )

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self.theme = theme
        self._show_pixels()
        self.theme_changed.emit(theme)

    def show_film(self, film: Film | None, frame: BitmapFrame | None = None) -> None:
        """Show another film, or none: at the same stage when it has as many, else where the same step comes first."""
        at = _same_place(self.film, self.at, film)
        self.film, self._frame = film, frame or BitmapFrame()
        self._projector = Projector(film) if film is not None else None
        self.rail.show_steps(film.numbers if film is not None else ())
        if film is not None:
            self.show_stage(at)
            return
        self.player.show_place(0, 0)
        if self._preview is None:
            self.pixels.show_pixels(None)
            self.pixels.show_key(())
        self.shown.emit()

    def show_preview(self, preview: PixelPaint | None, key: tuple[CodeRow, ...] = ()) -> None:
        """Show a picture in the place of the stages, or these again."""
        self.player.pause()
        self._preview = preview
        if preview is not None and self.text != "A":
            self.show_text("A")
        for widget in (self._head, self.rail, self._line, self.player):
            widget.setVisible(preview is None)
        self.pixels.light(())
        self.pixels.show_rows(np.zeros((0, 8)))
        self.pixels.show_marks(())
        if preview is not None:
            self.pixels.show_pixels(preview)
            self.pixels.show_key(key)
        else:
            self.show_film(self.film, self._frame)

    def show_stage(self, at: int) -> None:
        """Show a stage, by its number."""
        if self.film is None or self._projector is None or self._preview is not None:
            return
        self._projector.show(at)
        still = self.film.stills[at]
        self.rail.show_place(still.number, frozenset(each.number for each in self.film.stills[:at]))
        self.player.show_place(at, len(self.film))
        self.pixels.light(())
        self.pixels.show_rows(still.rows)
        self._show_pixels()
        self.shown.emit()

    def go_step(self, number: int) -> None:
        """Go to the next time that a step is done."""
        self.player.pause()
        if self.film is not None:
            self.show_stage(self.film.seek_step(number, self.at))

    def go_part(self, way: int) -> None:
        """Go to another phase or region, onwards (+1) or back (-1)."""
        if self.film is not None:
            self.show_stage(self.film.seek_part(self.at, way))

    def light_chain(self, index: int) -> None:
        """Light up a chain of the stage; -1 = none."""
        chains = self.still.chains if self.still is not None else ()
        self.pixels.light(chains[index : index + 1] if index >= 0 else ())

    def zoom_by(self, factor: float) -> None:
        """Zoom at the middle."""
        self.pixels.zoom_by(factor)

    def fit(self) -> None:
        """Show the whole bitmap."""
        self.pixels.fit()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Space plays, arrows step, Page up and down go part by part, Home and End to the ends."""
        held = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier
        if event.modifiers() & held or not self.player.takes_key(event.key()):
            super().keyPressEvent(event)

    def _show_pixels(self) -> None:
        """Hand the stage's pixels to the picture: the memory itself, or a copy with what is wrong marked, or lines
        dashed.
        """
        still, plane = self.still, self.plane
        if still is None or plane is None or self.film is None or self._preview is not None:
            return
        wrong = still.wrong
        if wrong is not None and wrong.any():
            plane = plane.copy()
            plane[wrong] = WRONG
        if still.number == 140:
            plane = dashed(plane, self.film.chains_of(120))
        colours = code_colours.step_colours(self.theme, still.number)
        self.pixels.show_pixels(
            PixelPaint(
                self._frame, plane, code_colours.table(colours), code_colours.LETTERS, code_colours.rank_of_code()
            )
        )
        codes = [code for code in code_colours.ORDER if code in self.film.codes_near(self.at)]
        if wrong is not None and wrong.any():
            codes.append(WRONG)
        self.pixels.show_key(tuple(_row(code, still.number, colours) for code in codes))

    def _tell_pixel(self, row: int, col: int) -> None:
        still, pixels = self.still, self.pixels.pixels
        if still is None or pixels is None or row < 0 or self._preview is not None:
            self.hovered.emit(f"Column {col}, row {row}" if row >= 0 else "")
            return
        code = pixels.code(row, col)
        self.hovered.emit(f"Column {col}, row {row}: {code_colours.LETTERS[code]}, {word(code, still.number)}")

    def _click(self, row: int, col: int, x: float, y: float) -> None:
        still = self.still
        if self._preview is not None:
            self.preview_clicked.emit(x, y)
        elif still is not None and still.chains:
            index = chain_at(still.chains, row, col)
            self.light_chain(-1 if index is None else index)
            self.chain_picked.emit(-1 if index is None else index)


def _row(code: int, step: int, colours: dict[int, QColor]) -> CodeRow:
    return CodeRow(code, code_colours.LETTERS[code], word(code, step), colours[code])


def _same_place(before: Film | None, at: int, after: Film | None) -> int:
    """Return the stage of a film that is nearest to stage `at` of the one before."""
    if before is None or after is None:
        return 0
    return at if len(before) == len(after) else max(after.seek_step(before.stills[at].number, -1), 0)
