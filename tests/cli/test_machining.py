"""Options of `make` that say how it is machined: read with units, refused in one line, and what they do to whole
programs.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli.commands.make import COMMAND as MAKE
from app.cli.main import main
from app.cli.make_options import make_options
from app.core.errors import InputError
from app.model.entry import EntryKind, LeadKind
from app.model.job import Copies
from app.model.operation import Side
from app.usecases.job.machining import MachiningOptions

ROOT = Path(__file__).parents[2]
FIG2 = ROOT / "resources/samples/fig2.dxf"


def asked(text: str, drawing: str = "part.dxf") -> MachiningOptions:
    return make_options(
        MAKE.arguments([drawing, "-o", "out.ngc", *text.split(" ")] if text else [drawing, "-o", "out.ngc"])
    ).machining


def test_nothing_is_nothing() -> None:
    assert asked("") == MachiningOptions()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("--side outside", MachiningOptions.of(side=Side.OUTSIDE)),
        ("--entry predrilled", MachiningOptions.of(entry=EntryKind.PREDRILLED)),
        ("--ramp-angle 5", MachiningOptions.of(entry_angle=math.radians(5))),
        ("--ramp-angle 0.05rad", MachiningOptions.of(entry_angle=0.05)),
        ("--lead none", MachiningOptions.of(lead=LeadKind.NONE)),
        (
            "--lead line --lead-radius 1/8in --lead-overlap 0",
            MachiningOptions.of(lead=LeadKind.LINE, lead_radius=3.175, lead_overlap=0.0),
        ),
        ("--tabs 4 --tab-width 0.5cm --tab-height 1", MachiningOptions.of(tabs=4, tab_width=5.0, tab_height=1.0)),
        ("--dog-bones --outside-in", MachiningOptions.of(dog_bones=True, outside_in=True)),
        ("--most-engaged 40%", MachiningOptions.of(most_engaged=0.4)),
        ("--most-engaged .4", MachiningOptions.of(most_engaged=0.4)),
        (
            "--finish-depth 0.2 --finish-width 0.3 --spring-passes 2",
            MachiningOptions.of(finish_depth=0.2, finish_width=0.3, spring_passes=2),
        ),
        ("--floor-to-leave 0.1", MachiningOptions.of(floor_to_leave=0.1)),
        (
            "--drill 5 --drill 1/4in --peck 2 --through 0.5",
            MachiningOptions.of(drills=(5.0, 6.35), peck=2.0, through=0.5),
        ),
        ("--copies 3x2@40,-1in", MachiningOptions.of(copies=Copies(3, 2, 40.0, -25.4))),
        ("--copies 4X1@50", MachiningOptions.of(copies=Copies(4, 1, 50.0))),
        ("--copies 2x1@50,0", MachiningOptions.of(copies=Copies(2, 1, 50.0))),
        ("--lead-overlap 50", MachiningOptions.of(lead_overlap=50.0)),
        ("--copies 1x4@50", MachiningOptions.of(copies=Copies(1, 4, 0.0, 50.0))),
        (
            "--keep-out a --keep-out b --keep-out-height 12",
            MachiningOptions.of(keep_out=("a", "b"), keep_out_height=12.0),
        ),
    ],
)
def test_options_are_read_with_their_units(text: str, expected: MachiningOptions) -> None:
    found = asked(text)
    assert found.values.keys() == expected.values.keys()
    for name, value in expected.values.items():
        assert found.values[name] == pytest.approx(value), name
    assert replace(found, values=expected.values) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("--side left", "--side is 'left'; choose one of 'inside', 'outside', 'on'"),
        ("--entry jump", "--entry is 'jump'; choose one of 'helix', 'ramp', 'plunge', 'predrilled'"),
        ("--ramp-angle 60", "--ramp-angle is 60 degrees; the entry angle must be 0.0573 to 45 degrees"),
        ("--ramp-angle steep", "--ramp-angle is wrong"),
        ("--lead-radius 0", "--lead-radius is 0 mm; the lead radius must be 0.001 to 1000 mm"),
        ("--tabs 2.5", "--tabs is '2.5'; the tabs must be a whole number from 0 to 100"),
        ("--tabs 101", "from 0 to 100"),
        ("--spring-passes 11", "from 0 to 10"),
        ("--most-engaged 4%", "write a share of the diameter from 5% to 100%"),
        ("--most-engaged 40", "is '40'; write a share"),
        ("--copies 3x2", "--copies is '3x2'; write columns x rows @ distances"),
        ("--copies 3x2@40", "--copies is wrong: Copies along Y are 0 mm apart"),
        ("--copies 0x2@40,40", "use 1 to 1000 each way"),
        ("--copies 2x2@a,b", "--copies is wrong"),
        (
            "--copies 2x1@50,10",
            "where 10 mm along Y have no effect on one row; write more rows, or one distance such as 2x1@50",
        ),
        (
            "--copies 1x4@10,50",
            "where 10 mm along X have no effect on one column; write more columns, or one distance such as 1x4@50",
        ),
        ("--copies 1x1@50", "--copies is '1x1@50', which is the part alone; leave the option away"),
        ("--copies 1x1@50,50", "which is the part alone"),
        ("--lead-overlap 51", "--lead-overlap is 51 mm; the lead overlap must be 0 to 50 mm"),
        ("--lead-overlap -1", "must be 0 to 50 mm"),
        ("--drill 0", "--drill is 0 mm; the diameter must be greater than 0 mm"),
        ("--stepover 101%", "not more than the tool's diameter (100 %)"),
    ],
)
def test_what_is_wrong_is_told(text: str, words: str) -> None:
    with pytest.raises(InputError) as error:
        asked(text)
    assert words in str(error.value)


@pytest.mark.parametrize(
    "text", ["--drill 5", "--side outside", "--tabs 3", "--dog-bones", "--keep-out a", "--lead none"]
)
def test_pixels_take_few_of_them(text: str) -> None:
    for drawing, more in (("part.png", ""), ("part.dxf", " --bitmap 400")):
        with pytest.raises(InputError, match=text.split()[0] + " has no effect on pixels"):
            asked(text + more, drawing)
    assert asked("--entry plunge --finish-depth 0.1", "part.png").values["entry"] is EntryKind.PLUNGE


def test_the_whole_diameter_is_a_stepover() -> None:
    options = make_options(MAKE.arguments(["part.dxf", "-o", "out.ngc", "--stepover", "100%"]))
    assert options.stepover is not None
    assert options.stepover.of(6.0) == 6.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("--peck 2", "--peck has no effect: the job has no drill operation; --drill D adds one."),
        ("--side on --stepover 2", "--stepover has no effect: the job has no pocket operation"),
        (
            "--side outside --order 1986",
            "--order has no effect: the job has no operation but contours, which it puts first",
        ),
        (
            "--drill 5 --drill 3 --drill 5mm",
            "--drill 5 mm is given twice and would drill the same circles again; give each diameter once",
        ),
        ("--keep-out nowhere", "there is no layer 'nowhere'"),
    ],
)
def test_no_effect_is_bad_usage(arguments: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["make", str(FIG2), "-o", str(tmp_path / "out.ngc"), *arguments.split()]) == 2
    shown = capsys.readouterr()
    assert (shown.out, shown.err.count("\n")) == ("", 1)
    assert words in shown.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("way", [[], ["--bitmap", "200"]], ids=["exact", "bitmap"])
@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[[operation]]\nkind = 'pocket'\ntool = 1\nenabled = false\n",
            "every operation of the job is switched off, so nothing is cut",
        ),
        (
            "[[tool]]\nnumber = 1\ndiameter = 6\nkind = 'drill'\n[[operation]]\nkind = 'pocket'\ntool = 1\n",
            "T1 is a drill, which cannot cut sideways",
        ),
    ],
)
def test_job_files_that_cut_nothing_are_bad_usage(
    text: str,
    words: str,
    way: list[str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    job = tmp_path / "job.toml"
    job.write_text(text, "utf-8")
    assert main(["make", str(FIG2), "-o", str(tmp_path / "out.ngc"), "--job", str(job), *way]) == 2
    shown = capsys.readouterr()
    assert (shown.out, shown.err.count("\n")) == ("", 1)
    assert words in shown.err
    assert list(tmp_path.iterdir()) == [job]
