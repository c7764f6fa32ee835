"""Motions of real and made programs are those of LinuxCNC's own interpreter."""

from pathlib import Path

import pytest

from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from tests.conftest import ROOT
from tests.gcode.interpreter.rs274_motions import OPTIONS, assert_as_rs274, rs274
from tests.gcode.interpreter.rs274_programs import PROGRAMS

OWN = ROOT / "tests" / "data" / "nc"
GOLDEN = ROOT / "tests" / "gcode" / "golden"
OUTSIDE = ROOT.parent / "shared" / "data" / "nc"


@pytest.mark.parametrize("name", ["test_pycam.ngc", "tux.ngc", "rs274ngc_canned_cycles.ngc"])
def test_real_programs(name: str) -> None:
    program = assert_as_rs274((OWN / name).read_bytes())
    assert len(program.motions) > 300


def test_a_real_program_without_its_end() -> None:
    """LinuxCNC asks for M2 at the end; with it every motion is the same."""
    program = assert_as_rs274((OWN / "jsdc.gcode").read_bytes() + b"\nM2\n")
    assert len(program.motions) == 2382


@pytest.mark.parametrize("name", ["cds.ngc", "3dtest.ngc"])
def test_real_programs_of_linuxcnc_itself(name: str) -> None:
    """Their licence keeps them out of this repository."""
    path = OUTSIDE / name
    if not path.exists():
        pytest.skip(f"{name} is not beside the repository")
    assert len(assert_as_rs274(path.read_bytes()).motions) > 40


@pytest.mark.parametrize("path", sorted(GOLDEN.glob("*.ngc")), ids=lambda path: path.name)
def test_our_own_programs(path: Path) -> None:
    assert_as_rs274(path.read_bytes())


@pytest.mark.parametrize("name", PROGRAMS)
def test_every_feature(name: str) -> None:
    program = assert_as_rs274(PROGRAMS[name])
    assert len(program.motions) > 0


def test_a_table_with_one_tool_refuses_others_as_linuxcnc_does() -> None:
    text = b"G43 H5\nG0 X1\nM2\n"
    _, complaint = rs274(text)
    assert complaint
    error = read_program(text, ReadOptions(tool_table=OPTIONS.tool_table)).error
    assert error is not None and error.line == 1
