"""A kind of tool is registered in one place: one that is added here is told, kept and cut with like any other."""

from __future__ import annotations

import copy
import json
import math
import pickle
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from app.cli.cut_options import tool_given
from app.cli.main import main
from app.core.errors import InputError, ParameterError
from app.formats.job.toml import read_job
from app.formats.job.write import tool_lines
from app.formats.tools.files import read_tools, write_tools
from app.formats.tools.library import ToolLibrary
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post
from app.gcode.writer.write import write_files
from app.model.tool import Tool
from app.model.tool_kind import ToolKind, ToolProfile, register, tool_kind, tool_kinds, withdraw
from app.simulation.cutter import cutter_of
from app.surfaces.cutter_contact.drop_cutter import shape_of
from app.toolpath.rest_material import flat_radius
from app.usecases.cutting.setup_tools import _noted
from tests.gcode.programs import job, two_tools

DRUM = ToolKind(
    "drum",
    "Drum mill",
    lambda shape: ToolProfile(shape.tip_radius, shape.radius - shape.tip_radius),
    keys=frozenset({"tip_diameter"}),
    given=("tip_diameter", "diameter"),
    aliases=("barrel",),
)
"""Round from a level disc up to its wall."""

MILL = Tool(1, 10.0, DRUM, tip_diameter=4.0)


@pytest.fixture(autouse=True)
def registered() -> Iterator[None]:
    register(DRUM)
    yield
    withdraw(DRUM)


def test_an_option_tells_it() -> None:
    assert tool_given("1=drum:4:10") == (1, MILL)
    with pytest.raises(
        InputError,
        match=r"1=drum:4' has 1 number behind drum; write one of .*taper:TIP:ANGLE:D, .*thread-mill:D:TIP, drum:TIP",
    ):
        tool_given("1=drum:4")


def test_files_keep_it() -> None:
    for suffix in (".toml", ".csv"):
        read, _ = read_tools(f"a{suffix}", write_tools(f"a{suffix}", ToolLibrary("a", (MILL,))))
        assert read.tools[0].kind is DRUM and read.tools[0].tip_diameter == 4.0
    assert read_job("j", "\n".join(tool_lines(MILL)).encode()).job.tools == (MILL,)
    assert read_tools("a.csv", b"number,diameter_mm,kind\n3,10,barrel mill\n")[0].tools[0].kind is DRUM
    with pytest.raises(
        InputError, match=r"no kind of tool; use flat, ball, bull, v, drill, taper, reamer, tap, thread-mill, drum"
    ):
        read_tools("a.csv", b"number,diameter_mm,kind\n3,10,square\n")
    with pytest.raises(ParameterError, match="a tool of kind drum has no tip angle"):
        Tool(1, 10.0, DRUM, tip_angle=1.0)


def test_a_program_tells_it_and_it_is_read_back() -> None:
    made = job(tools=(MILL, Tool(2, 3.0)))
    (file,) = write_files(two_tools().program(), made, load_post("linuxcnc"))
    notes = read_program(file.nc.text.encode(), ReadOptions(load_post("linuxcnc").dialect)).tools
    assert _noted(next(note for note in notes if note.number == 1), "the header").tool == MILL


def test_it_has_its_shape_wherever_one_is_asked_for() -> None:
    cutter = cutter_of(MILL)
    assert (cutter.flat, cutter.fillet, cutter.slope) == (2.0, 3.0, math.inf)
    assert shape_of(MILL) == pytest.approx((2.0, 3.0, 0.0, 5.0, 5.0))
    assert flat_radius(MILL) == 2.0


def test_it_is_cut_with(tmp_path: Path) -> None:
    program, heights = tmp_path / "a.nc", tmp_path / "a.npy"
    program.write_text("G21 G90\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-3 F100\nG1 X20 F300\nG0 Z5\nM2\n")
    stock = ["--stock=-10,-10,-10,30,10,0", "--grid", "400", "--heights", str(heights), "--quiet"]
    assert main(["cut", str(program), "--tool", "1=drum:4:10", *stock]) == 0
    told = json.loads(heights.with_suffix(".json").read_text())
    field = np.load(heights)
    assert field.min() == pytest.approx(-3.0, abs=1e-3)
    middle = field[:, field.shape[1] // 2]
    assert np.count_nonzero(middle < -2.999) * told["pitch"] == pytest.approx(4.0, abs=0.5)
    assert np.count_nonzero(middle < -0.01) * told["pitch"] == pytest.approx(10.0, abs=0.3)


def test_a_kind_is_one_thing_wherever_it_goes() -> None:
    assert pickle.loads(pickle.dumps(MILL)).kind is copy.deepcopy(MILL).kind is DRUM is tool_kind("drum")
    assert tool_kinds()[-1] is DRUM
    with pytest.raises(ValueError, match="two kinds of tool are called drum"):
        register(ToolKind("drum", "Another", lambda shape: ToolProfile()))
