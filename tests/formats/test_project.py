"""Project files: what is written is read back identical, and what is damaged is told with its place."""

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.drafting.document import Document
from app.drafting.history import HistoryState
from app.formats.job.toml import read_job
from app.formats.job.write import empty_lists, job_lines
from app.formats.project.extras import MOST_TEXT, ProjectExtras
from app.formats.project.project import MOST_HEAD, Project, SavedView, read_project, write_project
from app.formats.readers import read_drawing
from app.model.curves import Circle
from app.model.job import Job
from app.model.part import Part
from app.model.reading import DrawingSource, ReadingOptions
from tests.conftest import ROOT
from tests.examples import examples
from tests.formats.project_cases import jobs, projects

GOLDEN = ROOT / "tests" / "data" / "version1.hito"


def same(one: Project, other: Project) -> None:
    assert other.state.job == one.state.job
    assert other.state.job.part.used_id == one.state.job.part.used_id
    assert (other.state.layer, other.state.last, other.state.names) == (
        one.state.layer,
        one.state.last,
        one.state.names,
    )
    assert {name: each.source for name, each in other.state.commands.items()} == {
        n: c.source for n, c in one.state.commands.items()
    }
    assert list(other.state.names) == list(one.state.names)
    assert (other.look, other.beside) == (one.look, one.beside)


@settings(max_examples=examples(150), deadline=None)
@given(projects())
def test_every_project_is_read_back_identical(project: Project) -> None:
    data = write_project(project)
    again = read_project("p.hito", data)
    same(project, again)
    assert write_project(again) == data


@settings(max_examples=examples(50), deadline=None)
@given(jobs())
def test_a_job_file_in_order_is_read_back_identical(job: Job) -> None:
    """Where nothing is written that a job file refuses for having no effect."""
    text = "\n".join([*empty_lists(job), *job_lines(job)])
    try:
        read = read_job("j.toml", text.encode())
    except InputError as error:
        assert re.search("no effect|belongs to|has no tool|is a drill|is taken", str(error))
    else:
        if job.tools and job.operations:
            assert read.job == job


def drawn() -> Project:
    document = Document()
    for line in (
        "layer holes",
        'colour holes "#d55e00"',
        "let w = 1/3",
        "circle w,2 5 as hole",
        "line 0,0 10,10",
        "rect 0,0 30,20",
        "delete 3",
        "define bolt(c)\n  circle c 2\nend",
        "bolt 8,8",
        "let p = 3,4",
    ):
        document.run(line)
    return Project(document.state, SavedView("view_draw", (5.0, 6.25), 12.5))


def test_how_a_drawing_was_read_goes_on_into_its_programs() -> None:
    """Also what was assumed where its file leaves the size open."""
    svg = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 90"><rect width="90" height="90"/></svg>'
    part = read_drawing("a.svg", svg).part
    assert part.reading.pixels_per_inch == 96
    project = replace(
        drawn(), state=replace(drawn().state, job=replace(drawn().state.job, part=part), source=DrawingSource("a.svg"))
    )
    again = read_project("p.hito", write_project(project)).state
    assert again.job.part.reading == part.reading
    assert again.source == DrawingSource("a.svg", ReadingOptions(how=part.reading))


def test_the_first_version_opens() -> None:
    """The file is never written anew: it stands for all that people have."""
    same(drawn(), read_project(GOLDEN.name, GOLDEN.read_bytes()))


def test_one_change_changes_few_lines() -> None:
    document = Document()
    for k in range(20):
        document.run(f"line {k},0 {k},5")
    before = write_project(Project(document.state)).decode().splitlines()
    document.run("move @1,1 7")
    after = write_project(Project(document.state)).decode().splitlines()
    assert len(set(after) ^ set(before)) == 2
    document.run("delete 3")
    assert set(write_project(Project(document.state)).decode().splitlines()) - set(after) == {"#4"}


def test_names_and_commands_go_on_working() -> None:
    project = read_project("p.hito", write_project(drawn()))
    document = Document()
    document.load_state(project.state)
    document.run("bolt 1,1")
    document.run("delete hole")
    assert document.part.curve(1) is None
    assert document.layer == "holes" and document.part.entities[-1].id == 8


TEXT = write_project(drawn()).decode()


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('format = "hitofude"', 'format = "other"', "no project of Hitofude"),
        ('format = "hitofude"', "", "no project of Hitofude"),
        (
            "version = 1",
            "version = 2",
            "version 2, and this Hitofude reads up to version 1; open it with a newer one. The file stays as it is",
        ),
        ("version = 1", "version = 0", "version is 0"),
        ("version = 1", "version = true", "version is True"),
        ("version = 1", "version = 1\nmore = 3", r"p.hito:4: more is no part of a project file"),
        ('name = "0"', 'nam = "0"', r"p.hito:\d+: nam is no key of \[layer\]"),
        ('colour = "#d55e00"', 'colour = "red"', r"p.hito:\d+: colour is no colour"),
        ("line 0,0 10,10", "line 0,0 10", r"p.hito:\d+: 'line 0,0 10' cannot be read"),
        ("line 0,0 10,10", "line 0,0", r"'line 0,0' cannot be read \(a line has two points\)"),
        (
            "line 0,0 10,10",
            "lime 0,0 10,10",
            r"p.hito:\d+: 'lime 0,0 10,10' cannot be read \('lime' is no word for it\)",
        ),
        ("line 0,0 10,10", "line 0,0 nan,10", "nan is no length"),
        ("line 0,0 10,10", "#1\nline 0,0 10,10", "number 1 is there twice"),
        ("line 0,0 10,10", "#x\nline 0,0 10,10", "'#x' cannot be read"),
        ("line 0,0 10,10", 'layer "new"\nline 0,0 10,10', "curve 2 lies on the layer new, which is in no"),
        ("thickness = 10.0", "thickness = 0.0", r"p.hito:\d+: Stock margin is 0 mm and thickness 0 mm"),
        ("thickness = 10.0", "thickness = ", r"p.hito:\d+: .*the file is damaged"),
        ("w = 0.3333333333333333", 'w = "1-999999999"', r"w in \[names\]"),
        ("w = 0.3333333333333333", "w = [1]", r"w in \[names\]"),
        ('"define bolt(c)"', '"define bolt(c"', r"bolt in \[commands\] cannot be read"),
        ('"define bolt(c)"', '"define nut(c)"', r"bolt in \[commands\] is not one define"),
        ("scale = 12.5", "scale = 0", "scale is out of range"),
        ("centre = [5.0, 6.25]", "centre = [inf, nan]", r"p.hito:\d+: centre is .*it must be a number up to 1e\+15"),
        ("line 0,0 10,10", "line 0,0 1e308,10", "1e308 is no length, or larger than"),
        ("line 0,0 10,10", "ellipse 0,0 @1,0 ratio 0.5 from 0rad to 1e9rad", "a few turns at most"),
        ("line 0,0 10,10", "#9999999999999\nline 0,0 10,10", "too large or none"),
        ('name = "holes"', 'name = "0"', r"p.hito:\d+: name is that of another layer"),
        ("thickness = 10.0", "thickness = inf", "thickness is inf"),
        ("[names]", "[underlay]\norigin = [0, 0]\n[names]", r"p.hito:\d+: \[underlay\] names no picture"),
        (
            "[names]",
            '[underlay]\npath = "a.png"\nmm_per_px = 0\n[names]',
            r"p.hito:\d+: The picture a.png cannot lie there",
        ),
        ("[names]", "[source]\nto_zero = true\n[names]", r"p.hito:\d+: \[source\] names no drawing"),
        (
            "[names]",
            '[source]\npath = "a.svg"\npixels_per_inch = 0\n[names]',
            r"p.hito:\d+: --px-per-inch is 0; use 1 to 100000",
        ),
        ("[names]", '[source]\npath = "a.dxf"\nlayuot = "A3"\n[names]', r"p.hito:\d+: layuot is no key of \[source\]"),
        ("[names]", "[text]\nlines = 3\n[names]", r"p.hito:\d+: lines is 3: it must be a list of texts"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(old: str, new: str, told: str) -> None:
    assert old in TEXT
    damaged = TEXT.replace(old, new, 1)
    with pytest.raises(InputError, match=told) as caught:
        read_project("p.hito", damaged.encode())
    if match := re.match(r"p\.hito:(\d+):", str(caught.value)):
        assert abs(int(match[1]) - (TEXT[: TEXT.index(old)].count("\n") + 1)) <= 2


def test_a_text_too_long_for_the_file_is_left_out_and_the_file_is_read() -> None:
    kept, left_out = ("a" * count for count in (MOST_TEXT - 100, MOST_TEXT))
    for text, read in ((kept, kept), (left_out, "")):
        assert (
            read_project("p.hito", write_project(Project(drawn().state, beside=ProjectExtras(text=text)))).beside.text
            == read
        )


@pytest.mark.parametrize("size", [1e16, math.nan, math.inf])
def test_what_could_not_be_read_again_is_told_when_it_is_written(size: float) -> None:
    part = Part().with_curves([Circle((0.0, 0.0), size)], "0")
    with pytest.raises(InputError, match="a project holds up to 1e"):
        write_project(Project(HistoryState(Job(part))))


def test_windows_line_ends_are_read() -> None:
    other = TEXT.replace("\n", "\r\n").encode()
    assert other.count(b"\r\n") == TEXT.count("\n") > 10
    same(drawn(), read_project("p.hito", other))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff\xfe",
        b"[" * 100_000,
        b'format = "hitofude"\nversion = 1\nx = ' + b"[" * 50_000,
        b"a" * (MOST_HEAD + 10),
        b"format = \"hitofude\"\nversion = 1\n[curves]\nlines = '''\n" + b"line 0,0 1,1\n" * 500_002 + b"'''\n",
        b"0" * (64 * 2**20 + 1),
    ],
)
def test_bombs_are_refused(data: bytes) -> None:
    with pytest.raises(InputError, match=r"p\.hito"):
        read_project("p.hito", data)


@settings(max_examples=examples(300), deadline=None)
@given(st.data())
def test_damaged_files_are_told_and_nothing_else_happens(data: st.DataObject) -> None:
    raw = bytearray(TEXT.encode())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, max(len(raw) - 1, 0)))
        what = data.draw(st.sampled_from(["cut", "put", "swap", "end"]))
        if what == "cut":
            del raw[at : at + data.draw(st.integers(1, 30))]
        elif what == "put":
            raw[at:at] = data.draw(st.binary(min_size=1, max_size=8))
        elif what == "swap":
            raw[at : at + 1] = data.draw(st.binary(min_size=1, max_size=1))
        else:
            del raw[at:]
    try:
        read = read_project("p.hito", bytes(raw))
    except InputError as error:
        assert str(error).startswith("p.hito")
    else:
        same(read, read_project("p.hito", write_project(read)))


def test_large_drawings_are_written_and_read(tmp_path: Path) -> None:
    document = Document()
    part = Part()
    lines = [entity.curve for entity in drawn().state.job.part.entities] * 2000
    part = part.with_curves(lines, "0")
    document.load(replace(document.job, part=part))
    project = Project(document.state)
    same(project, read_project("p.hito", write_project(project)))


def test_a_name_for_a_length_is_a_length_again() -> None:
    document = Document()
    document.run("let w = 3in")
    document.load_state(read_project("p.hito", write_project(Project(document.state))).state)
    document.run("units in; circle 0,0 w; end")
    (entity,) = document.part.entities
    assert entity.curve.radius == 3 * 25.4  # type: ignore[union-attr]
