"""What the reader of NC programs needs to know of the control's tool table."""

from __future__ import annotations

from collections.abc import Iterable

from ..model.tool_table import TableRow
from .interpreter.options import ToolOffset


def tool_offsets(rows: Iterable[TableRow]) -> dict[int, ToolOffset]:
    """Return offsets and diameters by number, mm; of rows with the same number the first counts, as on the control."""
    offsets: dict[int, ToolOffset] = {}
    for row in rows:
        offsets.setdefault(row.number, ToolOffset(row.offset, row.diameter))
    return offsets
