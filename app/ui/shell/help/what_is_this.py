"""What is this? A question mark at the mouse: the thing that is clicked says what it is for, and opens the manual where
it is told.
"""

from __future__ import annotations

from html import escape

from PySide6.QtCore import QEvent, QObject, QTimer
from PySide6.QtGui import QWhatsThisClickedEvent
from PySide6.QtWidgets import QAbstractButton, QApplication, QLabel, QMenuBar, QToolButton, QWhatsThis, QWidget

from ....drafting.language.language import command_word
from ...framework.catalogue import tr
from ...panels.drawing_page import DrawingPage
from ...panels.reading_section import ReadingSection
from ...panels.side_panel import SidePanel
from ...panels.side_tabs import SideTabs
from ...views.canvas.canvas import Canvas
from ...views.curves.panel import CurvesPanel
from ...views.curves.view import CurvesView
from ...views.cut.panel import CutPanel
from ...views.cut.transport import Transport
from ...views.cut.view import CutView
from ...views.language.page import TextPage
from ...views.nc.view import NcView
from ...views.stages.view import StagesView
from ...views.surfaces.panel import ScenePanel
from ...views.surfaces.points_page import PointsPage
from ...views.surfaces.scene_tabs import SceneTabs
from ...views.surfaces.scene_text import SceneText
from ...views.surfaces.view import SurfacesView
from ..bars.command_line import CommandLine
from ..bars.question_card import QuestionCard
from ..bars.status_bar import StatusBar
from ..bars.tool_strip import ToolStrip
from .help_window import HelpWindow
from .tour import Callout

LANGUAGE = "language"
LISTENING_MS = 60_000
"""So long after the question a link in its answer opens the manual: nobody listens to every event for ever."""

PLACES: dict[type[QWidget], tuple[str, str]] = {
    Canvas: (
        "The drawing, or the tool paths. The wheel zooms at the mouse, the middle button moves, F fits. Tools ask "
        "below what they need; points can be clicked or typed.",
        LANGUAGE,
    ),
    ToolStrip: (
        "Tools that draw, change and measure. Choose one, then follow the line at the bottom; Esc leaves it, Enter "
        "repeats it.",
        LANGUAGE,
    ),
    SideTabs: (
        "Job: tools and operations. Drawing: properties, layers, clean-up and history. Text: the drawing in words.",
        "",
    ),
    SidePanel: ("What is machined with which tool, how deep and how fast. F5 computes the paths anew.", ""),
    DrawingPage: (
        "Numbers of what is selected, to be changed; layers; what is wrong with the drawing; everything that was done.",
        LANGUAGE,
    ),
    ReadingSection: (
        "How the drawing was read from its file. A change reads it again, as one step that can be undone; a project "
        "keeps it.",
        "",
    ),
    QuestionCard: (
        "What the file of a drawing leaves open. Choose how it is read; behind each answer stands what comes of it.",
        "",
    ),
    TextPage: (
        "The drawing as a text. What it would draw is shown while it is written; Ctrl+Enter draws it.",
        LANGUAGE,
    ),
    CommandLine: (
        "Type what a tool asks for, or a whole line such as circle 10,10 5. Above it is everything that was done, in "
        "the same words.",
        LANGUAGE,
    ),
    StatusBar: ("Where the mouse is, what it snaps to, and whether the paths are those of the drawing.", ""),
    StagesView: ("The way of 1986, step by step, as the display memory held it.", ""),
    CutView: (
        "What the program leaves of the stock: gouges red, metal left blue. Drag to turn, click to be told depth and "
        "line.",
        "",
    ),
    CutPanel: ("What was cut, with which tools, and what was found.", ""),
    CurvesView: (
        "The program's moves, and the proven curves in their stead. Below: how far they are apart; click there to see "
        "the place.",
        "",
    ),
    Transport: (
        "The cut along time: play it forward and backward, step to lines, tools and findings, or click the plot to go "
        "there.",
        "",
    ),
    CurvesPanel: ("How near curves must keep to the moves, and the certificate of what was written.", ""),
    SurfacesView: (
        "A scene's surfaces and the paths over them, each surface in its own colour; Section shows one cutting plane.",
        "scene",
    ),
    ScenePanel: (
        "What the scene is made of. Choose a line to see and change its numbers; it is computed at once.",
        "scene",
    ),
    SceneText: (
        "The scene as a text, as it is saved. What is wrong is marked; what is right is computed while it is written.",
        "scene",
    ),
    PointsPage: ("Where the topmost surface changes, plane by plane. A click shows the place.", "scene"),
    SceneTabs: (
        "Scene: surfaces, passes, tools and stock. Text: the same in words. Points: where surfaces meet.",
        "scene",
    ),
    NcView: ("The NC program as text and as path. A click on either shows the place in the other.", "posts"),
    QMenuBar: ("Everything that the program can do, with its keys. Ctrl+Shift+Space finds all of it by name.", ""),
    Callout: ("A tour of the window in six steps.", ""),
}
"""What the large parts of the window are for, and the page of the manual that tells more, or ""."""


class WhatIsThis(QObject):
    """Answers clicks after Shift+F1; built once for a window."""

    def __init__(self, root: QWidget, manual: HelpWindow) -> None:
        """Make one that explains what belongs to `root`."""
        super().__init__(root)
        self._root, self._help = root, manual
        self._own: set[QWidget] = set()
        self._listening = QTimer(self)
        self._listening.setSingleShot(True)
        self._listening.setInterval(LISTENING_MS)
        self._listening.timeout.connect(self._leave)

    def ask(self) -> None:
        """Wait for a click with the question mark."""
        self.explain()
        if (application := QApplication.instance()) is not None:
            application.installEventFilter(self)  # links in explanations are told to the program alone
        self._listening.start()
        QWhatsThis.enterWhatsThisMode()

    def _leave(self) -> None:
        if (application := QApplication.instance()) is not None:
            application.removeEventFilter(self)

    def explain(self) -> None:
        """Give every part of the window its explanation, in the words that it shows now."""
        for widget in (self._root, *self._root.findChildren(QWidget)):
            if not widget.whatsThis() or widget in self._own:
                self._own.add(widget)
                widget.setWhatsThis(explanation(widget))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """A link in an explanation opens the manual."""
        if isinstance(event, QWhatsThisClickedEvent):
            page, _, word = event.href().partition(":")
            QWhatsThis.hideText()
            if word:
                self._help.show_word(word)
            else:
                self._help.show_page(page)
            return True
        return super().eventFilter(watched, event)


def explanation(widget: QWidget) -> str:
    """Return what a widget is for, as rich text; "" where the one that holds it tells."""
    if type(widget) in PLACES:
        text, page = PLACES[type(widget)]
        return f"<p>{escape(tr(text))}</p>{_link(page)}"
    name = widget.accessibleName() or (widget.text() if isinstance(widget, QAbstractButton | QLabel) else "")
    tip = widget.toolTip()
    if not name and not tip:
        return ""
    head = f"<p><b>{escape(name)}</b></p>" if name and name != tip else ""
    return f"{head}<p>{escape(tip)}</p>{_link(_page_of(widget))}" if tip else head


def _page_of(widget: QWidget) -> str:
    """Return where the manual tells of a tool."""
    action = widget.defaultAction() if isinstance(widget, QToolButton) else None
    if action is None:
        return ""
    word = command_word(action.objectName().removeprefix("tool_").partition("_")[0])
    return f"{LANGUAGE}:{word}" if word and action.objectName().startswith("tool_") else ""


def _link(page: str) -> str:
    return f'<p><a href="{page}">{escape(tr("More in the manual"))}</a></p>' if page else ""
