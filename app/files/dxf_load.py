"""Bytes to a DXF document, text or binary, sound or damaged; everything else is refused in one sentence."""

from __future__ import annotations

import io
import logging
import re
from dataclasses import dataclass, replace
from typing import Any

from app.errors import InputError
from app.files.dxf_numbers import NO_COMMAS, Commas, with_points

_BINARY = b"AutoCAD Binary DXF\r\n\x1a\x00"
_SECTION = re.compile(rb"^\s*0[ \t]*\r?[\n\r][ \t]*SECTION", re.MULTILINE)
_CODEPAGE = re.compile(rb"\$DWGCODEPAGE[ \t]*\r?\n[ \t]*3[ \t]*\r?\n[ \t]*(\S+)")
_VERSION = re.compile(rb"\$ACADVER[ \t]*\r?\n[ \t]*1[ \t]*\r?\n[ \t]*(AC\d+)")
logging.getLogger("ezdxf").addHandler(logging.NullHandler())  # what it has to say is in our own findings
_HEAD, _TAIL = 1 << 16, 1 << 12


@dataclass(frozen=True)
class Loaded:
    """A document of the library, and what had to be done to read it.

    Attributes:
        repaired: how many faults in it had to be repaired.
        commas: where decimal commas stood, if they did.
    """

    document: Any
    repaired: int = 0
    commas: Commas = NO_COMMAS


def load(data: bytes, name: str) -> Loaded:
    """Return what a file holds.

    Args:
        data: the whole file.
        name: for messages.

    Raises:
        InputError: the data is empty, no DXF, cut short, or damaged beyond repair; or a number in it is none.
    """
    _refuse_others(data, name)
    try:
        return Loaded(_load_sound(data))
    except Exception as fault:  # whatever a parser makes of a damaged file: the repairing reader gets its turn
        reason = fault
    commas = Commas(data) if data.startswith(_BINARY) else with_points(data, name)
    if commas.count:
        try:
            return Loaded(_load_sound(commas.data), 0, replace(commas, data=b""))
        except Exception as fault:  # it has other faults too
            data, reason = commas.data, fault
    try:
        from ezdxf import recover

        document, auditor = recover.read(io.BytesIO(data))
    except Exception as error:  # a third-party parser on any bytes at all: its faults must not reach the user raw
        raise InputError(f"{name}: the DXF is damaged and cannot be repaired ({_short(reason)}); "
                         "save it again from the CAD program.") from error
    return Loaded(document, max(1, len(auditor.errors) + len(auditor.fixes)), replace(commas, data=b""))


def _refuse_others(data: bytes, name: str) -> None:
    if not data.strip():
        raise InputError(f"{name}: the file is empty; export the drawing again.")
    if data.startswith(_BINARY):
        return
    if re.match(rb"AC10\d\d\x00", data):
        raise InputError(f"{name}: this is a DWG file; save the drawing as DXF.")
    if not _SECTION.search(data[:_HEAD]):
        raise InputError(f"{name}: this is not a DXF file, no section begins in it; export the drawing as DXF (ASCII or binary).")
    if b"EOF" not in data[-_TAIL:]:
        raise InputError(f"{name}: the DXF is cut short, its end mark EOF is missing after {len(data)} bytes; copy or export it again.")


def _load_sound(data: bytes) -> Any:
    import ezdxf  # noqa: F401 (the whole before its parts: else, while another thread imports it too, parts are found half made)
    from ezdxf.document import Drawing
    from ezdxf.filemanagement import read
    from ezdxf.lldxf.encoding import decode_dxf_unicode
    from ezdxf.lldxf.tagger import binary_tags_loader

    if data.startswith(_BINARY):
        return Drawing.load(binary_tags_loader(data, errors="surrogateescape"))
    if b"\\U+" not in data:
        return read(io.TextIOWrapper(io.BytesIO(data), encoding=_encoding(data[:_HEAD]), errors="surrogateescape"))
    text = decode_dxf_unicode(data.decode(_encoding(data[:_HEAD]), "surrogateescape"))
    return read(io.StringIO(text, newline=None))


def _encoding(head: bytes) -> str:
    """Return the text encoding: UTF-8 since R2007, before that the code page that the header names."""
    version, page = _VERSION.search(head), _CODEPAGE.search(head)
    if version and version[1] >= b"AC1021":
        return "utf-8"
    if page is None:
        return "cp1252"
    from ezdxf.tools.codepage import toencoding

    return str(toencoding(page[1].decode("ascii", "replace")))


def _short(error: Exception) -> str:
    """Return the first line of an error's text, for a message of one line."""
    lines = str(error).splitlines()
    return (lines[0] if lines else type(error).__name__)[:120]
