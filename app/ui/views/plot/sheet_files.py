"""Sheets as files: PDF of any number, SVG and PNG a sheet each, HP-GL/2 for plotters."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QBuffer, QByteArray, QIODevice, QMarginsF, QSizeF, Qt
from PySide6.QtGui import QImage, QImageWriter, QPagedPaintDevice, QPageLayout, QPageSize, QPainter, QPdfWriter

from .... import __version__
from ....core.errors import InputError
from ....formats.plot.hpgl import hpgl_bytes
from ....formats.plot.page_svg import page_svg
from .sheet_painter import PlotSheet, paint

FORMATS = {".pdf": "PDF", ".svg": "SVG", ".png": "PNG", ".plt": "HP-GL/2 for plotters"}
FILTER = ";;".join(f"{name} (*{suffix})" for suffix, name in FORMATS.items())
_PDF_DPI = 1200
_PNG_DPI = 300
_MOST_PIXELS = 64e6
_MM_PER_INCH = 25.4


def plot_files(path: Path, sheets: Sequence[PlotSheet], name: str) -> dict[Path, bytes]:
    """Return the bytes of each file by its place: one, or of SVG and PNG one a sheet, numbered.

    Args:
        path: its suffix is the format. sheets: what to write. name: title in the files.

    Raises:
        InputError: the suffix is none of FORMATS.
    """
    suffix = path.suffix.lower()
    if suffix == ".pdf":
        return {path: pdf_bytes(sheets, name)}
    if suffix == ".plt":
        return {path: hpgl_bytes(sheet.page for sheet in sheets)}
    if suffix not in FORMATS:
        raise InputError(f"{path.name} names no format; end it in {', '.join(FORMATS)}.")
    paths = (
        [path]
        if len(sheets) == 1
        else [path.with_stem(f"{path.stem}-{number}") for number in range(1, len(sheets) + 1)]
    )
    return {
        each: page_svg(sheet.page, name) if suffix == ".svg" else png_bytes(sheet)
        for each, sheet in zip(paths, sheets, strict=True)
    }


def pdf_bytes(sheets: Sequence[PlotSheet], name: str) -> bytes:
    """Return all sheets as PDF at true size; lines and curves stay what they are."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    writer = QPdfWriter(buffer)
    writer.setTitle(name)
    writer.setCreator(f"Hitofude {__version__}")
    writer.setResolution(_PDF_DPI)
    page = sheets[0].page
    size = QPageSize(
        QSizeF(page.width, page.height), QPageSize.Unit.Millimeter, "", QPageSize.SizeMatchPolicy.ExactMatch
    )
    writer.setPageLayout(QPageLayout(size, QPageLayout.Orientation.Portrait, QMarginsF()))
    painter = QPainter(writer)
    paint_all(painter, sheets, writer)
    painter.end()
    return bytes(buffer.data().data())


def paint_all(painter: QPainter, sheets: Sequence[PlotSheet], device: QPagedPaintDevice) -> None:
    """Paint sheets one after another on a device that turns pages and has no margins."""
    painter.scale(device.logicalDpiX() / _MM_PER_INCH, device.logicalDpiY() / _MM_PER_INCH)
    for number, sheet in enumerate(sheets):
        if number:
            device.newPage()
        paint(painter, sheet)


def png_bytes(sheet: PlotSheet) -> bytes:
    """Return a sheet as PNG, 300 dots an inch, or as many as 64 million pixels allow; the file tells."""
    page = sheet.page
    per_mm = min(_PNG_DPI / _MM_PER_INCH, (_MOST_PIXELS / (page.width * page.height)) ** 0.5)
    image = QImage(round(page.width * per_mm), round(page.height * per_mm), QImage.Format.Format_RGB32)
    image.setDotsPerMeterX(round(1000 * per_mm))
    image.setDotsPerMeterY(round(1000 * per_mm))
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.scale(per_mm, per_mm)
    paint(painter, sheet)
    painter.end()
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    QImageWriter(buffer, QByteArray(b"png")).write(image)
    return bytes(buffer.data().data())
