"""Holes, chamfers and facing as a whole: from the drawing to the proven text, on every control, read by LinuxCNC
itself.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import GeometryError, HitofudeError, ParameterError
from app.core.resources import resource
from app.formats.job.toml import read_job
from app.gcode.posts import post_names
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.moves import MoveKind, Purpose
from app.operations.compute import compute
from app.usecases.job.options import MakeOptions
from app.usecases.job.plausible import read_for
from app.usecases.making.make import MakeResult, finish, job_from_drawing, make
from tests.gcode.rs274_oracle import exact_motions

TOOLS = """
[stock]
thickness = 10.0
under = 5.0
margin = 8.0
[[tool]]
number = 1
diameter = 6.0
[[tool]]
number = 2
kind = "drill"
diameter = 5.0
tip_angle = 118
[[tool]]
number = 3
kind = "tap"
diameter = 6.0
spindle_speed = 500
[[tool]]
number = 4
kind = "v"
diameter = 14.0
tip_angle = 90
[[tool]]
number = 5
kind = "reamer"
diameter = 5.1
[[tool]]
number = 6
kind = "thread-mill"
diameter = 4.0
[[tool]]
number = 7
kind = "ball"
diameter = 6.0
"""
PLATE = "rectangle 0,0 60,40\ncircle 15,20 3\ncircle 45,20 3\n"
DRILL = '[[operation]]\nkind = "drill"\ntool = 2\ndepth = 10\nthrough = 0.5\nleast = 5\nmost = 6\n'
TAP = DRILL + '[[operation]]\nkind = "tap"\ntool = 3\ndepth = 10\nthread = "M6"\n'


def made_of(operations: str, drawing: str = PLATE, post: str = "linuxcnc", tools: str = TOOLS) -> MakeResult:
    return make("part.draw", drawing.encode(), asked_for(operations, post, tools))


def asked_for(operations: str, post: str = "linuxcnc", tools: str = TOOLS) -> MakeOptions:
    text = f'{tools}{operations}\n[output]\npost = "{post}"\n'
    return MakeOptions(job=read_job("job", text.encode()).job)


def job_of(operations: str, drawing: str) -> Job:
    """The job alone, of which nothing is computed yet."""
    options = asked_for(operations)
    return job_from_drawing(read_for("part.draw", drawing.encode(), options), options).prepared()


def report_of(made: MakeResult) -> dict:
    return json.loads(made.report.text())


def blocks(made: MakeResult) -> list[str]:
    return [line for line in made.files[0].nc.text.splitlines() if not line.startswith(("(", ";"))]


def assert_same_cuts(made: MakeResult) -> None:
    """LinuxCNC's own interpreter cuts from where to where the moves do, at their feeds, cycles unrolled."""
    read = [each for each in exact_motions(made.nc.text) if each.kind is not MoveKind.RAPID]
    moves = made.program.moves
    cuts = (moves.kind != MoveKind.RAPID) & (moves.lengths() > 1e-9)
    assert [int(each.kind) for each in read] == moves.kind[cuts].tolist()
    for told, meant in (("start", moves.start), ("end", moves.end)):
        assert np.array([getattr(each, told) for each in read]) == pytest.approx(meant[cuts], abs=1e-3)
    assert np.array([each.feed for each in read]) == pytest.approx(moves.feed[cuts], abs=0.051)
    centre = np.array([(each.centre.real, each.centre.imag) for each in read if each.centre is not None]).reshape(-1, 2)
    assert centre == pytest.approx(moves.centre[cuts & (moves.kind >= MoveKind.ARC_CW)], abs=1e-3)


# What each kind cuts, by closed forms, and LinuxCNC's own reading

BORE = '[[operation]]\nkind = "bore"\ntool = 1\ndepth = 4\nstepdown = 1\n'
CHAMFER = '[[operation]]\nkind = "chamfer"\ntool = 4\nwidth = 1.0\ntip_offset = 0.3\nside = "{}"\n'
ROUND = '[[operation]]\nkind = "chamfer"\ntool = 7\nwidth = 1.0\nchamfer_depth = 0.8\nside = "{}"\n'


def groove(side: float) -> float:
    """The volume of the groove of a ball of 6 mm that breaks the edge of a circle of 20 mm, 1 mm wide and 0.8 mm deep:
    its axis is where both ends of the chamfer are 3 mm from the centre, and a segment of its meridian is turned.
    """
    middle, across = np.array([-1.0, -0.8]) / 2, np.array([0.8, 1.0]) / math.hypot(1.0, 0.8)
    off, above = middle + across * math.sqrt(9 - 0.41)
    segment = 9 * math.acos(above / 3) - above * math.sqrt(9 - above**2)
    return math.tau * (10 + side * off) * segment


KINDS = {
    "bore": (BORE, "circle 20,20 8\n", math.pi * 64 * 4),
    "countersink": ('[[operation]]\nkind = "countersink"\ntool = 4\n', PLATE, 2 * math.pi * 9 * 3 / 3),
    "chamfer inside": (CHAMFER.format("inside"), "circle 20,20 10\n", math.tau * 9.7 * 1.3**2),
    "chamfer outside": (CHAMFER.format("outside"), "circle 20,20 10\n", math.tau * 10.3 * 1.3**2),
    "ball inside": (ROUND.format("inside"), "circle 20,20 10\n", groove(-1)),
    "ball outside": (ROUND.format("outside"), "circle 20,20 10\n", groove(1)),
    "face": ('[[operation]]\nkind = "face"\ntool = 1\n', "rectangle 0,0 60,40\n", 76 * 56 * 0.5),
}
"""Operations, a drawing, and what they remove, mm3."""


@pytest.fixture(scope="module", params=KINDS)
def one_kind(request: pytest.FixtureRequest) -> tuple[MakeResult, float]:
    operations, drawing, volume = KINDS[request.param]
    tools = TOOLS.replace("[[tool]]", "above = 0.5\n[[tool]]", 1) if request.param == "face" else TOOLS
    return made_of(operations, drawing, tools=tools), volume


def test_it_removes_what_it_should_and_nothing_else(one_kind: tuple[MakeResult, float]) -> None:
    made, volume = one_kind
    report = report_of(made)
    assert made.clean and report["gouge"]["max_mm"] < 1e-6 and report["cut"]["gouged_places"] == 0
    assert report["cut"]["removed_mm3"] == pytest.approx(volume, rel=1e-3)


def test_linuxcnc_reads_the_same_motion(one_kind: tuple[MakeResult, float]) -> None:
    made, _ = one_kind
    assert_same_cuts(made)


def test_a_chamfered_boss_has_the_volume_of_a_cone() -> None:
    """A pocket clears round it, below the chamfer: what the chamfer takes is the ring alone."""
    pocket = '[[operation]]\nkind = "pocket"\ntool = 1\ndepth = 2\n'
    ring, drawing = CHAMFER.format("inside"), "circle 20,20 30\ncircle 20,20 10\n"
    plain, edged = (report_of(made_of(each, drawing))["cut"]["removed_mm3"] for each in (pocket, pocket + ring))
    rings = math.tau * ((10 - 1 / 3) + (30 + 1 / 3)) / 2  # a triangle of 1 x 1 mm, turned about the axis
    assert edged - plain == pytest.approx(rings, rel=0.01)


# Each is proven: a path that is broken on purpose is found


def broken(job: Job, operation: int, **off: float) -> MakeResult:
    """A job's program with what an operation cuts off by so much along an axis or in its feed."""
    program = compute(job)
    moves = program.moves
    mine = (moves.operation == operation) & (moves.purpose != Purpose.RAPID)
    end, feed = moves.end.copy(), moves.feed.copy()
    for axis, by in off.items():
        if axis == "feed":
            feed[mine] *= by
        else:
            end[mine & (end[:, 2] < 0), "xyz".index(axis)] += by
    return finish(replace(program, moves=replace(moves, end=end, feed=feed)), job)


@pytest.mark.parametrize(
    ("kind", "axis", "by", "found"),
    [
        ("bore", "z", -0.02, FindingKind.GOUGE),
        ("bore", "z", 0.02, FindingKind.LEFT_REACHABLE),
        ("countersink", "z", -0.02, FindingKind.GOUGE),
        ("countersink", "z", 0.02, FindingKind.LEFT_REACHABLE),
        ("chamfer inside", "z", -0.02, FindingKind.GOUGE),
        ("chamfer outside", "z", 0.02, FindingKind.LEFT_REACHABLE),
        ("ball inside", "z", -0.02, FindingKind.GOUGE),
        ("ball outside", "z", 0.02, FindingKind.LEFT_REACHABLE),
    ],
)
def test_a_path_that_is_off_is_found(kind: str, axis: str, by: float, found: FindingKind) -> None:
    operations, drawing, _ = KINDS[kind]
    made = broken(job_of(operations, drawing), 0, **{axis: by})
    assert [each for each in made.findings if each.counts and each.kind is found]


def test_a_tap_with_another_feed_is_found() -> None:
    made = made_of(TAP)
    assert made.clean
    wrong = broken(made.job, 1, feed=1.1)
    assert [each for each in wrong.findings if each.counts and "lead of M6 is off by 0.1000 mm a turn" in each.text]


# Points

POINTS = "layer p\npoint 10,10\npoint 50,10\nlayer 0\npoint 30,30\n"


@pytest.mark.parametrize(
    ("curves", "holes"), [("", {(10, 10), (50, 10), (30, 30)}), ('curves = ["layer:p"]\n', {(10, 10), (50, 10)})]
)
def test_points_are_drilled_like_circles_of_the_drills_size(curves: str, holes: set[tuple[int, int]]) -> None:
    drill = f'[[operation]]\nkind = "drill"\ntool = 2\ndepth = 10\npoints = true\n{curves}'
    made = made_of(drill, "rectangle 0,0 60,40\n" + POINTS)
    down = made.program.moves.end[made.program.moves.purpose != Purpose.RAPID]
    assert made.clean and {(x, y) for x, y, _ in np.round(down).astype(int).tolist()} == holes
    whole = math.pi * 2.5**2 * 10  # and the drill's point below
    assert report_of(made)["cut"]["removed_mm3"] >= len(holes) * whole * 0.99
    assert_same_cuts(made)


def test_points_are_no_holes_unless_they_are_asked_for() -> None:
    drill = '[[operation]]\nkind = "drill"\ntool = 2\ndepth = 10\n'
    with_points, without = (made_of(drill, PLATE + each + "circle 30,10 2.5\n") for each in (POINTS, ""))
    assert with_points.nc.text == without.nc.text


# Threads

THREAD = DRILL + '[[operation]]\nkind = "thread"\ntool = 6\ndepth = 8\nthread = "M6"\n'


@pytest.mark.parametrize("direction", ["climb", "conventional"])
@pytest.mark.parametrize("flutes", [1.0, 4.0, 20.0])
def test_threads_have_their_lead_and_their_pitch_diameter(direction: str, flutes: float) -> None:
    tools = TOOLS + f"flute_length = {flutes}\n"
    made = made_of(THREAD + f'direction = "{direction}"\n', tools=tools)
    thread = report_of(made)["operations"][1]["cut_thread"]
    assert made.clean
    assert thread["holes"] == 2 and thread["lead_off_mm"] < 1e-3 and thread["bare_mm"] == 0
    assert abs(thread["pitch_diameter_off_mm"]) < 1e-3
    assert_same_cuts(made)


@pytest.mark.parametrize("flutes", [1.0, 4.0])
def test_a_left_handed_thread_is_proven_and_one_of_the_wrong_hand_is_found(flutes: float) -> None:
    tools = TOOLS + f"flute_length = {flutes}\n"
    made = made_of(THREAD + "left_hand = true\n", tools=tools)
    assert made.clean and report_of(made)["operations"][1]["cut_thread"]["lead_off_mm"] < 1e-3
    assert any("M6, left-handed," in each.text for each in made.findings)
    assert_same_cuts(made)
    right = made_of(THREAD, tools=tools)
    asked = replace(right.job, operations=(*right.job.operations[:1], replace(right.job.operations[1], left_hand=True)))
    wrong = finish(compute(right.job), asked)
    assert not wrong.clean and report_of(wrong)["operations"][1]["cut_thread"]["lead_off_mm"] == pytest.approx(2.0)


@pytest.mark.parametrize("through", [0.0, 1.5])
def test_a_tap_that_stays_short_of_its_depth_or_of_its_way_through_is_found(through: float) -> None:
    made = made_of(TAP.replace("through = 0.5", "through = 2") + f"through = {through}\n")
    assert made.clean and report_of(made)["operations"][1]["cut_thread"]["bare_mm"] == 0
    operations = made.job.operations
    deeper = replace(operations[1], through=through + 0.25)
    short = finish(compute(made.job), replace(made.job, operations=(operations[0], deeper, *operations[2:])))
    assert not short.clean
    assert report_of(short)["operations"][1]["cut_thread"]["bare_mm"] == pytest.approx(0.25)


BORED = '[[operation]]\nkind = "bore"\ntool = 1\nleast = 6\nmost = 6\n'


@pytest.mark.parametrize(("thread", "operation"), [(THREAD, 1), (TAP, 1)], ids=["milled", "tapped"])
@pytest.mark.parametrize(
    ("other", "left", "counts"),
    [("diameter = 10\ndepth = 3\n", 3.0, False), ("diameter = 7\ndepth = 10\n", 0.0, True)],
    ids=["counterbored", "bored away"],
)
def test_what_other_operations_take_of_a_thread_is_told(
    thread: str, operation: int, other: str, left: float, counts: bool
) -> None:
    """Behind it, where nothing that is looked at before it is threaded could tell."""
    made = made_of(thread + BORED + other)
    (told,) = [each for each in made.findings if each.text.startswith("Of the ")]
    depth = made.job.operations[operation].cut.depth
    assert told.counts == counts and "the worst of 2 threads" in told.text
    assert f"{depth - left if not counts else 0:.3f} mm stand" in told.text
    assert report_of(made)["operations"][operation]["cut_thread"]["cut_away_mm"] == pytest.approx(left or depth)


def test_a_slot_that_crosses_a_thread_is_told_and_a_countersink_is_not() -> None:
    slot = '[[operation]]\nkind = "slot"\ntool = 1\ndepth = 4\ncurves = ["open"]\n'
    made = made_of(THREAD + slot, PLATE + "line 15,24 15,34\n")
    (told,) = [each for each in made.findings if each.text.startswith("Of the ")]
    assert not told.counts and "take 4.000 mm on a part of the way round" in told.text
    sunk = made_of(THREAD + '[[operation]]\nkind = "countersink"\ntool = 4\ndiameter = 6.6\nleast = 6\nmost = 6\n')
    assert sunk.clean and not [each for each in sunk.findings if each.text.startswith("Of the ")]


@pytest.mark.parametrize("thread", [TAP, THREAD.replace("depth = 8", "depth = 10")], ids=["tapped", "milled"])
def test_a_thread_that_is_open_on_one_side_all_the_way_down_counts(thread: str) -> None:
    pocket = '[[operation]]\nkind = "pocket"\ntool = 1\ndepth = 10\ncurves = ["layer:b"]\n'
    drawing = "layer a\n" + PLATE + "layer b\nrectangle 15,10 27,30\n"
    made = made_of(thread.replace("[[operation]]\n", '[[operation]]\ncurves = ["layer:a"]\n') + pocket, drawing)
    (told,) = [each for each in made.findings if each.text.startswith("Of the ")]
    assert told.counts and "take 10.000 mm on a part of the way round" in told.text


@pytest.mark.parametrize("y", [20.0, 21.8])
def test_a_narrow_cut_through_a_wide_thread_is_seen_wherever_it_goes(y: float) -> None:
    tools = TOOLS.replace("diameter = 4.0", "diameter = 16.0").replace("thickness = 10.0", "thickness = 20.0")
    tools += "[[tool]]\nnumber = 8\ndiameter = 3.0\n[[tool]]\nnumber = 9\ndiameter = 12.0\n"
    thread = (
        '[[operation]]\nkind = "bore"\ntool = 9\ndepth = 20\nstepdown = 4\ndiameter = 26.5\ncurves = ["layer:a"]\n'
        '[[operation]]\nkind = "thread"\ntool = 6\ndepth = 18\nthread = "M30"\ncurves = ["layer:a"]\n'
    )
    line = '[[operation]]\nkind = "contour"\ntool = 8\ndepth = 20\nstepdown = 4\nside = "on"\ncurves = ["layer:b"]\n'
    made = made_of(thread + line, f"layer a\ncircle 30,20 15\nlayer b\nline 5,{y} 55,{y}\n", tools=tools)
    (told,) = [each for each in made.findings if each.text.startswith("Of the ")]
    assert told.counts and "take 18.000 mm on a part of the way round" in told.text


def test_a_thread_on_a_boss() -> None:
    pocket = '[[operation]]\nkind = "pocket"\ntool = 1\ndepth = 9\n'
    thread = '[[operation]]\nkind = "thread"\ntool = 6\ndepth = 8\nthread = "M16"\nexternal = true\n'
    made = made_of(pocket + thread, "rectangle 0,0 60,40\ncircle 30,20 8\n")
    found = report_of(made)["operations"][1]["cut_thread"]
    assert made.clean and abs(found["pitch_diameter_off_mm"]) < 1e-3 and found["lead_off_mm"] < 1e-3


def test_a_thread_that_is_off_is_found() -> None:
    made = made_of(THREAD)
    program = compute(made.job)
    moves = program.moves
    end = moves.end.copy()
    end[(moves.operation == 1) & (end[:, 2] < 0), 2] *= 1.05  # the lead, and so all heights
    wrong = finish(replace(program, moves=replace(moves, end=end)), made.job)
    assert [each for each in wrong.findings if "The lead of M6 is off by 0.05" in each.text and each.counts]
    narrow = made.job.tool(6)
    thin = replace(made.job, tools=tuple(replace(t, diameter=3.96) if t is narrow else t for t in made.job.tools))
    slim = finish(replace(program, moves=moves), thin)  # the path of a mill that is 0.02 mm wider a side
    assert [each for each in slim.findings if "0.0400 mm too narrow" in each.text and each.counts]


# Cycles, on every control


@pytest.mark.parametrize("post", post_names())
def test_waits_stand_at_the_bottoms_and_are_read_back(post: str) -> None:
    made = made_of(DRILL + "dwell = 0.5\n", post=post)
    text = "\n".join(blocks(made))
    assert made.clean
    if post == "grbl":
        assert text.count("\nG4 P0.5\nG0 Z5.0000") == 2
    else:
        assert len(re.findall(r"G98 G82 X\S+ Y\S+ Z\S+ R\S+ P(?:500|0\.5) ", text)) == 1
    pecked = made_of(DRILL + "dwell = 0.5\npeck = 4.0\n", post=post)  # no cycle pecks and waits
    wait = "G4 P500" if post in ("fanuc", "haas") else "G4 P0.5"
    assert pecked.clean and blocks(pecked).count(wait) == 2


def test_files_of_other_tools_wait_nowhere() -> None:
    """grbl changes no tools: the file of a mill has no hole in it."""
    milled = '[[operation]]\nkind = "contour"\ntool = 1\ndepth = 10\nside = "outside"\ncurves = ["outer"]\n'
    made = made_of(DRILL + "dwell = 0.5\n" + milled, post="grbl")
    assert ["G4 P0.5" in file.nc.text for file in made.files] == [True, False]


@pytest.mark.parametrize("post", ["fanuc", "haas", "linuxcnc", "mach3"])
@pytest.mark.parametrize(("breaks", "word"), [("false", "G83"), ("true", "G73")])
def test_pecking_cycles(post: str, breaks: str, word: str) -> None:
    made = made_of(DRILL + f"peck = 3.0\nchip_break = {breaks}\n", post=post)
    assert made.clean and len([line for line in blocks(made) if f"G98 {word}" in line]) == 1
    if post == "linuxcnc":
        assert_same_cuts(made)


@pytest.mark.parametrize("post", ["fanuc", "haas", "linuxcnc"])
def test_taps_are_written_as_cycles(post: str) -> None:
    made = made_of(TAP, post=post)
    text = "\n".join(blocks(made))
    assert made.clean and report_of(made)["operations"][1]["cut_thread"]["lead_off_mm"] == 0
    assert text.count("G84") == (2 if post == "linuxcnc" else 1) and "F500" in text
    assert ("M29 S500\nG98 G84" in text) == (post == "fanuc")
    if post == "linuxcnc":
        assert_same_cuts(made)


@pytest.mark.parametrize("post", ["fanuc", "haas", "linuxcnc"])
@pytest.mark.parametrize("speed", [33, 61, 333])
def test_the_feed_of_a_tap_is_the_pitch_by_the_speed(post: str, speed: int) -> None:
    """F to 0.01 in/min would lead a tap at 33 rpm by 1.0006 mm a turn in place of 1."""
    tools = TOOLS.replace("spindle_speed = 500", f"spindle_speed = {speed}")
    job = read_job("job", f'{tools}{TAP}\n[output]\npost = "{post}"\nunits = "in"\n'.encode()).job
    made = make("part.draw", PLATE.encode(), MakeOptions(job=job))
    assert made.clean and report_of(made)["operations"][1]["cut_thread"]["lead_off_mm"] <= 0.0001
    feeds = [float(feed) for block in blocks(made) for feed in re.findall(r" Y.*F([0-9.]+)", block)]
    assert any(abs(feed * 25.4 - speed) <= 25.4 * 0.00005 + 1e-9 for feed in feeds)
    coarse = re.sub(r"( Y.*F[0-9]+\.[0-9]{2})[0-9]+", r"\1", made.nc.text)
    assert coarse != made.nc.text and "the feed is" in tampered(made, made.nc.text, coarse)


@pytest.mark.parametrize("post", ["fanuc", "haas", "linuxcnc"])
def test_taps_to_the_left_turn_counter_clockwise(post: str) -> None:
    made = made_of(TAP + "left_hand = true\n", post=post)
    text = "\n".join(blocks(made))
    assert made.clean and "G84" not in text and text.count("G74") == (2 if post == "linuxcnc" else 1)
    assert text.count("S500 M4") == 1 and ("M29 S500\nG98 G74" in text) == (post == "fanuc")
    assert "counter-clockwise (M4)" in tampered(made, "M4", "M3") or post == "linuxcnc"
    assert "that the tap comes out" in tampered(made, "G74", "G84") or post == "linuxcnc"
    if post == "linuxcnc":
        assert_same_cuts(made)


def test_a_tap_turns_one_way_alone() -> None:
    both = TAP + 'left_hand = true\ncurves = ["circles:5"]\n' + '[[operation]]\nkind = "tap"\ntool = 3\nthread = "M6"\n'
    with pytest.raises(ParameterError, match="a tap turns one way alone"):
        made_of(both)


@pytest.mark.parametrize("post", ["grbl", "mach3"])
def test_where_no_cycle_taps_the_program_is_refused(post: str) -> None:
    with pytest.raises(ParameterError, match="has no cycle that taps"):
        made_of(TAP, post=post)


@pytest.mark.parametrize(
    ("post", "change", "found"),
    [
        ("linuxcnc", ("P0.5", "P0.7"), "dwell here that was not meant"),
        ("linuxcnc", ("G82", "G89"), "this is G1 where G0 was meant"),
        ("fanuc", ("P500 F", "F"), "does not wait for 0.5 s"),
    ],
)
def test_a_wait_that_is_wrong_is_found(post: str, change: tuple[str, str], found: str) -> None:
    assert found in tampered(made_of(DRILL + "dwell = 0.5\n", post=post), *change)


@pytest.mark.parametrize(
    ("post", "change", "found"),
    [
        ("linuxcnc", ("G84", "G85"), "does not turn counter-clockwise"),
        ("fanuc", ("M29 S500\n", ""), "stands before tapping is missing"),
        ("fanuc", ("M29 S500", "M29 S600"), "none of the program's moves"),
        ("fanuc", ("G98 G81", "M29 S500\nG98 G81"), ""),
    ],
)
def test_a_tapping_cycle_that_is_wrong_is_found(post: str, change: tuple[str, str], found: str) -> None:
    assert found in tampered(made_of(TAP, post=post), *change)


def tampered(made: MakeResult, old: str, new: str) -> str:
    """What the check says of the program's text with something else in it."""
    from app.gcode.checks.check import CheckReference, check
    from app.gcode.posts import load_post

    (file,) = made.files
    assert old in file.nc.text
    data = file.nc.text.replace(old, new, 1).encode()
    found = check(data, file, CheckReference(made.program, made.job, load_post(made.job.post)))
    assert found.problems
    with pytest.raises(HitofudeError):
        found.require("program")
    return " ".join(each.text for each in found.problems)


def test_what_a_program_tells_is_read_back() -> None:
    from app.gcode.interpreter.options import ReadOptions
    from app.gcode.interpreter.reader import read_program
    from app.gcode.operation_notes import written
    from app.gcode.posts import load_post

    made = made_of(THREAD + TAP.removeprefix(DRILL) + CHAMFER.format("outside"))
    header = read_program(made.files[0].nc.text.encode(), ReadOptions(load_post("linuxcnc").dialect)).header
    assert header is not None
    read = [note.operation() for note in header.operations]
    assert [type(each) for each in read] == [type(each) for each in made.job.operations]
    for one, other in zip(read, made.job.operations, strict=True):
        assert one is not None and written(one) == written(other)


@pytest.mark.exhaustive
@pytest.mark.parametrize("post", ["linuxcnc", "fanuc", "haas"])
def test_the_sample_is_clean(post: str) -> None:
    job = read_job("holes.toml", resource("samples", "holes.toml").read_bytes().replace(b"linuxcnc", post.encode())).job
    made = make("holes.draw", resource("samples", "holes.draw").read_bytes(), MakeOptions(job=job))
    assert made.clean
    assert report_of(made)["operations"][0]["faced"]["left_mm2"] == 0


# What is no hole

BORE = '[[operation]]\nkind = "bore"\ntool = 1\ndepth = 2\n'
ROUND_PLATE = "circle 0,0 30\ncircle 18,0 5\ncircle 18,0 4\nrectangle -8,-8 6,6\n"
"""An outline of 60 mm, a hole of 10 with a shallower one about its centre, and a boss."""


def wrong(made: MakeResult) -> list[str]:
    return [each.text for each in made.findings if each.counts]


@pytest.mark.parametrize("kind", ["bore", "countersink"])
def test_a_circle_with_other_contours_inside_is_an_outline_and_no_hole(kind: str) -> None:
    """Or the boss were cut away with it, and the plate's rim."""
    operation = BORE if kind == "bore" else '[[operation]]\nkind = "countersink"\ntool = 4\n'
    wide = TOOLS.replace("diameter = 14.0", "diameter = 70.0")
    made = made_of(operation, ROUND_PLATE, tools=wide)
    moves = made.program.moves
    low = moves.end[:, 2] < 0
    assert low.any() and np.hypot(*(moves.end[low, :2] - (18, 0)).T).max() < 5
    (told,) = [each for each in made.findings if "as other contours lie inside" in each.text]
    assert (told.x, told.y) == (0, 0) and not told.counts and not wrong(made)


@pytest.mark.parametrize("named", ['curves = ["circles:60"]', "least = 50", "most = 70"])
def test_an_outline_that_is_named_is_bored_and_what_goes_with_it_is_told(named: str) -> None:
    made = made_of(f"{BORE}{named}\n", ROUND_PLATE)
    moves = made.program.moves
    assert np.hypot(*moves.end[moves.end[:, 2] < 0, :2].T).max() == pytest.approx(27, abs=1e-3)
    assert any("with the contours that lie inside" in each.text for each in made.findings)
    assert not wrong(made)


def test_holes_are_no_holes_for_the_bore_that_holds_them() -> None:
    """A cutter stays in the hole that holds it, and that need not be the one whose middle is nearest."""
    made = made_of(f"{BORE}least = 1\n", "circle 0,0 11\ncircle 5,0 4\n")
    assert not wrong(made)
    out = made_of(f"{BORE}least = 1\n", "circle 0,0 11\ncircle 9,0 4\n")
    assert not wrong(out), "holes that cross"


@pytest.mark.parametrize("kind", ["thread", "tap"])
def test_a_drawing_without_an_area_is_refused_for_threads_too(kind: str) -> None:
    tool = 6 if kind == "thread" else 3
    operation = f'[[operation]]\nkind = "{kind}"\ntool = {tool}\ndepth = 5\nthread = "M6"\n'
    with pytest.raises(GeometryError, match="there is no closed contour"):
        made_of(operation, "line 0,0 10,0\n")


def test_countersinks_that_cross_are_no_gouge() -> None:
    """Nearer to the one's middle its cone is deeper than the other's, and so is what is asked for; a tip that goes
    deeper is found as before.
    """
    operation = '[[operation]]\nkind = "countersink"\ntool = 4\ndiameter = 6\n'
    made = made_of(operation, "circle 0,0 1.5\ncircle 4.76,0 1.5\n")
    assert not wrong(made)
    depth = -made.program.moves.end[:, 2].min()
    assert depth == pytest.approx(3.0)
