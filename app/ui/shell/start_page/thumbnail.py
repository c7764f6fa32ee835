"""A small picture of what a file holds, made on a worker's thread. Knows pictures, but no widget."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPainterPath, QPen, QTransform

from ....core.progress import Progress
from ....model.curves import Curve
from ....usecases.pixels.options import is_picture
from ....usecases.scene.solid_files import is_solid
from ...framework.theme import Theme
from ...views.canvas.painting.curve_path import curve_path
from ...views.cut.camera import Camera, StandardView
from ...views.nc.program_reader import is_program
from ...views.surfaces.shown_scene import is_scene, read_file, shown_scene

MARGIN_PX = 14
FINER = 3
"""Pixels that each one of a solid's picture is the mean of, across and down: edges are smooth."""

MOST_BYTES = 8_000_000
"""A larger file is not read for the sake of its picture."""


def thumbnail(path: Path, size: QSize, theme: Theme, progress: Progress) -> QImage:
    """Return the picture of a drawing, a project, a scene, a solid, a picture or an NC program.

    Args:
        path: of the file. size: of the picture, px. theme: whose colours it has.

    Raises:
        HitofudeError: it cannot be read. Cancelled: nobody wants to see it any more.
    """
    image = QImage(size, QImage.Format.Format_RGB32)
    image.fill(theme.canvas)
    if path.stat().st_size > MOST_BYTES:
        return image
    if is_picture(path.name):
        _draw_picture(image, path)
    elif is_solid(path.name) or is_scene(path):
        return _space(path, size, theme, progress)
    elif is_program(path):
        _stroke(image, _program_path(path, progress), theme.pocket)
    else:
        _stroke(image, curve_path(*_curves(path)), theme.ink)
    return image


def _curves(path: Path) -> Sequence[Curve]:
    """Return what is drawn in a drawing or a project."""
    from ....formats.project import SUFFIXES
    from ....formats.project.files import load_project
    from ....formats.readers import read_drawing

    if path.suffix.lower() in SUFFIXES:
        part = load_project(path).project.state.job.part
    else:
        part = read_drawing(path.name, read_file(path)).part
    shown = {layer.name for layer in part.layers if layer.visible}
    return [entity.curve for entity in part.entities if entity.layer in shown]


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
    from ...views.surfaces.scene_raster import SceneColours, SceneStyle, raster

    data = read_file(path)
    if is_solid(path.name):
        sources = sources_of(lambda name: read_file(Path(name)))
        data = open_solid(path.name, str(path.absolute()), sources, progress.part(0.0, 0.2)).text().encode()
    shown = shown_scene(path.with_suffix(".toml"), data, progress.part(0.2, 0.9), passes=False)
    wide, high = size.width(), size.height()
    camera = Camera().seen_from(StandardView.ISOMETRIC).fitted(*shown.space.box, (float(wide), float(high)))
    seen = camera.project(shown.space.triangles.reshape(-1, 3), (wide, high))[:, :2]
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
    pixels = raster(shown.space, SceneStyle(camera, inks, ratio=float(FINER)), large).pixels
    image = QImage(pixels.data, *large, 4 * large[0], QImage.Format.Format_RGB32)
    return image.scaled(size, Qt.AspectRatioMode.IgnoreAspectRatio, Qt.TransformationMode.SmoothTransformation)


def _stroke(image: QImage, path: QPainterPath, colour: QColor) -> None:
    """Draw a path in mm so that all of it fits, Y upward."""
    box = path.boundingRect()
    if path.isEmpty():
        return
    wide, high = image.width() - 2 * MARGIN_PX, image.height() - 2 * MARGIN_PX
    scale = min(wide / max(box.width(), 1e-9), high / max(box.height(), 1e-9))
    middle = box.center()
    left, top = image.width() / 2 - scale * middle.x(), image.height() / 2 + scale * middle.y()
    place = QTransform(scale, 0, 0, -scale, left, top)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(colour, 1.3, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin))
    painter.drawPath(place.map(path))
    painter.end()


def _draw_picture(image: QImage, path: Path) -> None:
    picture = QImage(str(path))
    if picture.isNull():
        return
    room = QSize(image.width() - 2 * MARGIN_PX, image.height() - 2 * MARGIN_PX)
    size = picture.size().scaled(room, Qt.AspectRatioMode.KeepAspectRatio)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    left, top = (image.width() - size.width()) / 2, (image.height() - size.height()) / 2
    painter.drawImage(QRectF(left, top, size.width(), size.height()), picture)
    painter.end()


def _rgb(colour: QColor) -> tuple[int, int, int]:
    return colour.red(), colour.green(), colour.blue()
