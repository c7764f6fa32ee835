"""A small picture of what a file holds, made on a worker's thread. Knows pictures, but no widget."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from PySide6.QtCore import QLineF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPainterPath, QPen, QTransform

from ....core.progress import Progress
from ....geometry.chaining.chain import chain
from ....model.part import Entity
from ....usecases.pixels.options import is_picture
from ....usecases.scene.solid_files import is_solid
from ...framework.theme import Theme, mixed
from ...views.canvas.painting.curve_path import chain_path, curve_path
from ...views.cut.camera import Camera, StandardView
from ...views.nc.program_reader import is_program
from ...views.surfaces.scene_raster import SceneColours, SceneLayer, SceneStyle, raster
from ...views.surfaces.shown_scene import ScenePicture, is_scene, read_file, shown_scene

MARGIN_PX = 14
FINER = 3
"""Pixels that each one of a solid's picture is the mean of, across and down: edges are smooth."""

_TINT, _MOST_FILLED = 0.10, 3_000
_DENSE, _FAINTEST = 0.5, 0.08
_PLAN_PX, _WITHIN = 400, 0.7

MOST_BYTES = 8_000_000
"""A larger file is not read for the sake of its picture."""


def thumbnail(path: Path, size: QSize, theme: Theme, progress: Progress) -> QImage:
    """Return the picture of a drawing, a project, a scene, a solid, a picture or an NC program; none where there is
    nothing to be seen.

    Args:
        path: of the file. size: of the picture, px. theme: whose colours it has.

    Raises:
        HitofudeError: it cannot be read. Cancelled: nobody wants to see it any more.
    """
    image = QImage(size, QImage.Format.Format_RGB32)
    image.fill(theme.canvas)
    if path.stat().st_size > MOST_BYTES:
        return QImage()
    if is_picture(path.name):
        return _draw_picture(image, path)
    if is_solid(path.name) or is_scene(path):
        return _space(path, size, theme, progress)
    if is_program(path):
        return _draw_way(image, _program_path(path, progress), theme.pocket)
    return _draw_part(image, _entities(path), theme)


def _entities(path: Path) -> list[Entity]:
    """Return what is drawn in a drawing or a project."""
    from ....formats.project import SUFFIXES
    from ....formats.project.files import load_project
    from ....formats.readers import read_drawing

    if path.suffix.lower() in SUFFIXES:
        part = load_project(path).project.state.job.part
    else:
        part = read_drawing(path.name, read_file(path)).part
    shown = {layer.name for layer in part.layers if layer.visible}
    return [entity for entity in part.entities if entity.layer in shown]


def _area(entities: Sequence[Entity]) -> QPainterPath:
    """Return what closed outlines enclose, mm: every second one within another is a hole. Layers with open lines are
    engraved, and enclose nothing; nor do very many curves.
    """
    area = QPainterPath()
    if len(entities) > _MOST_FILLED:
        return area
    contours = chain(entities).contours
    engraved = {contour.layer for contour in contours if not contour.closed}
    for contour in contours:
        if contour.layer not in engraved:
            chain_path(contour.primitives, area)
    return area


def _program_path(path: Path, progress: Progress) -> QPainterPath:
    """Return the way of a program's cuts, seen from above."""
    from ....gcode.interpreter.dialect_guess import guess_dialect
    from ....gcode.interpreter.options import PATIENT, ReadOptions
    from ....gcode.interpreter.reader import read_program
    from ....model.motion import MotionKind

    data, way, lifted = read_file(path), QPainterPath(), True
    motions = read_program(data, ReadOptions(guess_dialect(data), {}, limits=PATIENT), progress).motions
    at = (0.0, 0.0)
    cuts, goes = motions.kind != MotionKind.RAPID, np.isfinite(motions.end).all(axis=1)
    for cut, (x, y) in zip((cuts & goes).tolist(), np.nan_to_num(motions.end[:, :2]).tolist(), strict=True):
        if not cut:  # a rapid lifts the pen, and so does a place that nobody knows
            lifted = True
        elif lifted:
            way.moveTo(*at)
            lifted = False
        if cut:
            way.lineTo(x, y)
        at = (x, y)
    return way


def _space(path: Path, size: QSize, theme: Theme, progress: Progress) -> QImage:
    """Return a scene's surfaces, or a solid, seen from above one corner."""
    from ....formats.scene.toml import sources_of
    from ....usecases.scene.solid_scene import open_solid

    data, scene = read_file(path), not is_solid(path.name)
    if not scene:
        sources = sources_of(lambda name: read_file(Path(name)))
        data = open_solid(path.name, str(path.absolute()), sources, progress.part(0.0, 0.2)).text().encode()
    shown = shown_scene(path.with_suffix(".toml"), data, progress.part(0.2, 0.9), passes=False)
    space = _topmost(shown.space) if scene else shown.space
    wide, high = size.width(), size.height()
    camera = Camera().seen_from(StandardView.ISOMETRIC).fitted(*space.box, (float(wide), float(high)))
    seen = camera.project(space.triangles.reshape(-1, 3), (wide, high))[:, :2]
    low, high_px = seen.min(axis=0), seen.max(axis=0)
    room = np.array([wide, high]) - 2.0 * MARGIN_PX
    larger = float(np.min(room / np.maximum(high_px - low, 1e-6)))
    aside = (np.array([wide, high]) - low - high_px) / 2 * larger
    camera = replace(camera, scale=camera.scale * larger).panned(float(aside[0]), float(aside[1]))
    inks = SceneColours(
        _rgb(theme.canvas),
        _rgb(theme.ink),
        _rgb(theme.rapid),
        _rgb(theme.plunge),
        [_rgb(QColor(colour)) for colour in shown.colours],
    )
    large = FINER * wide, FINER * high
    pixels = raster(space, SceneStyle(camera, inks, SceneLayer.SURFACES, ratio=float(FINER)), large).pixels
    image = QImage(pixels.data, *large, 4 * large[0], QImage.Format.Format_RGB32)
    return image.scaled(size, Qt.AspectRatioMode.IgnoreAspectRatio, Qt.TransformationMode.SmoothTransformation)


def _topmost(space: ScenePicture) -> ScenePicture:
    """Return a scene without what lies below other surfaces: what is left is what is machined."""
    style = SceneStyle(
        Camera().seen_from(StandardView.TOP).fitted(*space.box, (_PLAN_PX, _PLAN_PX)),
        SceneColours((0, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0), [(0, 0, 0)] * (int(space.owner.max(initial=0)) + 1)),
        SceneLayer.SURFACES,
        coarse=True,
    )
    owners = raster(space, style, (_PLAN_PX, _PLAN_PX)).owners
    corners = space.triangles.mean(axis=1, keepdims=True) * (1 - _WITHIN) + space.triangles * _WITHIN
    seen = style.camera.project(corners.reshape(-1, 3), (_PLAN_PX, _PLAN_PX))[:, :2]
    columns, rows = np.clip(seen.astype(int), 0, _PLAN_PX - 1).T
    on_top = (owners[rows, columns].reshape(-1, 3) == space.owner[:, None]).any(axis=1)
    return replace(space, strands=(), triangles=space.triangles[on_top], owner=space.owner[on_top])


def _place(image: QImage, path: QPainterPath) -> QTransform:
    """Return the transform that fits a path in mm into an image, Y upward."""
    box = path.boundingRect()
    wide, high = image.width() - 2 * MARGIN_PX, image.height() - 2 * MARGIN_PX
    scale = min(wide / max(box.width(), 1e-9), high / max(box.height(), 1e-9))
    middle = box.center()
    left, top = image.width() / 2 - scale * middle.x(), image.height() / 2 + scale * middle.y()
    return QTransform(scale, 0, 0, -scale, left, top)


def _draw_part(image: QImage, entities: Sequence[Entity], theme: Theme) -> QImage:
    """Draw curves, and what they enclose in a tint."""
    path = curve_path(*(entity.curve for entity in entities))
    if path.isEmpty():
        return QImage()
    place, painter = _place(image, path), QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.fillPath(place.map(_area(entities)), mixed(theme.canvas, theme.pocket, _TINT))
    painter.setPen(QPen(theme.ink, 1.3, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin))
    painter.drawPath(place.map(path))
    painter.end()
    return image


def _draw_way(image: QImage, path: QPainterPath, colour: QColor) -> QImage:
    """Draw the way of a tool; where lines lie so dense that they would be one patch, they shine through."""
    box = path.boundingRect()
    if path.isEmpty() or max(box.width(), box.height()) <= 0.0:
        return QImage()
    place, painter, ink = _place(image, path), QPainter(image), QColor(colour)
    drawn = place.map(path)
    seen, length = drawn.boundingRect(), drawn.length()
    ink.setAlphaF(min(1.0, max(_FAINTEST, _DENSE * seen.width() * seen.height() / max(length, 1.0))))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    if ink.alphaF() == 1.0:
        painter.setPen(QPen(ink, 1.3, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin))
        painter.drawPath(drawn)
    else:
        painter.setPen(QPen(ink, 1.0))
        for run in drawn.toSubpathPolygons():  # line by line, as a path of many lines covers a place but once
            painter.drawLines([QLineF(*pair) for pair in pairwise(run.toList())])
    painter.end()
    return image


def _draw_picture(image: QImage, path: Path) -> QImage:
    picture = QImage(str(path))
    if picture.isNull():
        return picture
    room = QSize(image.width() - 2 * MARGIN_PX, image.height() - 2 * MARGIN_PX)
    size = picture.size().scaled(room, Qt.AspectRatioMode.KeepAspectRatio)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    left, top = (image.width() - size.width()) / 2, (image.height() - size.height()) / 2
    painter.drawImage(QRectF(left, top, size.width(), size.height()), picture)
    painter.end()
    return image


def _rgb(colour: QColor) -> tuple[int, int, int]:
    return colour.red(), colour.green(), colour.blue()
