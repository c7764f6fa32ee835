"""What is asked for beyond tools and depths: it goes into the operations that it concerns, or is refused with the
reason.
"""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from app.core.errors import Cancelled, HitofudeError, InputError, ParameterError
from app.core.progress import Progress
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import on_layers
from app.model.entry import EntryKind, LeadKind
from app.model.hole_operations import DrillOperation
from app.model.job import Copies, Job
from app.model.operation import CutParameters, Order, PocketOperation, RestOperation, Side
from app.model.operation_kinds import parameters
from app.model.part import Layer, Part
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.usecases.job.machining import MachiningOptions, check_order
from app.usecases.job.options import MakeOptions, Stepover, job_with_options, layers_of_drawing
from app.usecases.making.make import export, make

HOLES = Job(Part(), (Tool(1, 3.0),), (DrillOperation(CutParameters(1)),))
NO_OPTIONS = MakeOptions()


def made(job: Job | None = None, options: MakeOptions = NO_OPTIONS, part: Part = Part(), **asked: Any) -> Job:  # noqa: B008  # frozen
    return job_with_options(part, replace(options, job=job, machining=MachiningOptions.of(**asked)))


def contour_of(job: Job) -> ContourOperation:
    (found,) = [each for each in job.operations if isinstance(each, ContourOperation)]
    return found


def test_nothing_asked_for_changes_nothing() -> None:
    assert MachiningOptions().requested == ()
    assert made() == Job(Part())


def test_every_value_reaches_its_operations() -> None:
    job = made(
        lead=LeadKind.LINE,
        lead_radius=2.0,
        lead_overlap=0.25,
        tabs=3,
        tab_width=4.0,
        tab_height=0.5,
        dog_bones=True,
        finish_width=0.2,
        spring_passes=2,
        outside_in=True,
        entry=EntryKind.RAMP,
        entry_angle=0.1,
        finish_depth=0.3,
        floor_to_leave=0.4,
        most_engaged=0.6,
    )
    contour, (pocket, rest) = contour_of(job), job.operations[:2]
    assert isinstance(pocket, PocketOperation) and isinstance(rest, RestOperation)
    assert (contour.lead.kind, contour.lead.radius, contour.lead.overlap) == (LeadKind.LINE, 2.0, 0.25)
    assert (contour.tabs.count, contour.tabs.width, contour.tabs.height) == (3, 4.0, 0.5)
    assert (contour.dog_bones, contour.finish_width, contour.spring_passes) == (True, 0.2, 2)
    assert pocket.outside_in
    for each in (pocket, rest, contour):
        assert (each.cut.entry.kind, each.cut.entry.angle) == (EntryKind.RAMP, 0.1)
        assert (each.cut.finish_depth, each.cut.floor_to_leave, each.most_engaged) == (0.3, 0.4, 0.6)


@pytest.mark.parametrize("side", [Side.OUTSIDE, Side.ON])
def test_a_side_beyond_the_areas_leaves_them_alone(side: Side) -> None:
    job = made(side=side)
    assert [type(each) for each in job.operations] == [ContourOperation]
    assert contour_of(job).side is side
    assert [tool.number for tool in job.tools] == [2]
    own = Job(Part(), operations=(PocketOperation(CutParameters(1)), ContourOperation(CutParameters(2))))
    assert [type(each) for each in made(own, side=side).operations] == [PocketOperation, ContourOperation]


def test_inside_is_the_default_job() -> None:
    assert made(side=Side.INSIDE) == Job(Part())


def test_one_tool_does_the_contour_alone() -> None:
    job = made(options=MakeOptions(pocket_diameter=5.0), side=Side.OUTSIDE)
    assert [tool.diameter for tool in job.tools] == [5.0]
    assert contour_of(job).cut.tool == job.tools[0].number


def test_drills_come_first_with_tools_of_their_own() -> None:
    job = made(options=MakeOptions(feed=99.0), depth=7.0, stock_to_leave=0.5, drills=(5.0, 3.3), peck=1.5, through=0.5)
    first, second = job.operations[:2]
    assert (first, second) == (
        DrillOperation(CutParameters(3, 7.0), peck=1.5, through=0.5),
        DrillOperation(CutParameters(4, 7.0), peck=1.5, through=0.5),
    )
    drills = job.tools[2:]
    assert [(tool.number, tool.diameter, tool.kind, tool.feed_rate) for tool in drills] == [
        (3, 5.0, ToolKind.DRILL, 99.0),
        (4, 3.3, ToolKind.DRILL, 99.0),
    ]
    assert all(each.cut.stock_to_leave == 0.5 for each in job.operations[2:])
    deep = Job(Part(), operations=(PocketOperation(CutParameters(1, 6.0, 3.0)),))
    assert made(deep, drills=(5.0,)).operations[0].cut.depth == 6.0


def test_copies_and_clamps() -> None:
    part = Part(layers=(Layer("a"), Layer("Clamps")))
    job = made(part=part, copies=Copies(2, 2, 10.0, 20.0), keep_out=("clamps",), keep_out_height=8.0)
    assert (job.copies, job.keep_out_layers, job.keep_out_height) == (Copies(2, 2, 10.0, 20.0), ("Clamps",), 8.0)
    with pytest.raises(InputError, match="no layer 'klamps'; the drawing has a, Clamps"):
        made(part=part, keep_out=("klamps",))


def test_layers_that_are_read_are_all_that_the_job_needs() -> None:
    job = Job(
        Part(),
        operations=(
            PocketOperation(CutParameters(1, curves=on_layers(("p",)))),
            ContourOperation(CutParameters(2, enabled=False, curves=on_layers(("q",)))),
        ),
    )
    machining = MachiningOptions.of(keep_out=("k",))
    assert layers_of_drawing(MakeOptions(job=job, machining=machining)) == ()
    assert layers_of_drawing(MakeOptions(job=job, layers=("a",), machining=machining)) == ("a", "p", "k")


@pytest.mark.parametrize(
    ("asked", "job", "words"),
    [
        ({"side": Side.INSIDE}, HOLES, "--side has no effect: the job has no contour or chamfer operation"),
        ({"dog_bones": True}, HOLES, "--dog-bones has no effect"),
        ({"outside_in": True}, HOLES, "--outside-in has no effect: the job has no pocket operation"),
        ({"entry": EntryKind.RAMP}, HOLES, "--entry has no effect: the job has no operation that mills"),
        ({"most_engaged": 0.5}, HOLES, "--most-engaged has no effect"),
        ({"floor_to_leave": 0.5}, HOLES, "--floor-to-leave has no effect"),
        (
            {"entry_angle": 0.1, "entry": EntryKind.PLUNGE},
            None,
            "--ramp-angle has no effect: the job has no operation that mills with a slope",
        ),
        (
            {"lead_radius": 1.0, "lead": LeadKind.NONE},
            None,
            "--lead-radius has no effect: the job has no contour operation with a lead",
        ),
        (
            {"tab_width": 1.0},
            None,
            "--tab-width has no effect: the job has no contour operation with tabs; --tabs N makes some",
        ),
        ({"tab_height": 1.0, "tabs": 0}, None, "--tab-height has no effect"),
        ({"peck": 1.0}, None, "--peck has no effect: the job has no drill operation; --drill D adds one"),
        ({"through": 1.0}, None, "--through has no effect"),
        ({"keep_out_height": 3.0}, None, "--keep-out-height has no effect: no layer of clamps is named"),
        ({"side": Side.ON, "dog_bones": True}, None, "A path on the line has no wall"),
        ({"floor_to_leave": 2.0}, None, "Floor to leave is 2 mm"),
        ({"outside_in": True, "side": Side.ON}, None, "--outside-in has no effect"),
    ],
)
def test_what_has_no_effect_is_refused(asked: dict[str, Any], job: Job | None, words: str) -> None:
    with pytest.raises(HitofudeError, match=words.replace("(", r"\(")):
        made(job, **asked)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (MakeOptions(pocket_diameter=4.0), "--pocket-tool has no effect: the job has no pocket operation"),
        (MakeOptions(contour_diameter=4.0), "--contour-tool has no effect"),
        (MakeOptions(stepover=Stepover(1.0)), "--stepover has no effect"),
        (MakeOptions(overlap=1.0), "--overlap has no effect"),
    ],
)
def test_tools_and_steps_of_operations_that_are_not_there(options: MakeOptions, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        made(HOLES, options)
    off = Job(
        Part(),
        operations=tuple(type(each)(CutParameters(each.cut.tool, enabled=False)) for each in Job(Part()).operations),
    )
    with pytest.raises(ParameterError, match=words):
        made(off, options)


def test_the_order_of_1986_needs_contours_and_others() -> None:
    contours = Job(
        Part(), operations=(ContourOperation(CutParameters(2)), PocketOperation(CutParameters(1, enabled=False)))
    )
    for job, words in ((contours, "no operation but contours"), (HOLES, "no contour operation")):
        with pytest.raises(ParameterError, match=f"--order has no effect: the job has {words}"):
            check_order(job, Order.PATENT_1986)
        check_order(job, None)
        check_order(job, Order.POCKET_FIRST)
    check_order(Job(Part()), Order.PATENT_1986)
    check_order(made(side=Side.OUTSIDE, drills=(5.0,)), Order.PATENT_1986)


def test_a_drill_mills_nothing() -> None:
    job = Job(Part(), (Tool(1, 3.0, ToolKind.DRILL),), (DrillOperation(CutParameters(1)),))
    assert job.cutter(job.operations[0]).number == 1
    for operation in (
        PocketOperation(CutParameters(1)),
        RestOperation(CutParameters(1)),
        ContourOperation(CutParameters(1)),
    ):
        with pytest.raises(ParameterError, match="T1 is a drill, which cannot cut sideways; a " + operation.WORD):
            export(replace(job, operations=(operation,)))


def test_a_switched_off_operation_is_left_as_it_is() -> None:
    off = Job(
        Part(), operations=(ContourOperation(CutParameters(1, enabled=False)), ContourOperation(CutParameters(2)))
    )
    job = made(off, tabs=4)
    assert [each.tabs.count for each in job.operations if isinstance(each, ContourOperation)] == [0, 4]


def test_every_field_can_be_asked_for() -> None:
    given: dict[str, Any] = {"drills": (1.0,), "keep_out": ("a",), "copies": Copies(2, 1, 5.0), "keep_out_height": 1.0}
    options = {"drills": "drill", "entry_angle": "ramp-angle"}
    for name, value in {**given, **dict.fromkeys(parameters(), 1.0)}.items():
        assert MachiningOptions.of(**{name: value}).requested == (options.get(name, name.replace("_", "-")),)


def test_a_thousand_passes_can_be_stopped(samples: Path) -> None:
    told: list[str] = []
    stop = threading.Event()

    def listen(_: float, text: str) -> None:
        told.append(text)
        if told.count("Depth passes") == 3:
            stop.set()

    with pytest.raises(Cancelled):
        options = MakeOptions(machining=MachiningOptions.of(depth=1.0, stepdown=0.001))
        make("fig2.dxf", (samples / "fig2.dxf").read_bytes(), options, Progress(listen, stop))
    assert told[-1] == "Depth passes"


def test_every_depth_pass_tells_how_far_it_is(samples: Path) -> None:
    told: list[float] = []

    def listen(fraction: float, text: str) -> None:
        if text == "Depth passes":
            told.append(fraction)

    options = MakeOptions(machining=MachiningOptions.of(depth=1.0, stepdown=0.1))
    made = make("fig2.dxf", (samples / "fig2.dxf").read_bytes(), options, Progress(listen))
    assert len(told) >= 10 * len(set(made.program.moves.operation.tolist()))
    assert told == sorted(set(told))
