"""Blocks of a DXF that are defined again under the name of another one: the first holds, as in CAD programs.

The library would draw all of them, one over the other.
"""

from __future__ import annotations

from typing import Any

_SPACES = ("*model_space", "*paper_space")
"""Names of spaces, which begin so; what lies in one may stand in several places."""
_NAME = 2


def without_repeated(sections: dict[str, list[Any]]) -> int:
    """Take later definitions of a block away, from BLOCK to ENDBLK, and return how many there were.

    Args:
        sections: of a file by name, each the entities of the library, as tags of codes and values.
    """
    entities, known = sections.get("BLOCKS", []), set[str]()
    kept, repeated, dropping = [], 0, False
    for tags in entities:
        kind = tags[0].value
        if kind == "BLOCK":
            name = str(next((tag.value for tag in tags if tag.code == _NAME), "")).casefold()
            dropping = name in known
            repeated += dropping
            known |= {name} if name and not name.startswith(_SPACES) else set()
        if not dropping:
            kept.append(tags)
        dropping = dropping and kind != "ENDBLK"
    entities[:] = kept
    return repeated
