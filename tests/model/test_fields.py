"""A parameter is declared once: one that is added here shows everywhere by itself."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from enum import Enum
from typing import Any

import pytest

from app.cli.commands.make import COMMAND as MAKE
from app.cli.make_options import make_options
from app.core.errors import InputError, ParameterError
from app.core.resources import resource
from app.formats.job.toml import TOOL_KEYS, read_job
from app.formats.job.write import job_lines, tool_lines
from app.formats.tools.csv import UNITS, read_tool_csv, write_tool_csv
from app.formats.tools.library import HEADER, ToolLibrary, read_library, write_library
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post
from app.gcode.writer.header import operation_words
from app.gcode.writer.write import write_files
from app.model import operation_kinds as operations
from app.model.contour_operation import ContourOperation
from app.model.fields import Unit, built, check_ranges, declared_of, parameter, parameters_of, with_values
from app.model.hole_operations import DrillOperation
from app.model.job import Job
from app.model.operation import CutParameters, Operation, Side
from app.model.operation_kinds import register
from app.model.part import Part
from app.model.tool import FeedRow, Tool, ToolMaterial
from app.model.tool_kind import ToolKind
from app.usecases.job.options import job_with_options
from app.usecases.making.report import _parameters
from app.usecases.manual.parameter_table import parameter_table
from tests.gcode.programs import job, two_tools


class Grain(Enum):
    """Which way a pattern runs."""

    ALONG = "along"
    ACROSS = "across"


@dataclass(frozen=True, slots=True)
class EngraveOperation(Operation):
    """A kind of operation that is registered from outside of the program."""

    overcut: float = parameter(
        0.5, "overcut", "Overcut", "how far lines go on", Unit.LENGTH, high=9.0, option=True, group="Walls"
    )
    grain: Grain = parameter(
        Grain.ALONG, "grain", "Grain", "which way it runs", Unit.CHOICE, option=True, choices=("Along", "Across")
    )
    slant: float = parameter(0.1, "slant", "Slant", "of the cutter", Unit.ANGLE, high=1.0, option=True)
    twice: bool = parameter(False, "twice", "Twice", "every line is cut again", Unit.FLAG, option=True)

    WORD = "engrave"
    FOLLOWS_WALLS = True

    def __post_init__(self) -> None:
        check_ranges(self)


ASKED: dict[str, Any] = {"overcut": 1.25, "grain": Grain.ACROSS, "slant": math.radians(12.5), "twice": True}


@pytest.fixture(autouse=True)
def registered(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(operations, "OPERATION_KINDS", dict(operations.OPERATION_KINDS))
    for module in ("app.formats.job.operations", "app.gcode.interpreter.own_header", "app.usecases.job.machining"):
        monkeypatch.setattr(f"{module}.OPERATION_KINDS", operations.OPERATION_KINDS)
    register(EngraveOperation)
    yield


def engraving(**values: Any) -> Operation:
    return with_values(EngraveOperation(CutParameters(2)), values)


def test_the_command_line_has_it() -> None:
    text = MAKE.parser().format_help()
    for words in ("--overcut MM", "how far lines go on", "--grain {along,across}", "--slant DEG", "--twice"):
        assert words in text
    asked = ["--overcut", "0.125cm", "--grain", "across", "--slant", "12.5", "--twice"]
    options = make_options(MAKE.arguments(["a.dxf", "-o", "o.ngc", *asked]))
    own = Job(Part(), operations=(EngraveOperation(CutParameters(2)),))
    assert job_with_options(Part(), replace(options, job=own)).operations == (engraving(**ASKED),)
    with pytest.raises(InputError, match="--overcut is 10 mm; the overcut must be 0 to 9 mm"):
        MAKE.arguments(["a.dxf", "-o", "o.ngc", "--overcut", "10"])
    with pytest.raises(ParameterError, match="--twice has no effect: the job has no engrave operation"):
        job_with_options(Part(), make_options(MAKE.arguments(["a.dxf", "-o", "o.ngc", "--twice"])))


def test_job_files_and_projects_have_it() -> None:
    text = "[[operation]]\nkind = 'engrave'\ntool = 2\novercut = 1.25\ngrain = 'across'\nslant = 12.5\ntwice = true\n"
    (read,) = read_job("j", text.encode()).job.operations
    assert read == engraving(**ASKED)
    written = "\n".join(job_lines(Job(Part(), operations=(read,))))
    assert read_job("j", written.encode()).job.operations == (read,)
    with pytest.raises(
        InputError, match="j:4: overcut belongs to engrave operations; remove it from this pocket operation"
    ):
        read_job("j", b"[[operation]]\nkind = 'pocket'\ntool = 1\novercut = 1\n")
    with pytest.raises(InputError, match="j:1: Overcut is 10 mm; use 0 to 9 mm"):
        read_job("j", b"[[operation]]\nkind = 'engrave'\ntool = 1\novercut = 10\n")


def test_programs_tell_it_and_it_is_read_back() -> None:
    made = job(operations=(ContourOperation(CutParameters(1), Side.ON), engraving(**ASKED)))
    assert operation_words(engraving(**ASKED), made) == (
        "Engrave T2: depth 2 mm, stepdown 2 mm, stock to leave 0 mm, climb, overcut 1.25 mm, grain across, slant 12.5 "
        "degrees, twice"
    )
    files = write_files(two_tools().program(), made, load_post("fanuc"))
    headers = [read_program(file.nc.text.encode(), ReadOptions(load_post("fanuc").dialect)).header for file in files]
    told = [note.operation() for header in headers if header for note in header.operations][-1]
    assert isinstance(told, EngraveOperation)
    assert {key: declared_of(EngraveOperation)[key].of(told) for key in ASKED} == {
        **ASKED,
        "slant": pytest.approx(ASKED["slant"]),
    }


def test_reports_have_it() -> None:
    told = _parameters(engraving(**ASKED))
    assert json.loads(json.dumps(told))["slant_deg"] == pytest.approx(12.5)
    assert (told["overcut_mm"], told["grain"], told["twice"]) == (1.25, "across", True)


def test_ranges_are_checked_where_a_value_comes_into_being() -> None:
    with pytest.raises(ParameterError, match=r"Slant is 90 degrees; use 0 to 57.2958 degrees"):
        engraving(slant=math.pi / 2)
    with pytest.raises(ParameterError, match="Overcut is nan mm"):
        engraving(overcut=math.nan)
    with pytest.raises(KeyError):
        engraving(stepover=1.0)
    assert built(EngraveOperation, {"tool": 2, **ASKED}) == engraving(**ASKED)
    with pytest.raises(KeyError, match="tool"):
        built(EngraveOperation, ASKED)


def test_every_parameter_has_one_meaning_in_all_kinds() -> None:
    for kind in operations.OPERATION_KINDS.values():
        for key, placed in declared_of(kind).items():
            first = operations.declared()[key].parameter
            assert (placed.parameter.label, placed.parameter.unit, placed.parameter.help) == (
                first.label,
                first.unit,
                first.help,
            )
            assert placed.parameter.help[:1].islower() or (placed.parameter.help[:1].isupper() and key == "tool")
            assert not placed.parameter.help.endswith(".")


def test_what_a_kind_leaves_unused_is_not_among_its_parameters() -> None:
    assert "stepdown" in declared_of(DrillOperation)
    assert "stepdown" not in parameters_of(DrillOperation)
    for kind in operations.OPERATION_KINDS.values():
        assert declared_of(kind).keys() >= kind.UNUSED


def test_a_tools_parameters_are_told_alike_by_all_files() -> None:
    keys = set(declared_of(Tool))
    assert keys == {field.name for field in fields(Tool)} == set(TOOL_KEYS) == {*UNITS, "feeds"}
    for key in keys:
        assert re.search(rf"\b{key}\b|tool\.{key}", HEADER), f"the head of a library does not explain {key}"
        assert f"| `{key}` |" in parameter_table()
    whole = Tool(
        3,
        12.0,
        ToolKind.TAPER,
        "t",
        3,
        9000.0,
        500.0,
        90.0,
        0.0,
        2.0,
        math.radians(12),
        30.0,
        80.0,
        40.0,
        12.0,
        -1.0,
        ((0.0, 10.0), (25.0, 15.0)),
        "r",
        (FeedRow("brass", 90.0, 0.03),),
        ToolMaterial.HSS,
    )
    library = read_library("l", write_library(ToolLibrary("l", (whole,)))).tools
    assert library == read_tool_csv("l", write_tool_csv(ToolLibrary("l", (whole,))))[0].tools == (whole,)
    assert read_job("j", "\n".join(tool_lines(whole)).encode()).job.tools == (whole,)


def test_the_manual_has_a_table_of_all() -> None:
    assert (
        "| `overcut` | `--overcut` | Overcut | how far lines go on | 0 to 9 mm | 0.5 mm | engrave |"
        in parameter_table()
    )
    operations.OPERATION_KINDS.pop("engrave")
    page = resource("docs", "parameters.md")
    assert page.read_text("utf-8") == parameter_table(), (
        "write the page anew: app.usecases.manual.parameter_table.parameter_table()"
    )
