"""Names of layers: as files write them, and as people typed them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

_SIGN = re.compile(r"_x([0-9A-Fa-f]{2}|[0-9A-Fa-f]{4})_")
_NO_LETTER = re.compile(r"[\x00-\x1f\x7f-\x9f\ufffd]")
_WILD = "*?["
"""Signs that mean other ones in a pattern."""


def typed_name(name: str) -> str:
    """Return the name of an element as it was typed: some editors write what no name may have as _x0020_, a letter of
    two such numbers as both; one that gives no letter was typed as it stands.
    """
    return _decoded(name, str)


def typed_pattern(pattern: str) -> str:
    """Return a pattern of names, such as A*, as it was typed; a letter that is written as its number is that letter
    alone, also where it is *, ? or [.
    """
    return _decoded(pattern, lambda letter: f"[{letter}]" if letter in _WILD else letter)


def _decoded(name: str, spelled_letter: Callable[[str], str]) -> str:
    """Return a name with letters in place of their numbers, as it stands where one gives no letter."""
    units = _SIGN.sub(lambda sign: spelled_letter(chr(int(sign[1], 16))), name).encode("utf-16", "surrogatepass")
    typed = units.decode("utf-16", "replace")
    return name if _NO_LETTER.search(typed) else typed


def spelled(names: Iterable[str], layers: Iterable[str]) -> dict[str, str | None]:
    """Return for each of some names the layer of a drawing that it means, as the drawing spells it; None where there
    is none.

    Args:
        names: in any case, as they were typed or as the file has them (L_x0020_1 for "L 1").
        layers: all that there are.
    """
    known = {layer.casefold(): layer for layer in layers}
    return {name: known.get(name.casefold(), known.get(typed_name(name).casefold())) for name in names}


def known_layers(names: Iterable[str], layers: Iterable[str]) -> frozenset[str]:
    """Return the layers of a drawing that some names mean, casefolded; what it has not is passed over."""
    return frozenset(layer.casefold() for layer in spelled(names, layers).values() if layer is not None)
