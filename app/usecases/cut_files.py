"""What a cut leaves, as files: its heights, and a picture of them."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace

from ..formats.plot.height_image import HeightImage, height_image
from ..simulation.heights_file import heights_files
from .cutting.cut import CutProgram
from .cutting.report import CutReport


def heights_of(done: CutProgram) -> tuple[bytes, bytes]:
    """Return the NPY file of the heights and the JSON file that tells where they lie; `read_stock` reads both again."""
    return heights_files(done.cut.workpiece, done.engine_report.engine)


def picture_of(done: CutProgram, title: str) -> bytes:
    """Return the picture of what is left, PNG: gouges red, metal left blue where it was compared with a part."""
    judged, cut = done.judgement, done.cut
    image = HeightImage(cut.heights, cut.before.grid.pitch, done.top, done.floor, title)
    if judged is not None:
        image = replace(image, deviation=judged.deviation, unreachable=judged.unreachable, tolerance=judged.tolerance)
    return height_image(image)


def cut_texts(done: CutProgram, report: CutReport, title: str, requested: Set[str]) -> dict[str, bytes]:
    """Return the files of a cut by what they hold.

    Args:
        title: of the picture.
        requested: which: report, heights, "heights, with its" (where these lie), image.
    """
    texts: dict[str, bytes] = {}
    if "report" in requested:
        texts["report"] = report.text().encode()
    if "heights" in requested:
        texts["heights"], texts["heights, with its"] = heights_of(done)
    if "image" in requested:
        texts["image"] = picture_of(done, title)
    return {name: text for name, text in texts.items() if name in requested}
