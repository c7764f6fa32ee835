"""Rows of problems and differences, and the lines that they mark."""

from app.gcode.interpreter.program import ProgramProblem, Severity
from app.gcode.interpreter.reader import read_program
from app.gcode.rework.compare import compare
from app.ui.views.nc.places import difference_places, differing_rows, in_order, problem_places, rows_of
from app.ui.views.nc.places_panel import PlacesPanel, PlaceWeight

FIRST = b"G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X40\nG1 Y20\nM2\n"


def differences(changed):
    return compare(read_program(FIRST), read_program(changed))


def test_errors_and_warnings_are_counted_and_sorted():
    problems = in_order([ProgramProblem(9, 3, "G5", "late."), ProgramProblem(2, 0, "", "early.", Severity.WARNING)])
    title, rows = problem_places(problems)
    assert title == "1 error, 1 warning"
    assert [row.words for row in rows] == ["2   early.", "9:3   G5: late."]
    assert [row.weight for row in rows] == [PlaceWeight.WARNING, PlaceWeight.ERROR]


def test_a_changed_line_is_marked_in_both():
    found = differences(FIRST.replace(b"G1 X40", b"G1 X41"))
    title, rows = difference_places(found)
    assert "1.000 mm apart" in title
    assert rows[0].weight is PlaceWeight.WARNING
    assert set(differing_rows([item.a for item in found.items])) >= {3}
    first, last = rows_of(found.items[0].a)
    assert first <= 3 <= last


def test_a_line_that_only_one_has_marks_none_in_the_other():
    found = differences(FIRST.replace(b"G1 Y20\n", b"G1 Y20\nG1 X0\n"))
    assert differing_rows([item.a for item in found.items]).tolist() == []
    assert differing_rows([item.b for item in found.items]).tolist() == [5]
    assert "after 5" in difference_places(found)[1][0].words


def test_a_line_in_two_halves_is_only_a_remark():
    found = differences(FIRST.replace(b"G1 X40\n", b"G1 X20\nG1 X40\n"))
    title, rows = difference_places(found)
    assert title == "1 difference, the same motion"
    assert rows[0].weight is PlaceWeight.REMARK


def test_panel_steps_round_and_hides_without_rows(qtbot):
    panel = PlacesPanel("problem", "F4")
    qtbot.addWidget(panel)
    panel.show_places("2 errors", problem_places([ProgramProblem(1, 1, "X", "a."), ProgramProblem(2, 1, "Y", "b.")])[1])
    seen = []
    panel.picked.connect(seen.append)
    for way in (1, 1, 1, -1):
        panel.step(way)
    assert seen == [0, 1, 0, 1]
    panel.show_places("", ())
    assert panel.isHidden()
