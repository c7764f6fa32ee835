"""Letters of outlines: TTF and OTF fonts of the system, or of a file."""

from __future__ import annotations

import difflib
import io
import logging
import os
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont

from ..core.errors import InputError
from ..core.toml_tables import brief
from ..model.curves import Curve, Line, Point, Spline
from .stroke_font import Glyph, StrokeFont, reach_below

logging.getLogger("fontTools").addHandler(logging.NullHandler())  # what is wrong with a font is in our own sentence
_KINDS = (".ttf", ".otf", ".ttc")
_UPRIGHT = frozenset({"regular", "book", "roman", "normal", "medium", ""})
_SHORT = 1e-9
"""Units of the font; a shorter line is left out."""
_RESTRICTION, _RESTRICTED, _NO_PART_OF_IT = 0x000F, 0x0002, 0x0300
"""Of OS/2's fsType: who may embed it, nobody without leave, and neither a part of its letters nor outlines."""
_MOST_PARTS = 1000
"""Of one letter; in fonts that people made it has fewer than ten, and parts of parts can double with each step."""


def outlined(name: str, words: str) -> StrokeFont:
    """Return a face with the letters of some words, their contours closed.

    Args:
        name: a family or full name, the name of its file without the ending, or the path of a file.

    Raises:
        InputError: there is no such font, it cannot be read, or it lacks a letter.
    """
    path = _found(name)
    with _readable(path.name):
        font = _opened(path, path.stat().st_mtime_ns)
    lacking = font.lacking(words)
    if lacking:
        raise InputError(f"The font {name} has no letter for {' '.join(lacking)}; choose other words or another font.")
    return font.face(words)


@lru_cache(4)
def _opened(path: Path, changed_ns: int) -> Typeface:
    """Return a font that many texts are set in, read once as long as its file does not change."""
    return Typeface(path)


class Typeface:
    """A font file, of which each letter is read once, when it is first asked for.

    Attributes:
        name: of the file, without its ending. units_per_em: of its letters' size.
        embeddable: letters of it may be put into a document, by what it says of its licence.
    """

    def __init__(self, path: Path) -> None:
        """Read what the file says of all its letters.

        Raises:
            InputError: the file cannot be read, or is no font.
        """
        self.name = path.stem
        self._glyphs: dict[str, Glyph] = {}
        self._file = path.name
        self._one = threading.Lock()  # tables are read when they are first asked for
        with _readable(self._file):
            self._font: Any = TTFont(io.BytesIO(path.read_bytes()), fontNumber=0, lazy=True)
            self._letters: dict[int, str] = self._font.getBestCmap() or {}
            self._shapes, self._widths = self._font.getGlyphSet(), self._font["hmtx"]
            self._capital = _capital(self._font, self._letters)
            self.units_per_em = int(self._font["head"].unitsPerEm)
            self.embeddable = _may_be_embedded(int(getattr(self._font.get("OS/2"), "fsType", 0) or 0))
            self._below = (
                -float(self._font["hhea"].descent) if ord("p") not in self._letters else reach_below(self._glyph("p"))
            )

    def lacking(self, words: str) -> str:
        """Return the letters of some words that the font does not have, each once."""
        return "".join(dict.fromkeys(letter for letter in words if ord(letter) not in self._letters))

    def face(self, words: str, kerned: bool = True) -> StrokeFont:
        """Return a face with those letters of some words that the font has.

        Args:
            words: that are to be set.
            kerned: neighbours stand as the font's table has it; CAD programs leave that aside.

        Raises:
            InputError: a letter cannot be read.
        """
        letters = [letter for letter in dict.fromkeys(words) if ord(letter) in self._letters]
        with self._one, _readable(self._file):
            glyphs = {letter: self._glyph(letter) for letter in letters}
            kerning = _kerning(self._font, self._letters, words) if kerned else {}
        return StrokeFont(self.name, self._capital, 0.0, glyphs, kerning, max(self._below, 0.0))

    def _glyph(self, letter: str) -> Glyph:
        if letter not in self._glyphs:
            name, pen = self._letters[ord(letter)], _Pen(self._shapes)
            self._shapes[name].draw(pen)
            self._glyphs[letter] = Glyph(tuple(pen.curves), float(self._widths[name][0]))
        return self._glyphs[letter]


@contextmanager
def _readable(name: str) -> Iterator[None]:
    try:
        yield
    except InputError:
        raise
    except Exception as error:  # readers of fonts raise whatever broken bytes make them
        why = brief(str(error) or type(error).__name__)
        raise InputError(f"The font {name} cannot be read ({why}); choose another one.") from error


def _may_be_embedded(licence: int) -> bool:
    """Tell what the licence bits of a font mean for outlines of some of its letters in a document."""
    return licence & _RESTRICTION != _RESTRICTED and not licence & _NO_PART_OF_IT


def _capital(font: Any, letters: dict[int, str]) -> float:
    """Return the height of the capitals, else of what rises highest, units."""
    stated = float(getattr(font.get("OS/2"), "sCapHeight", 0) or 0)
    if not stated and "glyf" in font and ord("H") in letters:
        stated = float(font["glyf"][letters[ord("H")]].yMax)
    return stated or float(font["hhea"].ascent or font["head"].unitsPerEm)


def _kerning(font: Any, letters: dict[int, str], words: str) -> dict[tuple[str, str], float]:
    """Return what the font's kerning table says of neighbours; that of newer layout tables is left aside."""
    pairs = [(a, b) for a, b in set(pairwise(words)) if ord(a) in letters and ord(b) in letters]
    tables = (
        [table.kernTable for table in font["kern"].kernTables if hasattr(table, "kernTable")] if "kern" in font else []
    )
    return {
        (a, b): float(table[key])
        for table in tables
        for a, b in pairs
        if (key := (letters[ord(a)], letters[ord(b)])) in table
    }


class _Pen(BasePen):  # type: ignore[misc, unused-ignore]
    """Gathers the curves of closed contours."""

    def __init__(self, shapes: Any) -> None:
        super().__init__(shapes)
        self.curves: list[Curve] = []
        self._first: Point = (0.0, 0.0)
        self._parts = 0

    def addComponent(self, glyphName: str, transformation: Any) -> None:  # noqa: N802, N803 (the library's names)
        """Draw a part of a letter that is a letter itself."""
        self._parts += 1
        if self._parts > _MOST_PARTS:
            raise ValueError(f"a letter of more than {_MOST_PARTS} parts")
        super().addComponent(glyphName, transformation)

    def _moveTo(self, pt: Any) -> None:  # noqa: N802
        self._first = _point(pt)

    def _lineTo(self, pt: Any) -> None:  # noqa: N802
        start, end = _point(self._getCurrentPoint()), _point(pt)
        if abs(end[0] - start[0]) + abs(end[1] - start[1]) > _SHORT:
            self.curves.append(Line(start, end))

    def _curveToOne(self, pt1: Any, pt2: Any, pt3: Any) -> None:  # noqa: N802
        self._bezier(pt1, pt2, pt3)

    def _qCurveToOne(self, pt1: Any, pt2: Any) -> None:  # noqa: N802
        self._bezier(pt1, pt2)

    def _bezier(self, *points: Any) -> None:
        controls = (_point(self._getCurrentPoint()), *map(_point, points))
        degree = len(points)
        if len(set(controls)) > 1:
            self.curves.append(Spline(degree, controls, (0.0,) * (degree + 1) + (1.0,) * (degree + 1)))

    def _closePath(self) -> None:  # noqa: N802
        self._lineTo(self._first)


def _point(at: Any) -> Point:
    return (float(at[0]), float(at[1]))


def _found(name: str) -> Path:
    path = Path(name).expanduser()
    if path.suffix.lower() in _KINDS:
        if path.is_file():
            return path
        raise InputError(f"There is no font file {name}; give its whole path, or the name of an installed font.")
    fonts, requested = _installed(), _plain(name)
    if requested not in fonts:
        near = (
            difflib.get_close_matches(requested, fonts, 5, 0.5)
            or [other for other in fonts if requested and requested in other][:5]
        )
        known = list(dict.fromkeys(fonts[each].stem for each in near))
        hint = f"near it: {', '.join(known)}" if known else "give the path of a .ttf or .otf file"
        raise InputError(f"There is no font '{name}' here; {hint}.")
    return fonts[requested]


def installed(file: str, family: str = "", style: str = "") -> Path | None:
    """Return the font of this machine that another one's drawing means; None where there is none.

    Args:
        file: the name of its file, its ending with it; a folder before it means nothing here, and no such file is ever
            opened.
        family: where the file is not here or not named.
        style: of the family, such as "bold italic"; "" = the upright one.
    """
    stem, _, ending = file.replace("\\", "/").rpartition("/")[2].rpartition(".")
    if f".{ending.lower()}" in _KINDS and _plain(stem) in _files():
        return _files()[_plain(stem)]
    if not _plain(family):
        return None
    names = [_plain(family + each) for each in ((style, style.replace("italic", "oblique")) if style else ())]
    return next((_installed()[name] for name in (*names, _plain(family)) if name in _installed()), None)


@lru_cache(1)
def _files() -> dict[str, Path]:
    """Return the font files of this machine by their names, without endings and blanks and in lower case."""
    return {_plain(path.stem): path for path in reversed(_paths())}


def _paths() -> list[Path]:
    return sorted(
        path for folder in _folders() if folder.is_dir() for path in folder.rglob("*") if path.suffix.lower() in _KINDS
    )


def installed_names() -> tuple[str, ...]:
    """Return the names of the fonts of this machine as a user knows them, sorted: families, and their styles."""
    named = {each.family if _plain(each.style) in _UPRIGHT else f"{each.family} {each.style}" for each in _faces()}
    return tuple(sorted(named, key=str.casefold))


class _Face(NamedTuple):
    """A font file of this machine with the names it goes by."""

    path: Path
    family: str
    style: str


@lru_cache(1)
def _faces() -> tuple[_Face, ...]:
    found = []
    for path in _paths():
        try:
            with TTFont(path, fontNumber=0, lazy=True) as font:
                names = font["name"]
                found.append(_Face(path, names.getBestFamilyName() or path.stem, names.getBestSubFamilyName() or ""))
        except Exception:  # a broken font among those installed is none to choose, whatever its bytes raise
            continue
    return tuple(found)


@lru_cache(1)
def _installed() -> dict[str, Path]:
    """Return the fonts of this machine by every name they go by, without blanks and in lower case."""
    found: dict[str, Path] = {}
    plain: dict[str, Path] = {}
    for path, family, style in _faces():
        found.setdefault(_plain(path.stem), path)
        found.setdefault(_plain(family + style), path)
        if _plain(style) in _UPRIGHT or _plain(family) not in plain:
            plain[_plain(family)] = path
    return plain | {name: path for name, path in found.items() if name not in plain}


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter.isalnum())


def _folders() -> tuple[Path, ...]:
    home = Path.home()
    if sys.platform == "win32":
        return (Path(os.environ.get("WINDIR", r"C:\Windows")) / "Fonts", home / "AppData/Local/Microsoft/Windows/Fonts")
    if sys.platform == "darwin":
        return (Path("/System/Library/Fonts"), Path("/Library/Fonts"), home / "Library/Fonts")
    return (Path("/usr/share/fonts"), Path("/usr/local/share/fonts"), home / ".local/share/fonts", home / ".fonts")
