"""The window: puts the parts together. What they do is connected in `wiring.py`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QGuiApplication, QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QHBoxLayout, QLabel, QLayout, QMainWindow, QWidget

from ...core.settings import Settings, ThemeChoice
from ...drafting.document import Document
from ...formats.readers import suffixes
from ...formats.tools.at_path import tool_suffixes
from ...usecases.pixels.options import PICTURES
from ...usecases.scene.solid_files import SOLIDS
from ..framework import style
from ..framework.activity import Activity
from ..framework.arrow import arrow_picture
from ..framework.boxes import v_box
from ..framework.computation import Computation
from ..framework.file_dialogs import dress_file_dialog
from ..framework.log import Log
from ..framework.notice import Notice
from ..framework.preferences import Preferences
from ..framework.section import upright_hairline
from ..framework.theme import DARK, LIGHT, Theme
from ..framework.typed_text import is_typed
from ..framework.view import View, ViewPage
from ..framework.worker import Worker
from ..framework.workspace import Workspace
from ..panels.drawing_page import DrawingPage
from ..panels.side_panel import SidePanel
from ..panels.side_tabs import SideTabs
from ..views.canvas.canvas import Canvas
from ..views.canvas.painting.program_layer import ProgramLayer
from ..views.curves.panel import CurvesPanel
from ..views.cut.panel import CutPanel
from ..views.cut.setup_form import SetupForm
from ..views.nc.program_reader import SUFFIXES as PROGRAM_SUFFIXES
from ..views.plot.panel import PlotPanel
from ..views.stages.import_panel import ImportPanel
from ..views.stages.panel import StagesPanel
from ..views.stages.text_film_panel import TextFilmPanel
from ..views.surfaces.scene_document import SceneDocument
from ..views.surfaces.scene_tabs import SceneTabs
from .bars.actions import Actions
from .bars.badge import FindingsList
from .bars.command_line import CommandLine
from .bars.question_card import QuestionCard
from .bars.status_bar import StatusBar
from .bars.tool_strip import ToolStrip
from .bars.top_bar import TopBar
from .view_stack import ViewStack
from .window_geometry import remember_geometry

if TYPE_CHECKING:
    from ...usecases.making.make import MakeResult

SIZE = (1440, 900)


def picture_of(made: MakeResult) -> ProgramLayer:
    """Return the moves of a result prepared for painting."""
    return ProgramLayer(made.program, made.coverage.places, operations=made.job.operations)


def opened_suffixes() -> tuple[str, ...]:
    """Return what the names of files end with that the window opens: drawings, solids, scenes, jobs, pictures, tools
    and NC programs.
    """
    return tuple(dict.fromkeys((*suffixes(), ".toml", *SOLIDS, *PICTURES, *tool_suffixes(), *PROGRAM_SUFFIXES)))


class MainWindow(QMainWindow):
    """Menu, bars, views, panel, log, command line, status; `set_theme_choice` gives it its looks when all is there.

    Signals:
        dropped(path): a file was dropped on the window.
        key_typed(text): a character that nothing which has the keyboard wants.
        closing(): about to close; `may_close` tells whether it may.
    """

    dropped = Signal(str)
    key_typed = Signal(str)
    closing = Signal()

    def __init__(self, document: Document, settings: Settings) -> None:
        theme = self._theme_for(settings.theme)
        if isinstance(application := QApplication.instance(), QApplication):
            style.prepare(application, theme)  # a window that there is already would keep the system's font
        super().__init__()
        self.theme = theme
        self.document, self.preferences = document, Preferences(settings, self)
        self.preferences.saving.connect(lambda: remember_geometry(self, self.preferences))
        self.may_close = True
        self.worker = Worker(self)
        self.activity = Activity(self)
        self.activity.follow(self.worker)
        self.computation = Computation(document, self.worker, picture_of)
        self.actions_ = Actions(self)
        self.canvas = Canvas(document, self.theme)
        self.views, self.panel, self.cut_panel = ViewStack(self.canvas), SidePanel(document), CutPanel()
        self.side = SideTabs()
        self.side.add_page("Job", self.panel, "stock, tools and operations")
        self.drawing_page = DrawingPage(document, lambda: self.canvas.picture.lookup.box)
        self.side.add_page("Drawing", self.drawing_page, "properties, layers and history of what is drawn")
        self.cut_form, self.curves_panel = SetupForm(), CurvesPanel()
        self.stages_panel, self.import_panel, self.plot_panel = StagesPanel(), ImportPanel(), PlotPanel()
        self.film_panel = TextFilmPanel()
        self.scene = SceneDocument(self)
        self.scene_side = SceneTabs(self.scene)
        self.sides: list[QWidget] = [
            self.side,
            self.import_panel,
            self.stages_panel,
            self.film_panel,
            self.cut_panel,
            self.cut_form,
            self.curves_panel,
            self.scene_side,
            self.plot_panel,
            self.views.nc.beside,
        ]
        self.side_line = upright_hairline()
        self.notice, self.card, self.command_line, self.status = (
            Notice(),
            QuestionCard(self.canvas),
            CommandLine(),
            StatusBar(),
        )
        self.top_bar, self.tool_strip = TopBar(self.actions_), ToolStrip(self.actions_)
        self.findings_list = FindingsList(self)
        self.file_label = QLabel()
        self.workspace = Workspace(
            document,
            self.computation,
            self.activity,
            self.preferences,
            Log(document, self.command_line.log),
            self.notice,
        )
        self._lay_out()
        QGuiApplication.styleHints().colorSchemeChanged.connect(
            lambda _: self.set_theme_choice(self.preferences.settings.theme)
        )

    def _lay_out(self) -> None:
        self.actions_.fill(self.menuBar())
        self.file_label.setProperty("role", "muted")
        self.file_label.setContentsMargins(0, 6, 16, 0)
        self.menuBar().setCornerWidget(self.file_label)
        centre = v_box(spacing=0)
        centre.addWidget(self.notice)
        centre.addWidget(self.card)
        centre.addWidget(self.views, 1)
        middle = self._middle = QHBoxLayout()
        middle.setSpacing(0)
        middle.addWidget(self.tool_strip)
        middle.addLayout(centre, 1)
        middle.addWidget(self.side_line)
        middle.addWidget(self.side)
        for widget in self.sides[1:]:
            self._middle.addWidget(widget)
            widget.hide()
        root = QWidget()
        root.setObjectName("root")
        column = v_box(root, spacing=0)
        column.addWidget(self.top_bar)
        column.addLayout(middle, 1)
        column.addWidget(self.command_line)
        column.addWidget(self.status)
        self.setCentralWidget(root)
        self.setAcceptDrops(True)
        self.setMinimumSize(860, 520)
        self.resize(*SIZE)
        self.canvas.setFocus()

    def take_pages(self, pages: dict[View, ViewPage]) -> None:
        """Show the pages of the views, and lay out what those that are new put beside themselves."""
        self.views.take_pages(pages)
        for page in pages.values():
            side = page.side() if page.side() not in self.sides else None
            if side is not None:
                self.sides.append(side)
                self._middle.addWidget(side)
                side.hide()

    def lay_out_now(self) -> None:
        """Give every part its place at once, so that what is fitted into it fits."""
        for layout in self.findChildren(QLayout):
            layout.activate()

    def _theme_for(self, choice: ThemeChoice) -> Theme:
        if choice is ThemeChoice.SYSTEM:
            return DARK if QGuiApplication.styleHints().colorScheme() == Qt.ColorScheme.Dark else LIGHT
        return DARK if choice is ThemeChoice.DARK else LIGHT

    def _apply_style(self) -> None:
        application = QApplication.instance()
        if isinstance(application, QApplication):
            style.apply(application, self.theme, arrow_picture(self.theme))

    def choose_theme(self, choice: ThemeChoice) -> None:
        """Switch colours and remember it."""
        self.set_theme_choice(choice)
        self.preferences.keep(replace(self.preferences.settings, theme=choice))

    def set_theme_choice(self, choice: ThemeChoice) -> None:
        """Paint everything in the theme that the user or the system chose."""
        self.theme = self._theme_for(choice)
        self._apply_style()
        self.actions_.set_theme(self.theme)
        for widget in self.findChildren(QWidget):
            if hasattr(widget, "set_theme"):
                widget.set_theme(self.theme)
        self.actions_[f"theme_{choice.value}"].setChecked(True)

    def event(self, event: QEvent) -> bool:
        """Dress the file dialog that opens now, whoever opens it: it waits over this window."""
        if event.type() == QEvent.Type.WindowBlocked:
            dialog = QApplication.activeModalWidget()
            if isinstance(dialog, QFileDialog):
                dress_file_dialog(dialog, self.theme)
        return super().event(event)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Let what is beside the view have its share of a wide window."""
        super().resizeEvent(event)
        self.cut_panel.fit_beside(event.size().width())

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Pass on what was typed where nobody wants it, so that it is not lost."""
        if is_typed(event):
            self.key_typed.emit(event.text())
        else:
            super().keyPressEvent(event)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:  # noqa: N802 (Qt's name)
        """Welcome one file; of a kind that cannot be opened it is said which can."""
        urls = event.mimeData().urls()
        if len(urls) == 1 and urls[0].isLocalFile():
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802 (Qt's name)
        """Open the file that was dropped."""
        event.acceptProposedAction()
        self.dropped.emit(event.mimeData().urls()[0].toLocalFile())

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802 (Qt's name)
        """Ask before changes are lost; leave the running job."""
        self.closing.emit()
        if not self.may_close:
            event.ignore()
            return
        self.activity.ended.emit()
        event.accept()
