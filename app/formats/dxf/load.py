"""Bytes to a DXF document, text or binary, sound or damaged; everything else is refused in one sentence."""

from __future__ import annotations

import io
import logging
import re
import sys
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib import import_module
from types import ModuleType
from typing import Any

from ...core.errors import InputError
from ..drawing_account import MOST_CURVES
from . import subclass_marks
from .code_pages import HEAD, MOST_BYTES, encoding, plain_letters
from .numbers import NO_COMMAS, DecimalCommas, with_points
from .sections import sections_of, strays_of, tidied, without_empty_variables
from .splines import MOST_POINTS, too_many

_BINARY = b"AutoCAD Binary DXF\r\n\x1a\x00"

_LINES = re.IGNORECASE | re.MULTILINE

_SECTION = re.compile(rb"^[ \t]*0+[ \t]*\r?\n[ \t]*SECTION\b", _LINES)

_ENTITIES = re.compile(
    rb"^[ \t]*0+[ \t]*\r?\n[ \t]*SECTION[ \t]*\r?\n[ \t]*0*2[ \t]*\r?\n[ \t]*ENTITIES[ \t]*\r?\n", _LINES
)
_FILE_END = re.compile(rb"^[ \t]*0+[ \t]*\r?\n[ \t]*EOF\b", _LINES)
_WHOLE = re.compile(rb"^[ \t]*0+[ \t]*\r?\n[ \t]*ENDSEC\s*\Z", _LINES)
_END_MARK = b"\n0\nEOF\n"

logging.getLogger("ezdxf").addHandler(logging.NullHandler())  # what it has to say is in our own findings

_TAIL = 1 << 12
"""Bytes of the end in which its mark stands."""

_ENDLESS = re.compile(
    rb"^[ \t]*0+[ \t]*\r?\n[ \t]*(SPLINE|LWPOLYLINE)[ \t]*\r?\n(?:[ \t]*0*[1-9]\d*[ \t]*\r?\n[^\n]*+\n)*+", _LINES
)

_POINT = re.compile(rb"^[ \t]*0*1([01])[ \t]*\r?\n[^\n]*\n[ \t]*0*2[01][ \t]*\r?\n", re.MULTILINE)

_OF_MANY_POINTS = re.compile(rb"(?:LWPOLY|SP)LINE", re.IGNORECASE)

_SUSPECT = 1 << 20
"""Bytes of an entity; a shorter one has not too many points."""


@dataclass(frozen=True)
class LoadedDocument:
    """A document of the library, and what had to be done to read it.

    Attributes:
        repaired: how many faults in it had to be repaired.
        repeated: names of blocks that are there once more, which is left out.
        strays: what stands where nothing is drawn, by its type.
        commas: where decimal commas stood, if they did.
    """

    document: Any
    repaired: int = 0
    repeated: tuple[str, ...] = ()
    strays: Mapping[str, int] = field(default_factory=dict)
    commas: DecimalCommas = NO_COMMAS


def load(data: bytes, name: str) -> LoadedDocument:
    """Return what a file holds.

    Args:
        data: the whole file, without a mark of the order of its bytes.
        name: for messages.

    Raises:
        InputError: the data is empty, no DXF, cut short, or damaged beyond repair; or a number in it is none.
    """
    data, unended = _with_end(_with_line_feeds(data))
    _refuse_others(data, name)
    try:
        return _load_sound(data, unended)
    except Exception as fault:  # whatever a parser makes of a damaged file: the repairing reader gets its turn
        reason = fault
    commas = DecimalCommas(data) if data.startswith(_BINARY) else with_points(data, name)
    if commas.count:
        try:
            return replace(_load_sound(commas.data, 0), commas=replace(commas, data=b""))
        except Exception as fault:  # it has other faults too
            data, reason = commas.data, fault
    try:
        loaded = _load_damaged(data if data.startswith(_BINARY) else plain_letters(data))
        _probed(loaded.document)
    except Exception as error:  # a third-party parser on any bytes at all: its faults must not reach the user raw
        raise InputError(
            f"{name}: the DXF is damaged and cannot be repaired ({_short(reason)}); save it again from the CAD program."
        ) from error
    return replace(loaded, repaired=max(1, loaded.repaired), commas=replace(commas, data=b""))


def _with_line_feeds(data: bytes) -> bytes:
    """Return a text with a line feed in place of every carriage return that stands alone, as old systems end lines."""
    if data.startswith(_BINARY) or data.count(b"\r") == data.count(b"\r\n"):
        return data
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")


def _with_end(data: bytes) -> tuple[bytes, int]:
    """Return a file without blank lines before it and with its end mark, and how many marks (0, 1) had to be put in.

    One is where the section of entities is there to its end, so that nothing of the drawing is missing.
    """
    if data.startswith(_BINARY):
        return data, 0
    data = data.lstrip()
    if _has_end(data) or not _WHOLE.search(data[-_TAIL:]) or not _ENTITIES.search(data):
        return data, 0
    return data.rstrip() + _END_MARK, 1


def _has_end(data: bytes) -> bool:
    """Tell whether the end mark is there; what follows it, zeros of a disk or another text, is nothing."""
    return (_FILE_END.search(data, max(len(data) - _TAIL, 0)) or _FILE_END.search(data)) is not None


def _refuse_others(data: bytes, name: str) -> None:
    if not data.strip():
        raise InputError(f"{name}: the file is empty; export the drawing again.")
    if len(data) > MOST_BYTES:
        raise InputError(
            f"{name}: the file has {len(data) >> 20} MB, more than {MOST_BYTES >> 20}; save the drawing in parts."
        )
    if data.startswith(_BINARY):
        return
    if re.match(rb"AC10\d\d\x00", data):
        raise InputError(f"{name}: this is a DWG file; save the drawing as DXF.")
    if not _SECTION.search(data[:HEAD]):
        raise InputError(
            f"{name}: this is not a DXF file, no section begins in it; export the drawing as DXF (ASCII or binary)."
        )
    if not _has_end(data):
        raise InputError(
            f"{name}: the DXF is cut short, its end mark EOF is missing after {len(data)} bytes; copy or export it "
            "again."
        )
    _refuse_endless_curves(data, name)


def _refuse_endless_curves(data: bytes, name: str) -> None:
    """Refuse splines and polylines of more points than are read, before the library makes objects of them all."""
    at = 0
    for word in _OF_MANY_POINTS.finditer(data):
        begin = data.rfind(b"\n", 0, max(data.rfind(b"\n", 0, word.start()), 0)) + 1
        found = _ENDLESS.match(data, begin) if word.start() >= at else None
        if found is None:
            continue
        at = found.end()
        if found.end() - found.start() > _SUSPECT:
            kinds = Counter(each[1] for each in _POINT.finditer(found[0]))
            most, what = (MOST_POINTS, "spline") if found[1].upper() == b"SPLINE" else (MOST_CURVES, "polyline")
            if kinds and max(kinds.values()) > most:
                line = data.count(b"\n", 0, found.start()) + 1
                raise InputError(f"{name}:{line}: {too_many(max(kinds.values()), most, what)}")


def _load_sound(data: bytes, repaired: int) -> LoadedDocument:
    """Return the document of a file in which so many faults were repaired before."""
    load_ezdxf()
    from ezdxf.lldxf.encoding import decode_dxf_unicode
    from ezdxf.lldxf.tagger import ascii_tags_loader, binary_tags_loader, tag_compiler

    if data.startswith(_BINARY):
        tags = binary_tags_loader(data, errors="surrogateescape")
    elif b"\\U+" not in data:
        stream = io.TextIOWrapper(io.BytesIO(data), encoding=encoding(data[:HEAD]), errors="surrogateescape")
        tags = ascii_tags_loader(stream)
    else:
        text = decode_dxf_unicode(data.decode(encoding(data[:HEAD]), "surrogateescape"))
        tags = ascii_tags_loader(io.StringIO(text, newline=None))
    sections = sections_of(tag_compiler(tidied(tags)))
    repeated, strays = without_repeated(sections), strays_of(sections)
    return LoadedDocument(_probed(_document(sections)), repaired, repeated, strays)


def _load_damaged(data: bytes) -> LoadedDocument:
    """Return the document of a damaged file."""
    load_ezdxf()
    from ezdxf.audit import Auditor
    from ezdxf.recover import Recover, bytes_loader

    found = Recover.run(io.BytesIO(data), lambda stream: tidied(bytes_loader(stream)))
    repeated, strays = without_repeated(found.section_dict), strays_of(found.section_dict)
    subclass_marks.put_in(found.section_dict)
    unreadable = subclass_marks.without_unreadable(found.section_dict)
    document = _document(found.section_dict)
    auditor = Auditor(document)
    auditor.run()
    told = len(found.errors) + len(found.fixes)
    faults = unreadable + told + len(auditor.errors) + len(auditor.fixes)
    return LoadedDocument(document, faults, repeated, strays)


def _document(sections: Any) -> Any:
    """Return the document of a file's sections."""
    from ezdxf.document import Drawing

    sections.pop("THUMBNAILIMAGE", None)
    without_empty_variables(sections.get("HEADER", []))
    subclass_marks.put_in(sections)
    document = Drawing()
    document._load_section_dict(sections)
    return document


def _probed(document: Any) -> Any:
    """Return a document whose tables and layouts can be walked; the library loads some that fall apart when they are
    looked at.
    """
    for layout in document.layouts:
        _ = layout.name, layout.is_modelspace, sum(1 for _ in layout)
    for layer in document.layers:
        _ = layer.dxf.name, layer.is_off(), layer.is_frozen(), layer.is_locked(), layer.rgb, layer.dxf.color
    for block in document.blocks:
        _ = block.name, sum(1 for _ in block)
    return document


def _short(error: Exception) -> str:
    """Return the first line of an error's text, for a message of one line."""
    lines = str(error).splitlines()
    return (lines[0] if lines else type(error).__name__)[:120]


# Has ezdxf imported without the grammar of its query language, which nothing here asks in, and without what reads
# typefaces and its table of hatch patterns, until one is asked for: 0.08 s of every start.


_PARSER, _GRAMMAR = "ezdxf.queryparser", "pyparsing"

_TYPEFACES = "fontTools.ttLib"

_PATTERNS = "ezdxf.tools.pattern"


class _LateParser:
    """Stands for the parser of queries until somebody asks it something."""

    def __getattr__(self, name: str) -> Any:
        if isinstance(getattr(sys.modules.get(_PARSER), "EntityQueryParser", None), _LateParser):
            del sys.modules[_PARSER]
        return getattr(import_module(_PARSER).EntityQueryParser, name)


class _LatePatterns(ModuleType):
    """Stands for the module of hatch patterns, which parses a table of them, until somebody asks it something."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if sys.modules.get(_PATTERNS) is self:
            del sys.modules[_PATTERNS]
        return getattr(import_module(_PATTERNS), name)


class _NeverRaisedError(Exception):
    """Stands for the error that the grammar raises, where the library catches it without asking a query."""


def load_ezdxf() -> None:
    """Import the library, the whole before its parts: else, while another thread imports it too, parts are found half
    made.
    """
    if "ezdxf" in sys.modules or _GRAMMAR in sys.modules:
        import_module("ezdxf")
        return
    parser, grammar = ModuleType(_PARSER), ModuleType(_GRAMMAR)
    vars(parser)["EntityQueryParser"], vars(grammar)["ParseException"] = _LateParser(), _NeverRaisedError
    stand_ins = {_PARSER: parser, _GRAMMAR: grammar, _PATTERNS: _LatePatterns(_PATTERNS)}
    if _TYPEFACES not in sys.modules:
        stand_ins[_TYPEFACES] = ModuleType(_TYPEFACES)
        vars(stand_ins[_TYPEFACES]).update(TTFont=_typeface, TTLibError=_NeverRaisedError)
    sys.modules.update(stand_ins)
    try:
        import_module("ezdxf")
    finally:
        for name in (_GRAMMAR, _TYPEFACES):
            if name in stand_ins and sys.modules.get(name) is stand_ins[name]:
                del sys.modules[name]


def _typeface(*arguments: Any, **options: Any) -> Any:
    """Stand for the class of typefaces where the library keeps it, until it is called the first time."""
    reader, manager = import_module(_TYPEFACES), import_module("ezdxf.fonts.font_manager")
    vars(manager).update(TTFont=reader.TTFont, TTLibError=reader.TTLibError)
    return reader.TTFont(*arguments, **options)


# Model space and the layouts of a DXF: which one is read, and what lies in the others.


def layout_named(document: Any, layout: str, name: str) -> Any:
    """Return a layout of paper space by its name in any case, or model space for "".

    Raises:
        InputError: there is no such layout.
    """
    if not layout:
        return document.modelspace()
    known = {each.name.casefold(): each for each in document.layouts}
    if layout.casefold() not in known:
        raise InputError(
            f"{name}: there is no layout {layout[:60]}; the drawing has "
            f"{', '.join(each.name for each in known.values())}."
        )
    return known[layout.casefold()]


def paper(document: Any) -> Counter[str]:
    """Count what lies in each layout of paper space, without its viewports, which only look at the model."""
    counts: Counter[str] = Counter()
    for layout in document.layouts:
        if not layout.is_modelspace:
            counts[layout.name] += sum(entity.dxftype() != "VIEWPORT" for entity in layout)
    return +counts


_SPACES = ("*model_space", "*paper_space")
"""Names of spaces, which begin so; what lies in one may stand in several places."""
_NAME = 2


def without_repeated(sections: dict[str, list[Any]]) -> tuple[str, ...]:
    """Take later definitions of a block away, from BLOCK to ENDBLK, and return their names: the first holds, as in CAD
    programs; the library would draw all of them, one over the other.

    Args:
        sections: of a file by name, each the entities of the library, as tags of codes and values.
    """
    entities, known = sections.get("BLOCKS", []), set[str]()
    kept, repeated, dropping = [], list[str](), False
    for tags in entities:
        kind = tags[0].value
        if kind == "BLOCK":
            name = str(next((tag.value for tag in tags if tag.code == _NAME), ""))
            dropping = name.casefold() in known
            repeated += [name] if dropping else []
            known |= {name.casefold()} if name and not name.casefold().startswith(_SPACES) else set()
        if not dropping:
            kept.append(tags)
        dropping = dropping and kind != "ENDBLK"
    entities[:] = kept
    return tuple(repeated)
