"""The tool library in the side panel: search, feeds for a material, into the job undoably; files in and out."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby

import pytest
from PySide6.QtCore import Qt

from app.core.resources import resource
from app.drafting.document import Document
from app.formats.tools.files import read_tools, write_tools
from app.formats.tools.library import ToolLibrary, load_libraries, own_folder
from app.model.hole_operations import DrillOperation
from app.model.job import Job
from app.model.operation import CutParameters
from app.model.part import Part, Units
from app.model.tool import FeedRow, Tool
from app.model.tool_kind import ToolKind, shape_keys
from app.simulation.cutter import cutter_of
from app.ui.framework.icons import IconLabel
from app.ui.panels.changes import Subject, SubjectKind, for_material, material_of
from app.ui.panels.side_panel import SidePanel
from app.ui.panels.tool_kinds import icon_of, listed_kinds, use_of
from app.ui.shell.files.tool_exchange import IN, ToolExchange
from tests.formats.foreign_tools import fusion_archive, fusion_tool


@pytest.fixture(scope="module")
def shared(qapp) -> Iterator[tuple[Document, SidePanel]]:
    """One panel for all tests: making its 400 widgets takes longer than most of what is asked of it."""
    document = Document(Job(Part()))
    made = SidePanel(document)
    yield document, made
    made.deleteLater()


@pytest.fixture
def document(shared) -> Document:
    document, _ = shared
    document.load(Job(Part()))
    return document


@pytest.fixture
def panel(shared, document) -> Iterator[SidePanel]:
    """The panel with its library, as it is opened the first time."""
    _, made = shared
    made.choose(Subject(SubjectKind.OPERATION, 0))
    made.library.search.clear()
    made.resize(328, 620)
    made.show()
    made.tools.library_button.click()
    yield made
    made.hide()


def search(qtbot, panel, text: str) -> None:
    panel.library.search.setFocus()
    panel.library.search.selectAll()
    qtbot.keyClicks(panel.library.search, text)


def test_it_opens_in_the_place_of_the_properties_and_closes_again(panel):
    assert panel.library.isVisible()
    assert panel.tools.library_button.isChecked()
    assert not panel.operation_form.isVisible()
    panel.choose(Subject(SubjectKind.OPERATION, 1))
    assert not panel.library.isVisible()
    assert panel.operation_form.isVisible()
    assert not panel.tools.library_button.isChecked()


def test_the_list_holds_every_kind_with_its_icon_and_words(qtbot, panel):
    library = panel.library
    assert [kind for kind, _ in groupby(tool.kind for tool in library.shown)] == list(listed_kinds()), "kind by kind"
    assert [kind.value for kind in listed_kinds()] == [
        "flat",
        "bull",
        "ball",
        "taper",
        "v",
        "thread-mill",
        "reamer",
        "drill",
        "tap",
    ]
    for _, kind in groupby(library.shown, lambda tool: tool.kind):
        diameters = [tool.diameter for tool in kind]
        assert diameters == sorted(diameters)
    for tool, row in library._rows:
        assert row.toolTip() == f"{tool.kind.title}. Enter: add to the job"
        assert row.findChild(IconLabel).name == icon_of(tool.kind)
        assert resource("icons", f"{icon_of(tool.kind)}.svg").is_file()
    search(qtbot, panel, "no such tool")
    assert library.shown == () and library.none.isVisible() and "No tool is called that" in library.none.text()
    assert not library.add_button.isEnabled()


@pytest.mark.parametrize(
    ("kind", "about"),
    [
        (ToolKind.FLAT, "Flat end mill, 2 flutes"),
        (ToolKind.DRILL, "Drill, 2 flutes, 118°"),
        (ToolKind.V, "V cutter, 1 flute, 30°, tip 0.1 mm"),
    ],
)
def test_what_a_tool_is_for_is_said_before_it_is_taken(panel, kind, about):
    panel.library.choose(next(tool for tool in panel.library.shown if tool.kind is kind and tool.diameter >= 3))
    lines = panel.library.details.text().splitlines()
    assert lines[0].startswith(about)
    assert lines[3:] == [use_of(kind)] * bool(use_of(kind))


@pytest.mark.parametrize("words", ["drill 5", "5mm drill"])
def test_a_drill_is_put_into_the_job_and_drills(qtbot, document, panel, words):
    search(qtbot, panel, words)
    assert [tool.name for tool in panel.library.shown] == ["Drill 5 mm, M6 tap"]
    qtbot.mouseClick(panel.library.add_button, Qt.MouseButton.LeftButton)
    added = document.job.tools[-1]
    assert added.kind is ToolKind.DRILL and added.tip_angle > 0
    document.job.cutter(DrillOperation(CutParameters(added.number)))


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("flat 1.5", ["Flat 1.5 mm"]),
        ("end mill flat 12 mm", ["Flat 12 mm"]),
        ("FLAT 8MM", ["Flat 8 mm"]),
        ("drill 4.2", ["Drill 4.2 mm, M5 tap"]),
        ("v cutter 60", ["V 60 deg 6 mm"]),
    ],
)
def test_the_search_knows_words_and_diameters(qtbot, panel, text, found):
    search(qtbot, panel, text)
    assert [tool.name for tool in panel.library.shown] == found


def test_enter_adds_the_tool_with_the_feeds_of_the_material_undoably(qtbot, document, panel):
    search(qtbot, panel, "flat 8")
    panel.library.material.box.setCurrentIndex(1)
    panel.library.material.box.activated.emit(1)
    assert "Flat end mill, 3 flutes\n24 mm of cut, 63 mm overall\nF 3\u2009820, down" in panel.library.details.text()
    qtbot.keyClick(panel.library.search, Qt.Key.Key_Return)
    added = document.job.tools[-1]
    wood = next(row for row in added.feeds if row.material == "wood")
    assert (added.number, added.diameter, material_of(added)) == (9, 8.0, "wood")
    assert added.feed_rate == pytest.approx(added.spindle_speed * added.flutes * wood.feed_per_tooth, rel=0.01)
    assert panel.subject == Subject(SubjectKind.TOOL, 9)
    document.undo()
    assert len(document.job.tools) == 2


def test_a_number_that_is_taken_becomes_the_next_one(qtbot, document, panel):
    search(qtbot, panel, "flat 1.5")
    qtbot.mouseClick(panel.library.add_button, Qt.MouseButton.LeftButton)
    assert [tool.number for tool in document.job.tools] == [1, 2, 3], "T2 is taken"


def test_a_tool_takes_the_place_of_the_jobs_own(qtbot, document, panel):
    assert not panel.library.put_button.isVisible(), "an operation is chosen, so there is nothing to replace"
    panel.choose(Subject(SubjectKind.TOOL, 2))
    assert panel.library.put_button.text() == "Replace T2"
    search(qtbot, panel, "flat 2.5")
    qtbot.mouseClick(panel.library.put_button, Qt.MouseButton.LeftButton)
    assert [(tool.number, tool.diameter) for tool in document.job.tools] == [(1, 6.0), (2, 2.5)]
    assert document.undo_name == "Replace T2"


def test_arrows_walk_from_the_search_through_the_list(qtbot, panel):
    library = panel.library
    qtbot.keyClick(library.search, Qt.Key.Key_Down)
    rows = [row for _, row in library._rows]
    qtbot.keyClick(rows[0], Qt.Key.Key_Down)
    assert rows[1].property("chosen") == "true"
    qtbot.keyClick(rows[1], Qt.Key.Key_Up)
    qtbot.keyClick(rows[0], Qt.Key.Key_Up)
    qtbot.keyClick(rows[0], Qt.Key.Key_Escape)
    assert not library.isVisible()


def test_the_list_has_the_rows_that_there_is_room_for(qtbot, panel):
    for height, rows in ((500, 4), (900, 13)):
        panel.resize(328, height)
        qtbot.waitUntil(lambda rows=rows: panel.library.area.height() == rows * 28)


def test_the_chosen_row_is_in_sight_when_the_library_opens_again(qtbot, panel):
    library = panel.library
    library.choose(library.shown[-1])
    panel.switch_library()
    panel.resize(328, 420)
    panel.switch_library()
    qtbot.wait(50)
    row = library._rows[-1][1]
    assert library.area.viewport().rect().contains(row.mapTo(library.area.viewport(), row.rect().center()))


def test_the_form_offers_the_tools_materials(qtbot, document, panel):
    tool = replace(Tool(2, 6.0), feeds=(FeedRow("steel", 90.0, 0.03), FeedRow("wood", 500.0, 0.12)))
    document.change_job("Change tools", replace(document.job, tools=(document.job.tools[0], tool)))
    panel.switch_library()
    panel.choose(Subject(SubjectKind.TOOL, 2))
    form = panel.tool_form
    assert form.material.isVisible()
    assert form.material.box.currentIndex() == -1, "its feeds are those of neither"
    form.material.box.activated.emit(0)
    assert document.job.tools[1] == for_material(tool, "steel")
    assert document.job.tools[1].spindle_speed == pytest.approx(1000 * 90 / 3.14159265 / 6, abs=5)
    assert form.material.box.currentText() == "Steel"
    panel.choose(Subject(SubjectKind.TOOL, 1))
    assert not form.material.isVisible()


@pytest.fixture
def exchange(qtbot, workspace):
    panel = SidePanel(workspace.document)
    qtbot.addWidget(panel)
    panel.refused.connect(workspace.notice.ask)
    return ToolExchange(panel, workspace)


def test_tools_are_imported_into_the_users_library_and_stay_there(tmp_path, exchange, workspace):
    notice = workspace.notice
    for name, data in (
        ("mine.csv", b"number,diameter_mm,name\n5,7.5,Own cutter\n"),
        ("lib.toml", write_tools("x.toml", ToolLibrary("Lib", (Tool(6, 9.5, name="Other"),)))),
    ):
        (tmp_path / name).write_bytes(data)
        exchange.take(tmp_path / name)
        assert notice.text.text() == f"1 tool of {name} in the library."
    assert {"Own cutter", "Other"} <= {tool.name for tool in exchange._panel.library.shown}
    assert set(load_libraries().libraries) == {"lib", "mine", "metric-drills", "metric-mills", "threads-and-reamers"}
    exchange.take(tmp_path / "mine.csv")
    assert notice.text.text() == "There is a library mine already."


def test_a_tool_table_names_no_units_so_they_are_asked_for(tmp_path, exchange, workspace):
    notice = workspace.notice
    (tmp_path / "mill.tbl").write_bytes(b"T1 P1 Z2 D0.25 ;quarter\nT2 P2 Z1 ;probe\n")
    exchange.take(tmp_path / "mill.tbl")
    assert "Left out: mill.tbl:2: T2: diameter is 0 mm" in notice.text.text()
    assert "It names no units; it was read in mm." in notice.text.text()
    assert notice.buttons[1].text() == "Read in inch"
    notice.buttons[1].click()
    (tool,) = load_libraries().libraries["mill"].tools
    assert (tool.diameter, tool.length_offset) == (pytest.approx(6.35), pytest.approx(50.8))


def test_what_is_wrong_with_a_file_is_said_and_nothing_is_kept(tmp_path, exchange, workspace):
    (tmp_path / "bad.csv").write_bytes(b"number,diameter_mm\n5,six\n")
    exchange.take(tmp_path / "bad.csv")
    assert workspace.notice.text.text().startswith("bad.csv:2: diameter_mm is 'six'")
    exchange.take(tmp_path / "gone.csv")
    assert "gone.csv does not exist" in workspace.notice.text.text()
    assert not own_folder().exists()


@pytest.mark.parametrize(
    ("name", "units"), [("t.toml", Units.MM), ("t.csv", Units.MM), ("t.tbl", Units.MM), ("t.tbl", Units.INCH)]
)
def test_the_jobs_tools_are_exported(tmp_path, exchange, workspace, name, units):
    exchange.write(tmp_path / name, units)
    library, _ = read_tools(name, (tmp_path / name).read_bytes(), units)
    assert [(tool.number, round(tool.diameter, 6)) for tool in library.tools] == [(1, 6.0), (2, 3.0)]
    exchange.write(tmp_path / "t.xls")
    assert "tools are read as .toml, .csv, .tbl, .tools, .json, .fctb, .vtdb" in workspace.notice.text.text()


@pytest.mark.parametrize("kind", listed_kinds())
def test_every_kind_has_its_fields_and_can_be_cut_with(document, panel, kind):
    panel.switch_library()
    panel.choose(Subject(SubjectKind.TOOL, 2))
    form = panel.tool_form
    form.kind.box.activated.emit(listed_kinds().index(kind))
    tool = document.job.tools[1]
    assert (tool.kind, tool.tip_angle) == (kind, kind.usual_angle)
    shown = {
        name
        for name, field in (("corner_radius", form.corner), ("tip_angle", form.angle), ("tip_diameter", form.tip))
        if field.isVisible()
    }
    assert shown == shape_keys(kind)
    cutter_of(tool)


def test_tools_of_another_program_come_in_by_the_same_door(tmp_path, exchange, workspace):
    entries = [fusion_tool(number=3), fusion_tool("dovetail mill", 4)]
    (tmp_path / "shop.tools").write_bytes(fusion_archive(entries))
    assert all(suffix in IN for suffix in ("*.tools", "*.json", "*.fctb", "*.fctl", "*.vtdb", "*.tbl"))
    exchange.take(tmp_path / "shop.tools")
    assert "1 tool of shop.tools in the library" in workspace.notice.text.text()
    assert "dovetail mill 4 is left out" in workspace.notice.text.text()
    assert any(tool.name == "flat end mill 3" and tool.stick_out == 25.0 for tool in exchange._panel.library.shown)
