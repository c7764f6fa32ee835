"""Tags of a DXF to its sections, as tolerantly as CAD programs: words in small letters, blanks round words and names,
sections that come several times, blocks without an end mark.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

Sections = dict[str, list[Any]]
"""Of a file by name: each the entities of the library, as tags of codes and values."""

_NAMES = frozenset({2, 6, 7, 8})
"""Codes of names: of blocks and entries of tables, of a line type, a style, a layer. None may begin or end with a
blank.
"""
_WORD, _NAME, _VARIABLE, _MARK = 0, 2, 9, 100
"""Codes of words that build the file, of the name behind one, of a variable of the header, of a subclass mark."""
_NAMED = frozenset({"SECTION", "TABLE", b"SECTION", b"TABLE"})
"""Words behind which a name of the format itself follows, as text or as bytes."""
_ENDS = frozenset({"EOF", b"EOF"})
_DRAWN = frozenset(
    (
        *("LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE", "HELIX", "MLINE", "INSERT", "POINT"),
        *("TEXT", "MTEXT", "HATCH", "SOLID", "TRACE", "REGION", "BODY", "3DSOLID", "3DFACE", "MESH"),
    )
)
"""Types of entities that somebody sees."""


def tidied(tags: Iterable[Any]) -> Iterator[Any]:
    """Yield the tags of a file to its end mark, words of the format in capitals, words and names without blanks round
    them.

    Args:
        tags: of the library, their values text or bytes.
    """
    from ezdxf.lldxf.types import DXFTag

    last: str | bytes = ""
    for tag in tags:
        code, value = tag.code, tag.value
        if code == _WORD or (code == _NAME and last in _NAMED):
            last = value.strip().upper()
            yield tag if last == value else DXFTag(code, last)
            if code == _WORD and last in _ENDS:
                return
        elif code in _NAMES or code == _MARK:
            kept = value.strip()
            yield tag if kept == value else DXFTag(code, kept)
        else:
            yield DXFTag(code, value.strip().upper()) if code == _VARIABLE else tag


def sections_of(tags: Iterable[Any]) -> Sections:
    """Return the sections of a file; what several of one name hold is one after another in one.

    Raises:
        DXFStructureError: something stands outside of all sections, one does not end or has no name, or the end mark
            is missing.
    """
    from ezdxf.lldxf.const import DXFStructureError
    from ezdxf.lldxf.tags import group_tags

    sections: Sections = {}
    section: list[Any] | None = None
    for entity in group_tags(tags):
        word = entity[0].value
        if word == "EOF" and section is None:
            return sections
        if word == "SECTION" and section is None and len(entity) > 1 and entity[1].code == _NAME:
            section = sections.setdefault(entity[1].value, [])
            _begin(section, entity)
        elif word in ("SECTION", "EOF") or section is None:
            raise DXFStructureError(f"the mark {word} stands where none can be")
        elif word == "ENDSEC":
            section = None
        else:
            section.append(entity)
    raise DXFStructureError("the end mark EOF is missing")


def _begin(section: list[Any], head: Any) -> None:
    """Begin a section, or go on with one: all of a header stands in its head."""
    if section:
        section[0].extend(head[2:])
    else:
        section.append(head)


def without_empty_variables(header: list[Any]) -> None:
    """Take variables away that have no value.

    Args:
        header: the section's entities, of which the first holds all.
    """
    if header:
        tags = header[0]
        followed = zip(tags, [*tags[1:], None], strict=True)
        tags[:] = [tag for tag, after in followed if tag.code != _VARIABLE or (after and after.code != _VARIABLE)]


def with_block_ends(entities: list[Any]) -> Iterator[Any]:
    """Yield the entities of a section of blocks, and the end mark of each block that lacks it."""
    from ezdxf.lldxf.tags import Tags
    from ezdxf.lldxf.types import DXFTag

    is_open = False
    for tags in entities:
        word = tags[0].value
        if word == "BLOCK" and is_open:
            yield Tags([DXFTag(_WORD, "ENDBLK")])
        is_open = word == "BLOCK" or (is_open and word != "ENDBLK")
        yield tags
    if is_open:
        yield Tags([DXFTag(_WORD, "ENDBLK")])


def strays_of(sections: Sections) -> Counter[str]:
    """Count by type what would be drawn, had it not been put where nothing is: in another section than those of
    entities and blocks, or beside the blocks.
    """
    elsewhere = [tags for name, section in sections.items() if name not in ("ENTITIES", "BLOCKS") for tags in section]
    words = [tags[0].value for tags in (*elsewhere, *_beside_blocks(sections.get("BLOCKS", [])))]
    return Counter(word for word in words if word in _DRAWN)


def _beside_blocks(entities: list[Any]) -> Iterator[Any]:
    is_open = False
    for tags in entities:
        word = tags[0].value
        if not is_open:
            yield tags
        is_open = word == "BLOCK" or (is_open and word != "ENDBLK")
