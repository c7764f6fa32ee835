"""A sheet as a file, by its suffix."""

from __future__ import annotations

from ...core.errors import InputError
from ..plot.page_pdf import pages_pdf
from ..plot.pdf_fonts import has_letters
from .content import SetupSheet
from .html import sheet_html
from .layout import sheet_pages
from .translated import translated


def sheet_bytes(sheet: SetupSheet, suffix: str, language: str = "en") -> bytes:
    """Return a sheet as a file's bytes.

    Args:
        suffix: one of the folder's `SUFFIXES`. language: code of one of the program's.

    Raises:
        InputError: no font of this machine has the letters of that language, which a PDF has to hold.
    """
    sheet = translated(sheet, language)
    if suffix == ".html":
        return sheet_html(sheet)
    if language != "en" and not has_letters(sheet.verdict):
        raise InputError(_NO_FONT)
    return pages_pdf(sheet_pages(sheet), f"{sheet.title}: {sheet.words.sheet}", in_font=True)


_NO_FONT = (
    "No font of this machine that may be put into a PDF has Japanese letters; install one, such as Noto Sans CJK JP or "
    "IPAGothic, or write the sheet as .html."
)
