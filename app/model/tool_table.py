"""A control's tool table: what it takes off for each tool, row by row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ..core.errors import HitofudeError
from .tool import Tool


@dataclass(frozen=True, slots=True)
class TableRow:
    """A tool as the control's table holds it.

    Attributes:
        number: T number, >= 0.
        pocket: place in the changer, >= 0; 0 = not told.
        offset: along X, Y, Z, mm. second_offset: along U, V, W, mm. rotary_offset: of A, B, C, degrees.
        diameter: mm; 0 = not told.
        front_angle, back_angle: of a lathe tool's edges, degrees. orientation: of a lathe tool, 0 ... 9.
        remark: or "".
        line: 1-based line of the file; 0 = from no file.
    """

    number: int
    pocket: int = 0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    second_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotary_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    diameter: float = 0.0
    front_angle: float = 0.0
    back_angle: float = 0.0
    orientation: int = 0
    remark: str = ""
    line: int = 0

    def tool(self) -> Tool:
        """Return the row as a cutter: a flat one, as the table tells no kind, with the usual speed and feeds.

        Raises:
            ParameterError: the row has no diameter, or a number or a length that no cutter has.
        """
        return Tool(self.number, abs(self.diameter), name=self.remark, length_offset=self.offset[2])


def row_of(tool: Tool) -> TableRow:
    """Return a cutter's row; its pocket has its number."""
    return TableRow(tool.number, tool.number, (0.0, 0.0, tool.length_offset), diameter=tool.diameter, remark=tool.label)


class CuttersOfTable(NamedTuple):
    """Cutters, and a sentence for each row that is none."""

    tools: tuple[Tool, ...]
    left_out: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ToolTable:
    """A tool table as it was read.

    Attributes:
        rows: in the order of the file; where a number comes twice the control takes the first.
        problems: sentences with file and line, one for each line that the control passes over.
    """

    rows: tuple[TableRow, ...] = ()
    problems: tuple[str, ...] = ()

    def tools(self, file: str) -> CuttersOfTable:
        """Return the cutters of the table.

        Args:
            file: its name, for the sentences.
        """
        tools: dict[int, Tool] = {}
        left_out = list(self.problems)
        for row in self.rows:
            try:
                tool = row.tool()
            except HitofudeError as error:
                left_out.append(f"{file}:{row.line}: {error}")
            else:
                tools.setdefault(tool.number, tool)
        return CuttersOfTable(tuple(tools.values()), tuple(left_out))
