"""Six quiet steps round the window, each a few words beside the thing itself; the work goes on meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from ...framework.catalogue import tr
from ...framework.labels import muted
from ...framework.preferences import Preferences
from ...framework.section import heading
from ..bars.top_bar import TopBar

WIDTH, _GAP, _EDGE = 320, 10, 8
SEEN = "seen"


@dataclass(frozen=True)
class Landmarks:
    """What the tour shows; `views` is where its words stand when the thing itself is not to be seen."""

    views: QWidget
    tool_strip: QWidget
    command_line: QWidget
    badge: QWidget
    top_bar: TopBar


@dataclass(frozen=True)
class TourStep:
    """One step: what it is beside, a heading and one or two sentences."""

    at: Callable[[Landmarks], QWidget]
    title: str
    words: str


STEPS = (
    TourStep(
        lambda marks: marks.tool_strip,
        "Draw",
        "Take a tool and click. Points snap to ends, middles and centres; typed values stand beside the mouse.",
    ),
    TourStep(
        lambda marks: marks.command_line,
        "Type",
        "Every click is also a line of words, and every line draws: try  rect 0,0 60,40  and Enter.",
    ),
    TourStep(
        lambda marks: marks.top_bar.compute,
        "Compute",
        "F5 makes the tool paths from the drawing, the tools and the operations at the right.",
    ),
    TourStep(
        lambda marks: marks.badge,
        "Look",
        "The verdict: gouges, material left, strokes and time. A click lists the places, another goes there.",
    ),
    TourStep(
        lambda marks: marks.top_bar.tabs["view_cut"],
        "Cut",
        "The program, cut out of its stock. Drag turns it; a click on the metal marks the line that cut there.",
    ),
    TourStep(
        lambda marks: marks.top_bar.export,
        "Export",
        "What is written is read back and cut first; what is wrong with it is told before the file is kept.",
    ),
)


class Callout(QFrame):
    """The words of a step, and the way on."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("callout")
        self.setFixedWidth(WIDTH)
        self.title, self.words, self.count = heading(""), QLabel(), muted()
        self.words.setWordWrap(True)
        self.skip, self.back, self.next = QPushButton(), QPushButton(), QPushButton()
        self.next.setProperty("role", "primary")
        column, head, row = QVBoxLayout(self), QHBoxLayout(), QHBoxLayout()
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(8)
        head.addWidget(self.title, 1)
        head.addWidget(self.count)
        row.setSpacing(8)
        row.addWidget(self.skip)
        row.addStretch(1)
        row.addWidget(self.back)
        row.addWidget(self.next)
        column.addLayout(head)
        column.addWidget(self.words)
        column.addLayout(row)
        self.hide()

    def say(self, step: TourStep, number: int) -> None:
        """Show a step by its number, from 0."""
        last = number == len(STEPS) - 1
        self.title.setText(tr(step.title))
        self.words.setText(tr(step.words))
        self.count.setText(tr(f"{number + 1} of {len(STEPS)}"))
        self.skip.setText(tr("Skip"))
        self.skip.setVisible(not last)
        self.back.setText(tr("Back"))
        self.back.setEnabled(number > 0)
        self.next.setText(tr("Done") if last else tr("Next"))
        self.words.setMinimumHeight(self.words.heightForWidth(WIDTH - 34))
        self.adjustSize()


class Tour(QObject):
    """Help, Tour: leads round the window; once it was gone through or skipped, nothing offers it again.

    Signals:
        left(): it is over.
    """

    left = Signal()

    def __init__(self, root: QWidget, marks: Landmarks, preferences: Preferences) -> None:
        """Make one that leads round `root`."""
        super().__init__(root)
        self._root, self.marks, self._preferences, self.number = root, marks, preferences, 0
        self.callout, self._ring = Callout(root), QFrame(root)
        self._ring.setObjectName("ring")
        self._ring.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._ring.hide()
        self.callout.next.clicked.connect(lambda: self.go(self.number + 1))
        self.callout.back.clicked.connect(lambda: self.go(self.number - 1))
        self.callout.skip.clicked.connect(self.end)
        for watched in (root, self.callout.next, self.callout.back, self.callout.skip):
            watched.installEventFilter(self)

    def start(self) -> None:
        """Begin at the first step."""
        self.callout.show()
        self.go(0)
        self.callout.next.setFocus()

    def go(self, number: int) -> None:
        """Show a step; after the last one the tour ends."""
        if number >= len(STEPS):
            self.end()
            return
        self.number = max(number, 0)
        self.callout.say(STEPS[self.number], self.number)
        self._place()
        if not self.callout.back.isEnabled():
            self.callout.next.setFocus()

    def end(self) -> None:
        """Leave the tour, and never offer it again."""
        self.callout.hide()
        self._ring.hide()
        self._preferences.keep(replace(self._preferences.settings, tour=SEEN))
        self.left.emit()

    def _place(self) -> None:
        """Put ring and words at the thing; where it is not shown, the words stand over the view."""
        target, whole = STEPS[self.number].at(self.marks), self._root.rect().adjusted(_EDGE, _EDGE, -_EDGE, -_EDGE)
        shown = target.isVisible()
        around = self._rectangle(target if shown else self.marks.views)
        self._ring.setGeometry(around.adjusted(-2, -2, 2, 2))
        self._ring.setVisible(shown)
        self.callout.move(
            _beside(around, self.callout.size().width(), self.callout.height(), whole)
            if shown
            else around.center() - self.callout.rect().center()
        )
        self._ring.raise_()
        self.callout.raise_()

    def _rectangle(self, widget: QWidget) -> QRect:
        return QRect(widget.mapTo(self._root, QPoint()), widget.size())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Follow the window's size; Escape skips, Left and Right step, Enter presses the button that has the keys."""
        if not self.callout.isVisible():
            return False
        if watched is self._root:
            if event.type() in (QEvent.Type.Resize, QEvent.Type.LayoutRequest):
                self._place()
            return False
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and isinstance(watched, QPushButton):
                watched.click()
                return True
            return self._key(event.key())
        return False

    def _key(self, key: int) -> bool:
        """Act on a key; False = it is none of the tour's."""
        steps = {Qt.Key.Key_Right: 1, Qt.Key.Key_Left: -1}
        if key == Qt.Key.Key_Escape:
            self.end()
        elif key in steps:
            self.go(self.number + steps[Qt.Key(key)])
        else:
            return False
        return True


def _beside(around: QRect, width: int, height: int, whole: QRect) -> QPoint:
    """Return where words of a size stand beside a rectangle: at its right, else under it, else over it; always within
    the whole.
    """
    if around.height() > around.width() and around.right() + _GAP + width <= whole.right():
        place = QPoint(around.right() + _GAP, around.top() + 5 * _GAP)
    elif around.bottom() + _GAP + height <= whole.bottom():
        place = QPoint(around.left(), around.bottom() + _GAP)
    else:
        place = QPoint(around.left() + _GAP, around.top() - _GAP - height)
    return QPoint(
        min(max(place.x(), whole.left()), whole.right() - width),
        min(max(place.y(), whole.top()), whole.bottom() - height),
    )
