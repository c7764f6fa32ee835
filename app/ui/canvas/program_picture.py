"""Paints a program: contour dashed, pocket solid, links thinner, rapids dotted, plunges as small rings."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from app.edit.sample import Box
from app.model.moves import Program, Purpose
from app.ui.canvas.curve_path import MANY, chain_path
from app.ui.canvas.modes import ColourBy, PathLayers
from app.ui.canvas.program_geometry import PathStyle, chunks, plunges, shape_moves
from app.ui.canvas.view import View
from app.ui.theme import Theme

CUT_WIDTH, LINK_WIDTH, RAPID_WIDTH = 1.6, 1.0, 1.0
CONTOUR_DASHES, RAPID_DOTS = (3.75, 2.25), (1.2, 2.6)
_LAYER_OF = {
    Purpose.RAPID: PathLayers.RAPID, Purpose.PLUNGE: PathLayers.PLUNGE, Purpose.CONTOUR: PathLayers.CONTOUR,
    Purpose.POCKET: PathLayers.POCKET, Purpose.LINK: PathLayers.LINK, Purpose.LEAD: PathLayers.LEAD,
}
_ORDER = (Purpose.RAPID, Purpose.LINK, Purpose.POCKET, Purpose.LEAD, Purpose.CONTOUR)


@dataclass(frozen=True, slots=True)
class PathLook:
    """How paths are shown."""

    theme: Theme
    layers: PathLayers = PathLayers.ALL
    colour_by: ColourBy = ColourBy.TOOL


def shown_purposes(layers: PathLayers) -> frozenset[Purpose]:
    """Return the purposes of the moves that are visible."""
    return frozenset(purpose for purpose, layer in _LAYER_OF.items() if layer in layers)


class ProgramPicture:
    """One program, ready to paint.

    Attributes:
        shapes: its moves, for picking.
    """

    def __init__(self, program: Program) -> None:
        """Build every path once, in mm."""
        self.shapes = shape_moves(program.moves)
        self._chunks = sorted(chunks(self.shapes), key=lambda c: _ORDER.index(c.style.purpose))
        self._plunges = plunges(self.shapes)
        self._roles = _roles([c.style for c in self._chunks])
        self._regions: dict[int, QPainterPath] = {}
        for region in program.regions:
            path = QPainterPath()
            path.setFillRule(Qt.FillRule.OddEvenFill)
            for contour in region.contours:
                chain_path(contour.primitives, path)
            self._regions[region.number] = path

    def paint(self, painter: QPainter, view: View, box: Box, look: PathLook) -> None:
        """Paint what lies in a box in mm; the painter works in screen px."""
        painter.save()
        painter.setTransform(view.transform(), True)
        if PathLayers.REGION in look.layers:
            self._paint_regions(painter, look)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        seen = [c for c in self._chunks if _LAYER_OF[c.style.purpose] in look.layers and _meet(c.box, box)]
        fine = sum(c.path.elementCount() for c in seen) > MANY
        for chunk in seen:
            pen = self.pen(chunk.style, look, fine)
            if chunk.begins_at:
                pen.setDashOffset(chunk.begins_at * view.scale / pen.widthF())
            painter.setPen(pen)
            painter.drawPath(chunk.path)
        painter.restore()
        if PathLayers.PLUNGE in look.layers:
            self._paint_plunges(painter, view, box, look.theme)

    def pen(self, style: PathStyle, look: PathLook, fine: bool = False) -> QPen:
        """Return the pen for paths of a style; `fine` ones are one px."""
        widths = {Purpose.RAPID: RAPID_WIDTH, Purpose.LINK: LINK_WIDTH, Purpose.LEAD: LINK_WIDTH}
        width = 1.0 if fine else widths.get(style.purpose, CUT_WIDTH)
        pen = QPen(self._colour(style, look), width)
        pen.setCosmetic(True)
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        pen.setJoinStyle(Qt.PenJoinStyle.BevelJoin)
        if style.purpose is Purpose.CONTOUR:
            pen.setDashPattern([d * CUT_WIDTH / width for d in CONTOUR_DASHES])
        elif style.purpose is Purpose.RAPID:
            pen.setDashPattern(list(RAPID_DOTS))
        return pen

    def _colour(self, style: PathStyle, look: PathLook) -> QColor:
        theme = look.theme
        if style.purpose is Purpose.RAPID:
            return theme.rapid
        if look.colour_by is ColourBy.REGION and style.region > 0:
            colour = QColor(theme.regions[(style.region - 1) % len(theme.regions)])
        else:
            colour = QColor(getattr(theme, self._roles.get((style.operation, style.tool), "rest")))
        if style.purpose is Purpose.LINK:
            colour.setAlphaF(0.75)
        return colour

    def _paint_regions(self, painter: QPainter, look: PathLook) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        for number, path in self._regions.items():
            colour = QColor(look.theme.region_fill)
            if look.colour_by is ColourBy.REGION:
                colour = QColor(look.theme.regions[(number - 1) % len(look.theme.regions)])
                colour.setAlphaF(0.10)
            painter.fillPath(path, colour)

    def _paint_plunges(self, painter: QPainter, view: View, box: Box, theme: Theme) -> None:
        reach = 6 / view.scale
        for x, y in self._plunges:
            if not _meet((x - reach, y - reach, x + reach, y + reach), box):
                continue
            at = view.to_screen((x, y))
            painter.setPen(QPen(theme.plunge, 1.4))
            painter.setBrush(theme.canvas)
            painter.drawEllipse(at, 4.4, 4.4)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.plunge)
            painter.drawEllipse(QPointF(at), 1.5, 1.5)


def _roles(styles: list[PathStyle]) -> dict[tuple[int, int], str]:
    """Return the theme's colour name for each (operation, tool): first pocket tool, first contour tool, then rest."""
    roles: dict[tuple[int, int], str] = {}
    first: dict[Purpose, int] = {}
    for style in sorted(styles, key=lambda s: s.operation):
        if style.purpose in (Purpose.POCKET, Purpose.CONTOUR):
            own = first.setdefault(style.purpose, style.tool) == style.tool
            name = "pocket" if style.purpose is Purpose.POCKET else "contour"
            roles[style.operation, style.tool] = name if own else "rest"
    return roles


def _meet(a: Box, b: Box) -> bool:
    return a[0] <= b[2] and a[2] >= b[0] and a[1] <= b[3] and a[3] >= b[1]
