"""A picture on its way to become a part: read, thresholded, what it encloses, and the places that can be read in two
ways. No Qt.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ....core.atomic import read_whole
from ....core.errors import InputError
from ....core.progress import NO_PROGRESS, Progress
from ....model.job import Job
from ....raster.ambiguities import Ambiguity, ambiguities
from ....raster.faces import ink_meaning, inner_faces
from ....raster.frame import BitmapFrame, PixelCode, Plane
from ....raster.picture import RasterPicture, pitch_of, read_picture, thresholded
from ....raster.picture_file import MM_PER_INCH
from ....raster.picture_options import InkMeaning, PictureOptions

if TYPE_CHECKING:
    from ....usecases.making.bitmap_job import BitmapJob

ASSUMED_DPI = 300.0
"""Pixels an inch of a picture that does not name its size, until somebody says it."""

Place = tuple[float, float]
"""Column and row, px."""


@dataclass(frozen=True)
class PixelSize:
    """How large a pixel is.

    Attributes:
        dpi: pixels an inch. points, apart: two places in the picture and their distance, mm, which then count instead.
    """

    dpi: float = ASSUMED_DPI
    points: tuple[Place, ...] = ()
    apart: float | None = None

    @property
    def pitch(self) -> float:
        """Size of a pixel, mm.

        Raises:
            ParameterError: the two places are one.
        """
        if len(self.points) == 2 and self.apart is not None:
            return pitch_of(*self.points, self.apart)
        return MM_PER_INCH / self.dpi


@dataclass(frozen=True, eq=False)
class PictureSettings:
    """What is wished for a picture.

    Attributes:
        path: its file. options: threshold and so on; the size stands in `measure`.
        names_size: the file says how large a pixel is.
    """

    path: Path
    picture: RasterPicture
    names_size: bool
    options: PictureOptions = field(default_factory=PictureOptions)
    measure: PixelSize = field(default_factory=PixelSize)

    @property
    def frame(self) -> BitmapFrame:
        """Where its pixels lie, mm."""
        rows, cols = self.picture.gray.shape
        return BitmapFrame(rows, cols, self.measure.pitch)


@dataclass(frozen=True, eq=False)
class PicturePreview:
    """How a picture is read.

    Attributes:
        reading: for which. picture: its ink. kind: LINES or AREAS.
        plane: (rows, cols) EMPTY paper, CONTOUR lines of ink, INSIDE what is to be machined.
        places: that can be read in two ways.
    """

    reading: PictureSettings
    picture: RasterPicture
    kind: InkMeaning
    plane: Plane
    places: tuple[Ambiguity, ...]

    def at(self, place: Ambiguity) -> tuple[float, float]:
        """Return where a place lies, mm."""
        x, y = self.reading.frame.to_mm(np.array([(place.col, place.row)]))[0].tolist()
        return x, y


def open_picture(path: Path, progress: Progress = NO_PROGRESS) -> PicturePreview:
    """Read a picture's file.

    Raises:
        InputError: it cannot be read, is damaged or too large.
        Cancelled: by progress.
    """
    progress.step(0.0, f"Reading {path.name}")
    try:
        data = read_whole(path)
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror}. Choose another file.") from error
    try:
        picture, named = read_picture(path.name, data, PictureOptions()), True
    except InputError:
        picture, named = read_picture(path.name, data, PictureOptions(dpi=ASSUMED_DPI)), False
    reading = PictureSettings(path, picture, named, measure=PixelSize(MM_PER_INCH / picture.pitch))
    return preview_of(reading, progress.part(0.4, 1.0))


def preview_of(reading: PictureSettings, progress: Progress = NO_PROGRESS) -> PicturePreview:
    """Read a decoded picture as is wished.

    Raises:
        Cancelled: by progress.
    """
    progress.step(0.1, "Telling ink from paper")
    ink = thresholded(reading.picture.gray, reading.measure.pitch, reading.options)
    picture = replace(ink, stretched=reading.picture.stretched)
    kind = ink_meaning(picture.ink, reading.options.shows)
    plane = np.where(
        picture.ink, PixelCode.CONTOUR if kind is InkMeaning.LINES else PixelCode.INSIDE, PixelCode.EMPTY
    ).astype(np.uint8)
    progress.step(0.4, "Looking for what lines enclose")
    if kind is InkMeaning.LINES:
        plane[inner_faces(picture.ink)] = PixelCode.INSIDE
    progress.step(0.7, "Looking for doubtful places")
    places = ambiguities(picture.ink) if kind is InkMeaning.LINES else ()
    return PicturePreview(reading, picture, kind, plane, places)


def part_of(preview: PicturePreview, before: Job, progress: Progress = NO_PROGRESS) -> BitmapJob:
    """Return the job whose part the picture is, with the tools of the job before.

    Raises:
        HitofudeError: nothing in the picture is to be machined.
        Cancelled: by progress.
    """
    from ....usecases.job.options import MakeOptions
    from ....usecases.making.bitmap_job import picture_job  # imports the engines: never on the window's thread

    reading = preview.reading
    progress.step(0.1, "Following the edges of the pixels")
    picture = replace(preview.picture, pitch=reading.measure.pitch)
    return picture_job(picture, MakeOptions(job=before), reading.options, reading.path.stem)
