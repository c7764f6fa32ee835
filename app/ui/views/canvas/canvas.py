"""The canvas: a document's drawing and its tool paths, shown and edited."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from PySide6.QtCore import QRectF, Signal
from PySide6.QtGui import QPainter, QPainterPath, QShowEvent

from ....drafting.difference import DrawingDifference
from ....drafting.document import Document, DocumentChange
from ....geometry.sample import Box, union
from ....model.curves import Point
from ....model.finding import Finding
from ....model.moves import Program
from ....model.notes import Note
from ....model.part import Entity, Part
from ....model.stock_box import StockBox
from ....raster.frame import BitmapFrame
from ...framework.theme import Theme
from .describe import describe_entity, describe_note
from .grips import GRIP_PX, GripDragTool, SelectionDragTool
from .interactive_viewport import PICK_PX, InteractiveViewport, MouseAnswers
from .modes import CanvasMode, CanvasTool, PathColourBy, PathLayers
from .painting import overlay
from .painting.annotation_layer import NoteLook, paint_note
from .painting.curve_path import MANY, curve_path
from .painting.grid import (
    paint_display,
    paint_display_marks,
    paint_origin,
    paint_paper,
    paint_raster,
    paint_ruler_marks,
    paint_rulers,
)
from .painting.program_layer import PathDisplay, ProgramLayer, shown_purposes
from .painting.purpose_layer import PurposeShape, paint_purposes
from .painting.snap_marks import paint_snap
from .painting.surroundings_layer import SurroundingsLayer
from .painting.underlay_layer import UnderlayLayer
from .program_hover import describe, nearest_move
from .value_picture import SheetPlace, ValueSheet, paint_values
from .view_transform import ViewTransform
from .viewport import FarScene, ViewportScene

__all__ = ["BitmapFrame", "Canvas", "CanvasMode", "CanvasTool", "PathColourBy", "PathLayers"]

_BLEED_PX = 8.0
"""How far lines and marks reach beyond the shape they belong to."""

_CLOSE_MM = 16.0
"""How much is seen around a place that is looked at closely."""

_SEEN = 0.8
"""Share of the view that what shall be seen whole takes at most."""

_STALE = 0.4
"""So much is left of the colours of paths that the job has outgrown."""

_LARGE = 0.35
"""A part that takes up this share of the frame's span is shown together with the frame."""


class Canvas(InteractiveViewport):
    """Shows a document and draws in it; signals are those of `InteractiveViewport`.

    Signals:
        mode_changed(): the drawing is shown instead of the paths, or these.

    Attributes:
        frame: the display of 400 x 400 cells, or another.
        around: stock, clamps and copies round the part.
        owned: curves of the operation that is chosen, mm; empty where it has none of its own.
    """

    mode_changed = Signal()

    def __init__(self, document: Document, theme: Theme) -> None:
        """Show a document; it is followed from now on."""
        scene = ViewportScene(
            self._scene_steps,
            self._paint_margins,
            self.paint_overlay,
            self._paint_ground,
            lambda: self.heavy,
            FarScene(self._far_box, self._far_steps),
        )
        super().__init__(document, scene, MouseAnswers(self.look_at, self.fit))
        self.frame = BitmapFrame()
        self._underlay: UnderlayLayer | None = None
        self._look, self._mode = PathDisplay(theme), CanvasMode.DRAW
        self._program: ProgramLayer | None = None
        self.around = SurroundingsLayer()
        self._trial, self._trial_picture, self._preview_picture = (
            DrawingDifference(),
            overlay.TrialLayer(),
            overlay.TrialLayer(),
        )
        self._findings: tuple[Finding, ...] = ()
        self._lit: int | Entity | Note | None = None
        self._lit_path, self.owned = QPainterPath(), QPainterPath()
        self._purposes: tuple[PurposeShape, ...] = ()
        self._purposes_shown = False
        self._stock_of: Part | None = None
        self._fresh = True
        self.setMinimumSize(200, 150)
        self.setAccessibleName("Drawing")
        document.subscribe(self._follow)
        self._follow(DocumentChange.ALL)

    @property
    def colour_by(self) -> PathColourBy:
        """What the colour of a path tells."""
        return self._look.colour_by

    def set_theme(self, theme: Theme) -> None:
        """Paint with another theme."""
        self._set_look(replace(self._look, theme=theme))

    @property
    def theme(self) -> Theme:
        """What it is painted with."""
        return self._look.theme

    @property
    def mode(self) -> CanvasMode:
        """Whether the drawing or its paths are shown."""
        return self._mode

    def set_mode(self, mode: CanvasMode) -> None:
        """Show the drawing, or the tool paths."""
        self._mode = mode
        self.mode_changed.emit()
        self.grips.update(self.document, mode is CanvasMode.DRAW)
        self.look_at(None)
        self.repaint_scene()

    def set_program(self, program: Program | ProgramLayer | None) -> None:
        """Show these tool paths in PATHS; None shows none. A picture that another thread has prepared costs nothing
        here.
        """
        self.look_at(None)
        self._program = ProgramLayer(program) if isinstance(program, Program) else program
        self.repaint_scene()

    def show_trial(self, trial: DrawingDifference) -> None:
        """Show what a command would make of the drawing before it is carried out; an empty difference shows nothing."""
        self._trial = trial
        self.update()

    def set_owned(self, path: QPainterPath) -> None:
        """Mark the curves of an operation, mm, in the drawing; an empty path marks none."""
        if not (path.isEmpty() and self.owned.isEmpty()):
            self.owned = path
            self.update()

    def set_purposes(self, shapes: tuple[PurposeShape, ...]) -> None:
        """Colour what the curves of the drawing are to become."""
        if shapes or self._purposes:
            self._purposes = shapes
            self.update()

    def show_purposes(self, on: bool) -> None:
        """Show these areas, or not."""
        if on != self._purposes_shown:
            self._purposes_shown = on
            self.update()

    def set_stock(self, stock: StockBox | None) -> None:
        """Show where the stock is; None = there is none yet. What was fitted is fitted anew where the job, and not the
        drawing, makes the stock reach beyond it.
        """
        drawn, self._stock_of = self._stock_of, self.document.part
        if stock == self.around.stock:
            return
        self.around.stock = stock
        self.repaint_scene()
        if stock is not None and drawn is self._stock_of:
            self.widen_fit((stock.x0, stock.y0, stock.x1, stock.y1))

    def set_findings(self, findings: tuple[Finding, ...]) -> None:
        """Mark the places of these findings."""
        self._findings = findings
        self.update()

    def set_visible_layers(self, layers: PathLayers) -> None:
        """Choose what PATHS shows."""
        self._set_look(replace(self._look, layers=layers))

    def set_colour_by(self, colour_by: PathColourBy) -> None:
        """Colour the paths by tool or by region."""
        self._set_look(replace(self._look, colour_by=colour_by))

    def set_stale(self, stale: bool) -> None:
        """Show the paths faintly, because the job has changed since they were computed, or fully."""
        if stale != self._look.stale:
            self._set_look(replace(self._look, stale=stale))

    def set_underlay(self, picture: UnderlayLayer | None) -> None:
        """Lay a picture under the drawing, or none."""
        self._underlay = picture
        self.repaint_scene()

    def fit(self) -> None:
        """Show the whole part and its stock, or the frame while nothing is drawn."""
        stock = self.around.stock
        around = None if stock is None else (stock.x0, stock.y0, stock.x1, stock.y1)
        self.glide_to_box(union([each for each in (self.picture.box, around) if each is not None]) or self.frame.extent)

    def go_to(self, x: float, y: float, closely: bool = False, around: Box | None = None) -> None:
        """Bring a point in mm to the middle; with `closely` zoom in, too, unless it is seen larger already.

        Args:
            around: a box, mm, all of which is seen then with the point, however far one has to zoom out for that.
        """
        scale = max(self.view.scale, min(self.area.width(), self.area.height()) / _CLOSE_MM if closely else 0.0)
        if around is not None:
            x0, y0, x1, y1 = min(x, around[0]), min(y, around[1]), max(x, around[2]), max(y, around[3])
            sides = ((self.area.width(), x1 - x0), (self.area.height(), y1 - y0))
            scale = min([scale, *(_SEEN * room / size for room, size in sides if size > 0)])
            x, y = (x0 + x1) / 2, (y0 + y1) / 2
        self.glide_to(replace(self.view, scale=scale).centred((x, y), self.area))

    @property
    def heavy(self) -> bool:
        """Whether so much is in view that painting it may take longer than a frame."""
        return self._many * self.devicePixelRatioF() > MANY

    @property
    def _many(self) -> int:
        """How many elements of paths are in view."""
        return self._elements(self.view.world_box(self.area))

    def _elements(self, box: Box) -> int:
        """Return how many elements of paths come into a box in mm."""
        program = self._shown_program
        return self.picture.count(box) + (program.count(box, self._look.layers) if program is not None else 0)

    @property
    def _shown_program(self) -> ProgramLayer | None:
        return self._program if self._mode is CanvasMode.PATHS else None

    def _scene_steps(self, painter: QPainter, area: QRectF) -> Iterator[None]:
        """Paint paper, paths and part within a screen rectangle, with pauses."""
        look, program, whole = self._look, self._shown_program, self.view.world_box(self.area)
        theme = look.theme
        box = self.view.world_box(area.adjusted(-_BLEED_PX, -_BLEED_PX, _BLEED_PX, _BLEED_PX))
        self._paint_ground(painter, area)
        if program is not None:
            fine = program.count(whole, look.layers) > MANY
            shown = replace(look, theme=theme.faint(_STALE) if look.stale else theme, fine=fine)
            yield from program.steps(painter, self.view, box, shown)
        self.around.paint_stock(painter, self.view, area, theme)
        if program is None or PathLayers.CLAMP in look.layers:
            self.around.paint_clamps(painter, self.view, box, theme)
        if program is None or PathLayers.PART in look.layers:
            self.picture.fine = self.picture.count(whole) > MANY
            self.around.paint_copies(painter, self.view, self.picture, box, theme)
            yield
            yield from self.picture.steps(painter, self.view, box, theme)
        paint_origin(painter, self.view, theme)

    def _far_box(self) -> Box | None:
        """Return the box of part and paths, where they are many."""
        program = self._shown_program
        box = union(
            [box for box in (self.picture.box, program.box if program is not None else None) if box is not None]
        )
        return box if box is not None and self._elements(box) > MANY else None

    def _far_steps(self, painter: QPainter, view: ViewTransform) -> Iterator[None]:
        """Paint paths and part with the finest pens."""
        look, program, box = self._look, self._shown_program, self._far_box()
        if program is not None and box is not None:
            theme = look.theme.faint(_STALE) if look.stale else look.theme
            yield from program.steps(painter, view, box, replace(look, theme=theme, fine=True))
        if program is None or PathLayers.PART in look.layers:
            yield from self.picture.coarse_steps(painter, view, look.theme)

    def _paint_ground(self, painter: QPainter, area: QRectF) -> None:
        """Paint the paper."""
        paint_paper(painter, self.view, area, self._look.theme, self.unit)
        if self._underlay is not None:
            self._underlay.paint(painter, self.view)
            paint_raster(painter, self.view, area, self._look.theme, self.unit)
        paint_display(painter, self.view, area, self.frame, self._look.theme)
        if self._in_display and self._mode is CanvasMode.DRAW:  # beside the paths the stock is what counts
            paint_display_marks(painter, self.view, area, self.frame, self._look.theme)

    @property
    def _in_display(self) -> bool:
        """Whether all that is drawn lies in the display: the corners of one that it does not fit would be a riddle."""
        (x0, y0, x1, y1), box = self.frame.extent, self.picture.box
        return box is None or (x0 <= box[0] and y0 <= box[1] and box[2] <= x1 and box[3] <= y1)

    def _paint_margins(self, painter: QPainter) -> None:
        """Paint the rulers."""
        paint_rulers(painter, self.view, self.size(), self._look.theme, self.unit)

    def paint_overlay(self, painter: QPainter) -> None:
        """Paint what follows the mouse."""
        theme = self._look.theme
        painter.setClipRect(self.area)
        if self._mode is CanvasMode.DRAW:
            if self._purposes_shown:
                paint_purposes(painter, self.view, self._purposes, theme)
            overlay.paint_owned(painter, self.view, self.owned, theme)
        if isinstance(self._lit, Note):
            paint_note(painter, self.view, self._lit, NoteLook(theme.accent_text, 2.2), self.area)
        elif self._lit is not None and not self.runner.shows_change:
            overlay.paint_highlight(painter, self.view, self._lit_path, (theme.accent, theme.accent_text))
        overlay.paint_findings(painter, self.view, self._findings, theme)
        self._trial_picture.paint(painter, self.view, self._trial, theme)
        if self._mode is CanvasMode.DRAW and self.tool is CanvasTool.SELECT:
            overlay.paint_grips(painter, self.view, self.grips.points, self._grip_under, theme)
        if self.runner.tool is not None:
            for curve in () if self.runner.shows_change else self.runner.tool.picked:
                overlay.paint_highlight(painter, self.view, curve_path(curve), (theme.accent, theme.accent_text))
            self._paint_tool(painter)
        self._paint_marks(painter)
        if self.banding and self.band_from is not None and self.mouse is not None:
            overlay.paint_band(painter, self.view.to_screen(self.band_from.at), self.mouse, theme)
        painter.setClipping(False)
        if self.mouse is not None and self.area.contains(self.mouse):
            paint_ruler_marks(painter, self.mouse, theme)

    def look_at(self, point: Point | None) -> None:
        """Light up the move or the entity under the mouse, and say what it is."""
        lit = self._under(point) if point is not None else None
        if lit == self._lit:
            return
        self._lit, self._lit_path = lit, self._path_of(lit)
        self.hovered.emit(self._words_for(lit))
        self.update()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 (Qt's name)
        """Look at the whole of a document that was opened meanwhile."""
        super().showEvent(event)
        if self._fresh:
            self._show_all()

    def _under(self, point: Point) -> int | Entity | Note | None:
        """Return what lies under the mouse: the number of a move, or an entity."""
        reach = PICK_PX / self.view.scale
        if self._mode is CanvasMode.PATHS and self._program is not None:
            move = nearest_move(self._program.shapes, point, reach, shown_purposes(self._look.layers))
            if move is not None:
                return move
        found = self.candidates()
        return found[self.turns.at(self.mouse) % len(found)] if found and self.mouse is not None else None

    def _path_of(self, lit: int | Entity | Note | None) -> QPainterPath:
        if isinstance(lit, Entity):
            return curve_path(lit.curve)
        if isinstance(lit, Note):
            return QPainterPath()
        return self._program.shapes.piece_path(lit) if lit is not None and self._program is not None else QPainterPath()

    def _words_for(self, lit: int | Entity | Note | None) -> str:
        if isinstance(lit, Entity):
            return describe_entity(lit)
        if isinstance(lit, Note):
            return describe_note(lit)
        return (
            describe(self._program.shapes, lit, self.document.job)
            if lit is not None and self._program is not None
            else ""
        )

    def _paint_marks(self, painter: QPainter) -> None:
        """Paint the places that are being marked by hand."""
        if self.marker_mode is not None:
            overlay.paint_points(painter, self.view, self.marked_places, self._look.theme)

    def set_unit(self, unit: float) -> None:
        """Count in another unit, of so many mm; typed lengths, too."""
        self.runner.set_unit(unit)
        super().set_unit(unit)

    def _paint_tool(self, painter: QPainter) -> None:
        tool, theme, typed = self.runner.tool, self._look.theme, self.runner.typed
        away = self.aim is None or self.mouse is None
        if tool is None or (away and typed.free and not self.entry.editing and not self.runner.wants_words):
            return
        at = self.entry.at
        if self.aim is not None:
            aids = overlay.TrackingAids(self.aim.tracked, self.snap_state.acquired)
            overlay.paint_tracking(painter, self.view, aids, self.area, theme)
        end = typed.answer(tool, at)
        end = end if isinstance(end, tuple) else at
        if isinstance(tool, SelectionDragTool):
            for _ in self.picture.selected_steps(painter, self._carried_view(tool, end), theme.selection, self.area):
                pass
        preview = self.runner.preview(at)
        self._preview_picture.paint(painter, self.view, preview.trial, theme)
        overlay.paint_preview(painter, self.view, preview, theme)
        given = [*tool.points[:1], *tool.points[-1:]]
        overlay.paint_points(painter, self.view, given if typed.free else [*given, end], theme)
        word = ""
        if self.aim is not None and typed.free:
            word = self.aim.word
            if self.aim.snap is not None:
                paint_snap(painter, self.view, self.aim.snap, theme)
        self._paint_values(painter, [preview.label, word], end)

    def _paint_values(self, painter: QPainter, words: list[str], end: Point) -> None:
        """Paint the boxes and words beside the mouse, or beside the point before while the mouse is elsewhere."""
        base = self.runner.tool.base if self.runner.tool is not None else None
        mouse = self.mouse or (self.view.to_screen(base) if base is not None else self.area.center())
        place = SheetPlace(
            mouse, self.view.to_screen(base) if base is not None else None, self.view.to_screen(end), self.area
        )
        paint_values(painter, ValueSheet.of(self.entry, words), place, self._look.theme)

    def _carried_view(self, tool: SelectionDragTool, to: Point) -> ViewTransform:
        """Return the view that shows the selection where it is carried to."""
        dx, dy = tool.shift(to)
        return self.view.panned(dx * self.view.scale, -dy * self.view.scale)

    @property
    def _grip_under(self) -> Point | None:
        """The grip under the mouse, or in hand."""
        if isinstance(self.runner.tool, GripDragTool):
            return self.runner.tool.base
        if self.mouse is None or self.runner.tool is not None or self.banding:
            return None
        return self.grips.at(self.view.to_world(self.mouse), GRIP_PX / self.view.scale)

    def _follow(self, change: DocumentChange) -> None:
        places: list[Box] | None = []
        in_display = self._in_display
        if DocumentChange.PART in change:
            places = self.picture.update(self.document.part)
            self.look_at(None)
            self.runner.after_undo()
            self._aim_again()
        around = bool(change & (DocumentChange.PART | DocumentChange.JOB)) and self.around.update(self.document.job)
        if change & (DocumentChange.PART | DocumentChange.SELECTION):
            selected = self.picture.select(self.document.selection)
            self.grips.update(self.document, self._mode is CanvasMode.DRAW)
            places = places + selected if places is not None and selected is not None else None
        other = (self.picture.count(self.view.world_box(self.area)) > MANY) != self.picture.fine
        other |= in_display != self._in_display
        if around or places is None or other or self.document.job.copies.shifts[1:]:
            self.repaint_scene()
        elif places:
            self.repaint_places(places, _BLEED_PX)
        if DocumentChange.LOADED in change:
            self._fresh = True
            self._show_all()

    def _show_all(self) -> None:
        """Look at a document just opened: with the frame when the part fills much of it, else at the part alone."""
        if not self.isVisible():
            return
        whole = _with_frame(self.picture.box, self.frame.extent)
        self.fit_to(whole)
        self._fresh = False

    def _set_look(self, look: PathDisplay) -> None:
        self._look = look
        self.look_at(None)
        self.repaint_scene()


def _with_frame(box: Box | None, frame: Box) -> Box:
    whole = union([box, frame]) if box is not None else None
    if box is None or whole is None:
        return frame
    span, most = max(box[2] - box[0], box[3] - box[1]), max(whole[2] - whole[0], whole[3] - whole[1])
    return whole if span > _LARGE * most else box
