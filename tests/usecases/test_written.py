"""What a job writes is read back before anybody gets it; how long it takes; whether it fits the machine; files for each
tool.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.core.errors import HitofudeError
from app.core.settings import config_folder
from app.formats.machine_toml import load_machine
from app.gcode.checks.check import CheckReference, check
from app.gcode.posts import Decimals, WordDecimals, load_post, post_names
from app.gcode.writer import write
from app.model.finding import FindingKind
from app.model.machine import Machine
from app.model.moves import MoveKind
from app.model.part import Units
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, finish, make
from app.usecases.making.written import write_and_check

FIG2 = Path(__file__).resolve().parents[2] / "resources/samples/fig2.dxf"


@pytest.fixture(scope="module")
def made() -> MakeResult:
    return make("fig2.dxf", FIG2.read_bytes(), MakeOptions())


def fast(acceleration: float, **changes: object) -> Machine:
    """A machine with 5000 mm/min rapids and much travel."""
    vmc = load_machine("vmc")
    x, y, z = (replace(axis, rapid=5000.0, acceleration=acceleration, low=-1e4, high=1e4) for axis in vmc.axes)
    return replace(vmc, x=x, y=y, z=z, tool_change=0.0, spindle=replace(vmc.spindle, high=3e4), **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", post_names())
@pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])
def test_every_post_writes_the_job_and_says_how_near(made: MakeResult, name: str, units: Units) -> None:
    this = finish(made.program, replace(made.job, post=name, out_units=units))
    check = this.report.data["check"]
    assert check["differences"] == 0
    assert check["largest_distance_mm"] <= check["tolerance_mm"]
    assert check["files"] == (["_1_T1", "_2_T2"] if load_post(name).file_per_tool else [""])
    assert sum(file.nc.text.count("M30") + file.nc.text.count("M2\n") for file in this.files) == len(this.files)


def test_files_of_one_tool_each_hold_every_move_once(made: MakeResult) -> None:
    this = finish(made.program, replace(made.job, post="grbl"))
    assert [file.first for file in this.files] == [0, int(np.argmax(made.program.moves.tool == 2))]
    assert sum(len(file.nc.lines) for file in this.files) == len(made.program.moves)
    lines = np.concatenate([file.nc.lines for file in this.files])
    assert this.program.moves.line.tolist() == lines.tolist()
    one = finish(made.program, made.job).report.data
    for key in ("cut", "entry", "air", "link", "lead"):
        assert this.report.data["length_mm"][key] == pytest.approx(one["length_mm"][key], abs=0.01)
    assert this.report.data["time_s"] == pytest.approx(one["time_s"], abs=3)


def test_without_acceleration_the_time_is_length_over_feed(made: MakeResult) -> None:
    moves = made.program.moves
    cuts = moves.kind != MoveKind.RAPID
    this = finish(made.program, made.job, machine=fast(1e9)).report.data
    assert this["time_parts_s"]["cut"] == pytest.approx(
        60 * float(np.sum(moves.lengths()[cuts] / moves.feed[cuts])), rel=1e-4
    )
    rapids = np.max(np.abs(moves.end - moves.start), axis=1)[~cuts]  # the axis with the longest way tells
    assert this["time_parts_s"]["rapid"] == pytest.approx(60 * float(np.sum(rapids)) / 5000, rel=1e-3)
    assert this["time_parts_s"]["wait"] == pytest.approx(4.0)
    slow = finish(made.program, made.job, machine=fast(100.0)).report.data
    assert slow["time_s"] > this["time_s"] + 5
    assert "Vertical machining centre" in slow["time_method"]
    assert sum(tool["time_s"] for tool in slow["tools"]) == pytest.approx(
        slow["time_parts_s"]["cut"] + slow["time_parts_s"]["rapid"]
    )
    assert sum(each["time_s"] for each in slow["operations"]) == pytest.approx(
        sum(tool["time_s"] for tool in slow["tools"])
    )


def test_a_machine_that_is_too_small_or_too_slow_is_a_finding(made: MakeResult) -> None:
    machine = fast(500.0, largest_feed=500.0)
    machine = replace(machine, x=replace(machine.x, low=0.0, high=50.0), spindle=replace(machine.spindle, high=15000.0))
    this = finish(made.program, made.job, machine=machine)
    told = [finding.text for finding in this.findings if finding.kind is FindingKind.MACHINE]
    assert [any(word in text for text in told) for word in ("spans", "feed is up to 600", "18000 rpm")] == [True] * 3
    assert all(text.startswith("NC line ") for text in told)
    assert not this.clean
    assert made.clean  # timed on a usual machine, and held against none


def test_a_writer_that_errs_is_refused(made: MakeResult, monkeypatch: pytest.MonkeyPatch) -> None:
    """The writer is broken on purpose, as a mistake in it would break it: one coordinate of the path moves by 10 um."""
    right = write.work_moves

    def wrong(*arguments: object) -> write.WorkMoves:
        moves = right(*arguments)  # type: ignore[arg-type]
        x, y, z = moves.end[20]
        moves.end[20] = (x + 100, y, z)
        return moves

    monkeypatch.setattr(write, "work_moves", wrong)
    with pytest.raises(
        HitofudeError, match=r"^LinuxCNC program:\d+: the written path is 0\.0100 mm from the move .* not kept"
    ):
        write_and_check(made.program, made.job, load_post("linuxcnc"), None)


@pytest.mark.parametrize(
    ("decimals", "units", "far"),
    [
        (0, Units.MM, 0.5),
        (1, Units.MM, 0.05),
        (2, Units.INCH, 0.1),
        (2, Units.MM, 0.0055),
    ],
)
def test_decimals_that_are_too_few_are_a_finding_that_counts(
    made: MakeResult, decimals: int, units: Units, far: float
) -> None:
    post = load_post("linuxcnc")
    few = WordDecimals(decimals, decimals, decimals, decimals, decimals, 1)
    written = write_and_check(
        made.program, replace(made.job, out_units=units), replace(post, decimals=Decimals(few, few)), None
    )
    (finding,) = written.coarseness(units)
    assert finding.kind is FindingKind.TOLERANCE
    assert finding.counts
    assert finding.amount is not None
    assert far <= finding.amount == written.largest_distance_mm <= 1.01 * units.value * 10.0**-decimals
    assert (
        f"writes {decimals} decimals: the path written is up to {finding.amount:.3f} mm from the computed one"
        in finding.text
    )


def test_the_report_of_a_coarse_post_says_of_which_path_its_gouges_are(made: MakeResult) -> None:
    folder = config_folder() / "posts"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "coarse.toml").write_text('extends = "linuxcnc"\n[decimals.mm]\nX = 1\nY = 1\nZ = 1\nI = 1\nJ = 1\n')
    this = finish(made.program, replace(made.job, post="coarse"))
    assert not this.clean
    gouge = this.report.data["gouge"]
    assert gouge["path"] == "as computed"
    assert gouge["written_within_mm"] == this.report.data["check"]["largest_distance_mm"] > 0.05
    assert made.report.data["gouge"]["written_within_mm"] < 2e-4
    assert not any(finding.kind is FindingKind.TOLERANCE for finding in made.findings)


def test_who_is_to_mend_what_is_refused(made: MakeResult) -> None:
    """A post of the program is ours to mend, one of the user's is the user's."""
    post = load_post("linuxcnc")
    wrong = replace(post, title="Mine", program=replace(post.program, leave=()))
    with pytest.raises(HitofudeError, match=r"it is not kept; Mine is a post of your own: mend its file"):
        write_and_check(made.program, made.job, wrong, None)
    right = write_and_check(made.program, made.job, post, None)
    broken = check(
        right.files[0].nc.text.replace("M5", "M4").encode(),
        right.files[0],
        CheckReference(made.program, made.job, post),
    )
    with pytest.raises(HitofudeError, match=r"it is not kept; please report this with the drawing and the post"):
        broken.require("part.ngc")
