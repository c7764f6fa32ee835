"""A sheet as a file, by its suffix."""

from __future__ import annotations

from ..plot.page_pdf import pages_pdf
from .content import SetupSheet
from .html import sheet_html
from .layout import sheet_pages

SUFFIXES = (".pdf", ".html")


def sheet_bytes(sheet: SetupSheet, suffix: str) -> bytes:
    """Return a sheet as a file's bytes.

    Args:
        suffix: one of `SUFFIXES`.
    """
    if suffix == ".html":
        return sheet_html(sheet)
    return pages_pdf(sheet_pages(sheet), f"{sheet.title}: set-up sheet", in_font=True)
