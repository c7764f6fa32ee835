"""Blocks of a DXF that are defined again under the name of another one: the first holds, as in CAD programs.

The library would draw all of them, one over the other.
"""

from __future__ import annotations

from typing import Any

_SPACES = ("*model_space", "*paper_space")
"""Names of spaces, which begin so; what lies in one may stand in several places."""
_NAME = 2


def without_repeated(sections: dict[str, list[Any]]) -> tuple[str, ...]:
    """Take later definitions of a block away, from BLOCK to ENDBLK, and return their names.

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
