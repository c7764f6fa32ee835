"""What small exporters leave out of a DXF: subclass marks, which every entity has since R13, the version, handles."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import dropwhile, takewhile
from typing import Any

from .sections import Sections, with_block_ends

_OWN = {
    "LWPOLYLINE": "AcDbPolyline",
    "SPLINE": "AcDbSpline",
    "MTEXT": "AcDbMText",
    "HATCH": "AcDbHatch",
    "MPOLYGON": "AcDbMPolygon",
    "LEADER": "AcDbLeader",
    "IMAGE": "AcDbRasterImage",
    "MLINE": "AcDbMline",
}
"""The mark of each kind that the library reads by its marks alone, behind that of what all kinds have."""
_AT_ONE_PLACE = frozenset({"LINE", "CIRCLE", "ARC", "ELLIPSE", "POINT", "INSERT", "TEXT"})
"""Kinds that have one place each."""
_MARKED = frozenset({*_OWN, "HELIX", "WIPEOUT", "MESH", "MULTILEADER"})
"""Kinds that R12 does not know, and that are read as one of R12 in a file that says nothing of its version."""
_ALL_KINDS = "AcDbEntity"
DAMAGED = " (damaged)"
"""What is put behind the kind of an entity that cannot be read, so that it is one that nobody knows."""

_COMMON = frozenset({6, 8, 48, 60, 62, 67, 370, 410, 420, 430, 440})
"""Codes of what all kinds have: line type, layer, its scale, whether it is seen, colour, paper, weight, layout."""
_HANDLE, _OWNER, _GROUP, _MARK, _EMBEDDED, _EXTENDED, _PLACE = 5, 330, 102, 100, 101, 1001, 10
"""Codes of groups: handle, owner, what is in braces, subclass mark, embedded object, data of another program, place."""
_SEQUENCE_END, _PARTS_FOLLOW = "SEQEND", 66
"""What ends the vertices of a polyline or the attributes of a block, and the code that says that some follow."""
_R12, _R2000 = "AC1009", "AC1015"
_VERSION = "$ACADVER"


def put_in(sections: Sections) -> None:
    """Give the entities that are read by their marks those that they lack, sequences and blocks the ends that they
    lack, take away handles that are none, in whose place the library makes new ones, and call damaged what two entities
    have become one of.

    A file that names no version is R12 for the library, where no mark is looked at; one that has entities of later
    versions all the same is taken for one of R2000.
    """
    kinds, blocks = set(), sections.get("BLOCKS", [])
    blocks[:] = with_block_ends(blocks)
    for entities in _drawn(sections):
        entities[:] = _with_sequence_ends(entities)
        for at, tags in enumerate(entities):
            kind = tags[0].value
            kinds.add(kind)
            _without_wrong_handle(tags)
            if (kind in _AT_ONE_PLACE and _is_merged(tags)) or (kind in _OWN and _is_marked_again(tags, kind)):
                _call_damaged(tags)
            elif kind in _OWN and not _is_marked(tags, kind):
                entities[at] = _with_marks(tags, kind)
    if kinds & _MARKED:
        _raise_version(sections)


def without_unreadable(sections: Sections) -> int:
    """Call entities that the library cannot make objects of damaged, so that each is left out by itself, and drop such
    objects, which draw nothing; return how many there are.
    """
    from ezdxf.entities import factory
    from ezdxf.lldxf.extendedtags import ExtendedTags

    def is_readable(tags: Any) -> bool:
        try:
            factory.load(ExtendedTags(tags))
        except Exception:  # whatever the library makes of a damaged entity
            return False
        return True

    unreadable = [tags for entities in _drawn(sections) for tags in entities if not is_readable(tags)]
    for tags in unreadable:
        _call_damaged(tags)
    objects = sections.get("OBJECTS", [])
    kept = objects[:1] + [tags for tags in objects[1:] if is_readable(tags)]
    lost = len(objects) - len(kept)
    objects[:] = kept
    return len(unreadable) + lost


def _call_damaged(tags: Any) -> None:
    """Leave of an entity what all kinds have, and call it damaged: one of a kind that nobody knows."""
    from ezdxf.lldxf.types import DXFTag

    head = {tag.code: tag for tag in reversed(tags) if tag.code in (_HANDLE, _OWNER)}  # the first of each
    common = [tag for tag in tags if tag.code in _COMMON]
    tags[:] = [DXFTag(0, f"{tags[0].value}{DAMAGED}"), *head.values(), DXFTag(_MARK, _ALL_KINDS), *common]


def _drawn(sections: Sections) -> Iterator[list[Any]]:
    return (sections[name] for name in ("BLOCKS", "ENTITIES") if name in sections)


def _with_sequence_ends(entities: list[Any]) -> Iterator[Any]:
    """Yield entities with the end mark of each sequence of vertices or attributes that lacks it, and without such marks
    where nothing ends.
    """
    from ezdxf.lldxf.tags import Tags
    from ezdxf.lldxf.types import DXFTag

    follows = ""
    for tags in entities:
        kind = tags[0].value
        if follows and kind not in (follows, _SEQUENCE_END):
            yield Tags([DXFTag(0, _SEQUENCE_END)])
        if follows or kind != _SEQUENCE_END:
            yield tags
        if kind != follows:
            follows = _following(tags)
    if follows:
        yield Tags([DXFTag(0, _SEQUENCE_END)])


def _following(tags: Any) -> str:
    """Return the kind of entities that follow one as its parts, "" for none."""
    kind = tags[0].value
    if kind == "INSERT":
        return "ATTRIB" if any(tag.code == _PARTS_FOLLOW and tag.value for tag in tags) else ""
    return "VERTEX" if kind == "POLYLINE" else ""


def _without_wrong_handle(tags: Any) -> None:
    at = next((k for k, tag in enumerate(tags) if tag.code == _HANDLE), None)
    if at is not None and not _is_handle(str(tags[at].value)):
        del tags[at]


def _is_handle(text: str) -> bool:
    try:
        return int(text, 16) > 0
    except ValueError:
        return False


def _is_merged(tags: Any) -> bool:
    """Tell whether an entity has two places: the line that begins another one is lost, and so are both."""
    return len([tag for tag in _plain(tags) if tag.code == _PLACE]) > 1


def _is_marked_again(tags: Any, kind: str) -> bool:
    """Tell whether an entity's kind is marked again behind a place: the line that begins another one is lost."""
    behind = dropwhile(lambda tag: tag.code != _PLACE, dropwhile(lambda tag: not _is_own(tag, kind), _plain(tags)))
    return any(_is_own(tag, kind) for tag in behind)


def _is_own(tag: Any, kind: str) -> bool:
    return bool(tag.code == _MARK and tag.value == _OWN[kind])


def _plain(tags: Any) -> Iterator[Any]:
    """Return an entity's tags without those of objects within it and of other programs."""
    return takewhile(lambda tag: tag.code not in (_EMBEDDED, _EXTENDED), tags)


def _is_marked(tags: Any, kind: str) -> bool:
    return [tag.value for tag in tags if tag.code == _MARK] == [_ALL_KINDS, _OWN[kind]]


def _with_marks(tags: Any, kind: str) -> Any:
    """Return an entity's tags with its marks: handle, owner and groups first, what all kinds have, its own."""
    from ezdxf.lldxf.types import DXFTag

    head, common, own = [tags[0]], [DXFTag(_MARK, _ALL_KINDS)], [DXFTag(_MARK, _OWN[kind])]
    in_group = False
    rest = iter(tags[1:])
    for tag in rest:
        if tag.code == _EMBEDDED:
            own += [tag, *rest]
        elif in_group or tag.code in (_HANDLE, _OWNER, _GROUP):
            in_group = str(tag.value).startswith("{") if tag.code == _GROUP else in_group
            head.append(tag)
        elif tag.code != _MARK:
            (common if tag.code in _COMMON else own).append(tag)
    return type(tags)([*head, *common, *own])


def _raise_version(sections: Sections) -> None:
    """Make a file of R12, or of none, one of R2000."""
    from ezdxf.lldxf.tags import Tags
    from ezdxf.lldxf.types import DXFTag

    header = sections.setdefault("HEADER", [])
    if not header:
        header.append(Tags([DXFTag(0, "SECTION"), DXFTag(2, "HEADER")]))
    tags = header[0]
    at = next((k for k, tag in enumerate(tags) if tag.code == 9 and tag.value == _VERSION), None)
    if at is None:
        tags[2:2] = [DXFTag(9, _VERSION), DXFTag(1, _R2000)]
    elif str(tags[at + 1].value) <= _R12:
        tags[at + 1] = DXFTag(1, _R2000)
