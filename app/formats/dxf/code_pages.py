"""Letters of a DXF in text: in UTF-8 since R2007, before that in the code page that its header names, unless its bytes
say otherwise.
"""

from __future__ import annotations

import codecs
import re
from itertools import compress

HEAD = 1 << 16
"""Bytes of the beginning in which version and code page have to stand."""
MOST_BYTES = 200 << 20
"""A larger file would take gigabytes before anything of it is known."""
_LINES = re.IGNORECASE | re.MULTILINE
_CODEPAGE = re.compile(rb"\$DWGCODEPAGE[ \t]*\r?[\n\r][ \t]*0*3[ \t]*\r?[\n\r][ \t]*(\S+)", _LINES)
_VERSION = re.compile(rb"\$ACADVER[ \t]*\r?[\n\r][ \t]*0*1[ \t]*\r?[\n\r][ \t]*(AC\d+)", _LINES)
_FIRST_UTF8 = b"AC1021"
"""The version, R2007, from which on letters are in UTF-8."""
_BYTE_ORDERS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
_BEYOND_ASCII = re.compile("[^\0-\x7f\U00010000-\U0010ffff]")
"""Letters that are escaped by four digits; a set from 80 to FFFF would say the same, and take 5 ms to compile."""
_OF_THREE_BYTES = re.compile(rb"[\xe0-\xef][\x80-\xbf]{2}")
_NAMED = re.compile(r"(ansi|dos|iso[-_]?8859)[-_]?(\d+)")
_NAMES = {
    "ansi_1200": "utf-8",
    "ansi_65001": "utf-8",
    "ansi_1361": "johab",
    "dos932": "cp932",
    "ansi_936": "gbk",
    "gb2312": "gbk",
    "big5": "cp950",
    "ksc5601": "cp949",
    "johab": "johab",
    "sjis": "cp932",
    "macintosh": "mac-roman",
    "mac-roman": "mac-roman",
    "utf-8": "utf-8",
    "utf8": "utf-8",
    "ascii": "cp1252",
}
"""Code pages that are not called by their number, or not as Python calls that."""
_OF_SEVERAL_BYTES = ("cp932", "gbk", "cp950", "cp949", "johab")
"""Encodings in which letters of Europe in UTF-8 may be something too."""


def encoding(head: bytes) -> str:
    """Return the text encoding that a file tells: UTF-8 since R2007, before that the code page that the header names.

    Args:
        head: its beginning.
    """
    return "utf-8" if _is_unicode(head) else _page(head) or "cp1252"


def _is_unicode(head: bytes) -> bool:
    version = _VERSION.search(head)
    return version is not None and version[1].upper() >= _FIRST_UTF8


def with_told_letters(data: bytes) -> bytes:
    """Return a text file whose letters are as its version and code page tell: one without a mark of the order of its
    bytes, and one that tells something else than it has, as plain letters.

    Numbers and lines stay as they are; letters of a file of before R2007 are escaped, since it is in a code page.
    """
    if len(data) > 2 * MOST_BYTES:
        return data
    mark = next((each for each in _BYTE_ORDERS if data.startswith(each)), None)
    meant = _BYTE_ORDERS[mark] if mark is not None else _meant(data)
    if meant == "":
        return data
    whole = mark is not None or meant == "utf-8"
    return _plain(data.decode(meant, "replace") if whole else _by_lines(data, meant))


def _by_lines(data: bytes, page: str) -> str:
    """Return the text of a file that should be in UTF-8 and is not throughout: one line that was put in by a program of
    old does not change the others.
    """
    lines = data.splitlines(keepends=True)
    kept = [not line.isascii() and _is_utf8(line) for line in lines]
    if page in _OF_SEVERAL_BYTES and not any(map(_OF_THREE_BYTES.search, compress(lines, kept))):
        return data.decode(page, "replace")
    return "".join(
        line.decode("utf-8" if stays or line.isascii() else page, "replace")
        for line, stays in zip(lines, kept, strict=True)
    )


def plain_letters(data: bytes) -> bytes:
    """Return a text file whose letters any reader finds: in UTF-8, or escaped in one of before R2007."""
    return data if data.isascii() else _plain(data.decode(encoding(data[:HEAD]), "replace"))


def _plain(text: str) -> bytes:
    if _is_unicode(text[:HEAD].encode()):
        return text.encode()
    return _BEYOND_ASCII.sub(lambda letter: f"\\U+{ord(letter[0]):04X}", text).encode()


def _meant(data: bytes) -> str:
    """Return the encoding that a file, or lines of it, has and does not tell, "" where it tells what it has."""
    if data.isascii() or b"\0" in data[:HEAD]:
        return ""
    told, page = encoding(data[:HEAD]), _page(data[:HEAD])
    if not _is_utf8(data):
        return page or "cp1252" if told == "utf-8" else ""
    sure = page not in _OF_SEVERAL_BYTES or _OF_THREE_BYTES.search(data)
    return "utf-8" if sure and told != "utf-8" else ""


def _is_utf8(data: bytes) -> bool:
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


def _page(head: bytes) -> str:
    """Return the encoding of the code page that a file names; "" for none, or for one that nobody knows."""
    found = _CODEPAGE.search(head)
    name = found[1].decode("ascii", "replace").lower() if found else ""
    number = _NAMED.fullmatch(name)
    spelled = _NAMES.get(name) or (f"{'iso8859-' if number[1][0] == 'i' else 'cp'}{number[2]}" if number else "")
    try:
        return codecs.lookup(spelled).name and spelled
    except LookupError:
        return ""
