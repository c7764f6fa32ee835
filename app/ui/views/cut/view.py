"""The Cut view: the stock as the program leaves it; orbit, pan, zoom, probe, section."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from PySide6.QtCore import QEasingCurve, QEvent, QPointF, Qt, QVariantAnimation, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QLabel, QWidget

from ...framework.boxes import give_ground, v_box
from ...framework.samples import PathLineKind
from ...framework.theme import Theme
from ..canvas.viewport import GLIDE_MS
from ..nc.motion_shapes import MotionLineStyle
from .camera import Camera, StandardView
from .cell_colours import CutColourBy, possible
from .cell_picking import PickedCell, SectionPlane
from .colour_worker import ColourWorker
from .cut_input import KEYS, CutInput
from .cut_picture import CutPicture
from .height_profile import height_profile
from .legend import CutLegend, SectionAxis
from .model import CutModel
from .overlay import CutOverlay, Line, PlacePin, ProbedCell
from .overlay_text import facts_of, place_of
from .profile_panel import HEIGHT, ProfilePanel
from .render_scheduler import RenderScheduler
from .surface import pixel_size
from .surface_host import SurfaceHost
from .theme_colours import render_style_of

_NOTCH, _CROWDED_PX = 1.2, 6.0
_EDGE_PX = 16
_STEEP, _MOST_OF_STOCK = np.radians(55.0), 0.5
_LOOKS = {
    PathLineKind.RAPID: MotionLineStyle.RAPID,
    PathLineKind.POCKET: MotionLineStyle.CUT,
    PathLineKind.PLUNGE: MotionLineStyle.PLUNGE,
    PathLineKind.CONTOUR: MotionLineStyle.CONTOUR,
}


class CutView(QWidget):
    """Shows a cut; whoever owns it computes it.

    Signals:
        cell_picked(x, y, z, move): the metal was clicked at a place, mm; move = index of the one that cut it last, -1 =
        none. hovered(sentence): what is under the mouse, or "". cursor_moved(x, y): the place under the mouse, mm.

    Attributes:
        model: what is shown and from where. colours: of the metal. render_scheduler: when it is painted, and on what.
        playback: the tool at its place. cut_input: mouse and keys. surface_host: gives it what it is painted on.
    """

    cell_picked = Signal(float, float, float, int)
    hovered = Signal(str)
    cursor_moved = Signal(float, float)

    def __init__(self) -> None:
        super().__init__()
        self.model = model = CutModel(looks=frozenset(int(look) for look in MotionLineStyle))
        self.render_scheduler, self.colours, self.cut_input = (
            RenderScheduler(model, self),
            ColourWorker(model, self),
            CutInput(model, self),
        )
        self.playback = self.render_scheduler.playback
        self._fitted, self.surface_host = True, SurfaceHost(self.render_scheduler, self)
        self._side, self._signs = SectionAxis.WHOLE, (1.0, 1.0)
        self.sentence = QLabel()
        self.sentence.setProperty("role", "muted")
        self.sentence.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.sentence.setWordWrap(True)
        column = v_box(self)
        column.addWidget(self.sentence)
        self.overlay, self.legend, self.profile = CutOverlay(self), CutLegend(self), ProfilePanel(self)
        self._way = (model.camera, model.camera)
        self._glide = QVariantAnimation(self)
        self._glide.setDuration(GLIDE_MS)
        self._glide.setEasingCurve(QEasingCurve.Type.OutCubic)
        self._glide.setStartValue(0.0)
        self._glide.setEndValue(1.0)
        self._glide.valueChanged.connect(lambda share: self._look(self._way[0].towards(self._way[1], float(share))))
        self._begin()

    def _begin(self) -> None:
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(200, 150)
        give_ground(self, "cutView")
        self.setAccessibleName("Cut in three dimensions")
        self.legend.colour_chosen.connect(self.set_colour)
        self.legend.layer_switched.connect(self._on_layer)
        self.legend.wedges_switched.connect(self.playback.switch_wedges)
        self.legend.section_chosen.connect(self._on_section)
        self.profile.closed.connect(lambda: self.show_line(None))
        self.colours.known.connect(self._show_colours)
        self.playback.has_wedges.connect(self.legend.show_wedges)
        self.playback.facet.connect(self.legend.tell_facet)
        self.surface_host.given_up.connect(self._give_up)
        self.cut_input.looked.connect(self.look_now)
        self.cut_input.glided.connect(self.glide_to)
        self.cut_input.pointed.connect(self.hover)
        self.cut_input.held.connect(lambda at: self.show_hit(None, at))
        self.cut_input.drew.connect(self.show_line)
        self.cut_input.clicked.connect(self._pick)
        self.overlay.hide()
        self.legend.hide()

    def _give_up(self, failure: str) -> None:
        """Say why nothing can be shown here."""
        self.sentence.setText(failure)
        self.overlay.hide()
        self.legend.hide()

    def _pick(self) -> None:
        if (hit := self.model.hit) is not None:
            self.cell_picked.emit(*hit.place, hit.move)

    def show_cut(self, picture: CutPicture | None) -> None:
        """Show another cut; the view stays unless the stock is another one."""
        before, self.model.picture, self.model.detail = self.model.picture, picture, None
        self.overlay.show_probe(None)
        self.overlay.show_pin(None)
        self.overlay.show_way(None)
        self.show_line(None)
        self.model.hit = None
        for widget in (self.overlay, self.legend, self.render_scheduler.surface):
            if widget is not None:
                widget.setVisible(picture is not None)
        if picture is None:
            self.update()
            return
        looks = set(picture.paths.look.tolist()) if picture.paths is not None else set()
        self.legend.show_layers({sample for sample, look in _LOOKS.items() if look in looks})
        self.overlay.show_pitch(picture.pitch, finer=False)
        self.render_scheduler.new_picture()
        self.colours.refresh()
        self._on_section(self.legend.chosen_side, self.legend.slider.value() / self.legend.slider.maximum())
        if before is None or not (
            np.array_equal(before.low, picture.low) and np.array_equal(before.high, picture.high)
        ):
            self.look_now(self._fitted_camera())
            self._fitted = True
            self._thin_out(picture)
        if self.isVisible():
            self.surface_host.need()

    def _thin_out(self, picture: CutPicture) -> None:
        """Leave out paths of cuts that would hide the metal, until the user wants them; a wall's steps down, which lie
        over each other, hide no more of it than one.
        """
        room = float(np.prod((picture.high - picture.low)[:2])) * self.model.camera.scale / _CROWDED_PX
        paths = picture.paths
        pocket, contour = int(_LOOKS[PathLineKind.POCKET]), int(_LOOKS[PathLineKind.CONTOUR])
        few = paths is None or paths.length(pocket) < room
        self.legend.rows[PathLineKind.POCKET].setChecked(few)
        few = paths is None or paths.length(contour) < room or paths.ground_length(contour) < room
        self.legend.rows[PathLineKind.CONTOUR].setChecked(few)

    def show_detail(self, detail: CutPicture | None) -> None:
        """Show a part of the cut in finer cells, or only the whole again."""
        if self.model.picture is None or detail is self.model.detail:
            return
        self.model.detail = detail
        colour = self.model.colour_shown
        self.overlay.show_pitch((detail or self.model.picture).pitch, finer=detail is not None)
        if self.overlay.line is not None:
            self.show_line(self.overlay.line)
        if detail is None or colour in detail.values:
            self.render_scheduler.new_detail(detail.values[colour] if detail is not None else None)
        else:
            self.colours.refresh()

    @property
    def colour(self) -> CutColourBy:
        """What the colours of the metal shall tell."""
        return self.model.requested_colour

    def set_colour(self, colour: CutColourBy) -> None:
        """Let the colours of the metal tell something else."""
        self.model.requested_colour = colour
        self.colours.refresh()

    def set_theme(self, theme: Theme) -> None:
        """Paint by day or by night."""
        self.colours.set_theme(theme)

    def fit(self) -> None:
        """Show the whole stock in the direction that is looked in."""
        if self.model.picture is not None:
            self.glide_to(self._fitted_camera())
            self._fitted = True

    def zoom_by(self, factor: float, at: QPointF | None = None) -> None:
        """Zoom; what is seen at a place, by default in the middle, stays there."""
        ratio = self.devicePixelRatioF()
        place = at * ratio if at is not None else QPointF(*pixel_size(self)) / 2
        self.look_now(self.model.camera.zoomed(factor, (place.x(), place.y()), pixel_size(self)))

    def stand(self, view: StandardView) -> None:
        """Look from a standard direction at the whole stock."""
        if self.model.picture is not None:
            self.glide_to(self._fitted_camera(self.model.camera.seen_from(view)))
            self._fitted = True

    def go_to(self, pin: PlacePin, field: float) -> None:
        """Glide to a place, steeply enough to look into the metal, and point at it.

        Args:
            pin: the place. field: about how much round it should be seen, mm.
        """
        if self.model.picture is None:
            return
        self.overlay.show_pin(pin)
        width, height = pixel_size(self)
        field = min(field, _MOST_OF_STOCK * float(np.max((self.model.picture.high - self.model.picture.low)[:2])))
        towards = replace(
            self.model.camera,
            target=pin.place,
            pitch=max(self.model.camera.pitch, _STEEP),
            scale=min(width, height) / field,
        )
        self._fitted = False
        self.glide_to(towards.panned(-self._covered() / 2, 0.0))

    def look_now(self, camera: Camera) -> None:
        """Look this way at once."""
        self._glide.stop()
        self._fitted = False
        self._look(camera)

    def metal_changed(self) -> None:
        """The picture's cells have changed in place: what is told of single ones is told anew, or no more."""
        if self.overlay.line is not None:
            self.show_line(self.overlay.line)
        self.show_hit(None, QPointF())

    def showEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Make the surface when it is first needed: a window with OpenGL in it costs more to paint."""
        if self.model.picture is not None:
            self.surface_host.need()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep what was fitted fitted."""
        for widget in (self.render_scheduler.surface, self.overlay):
            if widget is not None:
                widget.setGeometry(self.rect())
        self.profile.setGeometry(0, self.height() - HEIGHT, self.width(), HEIGHT)
        self._place_legend()
        if self.model.picture is not None and self._fitted:
            self._look(self._fitted_camera())
        else:
            self.render_scheduler.moved()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Hold the stock."""
        self.cut_input.press(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Turn or shift what is held; else tell what is under the mouse."""
        self.cut_input.move(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Let go; a click picks the cell."""
        self.cut_input.release(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """The second press of two is a press like any other."""
        self.cut_input.press(event)

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Nothing is under the mouse."""
        self.show_hit(None, QPointF())

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 (Qt's name)
        """Zoom at the mouse."""
        if event.angleDelta().y() and self.model.picture is not None:
            self.show_hit(None, event.position())
            self.zoom_by(_NOTCH ** (event.angleDelta().y() / 120), event.position())
        event.accept()

    def event(self, event: QEvent) -> bool:
        """Keep the digits and F from whoever types elsewhere."""
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and not event.modifiers()
            and event.key() in KEYS
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """F fits, 1 to 4 are the standard views, arrows turn, Escape ends the profile and unpins."""
        key = Qt.Key(event.key())
        if event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier:
            super().keyPressEvent(event)
        elif key == Qt.Key.Key_Escape and self.overlay.line is not None:
            self.show_line(None)
        elif key == Qt.Key.Key_Escape and (self.overlay.pin is not None or self.overlay.way is not None):
            self.overlay.show_pin(None)
            self.overlay.show_way(None)
        elif key == Qt.Key.Key_F:
            self.fit()
        elif key in KEYS:
            self.stand(KEYS[key])
        elif not self.cut_input.turn(event):
            super().keyPressEvent(event)

    def show_line(self, line: Line | None) -> None:
        """Show the heights along a line over the metal, or no line any more.

        Args:
            line: its two ends, mm.
        """
        self.overlay.show_line(line)
        self.profile.setVisible(line is not None)
        if line is not None and self.model.picture is not None:
            finer = self.model.detail is not None and all(self.model.detail.holds(*end[:2]) for end in line)
            picture = self.model.detail if self.model.detail is not None and finer else self.model.picture
            self.profile.show_profile(height_profile(picture, line[0][:2], line[1][:2]))

    def _fitted_camera(self, camera: Camera | None = None) -> Camera:
        """Return the camera that shows the whole stock beside the legend and above the profile."""
        if self.model.picture is None:
            return self.model.camera
        width, height = pixel_size(self)
        free = width - self._covered()
        below = HEIGHT * self.devicePixelRatioF() if self.profile.isVisible() and height > 2 * HEIGHT else 0.0
        fitted = (camera or self.model.camera).fitted(
            self.model.picture.low, self.model.picture.high, (free, height - below)
        )
        return fitted.panned((free - width) / 2, -below / 2)

    def _covered(self) -> float:
        """Return how much of the width the legend covers, px; none where the view is too narrow to keep clear of it."""
        covered = (self.legend.width() + _EDGE_PX) * self.devicePixelRatioF()
        return covered if covered < 0.45 * pixel_size(self)[0] else 0.0

    def _look(self, camera: Camera) -> None:
        self.model.camera = camera
        self.overlay.show_camera(camera)
        self.render_scheduler.moved()

    def glide_to(self, camera: Camera) -> None:
        """Look another way, by and by."""
        self._glide.stop()
        self.show_hit(None, QPointF())
        if not self.isVisible():
            self._look(camera)
            return
        self._way = (self.model.camera, camera)
        self._glide.start()

    def _show_colours(self) -> None:
        """Paint in other colours, and explain them."""
        if self.model.picture is None:
            return
        colour, made = self.model.colour_shown, self.colours.of_whole(self.model.picture)
        detail = self.model.detail.values[colour] if self.model.detail is not None else None
        self.render_scheduler.new_colours(made, detail, render_style_of(self.colours.theme))
        self.legend.show_colours(colour, made.key, possible(self.model.picture))
        self._place_legend()

    def _place_legend(self) -> None:
        self.legend.fit_into(self.size())
        self.legend.move(self.width() - self.legend.width() - _EDGE_PX, _EDGE_PX)

    def _on_layer(self, sample: PathLineKind, on: bool) -> None:
        look = int(_LOOKS[sample])
        self.model.looks = self.model.looks | {look} if on else self.model.looks - {look}
        self.render_scheduler.moved()

    def _on_section(self, side: SectionAxis, share: float) -> None:
        """Cut the stock open across an axis; the part towards the eye is taken away, and stays so while the cut is
        turned.
        """
        self._place_legend()
        if side is not self._side:
            self._side, towards = side, self.model.camera.axes[2]
            self._signs = (1.0 if towards[0] > 0 else -1.0, 1.0 if towards[1] > 0 else -1.0)
        if self.model.picture is None or side is SectionAxis.WHOLE:
            self.model.section = None
        else:
            axis = 0 if side is SectionAxis.X else 1
            sign = self._signs[axis]
            low, high = self.model.picture.low[axis], self.model.picture.high[axis]
            normal = (sign, 0.0) if axis == 0 else (0.0, sign)
            self.model.section = SectionPlane(normal, sign * float(low + share * (high - low)))
        self.render_scheduler.moved()

    def hover(self, at: QPointF) -> None:
        """Tell what is under the mouse."""
        self.show_hit(self.cut_input.probe(at), at)

    def show_hit(self, hit: PickedCell | None, at: QPointF) -> None:
        """Tell what is known of a cell, here and to whoever listens."""
        if hit is None and self.model.hit is None:
            return
        self.model.hit = hit
        if hit is None:
            self.overlay.show_probe(None)
            self.hovered.emit("")
            return
        facts = facts_of(hit)
        self.overlay.show_probe(ProbedCell(at, place_of(hit), facts))
        self.hovered.emit(facts)
        self.cursor_moved.emit(hit.place[0], hit.place[1])
