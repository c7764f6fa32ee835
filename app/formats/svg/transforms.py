"""Transforms of SVG elements as attributes and as style sheets write them, as far as they stay in the plane."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from ...geometry.affine import IDENTITY, Affine
from .lengths import LengthBasis, length
from .numbers import NUMBER, UnreadableError

INDIVIDUAL = ("translate", "rotate", "scale")
"""Properties of style sheets that are transforms by themselves, in the order in which they go before `transform`."""
_NOTHING = ("", "none", "initial", "unset", "revert", "revert-layer")
_SUM = r"calc\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\)"
_FUNCTION = re.compile(rf"[\s,]*([a-z]\w*)\s*\(((?:{_SUM}|[^()])*)\)", re.IGNORECASE)
_ARGUMENT = re.compile(rf"[\s,]*({_SUM}|{NUMBER}(?:%|[a-z]*))", re.IGNORECASE)
_ANGLE = re.compile(rf"({NUMBER})(deg|grad|rad|turn|)\Z", re.IGNORECASE)
_DEGREES = {"": 1.0, "deg": 1.0, "grad": 0.9, "rad": math.degrees(1.0), "turn": 360.0}
"""Units of angles."""
_QUARTERS = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
"""Quarter turns are exact, so that what is drawn square stays square."""
_UNIT = LengthBasis((1.0, 1.0))


class UnplacedError(UnreadableError):
    """It is not known where an element lies; the argument is its transform."""


def written_transform(declared: Mapping[str, str]) -> str:
    """Return all that a style says of an element's place as one list of transforms, "" for nothing.

    Args:
        declared: values by property.
    """
    own = ((key, declared.get(key, "").strip()) for key in INDIVIDUAL)
    parts = [_INDIVIDUAL[key](value.split()) for key, value in own if value.lower() not in _NOTHING]
    last = declared.get("transform", "").strip()
    return " ".join([*parts, last] if last.lower() not in _NOTHING else parts)


def _turned(words: list[str]) -> str:
    """Return the property `rotate`, an angle round an axis that may stand before it or behind, as a transform."""
    axes = [word for word in words if word.lower() in ("x", "y", "z")]
    rest = [word for word in words if word not in axes]
    if len(rest) == 4:
        return f"rotate3d({','.join(rest)})"
    return f"rotate{axes[0].upper() if axes else ''}({' '.join(rest)})"


_INDIVIDUAL: dict[str, Callable[[list[str]], str]] = {
    "translate": lambda words: f"translate{'3d' * (len(words) == 3)}({','.join(words)})",
    "rotate": _turned,
    "scale": lambda words: f"scale{'3d' * (len(words) == 3)}({','.join(words)})",
}


def transform(text: str, basis: LengthBasis = _UNIT) -> Affine:
    """Return the map of a list of transforms, y downwards as in the file.

    Args:
        text: of an attribute or a style. basis: what its lengths are relative to; percentages are of its viewport.

    Raises:
        UnreadableError: a name or a count of values that SVG does not know, or something that leaves the plane.
    """
    made, at = IDENTITY, 0
    while match := _FUNCTION.match(text, at):
        made = made.after(_one(match[1].lower(), list(_arguments(match[2])), basis))
        at = match.end()
    if text[at:].strip(" \t\r\n,") not in ("", "none"):
        raise UnreadableError(text)
    return made


def _arguments(text: str) -> Iterator[str]:
    at = 0
    while match := _ARGUMENT.match(text, at):
        yield match[1]
        at = match.end()
    if text[at:].strip(" \t\r\n,"):
        raise UnreadableError(text)


def _one(kind: str, given: list[str], basis: LengthBasis) -> Affine:
    reader = _READERS.get(kind)
    if reader is None or len(given) not in reader.counts:
        raise UnreadableError(kind)
    return reader.read(given, basis)


def _number(text: str) -> float:
    """Return a number, or a percentage as a share of 1."""
    amounts = dict(length(text).amounts)
    value = amounts.pop("", 0.0) + amounts.pop("%", 0.0) / 100
    if amounts or not math.isfinite(value):
        raise UnreadableError(text)
    return value


def _angle(text: str) -> float:
    """Return an angle, degrees."""
    found = _ANGLE.match(text)
    if found is None or not math.isfinite(float(found[1])):
        raise UnreadableError(text)
    return float(found[1]) * _DEGREES[found[2].lower()]


def _matrix(given: list[str], basis: LengthBasis) -> Affine:
    a, b, c, d = map(_number, given[:4])
    return Affine(a, c, b, d, length(given[4]).user(basis, "x"), length(given[5]).user(basis, "y"))


def _matrix3d(given: list[str], _: LengthBasis) -> Affine:
    """The plane is seen from above, so what is told of Z does not count; one in perspective cannot be followed."""
    m = [_number(text) for text in given]
    if m[3] or m[7] or not m[15]:
        raise UnreadableError("matrix3d")
    return Affine(*(m[k] / m[15] for k in (0, 4, 1, 5, 12, 13)))


def _translate(given: list[str], basis: LengthBasis) -> Affine:
    y = length(given[1]).user(basis, "y") if len(given) > 1 else 0.0
    return Affine(x0=length(given[0]).user(basis, "x"), y0=y)


def _scale(given: list[str], _: LengthBasis) -> Affine:
    across = _number(given[0])
    return Affine(across, 0.0, 0.0, _number(given[1]) if len(given) > 1 else across)


def _rotate(given: list[str], basis: LengthBasis) -> Affine:
    degrees = _angle(given[0])
    c, s = _QUARTERS.get(degrees % 360.0) or (math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))
    x, y = (length(given[1]).user(basis, "x"), length(given[2]).user(basis, "y")) if len(given) == 3 else (0.0, 0.0)
    return Affine(c, -s, s, c, x - c * x + s * y, y - s * x - c * y)


def _rotate3d(given: list[str], basis: LengthBasis) -> Affine:
    x, y, z = map(_number, given[:3])
    if x or y or not z:
        raise UnreadableError("rotate3d")
    return _rotate([f"{math.copysign(1.0, z) * _angle(given[3])!r}"], basis)


def _skew(given: list[str], _: LengthBasis) -> Affine:
    along, up = _angle(given[0]), _angle(given[1]) if len(given) > 1 else 0.0
    return Affine(xy=math.tan(math.radians(along)), yx=math.tan(math.radians(up)))


class _FunctionReader(NamedTuple):
    """Reads one kind of transform; `counts`: how many values it may have."""

    counts: tuple[int, ...]
    read: Callable[[list[str], LengthBasis], Affine]


_READERS: dict[str, _FunctionReader] = {
    "matrix": _FunctionReader((6,), _matrix),
    "matrix3d": _FunctionReader((16,), _matrix3d),
    "translate": _FunctionReader((1, 2), _translate),
    "translate3d": _FunctionReader((3,), _translate),
    "translatex": _FunctionReader((1,), _translate),
    "translatey": _FunctionReader((1,), lambda given, basis: Affine(y0=length(given[0]).user(basis, "y"))),
    "translatez": _FunctionReader((1,), lambda _, __: IDENTITY),
    "scale": _FunctionReader((1, 2), _scale),
    "scale3d": _FunctionReader((3,), _scale),
    "scalex": _FunctionReader((1,), lambda given, _: Affine(xx=_number(given[0]))),
    "scaley": _FunctionReader((1,), lambda given, _: Affine(yy=_number(given[0]))),
    "scalez": _FunctionReader((1,), lambda _, __: IDENTITY),
    "rotate": _FunctionReader((1, 3), _rotate),
    "rotatez": _FunctionReader((1,), _rotate),
    "rotate3d": _FunctionReader((4,), _rotate3d),
    "skew": _FunctionReader((1, 2), _skew),
    "skewx": _FunctionReader((1,), _skew),
    "skewy": _FunctionReader((1,), lambda given, basis: _skew(["0", *given], basis)),
}
"""By name, in small letters."""
