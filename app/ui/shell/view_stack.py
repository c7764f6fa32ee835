"""The middle of the window: the canvas, Stages as pixels, Cut in space, Curves, Surfaces, NC as text; or what is
missing.
"""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QRect, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QLabel, QPushButton, QStackedWidget, QWidget

from ..framework.boxes import v_box
from ..framework.catalogue import tr
from ..framework.fade import Fade
from ..framework.labels import show_words
from ..framework.themed import Themed
from ..framework.view import View, ViewPage, Zoomable
from ..views.canvas.canvas import Canvas
from ..views.canvas.legend import Legend
from ..views.canvas.modes import CanvasMode
from ..views.curves.view import CurvesView
from ..views.cut.page import CutPage
from ..views.cut.view import CutView
from ..views.nc.view import NcView
from ..views.plot.preview import PlotPreview
from ..views.stages.view import StagesView
from ..views.surfaces.view import SurfacesView
from .start_page.page import StartPage

_RULER_PX, _MARGIN_PX, _SIDE_PX = 24, 16, 24
_MOST_PX = 1 << 14
"""More than any screen has."""
_LONG_MS = 30.0


class EmptyState(Themed, QWidget):
    """One sentence that says what is missing, and the button that makes it.

    Signals:
        pressed(): the button was. resized(): the words want another size.

    Attributes:
        on_paper: the view behind it has the panels' ground, not the canvas'.
    """

    pressed, resized = Signal(), Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.on_paper = False
        self.sentence, self.button = QLabel(), QPushButton()
        self.sentence.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.button.clicked.connect(self.pressed)
        self.button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        column = v_box(self, (_SIDE_PX, 16, _SIDE_PX, 16), 12)
        column.addWidget(self.sentence)
        column.addWidget(self.button, 0, Qt.AlignmentFlag.AlignHCenter)
        self.hide()

    def say(self, sentence: str, button: str) -> None:
        """Show a sentence and a button."""
        self.sentence.setText(sentence)
        show_words(self.button, button)
        self.adjustSize()
        self.show()

    def fit_into(self, width: int) -> None:
        """Break the sentence into lines where it is too long for so many px."""
        words, room = tr(self.sentence.text()), max(width - 2 * _SIDE_PX, 1)
        metrics = self.sentence.fontMetrics()
        broken = metrics.horizontalAdvance(words) > room
        self.sentence.setWordWrap(broken)
        if broken:
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            high = metrics.boundingRect(QRect(0, 0, room, _MOST_PX), int(flags), words).height()
            self.sentence.setFixedSize(room, high)
        else:
            self.sentence.setMinimumSize(0, 0)
            self.sentence.setMaximumSize(_MOST_PX, _MOST_PX)
        self.adjustSize()

    def event(self, event: QEvent) -> bool:
        """Stay as large as the words: they are looked up in another language when painted."""
        handled = super().event(event)
        if event.type() == QEvent.Type.LayoutRequest and self.size() != self.sizeHint():
            self.adjustSize()
            self.resized.emit()
        return handled

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the view's ground, so that the grid does not run through the words."""
        ground = QColor(self._theme.paper if self.on_paper else self._theme.canvas)
        ground.setAlphaF(0.92)
        QPainter(self).fillRect(self.rect(), ground)


class ViewStack(QStackedWidget):
    """Canvas, stages, cut, curves, surfaces and NC text, with legend and empty state laid over them."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__()
        self.canvas, self.stages, self.cut, self.curves, self.nc = (
            canvas,
            StagesView(),
            CutView(),
            CurvesView(),
            NcView(),
        )
        self.surfaces, self.cut_page = SurfacesView(), CutPage(self.cut)
        self._pages: dict[View, ViewPage] = {}
        self.view, self.plot, self.start = View.DRAW, PlotPreview(), StartPage()
        for widget in (canvas, self.stages, self.cut_page, self.curves, self.surfaces, self.nc, self.plot, self.start):
            self.addWidget(widget)
        self.legend, self.empty, self.fade = Legend(self), EmptyState(self), Fade(self)
        self.legend.hide()
        self.empty.resized.connect(self._place_empty)
        self.installEventFilter(self)

    def take_pages(self, pages: dict[View, ViewPage]) -> None:
        """Show these pages from now on."""
        self._pages = pages
        for page in pages.values():
            if self.indexOf(page.widget) < 0:
                self.addWidget(page.widget)

    def show_view(self, view: View) -> None:
        """Bring a view to the front; zoom and selection stay. The one before fades, unless painting it would take
        long.
        """
        if view is not self.view and self.isVisible() and self.canvas.scene_ms < _LONG_MS:
            self.fade.hide()
            self.fade.begin(self.grab())
        self.view = view
        widget = self._pages[view].widget
        self.setCurrentWidget(widget)
        if widget is self.canvas:
            self.canvas.set_mode(CanvasMode.PATHS if view is View.PATHS else CanvasMode.DRAW)
        else:
            self.take_focus()

    def show_plot(self) -> None:
        """Bring the sheets of paper to the front, until a view is shown again."""
        self.setCurrentWidget(self.plot)
        self.take_focus()

    def show_start(self) -> None:
        """Bring the page that the window begins with to the front, until a view is shown."""
        self.setCurrentWidget(self.start)
        self.start.setFocus()

    @property
    def starting(self) -> bool:
        """Whether the page that the window begins with is in front of the view."""
        return self.currentWidget() is self.start

    @property
    def covered(self) -> bool:
        """Whether the view is behind something else."""
        return self.plotting or self.starting

    @property
    def plotting(self) -> bool:
        """Whether sheets of paper are in front of the view."""
        return self.currentWidget() is self.plot

    def take_focus(self) -> None:
        """Have the keys go to what is at the front."""
        over = self.plot if self.plotting else self.start if self.starting else None
        (over or self._pages[self.view].widget).setFocus()

    @property
    def viewport(self) -> Zoomable:
        """What zooms and fits at the front."""
        return self.plot if self.plotting else self._pages[self.view].viewport

    def show_missing(self, sentence: str, button: str, shows_paths: bool) -> None:
        """Say what is missing in the view, or nothing when `sentence` is empty.

        Args:
            sentence, button: of the empty state.
            shows_paths: there are paths, so the legend belongs beside them.
        """
        self.empty.setVisible(bool(sentence) and not self.covered)
        if sentence and not self.covered:
            self.empty.say(sentence, button)
            self.empty.raise_()
        self.legend.setVisible(self.view is View.PATHS and shows_paths and not self.covered)
        self.legend.raise_()
        self.fade.raise_()
        self.place()
        if self.currentWidget() is self.canvas:
            beside = self.legend if not self.legend.isHidden() else self.empty if self._beside_drawing else None
            self.canvas.cover_right(beside.width() + _MARGIN_PX if beside is not None else 0.0)

    @property
    def _beside_drawing(self) -> bool:
        """Whether the empty state has a drawing behind it, which it must not hide: it stands where the legend will."""
        return self.currentWidget() is self.canvas and not self.empty.isHidden() and self.canvas.picture.box is not None

    def place(self) -> None:
        """Put the overlays where they belong."""
        self.legend.adjustSize()
        self.legend.fit_into(QSize(self.width(), self.height() - _RULER_PX - _MARGIN_PX))
        self.legend.move(self.width() - self.legend.width() - _MARGIN_PX, _RULER_PX + 12)
        self.fade.resize(self.size())
        self._place_empty()

    def _place_empty(self) -> None:
        """Put what is missing into the middle of the view, or beside the drawing."""
        self.empty.on_paper = self.view is View.STAGES
        behind = self.stages.picture if self.empty.on_paper else self
        self.empty.fit_into(behind.width() - 2 * _MARGIN_PX)
        if self._beside_drawing:
            self.empty.move(max(self.width() - self.empty.width() - _MARGIN_PX, 0), _RULER_PX + 12)
            return
        middle = behind.mapTo(self, behind.rect().center()) - self.empty.rect().center()
        self.empty.move(max(middle.x(), 0), max(middle.y(), 0))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Keep the overlays in place when the size changes."""
        if event.type() == QEvent.Type.Resize:
            self.place()
        return super().eventFilter(watched, event)
