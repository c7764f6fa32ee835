"""Model space and the layouts of a DXF: which one is read, and what lies in the others."""

from __future__ import annotations

from collections import Counter
from typing import Any

from ...core.errors import InputError

PAPER = "paper space entity"


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
