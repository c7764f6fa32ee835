"""Bytes of an XML file to a light tree that knows its lines; bombs and damage are refused in one sentence."""

from __future__ import annotations

import gzip
import io
import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NoReturn
from xml.parsers import expat

from ...core.errors import MOST_QUOTED, InputError
from ..drawing_account import MOST_CURVES
from .xml_text import plainly_encoded, with_prefixes

SVG = "http://www.w3.org/2000/svg"
LINK = "http://www.w3.org/1999/xlink"
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
SODIPODI = "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"
_USUAL = {"svg": SVG, "xlink": LINK, "inkscape": INKSCAPE, "sodipodi": SODIPODI}
_UNDECLARED = expat.errors.codes[expat.errors.XML_ERROR_UNBOUND_PREFIX]
DEEPEST = 100
"""Elements nested deeper than this are refused."""
MOST_BYTES = 256 << 20
"""A larger file is no drawing to machine."""
_MOST_ENTITIES = 100
_LONGEST_ENTITY = 200
"""Old drawing programs name their namespaces by entities; none is longer, and none holds another."""
MOST_USES = 10_000
"""So often may entities be used: two megabytes at most come from them."""
_USE = re.compile(rb"&(?!(?:amp|lt|gt|quot|apos);)[^#;&\s<>]{1,200};")
_LONGEST_COMMENTS = 4096
_WRITTEN = ("text", "tspan", "textPath", "a", "flowRoot", "flowPara", "flowSpan", "flowDiv", "flowRegionBreak")
_XHTML = "http://www.w3.org/1999/xhtml"
STYLES = ("style", f"{_XHTML} style")
"""Elements that hold style sheets."""
LINKED = f"{_XHTML} link"
"""Element that names what lies in another file, such as a style sheet."""
_WITH_TEXT = (*STYLES, *_WRITTEN)
_HEAD = 1 << 16
_COMPRESSED = b"\x1f\x8b"


@dataclass(slots=True)
class Node:
    """One element.

    Attributes:
        tag: its name; that of an SVG element alone, any other with its namespace and a blank before it.
        attributes: by name, likewise.
        line: where it begins, 1-based.
        text: its own text, kept for style sheets and what is written alone.
        comments: those before the root, kept there alone; editors name themselves in them.
        outer_sheets: what names style sheets in other files, kept at the root alone.
    """

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Node] = field(default_factory=list)
    text: str = ""
    comments: str = ""
    outer_sheets: tuple[str, ...] = ()

    def every(self) -> Iterator[Node]:
        """Yield this element and all that it holds, in the order of the file."""
        waiting = [self]
        while waiting:
            node = waiting.pop()
            yield node
            waiting.extend(reversed(node.children))

    @property
    def words(self) -> str:
        """What is written in it, with single blanks."""
        return " ".join(" ".join(node.text for node in self.every() if node.tag in _WRITTEN).split())


def read_xml(data: bytes, name: str) -> Node:
    """Return the root element.

    Raises:
        InputError: no XML, damaged, nested too deep, too large, or with entities that hold others or come from
            elsewhere.
    """
    if data.startswith(_COMPRESSED):
        data = _unpacked(data, name)
    if not data.strip():
        raise InputError(f"{name}: the file is empty; export the drawing again.")
    if len(data) > MOST_BYTES:
        raise InputError(f"{name}: the file has more than {MOST_BYTES} bytes; save the drawing in parts.")
    if b"<" not in data[:_HEAD].replace(b"\0", b""):
        raise InputError(f"{name}: this is not an SVG file, no element begins in it; export the drawing as SVG.")
    _refuse_repeated_entities(data, name)
    data = plainly_encoded(data)
    try:
        return _Reader(name).read(data)
    except _UndeclaredPrefixError:
        return _Reader(name, lenient=False).read(with_prefixes(data, _USUAL))


def _unpacked(data: bytes, name: str) -> bytes:
    """Return what a compressed file holds, or a little more than the most bytes where it holds more than those."""
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as packed:
            return packed.read(MOST_BYTES + 1)
    except EOFError:
        raise InputError(f"{name}: the compressed SVG is cut short; copy or export it again.") from None
    except (zlib.error, gzip.BadGzipFile):
        raise InputError(f"{name}: the compressed SVG is damaged; copy or export it again.") from None


def _refuse_repeated_entities(data: bytes, name: str) -> None:
    """Refuse a small file that unfolds to a large one: editors use the entities that they declare a few times."""
    plain = data.replace(b"\0", b"") if b"\0" in data[:_HEAD] else data
    if b"<!ENTITY" not in plain:
        return
    uses = sum(1 for _ in _USE.finditer(plain))
    if uses > MOST_USES:
        raise InputError(
            f"{name}: entities are used {uses} times, and {MOST_USES} are the most; save it again as a plain SVG."
        )


class _UndeclaredPrefixError(Exception):
    """A name has a prefix that stands for no namespace, as parts copied out of other files have."""


class _Reader:
    def __init__(self, name: str, lenient: bool = True) -> None:
        """Make a reader; a lenient one tells of prefixes that are not declared by an error of their own."""
        self._name, self._lenient = name, lenient
        self._parser = expat.ParserCreate(namespace_separator=" ")
        self._parser.buffer_text, self._parser.buffer_size = True, 1 << 20
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._characters
        self._parser.CommentHandler = self._comment
        self._parser.ProcessingInstructionHandler = self._instruction
        self._parser.EntityDeclHandler = self._entity
        self._open: list[Node] = []
        self._root: Node | None = None
        self._comments = ""
        self._sheets: list[str] = []
        self._count = self._entities = 0

    def read(self, data: bytes) -> Node:
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            if self._lenient and error.code == _UNDECLARED:
                raise _UndeclaredPrefixError from None
            what = expat.ErrorString(error.code)
            raise InputError(
                f"{self._name}:{error.lineno}: the XML is damaged, column {error.offset + 1}: {what}; "
                "save it again from the drawing program."
            ) from None
        except (
            LookupError,
            ValueError,
        ) as error:  # an encoding that does not exist, or that Python alone cannot decode
            raise InputError(
                f"{self._name}: the text encoding of the XML cannot be read ({str(error)[:MOST_QUOTED]}); save it as "
                "UTF-8."
            ) from None
        assert self._root is not None  # XML without a root is an error of the parser
        return self._root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if self._count > MOST_CURVES:
            self._refuse(f"there are more than {MOST_CURVES} elements; save the drawing in parts.")
        if len(self._open) >= DEEPEST:
            self._refuse(f"elements are nested deeper than {DEEPEST} levels; ungroup some and save again.")
        node = Node(
            _plain(tag), {_plain(key): value for key, value in attributes.items()}, self._parser.CurrentLineNumber
        )
        if self._open:
            self._open[-1].children.append(node)
        else:
            self._root = node
            node.comments, node.outer_sheets = self._comments, tuple(self._sheets)
        self._open.append(node)

    def _end(self, _: str) -> None:
        self._open.pop()

    def _characters(self, text: str) -> None:
        if self._open[-1].tag in _WITH_TEXT:
            self._open[-1].text += text

    def _comment(self, text: str) -> None:
        if self._root is None and len(self._comments) < _LONGEST_COMMENTS:
            self._comments += text[:_LONGEST_COMMENTS]

    def _instruction(self, target: str, text: str) -> None:
        if target == "xml-stylesheet" and self._root is None and len(self._sheets) < _MOST_ENTITIES:
            self._sheets.append(f"{target} {text}")

    def _entity(self, entity: str, parameter: bool, value: str | None, *_: str | None) -> None:
        self._entities += 1
        if (
            value is None
            or parameter
            or "&" in value
            or len(value) > _LONGEST_ENTITY
            or self._entities > _MOST_ENTITIES
        ):
            self._refuse(
                f"the entity {entity[:40]} holds others, comes from elsewhere or is too long; save it again as a plain "
                "SVG."
            )

    def _refuse(self, what: str) -> NoReturn:
        raise InputError(f"{self._name}:{self._parser.CurrentLineNumber}: {what}")


def _plain(name: str) -> str:
    """Return a name without the namespace of SVG; prefixes of links are plain too."""
    space, _, local = name.rpartition(" ")
    return local if space in ("", SVG) else f"{space} {local}"
