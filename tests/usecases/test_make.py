"""The main job on real drawings: the report tells the truth, the control does what the program means."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from app.core.errors import Cancelled, GeometryError, InputError, ParameterError
from app.core.progress import Progress
from app.formats.machine_toml import DEFAULT_MACHINE, load_machine
from app.gcode.posts import load_post
from app.model.contour_operation import ContourOperation
from app.model.finding import FindingKind
from app.model.job import Job, OriginXY, OriginZ
from app.model.moves import MoveKind
from app.model.operation import CutParameters, PocketOperation, RestOperation
from app.model.part import Part, Units
from app.model.stock_box import stock_box, work_origin
from app.model.tool_kind import ToolKind
from app.usecases.job.machining import MachiningOptions
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, finish, make
from tests.gcode.rs274_oracle import assert_same_motion, canonical_calls
from tests.usecases.truth import assert_left_is_true

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = (
    ROOT / "tests/data/dxf",
    ROOT / "resources/samples",
    ROOT.parent / "shared/data/dxf",
    ROOT.parent / "shared/bench",
)

DRAWINGS = {
    "fig2.dxf": MakeOptions(),
    "gear.dxf": MakeOptions(pocket_diameter=2, contour_diameter=1),
    "apu-mount.dxf": MakeOptions(pocket_diameter=6, contour_diameter=3),
    "genshi.dxf": MakeOptions(pocket_diameter=4, contour_diameter=2),
    "insert.dxf": MakeOptions(pocket_diameter=6, contour_diameter=3),
    "forms.dxf": MakeOptions(pocket_diameter=20, contour_diameter=10),
    "LM2.dxf": MakeOptions(pocket_diameter=6, contour_diameter=3),
    "broken_loop.dxf": MakeOptions(pocket_diameter=0.5, contour_diameter=0.3, join_tolerance=0.2),
    "complex.dxf": MakeOptions(pocket_diameter=1, contour_diameter=0.5),
}


def drawing(name: str) -> Path:
    """A drawing that travels with the project, or lies in the shared collection."""
    for folder in FOLDERS:
        if (folder / name).is_file():
            return folder / name
    pytest.skip(f"{name} is neither in tests/data nor in the shared collection beside this checkout")


@cache
def made(name: str) -> MakeResult:
    return make(name, drawing(name).read_bytes(), DRAWINGS[name])


MANY_MOVES = "complex.dxf"  # 40,000: the other drawings ask the same in every run
each = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.exhaustive) if name == MANY_MOVES else name for name in DRAWINGS]
)


@each
def test_no_gouge_and_no_rapid_in_material(name: str) -> None:
    report = made(name).report.data
    assert report["gouge"]["max_mm"] <= 1e-3
    assert report["gouge"]["count"] == 0
    assert report["rapids_in_material"] == []


@each
def test_the_control_accepts_the_program_and_moves_as_it_means(name: str) -> None:
    this = made(name)
    assert_same_motion(this.program.moves, this.nc, this.job)


@pytest.mark.exhaustive
def test_the_control_accepts_a_program_of_many_moves() -> None:
    this = made(MANY_MOVES)
    calls = [name for name, _ in canonical_calls(this.nc.text)]
    assert len(this.program.moves) > 40_000
    assert calls.count("CHANGE_TOOL") == 2
    assert sum(name in ("STRAIGHT_FEED", "ARC_FEED") for name in calls) > 40_000


@each
def test_what_the_report_calls_left_is_left_and_nothing_else_is(name: str) -> None:
    assert assert_left_is_true(made(name)) > 50


@each
def test_the_numbers_of_the_report_are_those_of_the_moves(name: str) -> None:
    this = made(name)
    report, moves = this.report.data, this.program.moves
    lengths, rapid = moves.lengths(), moves.kind == MoveKind.RAPID
    kinds = read_kinds(this.nc.text)
    assert [report["moves"][f"G{k}"] for k in range(4)] == [kinds.count(k) for k in range(4)]
    rounding = 2e-4 * len(kinds) ** 0.5
    assert sum(report["length_mm"].values()) == pytest.approx(float(np.sum(lengths)), abs=rounding)
    assert report["length_mm"]["rapid"] == pytest.approx(float(np.sum(lengths[rapid])), abs=rounding)
    assert "first approach" in report["moves_method"]
    assert report["strokes"] == this.program.strokes
    waits = len(np.unique(moves.tool)) * (
        load_post(this.job.post).spindle.dwell_s + load_machine(DEFAULT_MACHINE).tool_change
    )
    cutting = float(np.sum(lengths[~rapid] / moves.feed[~rapid])) * 60
    assert report["time_parts_s"]["wait"] == pytest.approx(waits)
    assert cutting - 0.01 <= report["time_parts_s"]["cut"] <= 3 * cutting
    assert report["time_s"] == pytest.approx(sum(report["time_parts_s"].values()))
    assert report["check"]["differences"] == 0
    assert (
        0
        <= report["check"]["largest_distance_mm"]
        <= report["check"]["tolerance_mm"]
        == report["tolerance"]["writing_mm"]
    )
    assert json.loads(this.report.text()) == report
    assert this.clean == (not any(finding["counts"] for finding in report["findings"]))


def read_kinds(text: str) -> list[int]:
    """The G word of every motion block, read from the text alone."""
    kinds, motion = [], -1
    for line in text.splitlines():
        block = re.sub(r"\([^)]*\)", "", line)
        if word := re.search(r"\bG0?([0123])\b(?!\.)", block):
            motion = int(word[1])
        if re.search(r"[XYZ]-?\d", block):
            kinds.append(motion)
    return kinds


def test_the_report_gives_the_stepover_that_was_chosen() -> None:
    pocket, rest, contour = (each.get("stepover_mm") for each in made("fig2.dxf").report.data["operations"])
    assert pocket in [pytest.approx(share * 3.0) for share in (1.4, 1.5, 1.6, 1.65, 1.7, 1.75, 1.8)] and (
        rest,
        contour,
    ) == (3.0, None)


def test_fig2_is_clean_and_its_corners_are_told() -> None:
    this = made("fig2.dxf")
    assert this.clean
    report = this.report.data
    assert report["left"]["reachable_mm2"] == 0
    assert report["left"]["unreachable_mm2"] == pytest.approx(2.66, abs=0.01)
    assert [each["number"] for each in report["regions"]] == [1, 2]
    assert (report["strokes"], report["retracts"], report["open_contours"], report["skipped"]) == (2, 5, [], [])
    assert [(each["kind"], each["tool"]) for each in report["operations"]] == [
        ("pocket", 1),
        ("rest", 2),
        ("contour", 2),
    ]
    assert sum(each["time_s"] for each in report["operations"]) < report["time_s"]


def test_rings_that_are_polylines_are_told() -> None:
    this = made("fig2.dxf")
    assert "polylines" not in this.report.data["engine"]
    for count, words in (
        (7, "7 rings are fine polylines within 1 um instead of lines and arcs."),
        (1, "1 ring is a fine polyline within 1 um instead of lines and arcs."),
    ):
        again = finish(replace(this.program, polyline_rings=count), this.job)
        (finding,) = [each for each in again.findings if each.kind is FindingKind.TOLERANCE]
        assert (finding.text, finding.counts, finding.amount) == (words, False, count)
        assert again.clean
        assert words[:-1] in again.report.data["engine"]


def test_a_tool_that_is_not_flat_is_told() -> None:
    this = made("fig2.dxf")
    first, *others = this.job.tools
    again = finish(this.program, replace(this.job, tools=(first.as_kind(ToolKind.BALL), *others)))
    (finding,) = [each for each in again.findings if each.kind is FindingKind.TOOL_SHAPE]
    assert finding.counts
    assert finding.text.startswith("T1 is a ball cutter, and its path is that of a flat one of 6 mm")


def test_the_first_approach_is_among_the_rapids() -> None:
    """Each tool's text begins with a rapid to safe Z that the program does not have."""
    this = made("fig2.dxf")
    assert this.report.data["moves"]["G0"] == int(np.sum(rapids(this))) + 2
    assert this.report.data["length_mm"]["rapid"] == pytest.approx(
        float(np.sum(this.program.moves.lengths()[rapids(this)])), abs=1e-3
    )


def rapids(this: MakeResult) -> np.ndarray:
    return this.program.moves.kind == MoveKind.RAPID


def test_gear_is_cleared_of_the_rest_that_its_pocket_tool_leaves() -> None:
    this = made("gear.dxf")
    assert this.report.data["left"]["reachable_mm2"] == 0
    assert this.clean


def test_what_is_left_without_rest_machining_is_told() -> None:
    """Peers leave about 30 mm2 here with these tools and say nothing of it."""
    job = Job(Part(), operations=(PocketOperation(CutParameters(1), 1.0), ContourOperation(CutParameters(2))))
    this = make("gear.dxf", drawing("gear.dxf").read_bytes(), replace(DRAWINGS["gear.dxf"], job=job))
    assert this.report.data["left"]["reachable_mm2"] == pytest.approx(30, abs=1)
    assert not this.clean
    assert any(finding.kind is FindingKind.LEFT_REACHABLE and finding.counts for finding in this.findings)
    assert any("names no units" in finding["text"] for finding in this.report.data["findings"])


@pytest.mark.exhaustive
def test_every_region_that_no_tool_fits_is_named_and_counts() -> None:
    this = make("forms.dxf", drawing("forms.dxf").read_bytes(), MakeOptions(pocket_diameter=60, contour_diameter=40))
    uncut = [region["number"] for region in this.report.data["regions"] if region["cut_mm"] == 0]
    skipped = [each for each in this.report.data["skipped"] if each["kind"] == "region_too_small" and each["counts"]]
    assert uncut == [2, 3, 4, 5]
    assert [f"Region {number} " in each["text"] for number, each in zip(uncut, skipped, strict=True)] == [True] * 4
    assert all(each["x"] is not None and 0 < each["amount"] < 40 for each in skipped)
    assert not this.clean


def test_broken_loop_names_both_ends_and_the_overlap() -> None:
    with pytest.raises(GeometryError) as error:
        make(
            "broken_loop.dxf",
            drawing("broken_loop.dxf").read_bytes(),
            MakeOptions(pocket_diameter=0.5, contour_diameter=0.3),
        )
    text = str(error.value)
    assert "(1.000, 0.000)" in text
    assert "(1.100, 0.000)" in text
    assert "overlap by 0.100 mm" in text
    assert made("broken_loop.dxf").clean


def test_open_contours_are_listed_and_count() -> None:
    torn = drawing("fig2.dxf").read_text().replace("68.0", "68.4", 1).encode()
    this = make("fig2.dxf", torn, MakeOptions())
    (finding,) = this.report.data["open_contours"]
    assert finding["amount"] == pytest.approx(0.4, abs=0.01)
    assert not this.clean


def test_one_tool_does_both_jobs() -> None:
    this = make("fig2.dxf", drawing("fig2.dxf").read_bytes(), MakeOptions(contour_diameter=4))
    assert [tool["diameter_mm"] for tool in this.report.data["tools"]] == [4]
    assert this.nc.text.count("M6") == 1


def test_depth_passes_origin_and_units_reach_the_program() -> None:
    options = MakeOptions(
        origin_xy=OriginXY.CENTRE,
        origin_z=OriginZ.BOTTOM,
        out_units=Units.INCH,
        safe_z=0.5,
        feed=333,
        machining=MachiningOptions.of(depth=5, stepdown=2),
    )
    this = make("fig2.dxf", drawing("fig2.dxf").read_bytes(), options)
    level = this.program.moves.start[:, 2] == this.program.moves.end[:, 2]
    depths = sorted({round(float(z), 6) for z in this.program.moves.end[level, 2] if z < 0})
    assert depths == pytest.approx([-5, -10 / 3, -5 / 3])
    assert this.job.safe_z == 0.5
    assert this.job.retract_z == 0.5
    assert "G20" in this.nc.text
    assert this.report.data["left"]["floor_depth_mm"] == 5
    assert this.report.data["rapids_in_material"] == []
    assert_same_motion(
        this.program.moves, this.nc, this.job, work_origin(this.job, stock_box(this.job, this.program.regions))
    )


def test_a_depth_below_the_stock_makes_it_thicker() -> None:
    this = make(
        "fig2.dxf", drawing("fig2.dxf").read_bytes(), MakeOptions(machining=MachiningOptions.of(depth=14, stepdown=14))
    )
    assert this.job.stock.thickness == 14


def test_the_same_input_gives_the_same_bytes() -> None:
    first, again = made("fig2.dxf"), make("fig2.dxf", drawing("fig2.dxf").read_bytes(), MakeOptions())
    assert first.nc.text == again.nc.text
    assert first.report.text() == again.report.text()


def test_a_wrong_option_names_itself() -> None:
    data = drawing("fig2.dxf").read_bytes()
    for options, words in (
        (MakeOptions(overlap=6), "Overlap is 6 mm with a pocket tool of 6 mm"),
        (MakeOptions(overlap=1, stepover=None, pocket_diameter=0.5), "Overlap is 1 mm with a pocket tool of 0.5 mm"),
        (MakeOptions(machining=MachiningOptions.of(depth=-1)), "Depth is -1 mm"),
        (MakeOptions(safe_z=0), "Safe Z is 0 mm"),
    ):
        with pytest.raises(ParameterError, match=words):
            make("fig2.dxf", data, options)
    with pytest.raises(InputError, match="no post 'abacus'"):
        make("fig2.dxf", data, MakeOptions(post="abacus"))
    with pytest.raises(InputError, match="no layer walls"):
        make("fig2.dxf", data, MakeOptions(layers=("walls",)))


@pytest.mark.exhaustive
def test_cancel_is_heard_in_every_stage() -> None:
    class Stop:
        def __init__(self, at: int) -> None:
            self.at, self.calls = at, 0

        def is_set(self) -> bool:
            self.calls += 1
            return self.calls > self.at

    texts: list[str] = []
    make(
        "fig2.dxf", drawing("fig2.dxf").read_bytes(), MakeOptions(), Progress(lambda fraction, text: texts.append(text))
    )
    few = 0.9 * len(texts)  # while threads cut, how often they are looked at depends on how long they take
    for at in range(0, int(few), 3):
        with pytest.raises(Cancelled):
            make("fig2.dxf", drawing("fig2.dxf").read_bytes(), MakeOptions(), Progress(None, Stop(at)))  # type: ignore[arg-type]


def test_progress_grows_to_one() -> None:
    seen: list[float] = []
    make(
        "fig2.dxf",
        drawing("fig2.dxf").read_bytes(),
        MakeOptions(),
        Progress(lambda fraction, text: seen.append(fraction)),
    )
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx(1.0)


def test_operations_of_the_default_job() -> None:
    operations = made("fig2.dxf").job.operations
    assert [type(operation) for operation in operations] == [PocketOperation, RestOperation, ContourOperation]
