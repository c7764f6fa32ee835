"""A word at each area of the drawing that says what it is to become; a press changes it, or leaves it standing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPainterPath, QPaintEvent
from PySide6.QtWidgets import QMenu, QToolButton

from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....geometry.sample import bounds_of_all
from ....model.curves import Curve
from ....model.fields import parameters_of
from ....model.job import Copies, Job
from ....model.operation import Operation
from ....model.part import Contour
from ...framework.display_unit import display_unit_name, display_unit_size
from ...framework.figures import TIMES, counted
from ...framework.samples import PathLineKind, sample_of, sample_pen
from ...framework.themed import Themed
from ...framework.worker import Worker
from ...framework.workspace import Workspace
from ...panels.changes import Subject, SubjectKind, operation_name
from ...panels.side_panel import SidePanel
from ...views.canvas.canvas import Canvas
from ...views.canvas.modes import CanvasMode
from ...views.canvas.painting.curve_path import chain_path, curve_path
from ...views.canvas.painting.purpose_layer import PurposeShape
from .contour_store import ContourStore
from .proposal_controller import ProposalController
from .word_places import WordPlaces

if TYPE_CHECKING:
    from ....toolpath.drawn_contours import DrawnContours
    from ....usecases.proposal.purpose_areas import PurposeArea

INSTEAD = {
    "pocket": "Pocket",
    "outside": "Contour outside",
    "inside": "Contour inside",
    "on": "Contour on line",
    "drill": "Drill",
    "engrave": "Engrave",
    "vcarve": "V-carve",
}
"""What an area may become instead, by the commands' names."""

_MOST_CURVES = 5000
"""A drawing of more is not looked through for words."""

_MOST_WORDS = 24
_DOT_PX, _DOT_RADIUS_PX = 10.0, 3.5
"""Where the dot's middle is, from the left; the style sheet leaves room for it."""


@dataclass(frozen=True, eq=False)
class PlacedArea:
    """An area with what is seen of it: its shape, and its word at a box in mm: of many places, of the first."""

    area: PurposeArea
    shape: PurposeShape
    operation: Operation
    through: bool
    box: QRectF

    @property
    def word(self) -> str:
        """What it is to become: how many of it, how deep in the unit that is shown, held by what."""
        name, cut = operation_name(self.operation), self.operation.cut
        many = f"{self.area.places} {TIMES} {name}" if self.area.places > 1 else name
        deep = "through" if self.through else f"{cut.depth / display_unit_size():.4g} {display_unit_name('mm')}"
        return " · ".join([many, deep, *_tabs_of(self.operation)])


def _tabs_of(operation: Operation) -> list[str]:
    """Return in a few words how what an operation cuts out is held, if it is."""
    known = parameters_of(type(operation))
    count = known["tabs"].of(operation) or len(known["tab_places"].of(operation)) if "tabs" in known else 0
    return [counted(count, "tab")] if count else []


@dataclass(frozen=True, eq=False)
class FoundAreas:
    """The areas of a job's drawing.

    Attributes:
        job: whose they are. drawn: its contours. areas: as they are listed.
        refused: what each cannot become, by the commands' names. boxes: (4, n) x0, y0, x1, y1 of all contours, mm.
    """

    job: Job
    drawn: DrawnContours
    areas: tuple[PlacedArea, ...]
    refused: tuple[frozenset[str], ...]
    boxes: NDArray[np.float64]


def found_areas(job: Job, contours: ContourStore, progress: Progress) -> FoundAreas:
    """Return what the curves of a job's drawing are to become, and what they cannot.

    Args:
        job: its drawing and operations. contours: of the drawing.
        progress: to be cancelled by.
    """
    from ....usecases.proposal.chosen_curves import refusals
    from ....usecases.proposal.purpose_areas import purpose_areas

    progress.step(0.0)
    job, drawn = replace(job, copies=Copies()), contours.of(job)
    progress.step(0.5)
    areas = purpose_areas(job, drawn)
    refused = [frozenset(way.name.lower() for way in refusals(drawn, area.numbers)) for area in areas]
    curves = {each.id: each.curve for each in job.part.entities}
    placed = tuple(_placed(job, curves, area) for area in areas)
    return FoundAreas(job, drawn, placed, tuple(refused), _boxes((*drawn.closed, *drawn.open)))


def _boxes(contours: Sequence[Contour]) -> NDArray[np.float64]:
    boxes = np.array([bounds_of_all(each.primitives) for each in contours], float).reshape(-1, 4)
    return np.ascontiguousarray(boxes.T)


def _placed(job: Job, curves: dict[int, Curve], area: PurposeArea) -> PlacedArea:
    operation = job.operations[area.index]
    filled = not operation.FOLLOWS_WALLS and all(each.closed for each in area.contours)
    path = QPainterPath()
    if filled:
        for contour in area.contours:
            chain_path(contour.primitives, path)
    else:
        path = curve_path(*(curves[number] for number in sorted(area.numbers) if number in curves))
    through = operation.cut.depth >= job.stock.thickness
    first = area.contours[0].primitives if area.places > 1 else ()
    box = (curve_path(*first) if first else path).boundingRect()
    return PlacedArea(area, PurposeShape(path, sample_of(operation), filled), operation, through, box)


class PurposeWord(Themed, QToolButton):
    """A word at an area, behind a dot in the colour of its operation's paths."""

    def __init__(self, canvas: Canvas, kind: PathLineKind) -> None:
        super().__init__(canvas)
        self._kind, self._theme = kind, canvas.theme
        self.setProperty("role", "word")
        self.setCursor(Qt.CursorShape.ArrowCursor)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setToolTip("What this becomes; press to change it, or to leave it standing")

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the dot where the style leaves room for it."""
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(sample_pen(self._kind, self._theme).color())
        painter.drawEllipse(QPointF(_DOT_PX, self.height() / 2), _DOT_RADIUS_PX, _DOT_RADIUS_PX)


class PurposeWords(QObject):
    """Follows the job; shows areas and words over the drawing while no tool is in hand.

    Attributes:
        words: the buttons, by the areas' order. menu: the one opened last, or None.
    """

    def __init__(
        self,
        panel: SidePanel,
        canvas: Canvas,
        workspace: Workspace,
        proposals: ProposalController,
        contours: ContourStore,
    ) -> None:
        super().__init__(canvas)
        self._contours = contours
        self._panel, self._canvas, self._document, self._proposals = panel, canvas, workspace.document, proposals
        self._found: FoundAreas | None = None
        self._asked: Job | None = None
        self._unit = display_unit_size()
        self.words: list[QToolButton] = []
        self.menu: QMenu | None = None
        self.worker = Worker(self)
        workspace.activity.ended.connect(self.worker.finish)
        self._document.subscribe(self._follow)
        for signal in (canvas.prompt_changed, canvas.tool_changed, canvas.view_changed, canvas.mode_changed):
            signal.connect(self.place)
        canvas.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Stay as large as the words are: they are looked up in another language when they are painted."""
        if event.type() == QEvent.Type.LayoutRequest and any(word.size() != word.sizeHint() for word in self.words):
            self.place()
        return super().eventFilter(watched, event)

    def _follow(self, change: DocumentChange) -> None:
        """Look for the areas of another job; those of the one before are gone at once where the drawing is another."""
        job = self._document.job
        if not change & (DocumentChange.PART | DocumentChange.JOB | DocumentChange.LOADED) or job == self._asked:
            return
        self._asked = job
        own = any(each.cut.enabled and each.cut.curves for each in job.operations)
        if not own or len(job.part.entities) > _MOST_CURVES:
            self.worker.cancel()
            self._show(None)
            return
        if self._found is not None and self._found.job.part is not job.part:
            self._show(None)
        self.worker.start(
            lambda progress: found_areas(job, self._contours, progress), self._document.revision, self._show
        )

    def _show(self, found: FoundAreas | None) -> None:
        self._found = found
        for word in self.words:
            word.hide()
            word.deleteLater()
        areas = found.areas if found is not None else ()
        self._canvas.set_purposes(tuple(each.shape for each in areas))
        self.words = [self._word(k, each) for k, each in enumerate(areas[:_MOST_WORDS])]
        self.place()

    def _word(self, at: int, placed: PlacedArea) -> QToolButton:
        word = PurposeWord(self._canvas, placed.shape.kind)
        word.setText(placed.word)
        word.clicked.connect(partial(self._open, at))
        word.lower()
        return word

    def place(self, *_: object) -> None:
        """Put each word at its area, where it covers no other one; be gone while a tool is in hand."""
        canvas, found = self._canvas, self._found
        shown = found is not None and canvas.mode is CanvasMode.DRAW and not canvas.working
        canvas.show_purposes(shown)
        if found is None:
            return
        size = canvas.around.size_place(canvas.view).toAlignedRect()
        places = WordPlaces(canvas.view, canvas.area.toRect(), found.boxes, [] if size.isEmpty() else [size])
        for word, placed in zip(self.words, found.areas, strict=False):
            if self._unit != display_unit_size():
                word.setText(placed.word)
            word.adjustSize()
            place = places.take(placed.box, word.size(), placed.shape.filled) if shown else None
            word.setVisible(place is not None)
            if place is not None:
                word.move(place.topLeft())
        self._unit = display_unit_size()

    def _open(self, at: int) -> None:
        """Choose the operation, and offer what else its area may be."""
        if self._found is None or self._asked != self._document.job:
            return
        placed = self._found.areas[at]
        self._panel.choose(Subject(SubjectKind.OPERATION, placed.area.index))
        if self.menu is not None:
            self.menu.deleteLater()
        self.menu = self._menu_of(placed, self._found.refused[at])
        word = self.words[at]
        self.menu.popup(word.mapToGlobal(QPoint(0, word.height())))

    def _menu_of(self, placed: PlacedArea, refused: frozenset[str]) -> QMenu:
        menu = QMenu(self._canvas)
        leave = menu.addAction("Leave this standing")
        leave.triggered.connect(lambda *_: self._leave(placed.area))
        menu.addSeparator()
        now = operation_name(self._document.job.operations[placed.area.index])
        for way, name in INSTEAD.items():
            if name != now:
                action = menu.addAction(name)
                action.setEnabled(way not in refused)
                action.triggered.connect(partial(self._change, placed.area, way))
        return menu

    def _leave(self, area: PurposeArea) -> None:
        """Take an area from its operation."""
        self._panel.subject = Subject(SubjectKind.OPERATION, 0)
        self._document.change_job("Leave this standing", self._without(area))

    def _change(self, area: PurposeArea, way: str, *_: object) -> None:
        """Have an area become something else."""
        self._proposals.machine_instead(self._without(area), area.numbers, way)

    def _without(self, area: PurposeArea) -> Job:
        from ....usecases.proposal.purpose_areas import left_standing

        assert self._found is not None
        return left_standing(self._document.job, self._found.drawn, area)
