"""A sheet as a file, by its suffix."""

from __future__ import annotations

from ..plot.page_pdf import pages_pdf
from .content import SetupSheet
from .html import sheet_html
from .layout import sheet_pages


def sheet_bytes(sheet: SetupSheet, suffix: str) -> bytes:
    """Return a sheet as a file's bytes.

    Args:
        suffix: one of the folder's `SUFFIXES`.
    """
    if suffix == ".html":
        return sheet_html(sheet)
    return pages_pdf(sheet_pages(sheet), f"{sheet.title}: set-up sheet", in_font=True)
