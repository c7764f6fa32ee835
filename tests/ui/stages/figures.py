"""Figures 2 and 5 of the 1986 text, redrawn by the view itself: `python -m tests.ui.stages.figures` renews the stored
ones.

2a the shape, 2b its offset area filled, 2c the paths; 5a an offset contour, 5b its pixels, 5c the directions of the
chain code, 5d the filled area with its marks. Look at them after they were renewed.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from PySide6.QtGui import QColor, QImage
from PySide6.QtWidgets import QApplication

from app.core.resources import resource
from app.drafting.document import Document
from app.formats.readers import read_drawing
from app.geometry.offset.offset import offset_levels
from app.geometry.primitives import pack
from app.model.job import Job
from app.raster.frame import PixelCode
from app.raster.levels import SAFE_PX
from app.ui.framework import style
from app.ui.framework.theme import LIGHT
from app.ui.views.stages.code_colours import code_colours, table
from app.ui.views.stages.direction_rose import DirectionRose
from app.ui.views.stages.film_set import FilmRequest, film_set_of
from app.ui.views.stages.painting.pixel_painter import PixelPaint
from app.ui.views.stages.view import HEAD_PX, StagesView
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import job_from_drawing
from app.usecases.pixels.options import BitmapSize

FOLDER = Path(__file__).resolve().parents[2] / "data" / "figures"
_SIDE, _SMALL = 560, 32
_LARGE = 820


def sample_job() -> Job:
    """Return the job of the part of figure 2."""
    path = resource("samples", "fig2.dxf")
    return job_from_drawing(read_drawing(path.name, path.read_bytes(), None, ()), MakeOptions())


def small_job() -> Job:
    """Return a job whose contour has an acute corner, a flat top, slopes both ways and an arc."""
    document = Document()
    document.run("line 0,0 28,0 28,13 19,13 19,22 8,22 0,13 0,0")
    return document.job


def by_day() -> None:
    """Give the program the light theme, whatever was there before."""
    application = QApplication.instance()
    assert isinstance(application, QApplication)
    style.apply(application, LIGHT)


def view_of(job: Job, points: int, side: int = _SIDE) -> StagesView:
    """Return a view that shows the stages of a job, its sides about so many px long."""
    by_day()
    reel = film_set_of(FilmRequest(job, BitmapSize(points)))
    view = StagesView()
    view.set_theme(LIGHT)
    view.resize(side + view.rail.width(), side + HEAD_PX)
    view.show()
    QApplication.processEvents()
    view.show_film(reel.film, reel.part.frame)
    view.pixels.show_key(())
    view.pixels.fit_now()
    return view


def stage(view: StagesView, number: int) -> QImage:
    """Return the picture of a step, without its key."""
    assert view.film is not None
    view.show_stage(view.film.seek_step(number, -1))
    view.pixels.show_key(())
    return picture(view)


def picture(view: StagesView) -> QImage:
    """Return what the view shows, fitted, and close it: one that stays open lies over the windows of later tests and
    takes their mouse.
    """
    view.pixels.fit_now()
    image = view.pixels.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    view.close()
    view.deleteLater()
    return image


def offset_contour() -> QImage:
    """Return the line that the pixels of figure 5b are made for, on paper: as far from the drawing as they keep."""
    view = view_of(small_job(), _SMALL, _LARGE)
    assert view.film is not None and view.pixels.pixels is not None
    reel = film_set_of(FilmRequest(small_job(), BitmapSize(_SMALL)))
    wall = min(paths.wall for paths in reel.made.paths) + SAFE_PX * reel.part.frame.pitch
    rows = offset_levels(pack(reel.part.regions), (wall,))[0].rings[0].rows
    paper = np.full(view.film.shape, PixelCode.EMPTY, np.uint8)
    view.pixels.show_pixels(PixelPaint(view.pixels.pixels.frame, paper, table(code_colours(LIGHT))))
    view.pixels.show_rows(rows)
    return picture(view)


def rose() -> QImage:
    """Return the directions of the chain code."""
    by_day()
    widget = DirectionRose()
    image = QImage(widget.size(), QImage.Format.Format_RGB888)
    image.fill(QColor(LIGHT.paper))
    widget.render(image)
    return image


def figures() -> dict[str, Callable[[], QImage]]:
    """Return how each figure is drawn, by its name."""

    def part(number: int) -> Callable[[], QImage]:
        return lambda: stage(view_of(sample_job(), 400), number)

    def small(number: int) -> Callable[[], QImage]:
        return lambda: stage(view_of(small_job(), _SMALL, _LARGE), number)

    return {
        "2a": part(110),
        "2b": part(130),
        "2c": part(140),
        "5a": offset_contour,
        "5b": small(201),
        "5c": rose,
        "5d": small(208),
    }


def pixels_of(image: QImage) -> np.ndarray:
    """Return an image as (rows, cols, 3) numbers."""
    image = image.convertToFormat(QImage.Format.Format_RGB888)
    data = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return data[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(np.int16)


def main() -> None:
    """Renew the stored figures."""
    application = QApplication.instance() or QApplication([])
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, draw in figures().items():
        draw().save(str(FOLDER / f"fig{name}.png"))
        print(FOLDER / f"fig{name}.png")
    application.quit()


if __name__ == "__main__":
    main()
