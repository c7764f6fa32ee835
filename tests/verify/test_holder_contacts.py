"""Shanks and holders in metal: closed forms, and a slow oracle that steps through a program and looks before each step
is cut.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence

import numpy as np
import pytest

from app.core.errors import Cancelled
from app.core.progress import Progress
from app.model.motion import Floats, MotionKind, Motions, Plane
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.bodies.bodies import HolderPart, bodies_of
from app.simulation.cutter import Cutter, cutter_of
from app.simulation.field.workpiece import BoxStock, Grid, Workpiece
from app.simulation.sweeps.course import Course
from app.verify import holder_contacts as module
from app.verify.body_contacts import STEP, TOUCH, chords_of
from app.verify.holder_contacts import HolderReport, holder_contacts
from tests.simulation.courses import arc, joined, motions_of, polyline

NUT = ((0.0, 10.0), (20.0, 10.0))
TOOL = Tool(1, 6.0, stick_out=20.0, holder=NUT)


def block(depth: float = 40.0, cells: int = 160, size: float = 80.0, high: float | None = None) -> Workpiece:
    """A block with its top at 0; `high`: the half at X > 0 stands so much higher."""
    half = size / 2
    piece = BoxStock(StockBox(-half, -half, -depth, half, half)).over(Grid.over((-half, -half, half, half), cells))
    if high is None:
        return piece
    heights = piece.heights.copy()
    heights[:, piece.grid.xs() > 0] = high
    return Workpiece(piece.grid, heights, piece.floor)


def look(
    motions: Motions, tool: Tool = TOOL, piece: Workpiece | None = None, tools: Sequence[int] = ()
) -> HolderReport:
    course = Course(motions, np.array(tools or np.ones(len(motions)), np.int32))
    return holder_contacts(course, piece if piece is not None else block(), {1: cutter_of(tool)}, {1: tool})


def holders(found: HolderReport) -> list[float]:
    return [contact.depth for contact in found.contacts if contact.part is HolderPart.HOLDER]


def test_nothing_is_asked_of_tools_that_nobody_knows() -> None:
    assert look(polyline([(0, 0, 5), (0, 0, -30)]), Tool(1, 6.0)) == HolderReport()


@pytest.mark.parametrize(("stick_out", "touches"), [(20.0, True), (20.48, True), (20.51, False), (25.0, False)])
def test_a_holder_touches_a_step_beside_a_pocket(stick_out: float, touches: bool) -> None:
    """The step is 20.5 mm over the floor and its wall 9 mm beside the path, the holder 10 mm wide."""
    path = polyline([(-9, -20, 5), (-9, -20, -12.5), (-9, 20, -12.5)])
    found = look(path, Tool(1, 6.0, stick_out=stick_out, holder=NUT), block(high=8.0))
    assert holders(found) == ([pytest.approx(20.5 - stick_out, abs=1e-5)] if touches else [])
    assert found.least == {1: 20.5}


@pytest.mark.parametrize(("x", "touches"), [(-9.5, True), (-10.2, False)])
def test_a_holder_touches_what_is_within_its_radius(x: float, touches: bool) -> None:
    """Cells are 0.5 mm wide, so the wall's first centre is at X 0.25."""
    found = look(polyline([(x, -20, 5), (x, -20, -12.5), (x, 20, -12.5)]), piece=block(high=8.0))
    assert holders(found) == ([pytest.approx(0.5, abs=1e-5)] if touches else [])


def test_a_contact_has_a_place_and_its_motions() -> None:
    found = look(
        polyline([(-30, 0, 5), (-30, 0, -20.25), (-10, 0, -20.25), (-10, 0, -22.5), (-30, 0, -22.5), (-30, 0, 5)])
    )
    (contact,) = found.contacts
    assert (contact.tool, contact.part, contact.first, contact.count) == (1, HolderPart.HOLDER, 0, 5)
    assert contact.motion == 2
    assert (contact.z, contact.depth) == (pytest.approx(-2.5, abs=1e-5), pytest.approx(2.5, abs=1e-5))
    assert np.hypot(contact.x + 10, contact.y) <= 10.0
    assert found.least == {1: 22.5}


def test_rapids_are_asked_too() -> None:
    down = motions_of(np.array([(-9.0, 0, 30)]), np.array([(-9.0, 0, -12.5)]), MotionKind.RAPID)
    assert holders(look(down, piece=block(high=8.0))) == [pytest.approx(0.5, abs=1e-5)]


@pytest.mark.parametrize("far_first", [True, False])
def test_metal_counts_as_it_is_when_the_motion_is_done(far_first: bool) -> None:
    """A rib beside a deep slot: cut away before, it is in nobody's way; cut away afterwards, it is."""
    found = beside_a_rib(far_first)
    assert holders(found) == ([] if far_first else [pytest.approx(3.0, abs=1e-5)])
    assert found.least == {1: 15.0 if far_first else 23.0}


def beside_a_rib(far_first: bool) -> HolderReport:
    """A slot, in three motions, beside a rib 23 mm over it that another tool cuts away: after that, and unless
    `far_first` before it.
    """
    clear = [(20.0, -50.0, 0.0), (20.0, 50.0, 0.0)]
    slot = [(8.0, -50.0, -15.0), (8.0, -10.0, -15.0), (8.0, 10.0, -15.0), (8.0, 50.0, -15.0)]
    ribbed = block()
    heights = ribbed.heights.copy()
    heights[:, (ribbed.grid.xs() > 14) & (ribbed.grid.xs() < 26)] = 8.0
    piece = Workpiece(ribbed.grid, heights, ribbed.floor)
    wide = Tool(2, 14.0)
    ways = [*([] if far_first else [(slot, 1)]), (clear, 2), (slot, 1)]
    motions = joined([polyline(way) for way, _ in ways])
    numbers = np.concatenate([np.full(len(way) - 1, number, np.int32) for way, number in ways])
    return holder_contacts(
        Course(motions, numbers), piece, {1: cutter_of(TOOL), 2: cutter_of(wide)}, {1: TOOL, 2: wide}
    )


SHANK = Tool(1, 6.0, flute_length=10.0, shank_diameter=6.0)


def test_a_shank_as_wide_as_the_cutter_fits_between_walls_that_the_cutter_has_cut() -> None:
    ways = [[(-30, 0, z), (30, 0, z)] for z in (-8.0, -16.0, -24.0, -32.0)]
    assert look(joined([polyline(way) for way in ways]), SHANK).contacts == ()


def test_a_shank_fits_round_arcs_that_the_cutter_has_cut() -> None:
    turns = [arc((20, 0, z), (20, 0, z), (0, 0, z)) for z in (-8.0, -16.0, -24.0, -32.0)]
    assert look(joined(turns), SHANK).contacts == ()


def test_a_shank_follows_a_drill_into_its_hole() -> None:
    assert look(polyline([(0, 0, 5), (0, 0, -35)]), SHANK).contacts == ()
    assert look(polyline([(0, 0, 5), (30, 0, -35)]), SHANK).contacts == (), "steeper than the flutes are long"


def test_metal_higher_than_the_flutes_meets_the_shank() -> None:
    (contact,) = look(polyline([(-50, 0, -13.5), (50, 0, -13.5)]), SHANK).contacts
    assert (contact.part, contact.depth) == (HolderPart.SHANK, pytest.approx(3.5, abs=1e-5))


def test_a_thicker_shank_meets_the_rim_of_a_hole() -> None:
    thick = Tool(1, 3.0, flute_length=10.0, shank_diameter=6.0)
    assert look(polyline([(0, 0, 5), (0, 0, -9.995)]), thick).contacts == ()
    (contact,) = look(polyline([(0, 0, 5), (0, 0, -12)]), thick).contacts
    assert contact.depth == pytest.approx(2.0, abs=1e-5)


def test_a_boss_that_a_plunge_cuts_away_is_not_met() -> None:
    """All the metal within the holder is within the cutter: it goes before the holder comes."""
    piece = block()
    heights = np.where(np.hypot(*np.meshgrid(piece.grid.xs(), piece.grid.ys())) < 2.5, 0.0, -39.0).astype(np.float32)
    boss = Workpiece(piece.grid, heights, piece.floor)
    assert look(polyline([(0, 0, 5), (0, 0, -30)]), piece=boss).contacts == ()
    found = look(polyline([(-0.1, 0, 5), (0.1, 0, -30)]), piece=boss)
    assert found.contacts == ()
    (contact,) = look(
        motions_of(np.array([(0.0, 0, 5)]), np.array([(0.0, 0, -30)]), MotionKind.RAPID), piece=boss
    ).contacts
    assert contact.depth == pytest.approx(10.0, abs=1e-5), "a rapid cuts nothing away"


@pytest.mark.parametrize("blocks", [1, 32])
def test_a_fin_that_a_ramp_cuts_away_is_met_as_long_as_it_stands(monkeypatch: pytest.MonkeyPatch, blocks: int) -> None:
    """The holder sinks 10 mm over 24; each cell of the fin stands until the cutter's front comes to it."""
    monkeypatch.setattr(module, "BLOCKS", blocks)
    piece = block()
    x, y = np.meshgrid(piece.grid.xs(), piece.grid.ys())
    fin = (x > 5) & (x < 6) & (np.abs(y) < 2.5)
    metal = Workpiece(piece.grid, np.where(fin, 0.0, -39.0).astype(np.float32), piece.floor)
    (contact,) = look(polyline([(-12, 0, -15), (12, 0, -25)]), piece=metal).contacts
    cut_at = x[fin] - np.sqrt(9 - y[fin] ** 2)
    truly = (cut_at + 12) * 10 / 24 - 5
    assert truly.max() - 0.001 <= contact.depth <= truly.max() + STEP + 0.001


def samples(motions: Motions, row: int) -> Floats:
    """Places along a motion, 0.02 mm apart."""
    chords = chords_of(Course(motions, np.ones(len(motions), np.int32)), np.array([row]))
    parts = []
    for start, end in zip(chords.start, chords.end, strict=True):
        count = max(2, int(np.ceil(np.linalg.norm(end - start) / 0.02)) + 1)
        parts.append(start + (end - start) * np.linspace(0, 1, count)[:, None])
    return np.concatenate(parts)


def stepped(motions: Motions, tool: Tool, piece: Workpiece, wider: float) -> dict[tuple[int, HolderPart], float]:
    """How deep bodies, so much wider, mm, go into metal by motion and part: looked at before each small step is cut."""
    x, y = np.meshgrid(piece.grid.xs(), piece.grid.ys())
    metal, cutter, found = piece.heights.astype(np.float64), cutter_of(tool), {}

    def over(shape: Cutter, place: Floats, more: float) -> Floats:
        aside = np.maximum(np.hypot(x - place[0], y - place[1]) - more, 0.0)
        return shape.heights(aside) + place[2] + shape.lift

    for row in range(len(motions)):
        for place in samples(motions, row):
            for body in bodies_of(tool):
                depth = float((metal - np.maximum(over(body.shape, place, wider), piece.floor)).max())
                if depth > 0:
                    found[row, body.part] = max(depth, found.get((row, body.part), 0.0))
            if motions.kind[row] != MotionKind.RAPID:
                metal = np.minimum(metal, np.maximum(over(cutter, place, 0.0), piece.floor))
    return found


def random_program(seed: int) -> Motions:
    """Lines, plunges, ramps, arcs, helices and rapids, deep."""
    rng = np.random.default_rng(seed)
    parts, at = [polyline([(0, 0, 3), (0, 0, -5)])], np.array([0.0, 0.0, -5.0])
    for _ in range(14):
        sort = rng.integers(0, 6)
        to = (
            at
            + (rng.uniform(-6, 6, 3) - (0, 0, 1))
            * [(1, 1, 0), (0, 0, 1), (1, 1, 0.7), (0, 0, 1), (1, 1, 1), (1, 1, 0.2)][sort]
        )
        to = np.clip(to, (-9, -9, -14), (9, 9, 3))
        if sort == 3:
            centre = at + [rng.uniform(1, 3), 0, 0]
            end = [*at[:2], at[2] + rng.choice([0.0, -2.0, 1.0])]
            parts.append(arc(at, end, centre, Plane.XY, bool(rng.integers(2))))
            to = np.array(end)
        else:
            parts.append(motions_of(at[None], to[None], MotionKind.RAPID if sort == 4 else MotionKind.LINE))
        at = to
    return joined(parts)


TOOLS = {
    "nut": Tool(1, 3.0, stick_out=8.0, holder=((0.0, 3.0), (2.0, 5.0), (2.0, 6.0), (9.0, 6.0))),
    "ball and shank": Tool(
        1, 3.0, ToolKind.BALL, flute_length=5.0, shank_diameter=4.0, stick_out=9.0, holder=((0.0, 5.0), (9.0, 5.0))
    ),
    "long": Tool(1, 4.0, flute_length=6.0, shank_diameter=4.0),
}


@pytest.mark.parametrize("seed", [0, 2, 3, 4, 5, 6])
@pytest.mark.parametrize("tool", TOOLS.values(), ids=TOOLS)
def test_random_deep_programs_touch_as_stepping_through_them_shows(tool: Tool, seed: int) -> None:
    piece, motions = block(15.0, 48, 20.0), random_program(seed)
    less, more = (stepped(motions, tool, piece, wider) for wider in (-TOUCH - 0.03, 0.03))
    asking = module._HolderCheck(
        Course(motions, np.ones(len(motions), np.int32)), piece, {1: cutter_of(tool)}, {1: tool}, {1: bodies_of(tool)}
    )
    asking.done(module.NO_PROGRESS)
    found: dict[tuple[int, HolderPart], float] = {}
    for (row, body), touch in asking._touched.items():
        key = row, bodies_of(tool)[body].part
        found[key] = max(found.get(key, 0.0), touch.depth)
    assert asking._touched, "the program should touch somewhere"
    for key, depth in less.items():
        assert found.get(key, 0.0) >= depth - TOUCH - 0.02, f"{key} is missed"
    for key, depth in found.items():
        assert depth <= more.get(key, 0.0) + STEP + 0.02, f"{key} is none"


@pytest.mark.parametrize("seed", range(8))
def test_at_the_least_stick_out_nothing_touches_and_with_less_something_does(seed: int) -> None:
    piece, motions, tool = block(15.0, 48, 20.0), random_program(seed), TOOLS["nut"]
    least = look(motions, tool, piece).least[1]

    def touches(stick_out: float) -> bool:
        return bool(holders(look(motions, Tool(1, 3.0, stick_out=stick_out, holder=tool.holder), piece)))

    assert not touches(least)
    assert touches(least - 0.2)


def test_blocks_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    """With one block for all, everything that is in doubt is asked alone."""
    piece, motions, tool = block(15.0, 48, 20.0), random_program(3), TOOLS["ball and shank"]
    many = look(motions, tool, piece)
    monkeypatch.setattr(module, "BLOCKS", 1)
    one = look(motions, tool, piece)
    assert one.least == many.least
    assert [(each.part, each.first, each.count) for each in one.contacts] == [
        (each.part, each.first, each.count) for each in many.contacts
    ]
    assert [each.depth for each in one.contacts] == pytest.approx(
        [each.depth for each in many.contacts], abs=STEP + 1e-5
    )


def test_what_cannot_be_afforded_is_counted_and_the_stick_out_stays_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "BLOCKS", 1)
    assert (beside_a_rib(False).unseen, holders(beside_a_rib(False))) == (0, [pytest.approx(3.0, abs=1e-5)])
    monkeypatch.setattr(module, "CELLS", 1.0)
    monkeypatch.setattr(module, "ROUNDS", ())
    assert (beside_a_rib(False).unseen, beside_a_rib(False).least) == (5, {1: 23.0})


def test_a_look_tells_how_far_it_is_and_can_be_cancelled() -> None:
    motions, steps, stop = random_program(3), list[float](), threading.Event()

    def listen(fraction: float, text: str) -> None:
        steps.append(fraction)
        if fraction > 0.3:
            stop.set()

    course = Course(motions, np.ones(len(motions), np.int32))
    with pytest.raises(Cancelled):
        holder_contacts(
            course, block(15.0, 48, 20.0), {1: cutter_of(TOOLS["nut"])}, {1: TOOLS["nut"]}, Progress(listen, stop)
        )
    assert steps == sorted(steps) and 0.3 < steps[-1] < 0.5


def test_programs_follow_each_other() -> None:
    one, two = look(polyline([(0, 0, -21.0), (5, 0, -21.0)])), look(polyline([(0, 0, -23.0), (5, 0, -23.0)]))
    both = one.followed(two, 7)
    assert [(each.first, each.motion) for each in both.contacts] == [(0, 0), (7, 7)]
    assert both.least == {1: 23.0}


def test_touches_far_from_each_other_along_a_wall_are_two_contacts() -> None:
    """The tool leaves the wall in between, to where its holder is free."""
    path = [(-30, -30, 5), (-30, -30, -12.5), (-9, -30, -12.5), (-9, -17, -12.5), (-30, -17, -12.5)]
    path += [(-30, 17, -12.5), (-9, 17, -12.5), (-9, 30, -12.5)]
    contacts = look(polyline(path), piece=block(high=8.0)).contacts
    assert [(contact.first, contact.count) for contact in contacts] == [(1, 3), (5, 2)]
