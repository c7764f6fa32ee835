"""The control's tool table as the reader of programs takes it."""

from app.gcode.interpreter.options import ToolOffset
from app.gcode.tool_offsets import tool_offsets
from app.model.tool_table import TableRow


def test_of_rows_with_one_number_the_first_counts():
    rows = [TableRow(1, 1, (1.0, 2.0, 50.0), diameter=6.0), TableRow(7, 2), TableRow(1, 3, (0.0, 0.0, 9.0))]
    assert tool_offsets(rows) == {1: ToolOffset((1.0, 2.0, 50.0), 6.0), 7: ToolOffset()}
