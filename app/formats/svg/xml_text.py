"""Bytes of an XML file as a strict parser takes them: what is sure to be meant, though a parser would stop at it."""

from __future__ import annotations

import codecs
import re
from collections.abc import Mapping

_BLANK = b" \t\r\n"
_DECLARATION = b"<?xml"
_ENCODING = re.compile(rb"<\?xml\b[^>]*?\bencoding\s*=\s*[\"']([A-Za-z0-9._-]{1,40})[\"']")
_SEVERAL_BYTES = {"shift_jis": "cp932"} | {
    name: name
    for name in (
        *("cp932", "shift_jis_2004", "shift_jisx0213", "euc_jp", "euc_jis_2004", "euc_jisx0213", "iso2022_jp"),
        *("gb2312", "gbk", "gb18030", "big5", "big5hkscs", "cp950", "euc_kr", "cp949", "johab"),
    )
}
"""Encodings with letters of several bytes, which the parser does not know, and as which one each is read."""
_USED = re.compile(rb"[<\s/]([A-Za-z_][\w.-]{0,40}):[A-Za-z_]")
_DECLARED = re.compile(rb"\bxmlns:([\w.-]+)\s*=")
_ROOT = re.compile(rb"<(?:[A-Za-z_][\w.-]*:)?svg(?=[\s/>])")
_MOST_PREFIXES = 100
_UNKNOWN = "urn:undeclared:"
"""Begins the namespace of a prefix that nobody knows."""


def plainly_encoded(data: bytes) -> bytes:
    """Return a file whose blanks before the declaration stand within it, and whose letters of several bytes are UTF-8:
    every line keeps its number.
    """
    blanks = len(data) - len(data.lstrip(_BLANK))
    if blanks and data.startswith(_DECLARATION, blanks):
        data = _DECLARATION + data[:blanks] + data[blanks + len(_DECLARATION) :]
    found = _ENCODING.match(data)
    try:
        name = _SEVERAL_BYTES.get(codecs.lookup(found[1].decode()).name) if found else None
        text = data.decode(name).encode() if name else b""
    except (LookupError, UnicodeDecodeError):  # the parser says so
        return data
    return text.replace(found[1], b"UTF-8", 1) if found and text else data


def with_prefixes(data: bytes, known: Mapping[str, str]) -> bytes:
    """Return a file in which every prefix of a name is declared: those that stand for nothing known get namespaces of
    their own, in which nobody looks.

    Args:
        known: namespaces by the prefix that they usually have.
    """
    used = dict.fromkeys(each[1] for each in _USED.finditer(data))
    declared = {each[1] for each in _DECLARED.finditer(data)} | {b"xml", b"xmlns"}
    missing = [prefix.decode() for prefix in used if prefix not in declared][:_MOST_PREFIXES]
    spaces = "".join(f' xmlns:{prefix}="{known.get(prefix, _UNKNOWN + prefix)}"' for prefix in missing)
    return _ROOT.sub(lambda root: root[0] + spaces.encode(), data, count=1)
