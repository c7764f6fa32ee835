"""Names of layers: as files write them, and as people typed them."""

from __future__ import annotations

import re
from collections.abc import Iterable

_SIGN = re.compile(r"_x([0-9A-Fa-f]{2}|[0-9A-Fa-f]{4})_")
_NO_LETTER = re.compile(r"[\x00-\x1f\x7f-\x9f\ufffd]")


def typed_name(name: str) -> str:
    """Return the name of an element as it was typed: some editors write what no name may have as _x0020_, a letter of
    two such numbers as both; one that gives no letter was typed as it stands.
    """
    units = _SIGN.sub(lambda sign: chr(int(sign[1], 16)), name).encode("utf-16", "surrogatepass")
    typed = units.decode("utf-16", "replace")
    return name if _NO_LETTER.search(typed) else typed


def known_layer(name: str, layers: Iterable[str]) -> str | None:
    """Return the layer of a drawing that a name means, as the drawing spells it; None where there is none.

    Args:
        name: in any case, as it was typed or as the file has it (L_x0020_1 for "L 1").
        layers: all that there are.
    """
    known = {layer.casefold(): layer for layer in layers}
    return known.get(name.casefold(), known.get(typed_name(name).casefold()))


def known_layers(names: Iterable[str], layers: Iterable[str]) -> frozenset[str]:
    """Return the layers of a drawing that some names mean, casefolded; what it has not is passed over."""
    there = tuple(layers)
    found = (known_layer(name, there) for name in names)
    return frozenset(layer.casefold() for layer in found if layer is not None)
