"""A sheet as a file, by its suffix; in another language what the program says on it is looked up, names and figures
stay.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import fields, replace
from functools import partial

from ...core.catalogue import Catalogue, catalogue
from ...core.errors import InputError
from ..plot.page_pdf import pages_pdf
from ..plot.pdf_fonts import has_letters
from .content import SetupSheet, SheetTable, SheetWords
from .html import sheet_html
from .layout import sheet_pages


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


_SENTENCE = re.compile(r"(?<=[.?!]) +")

Words = Callable[[str], str]


def translated(sheet: SetupSheet, language: str) -> SetupSheet:
    """Return a sheet in a language.

    What the catalogue lacks stays as it is, names and figures, and so does what somebody has written in his own words.

    Args:
        language: code, such as "ja"; "en" is what sheets are in.
    """
    if language == "en":
        return sheet
    known = catalogue(language)
    words, items = partial(_found, known), partial(_items, known)
    return replace(
        sheet,
        program=words(sheet.program),
        verdict=words(sheet.verdict),
        picture=replace(sheet.picture, legend=tuple((words(word), line) for word, line in sheet.picture.legend)),
        facts=tuple(replace(each, label=words(each.label), text=_sentences(each.text, items)) for each in sheet.facts),
        tables=tuple(_table(each, items) for each in sheet.tables),
        proofs=tuple(replace(each, claim=words(each.claim), bound=words(each.bound)) for each in sheet.proofs),
        findings=tuple(map(words, sheet.findings)),
        remarks=tuple(map(words, sheet.remarks)),
        hashes=tuple(replace(each, what=words(each.what)) for each in sheet.hashes),
        language=language,
        words=SheetWords(**{each.name: words(getattr(sheet.words, each.name)) for each in fields(sheet.words)}),
    )


def _found(known: Catalogue, text: str) -> str:
    """Return a text as the catalogue has it, or as it is."""
    return known.look_up(text) or text


def _sentences(text: str, items: Words) -> str:
    """Return sentences each of which is looked up."""
    return " ".join(map(items, _SENTENCE.split(text))).replace("。 ", "。")


def _table(table: SheetTable, items: Words) -> SheetTable:
    columns = tuple(replace(column, title=items(column.title)) for column in table.columns)
    *rows, total = (tuple(map(items, row)) for row in (*table.rows, table.total))
    return replace(table, title=items(table.title), columns=columns, rows=tuple(rows), total=total)


def _items(known: Catalogue, text: str) -> str:
    """Return a text that may be a list: each item is looked up, also as a title that is written small there."""
    items = text.split(", ")
    found = [known.look_up(item) or known.look_up(item.capitalize()) for item in items]
    whole = known.look_up(text) if None in found else None
    return whole or known.joined([other or item for other, item in zip(found, items, strict=True)])
