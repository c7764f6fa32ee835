"""Nothing is lost between the drawn curves and the program, and a link that loses something turns the verdict red."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from app.geometry.arcs.bezier import pieces_of
from app.geometry.arcs.chord_kernels import chords
from app.geometry.chaining import chain
from app.geometry.chaining.chain import ChainingResult
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import grown_lines
from app.geometry.outlines import NestingResult, Outlines
from app.geometry.overlay import overlay as overlay_net
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.part import Contour, Entity, Part
from app.toolpath import drawn_contours, machining_areas, witness
from app.toolpath.witness import grown_findings
from app.usecases.job.machining import MachiningOptions
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make
from tests.geometry.meeting_shapes import OFFSETS
from tests.part_shapes import circle, layered_part, random_part, square

PAIR = "circle 0,0 10\ncircle 19.999999,0 10\n"
CROSSING = "circle 0,0 10\ncircle 15,0 10\ncircle 50,0 12\n"
APART = "rect 0,0 40,30\ncircle 12,15 6\nslot 60,0 90,0 14\n"
CLAMPED = "layer clamps\ncircle 20,0 8\nlayer 0\nrect 0,0 40,30\nrect 60,0 90,30\n"


def made_of(text: str, options: MakeOptions | None = None) -> MakeResult:
    return make("words.draw", text.encode(), options or MakeOptions())


def lens(r: float, s: float, gap: float) -> float:
    if gap >= r + s:
        return 0.0
    a, b = (math.acos((gap**2 + p**2 - q**2) / (2 * gap * p)) for p, q in ((r, s), (s, r)))
    return r * r * (a - math.sin(2 * a) / 2) + s * s * (b - math.sin(2 * b) / 2)


def area_of(made: MakeResult) -> float:
    return float(Outlines.of([contour for region in made.program.regions for contour in region.contours]).areas.sum())


def test_two_circles_that_overlap_by_a_nanometre_are_both_machined() -> None:
    made = made_of(PAIR)
    assert made.clean
    assert area_of(made) == pytest.approx(200 * math.pi, abs=1e-3)
    assert made.coverage.area_mm2 == pytest.approx(200 * math.pi, abs=0.1)
    assert made.coverage.reachable_left_mm2 == 0


@pytest.mark.parametrize("turn", [0.0, 31.0])
def test_circles_that_touch_are_machined_whole(turn: float) -> None:
    for e in (0.0, 2e-6):
        assert_two_are_machined(e, turn)


@pytest.mark.exhaustive
@pytest.mark.parametrize("turn", [0.0, 45.0, 163.0])
def test_circles_at_all_offsets_are_machined_whole(turn: float) -> None:
    for e in OFFSETS:
        assert_two_are_machined(e, turn)


def assert_two_are_machined(e: float, turn: float) -> None:
    x, y = (20 - e) * math.cos(math.radians(turn)), (20 - e) * math.sin(math.radians(turn))
    made = made_of(f"circle 0,0 10\ncircle {x!r},{y!r} 10\n")
    assert not [each for each in made.findings if each.kind in (FindingKind.AREA, FindingKind.LEFT_REACHABLE)]
    assert area_of(made) == pytest.approx(200 * math.pi - 2 * lens(10, 10, 20 - e), abs=2e-4)


@pytest.mark.parametrize("y", [-6.0, 6.0])
def test_a_circle_that_touches_a_side_is_machined_whole(y: float) -> None:
    assert_side_is_machined(0.0, y)


@pytest.mark.exhaustive
@pytest.mark.parametrize("y", [-6.0, 6.0])
def test_a_circle_at_all_offsets_from_a_side_is_machined_whole(y: float) -> None:
    for e in OFFSETS:
        assert_side_is_machined(e, y)


def assert_side_is_machined(e: float, y: float) -> None:
    place = y + math.copysign(e, -y)
    made = made_of(f"rect 0,0 40,30\ncircle 20,{place!r} 6\n")
    assert not [each for each in made.findings if each.kind in (FindingKind.AREA, FindingKind.LEFT_REACHABLE)]
    sign = 1 if y < 0 else -1
    assert area_of(made) == pytest.approx(1200 + sign * 36 * math.pi, abs=0.02 if abs(e) > 1e-4 else 1e-3)


@pytest.mark.parametrize(
    "angle", [76, pytest.param(13, marks=pytest.mark.exhaustive), pytest.param(141, marks=pytest.mark.exhaustive)]
)
def test_a_letter_with_a_stroke_across_is_made(angle: int) -> None:
    made = made_of(f'rect 0,0 100,40\ntext 79,12 5 "Ø" angle {angle}\n')
    assert made.files and not [each for each in made.findings if each.kind is FindingKind.AREA]


def one_less(link: Callable[..., tuple[object, ...]]) -> Callable[..., tuple[object, ...]]:
    return lambda *given: link(*given)[:-1]


def lose_a_loop(patch: pytest.MonkeyPatch) -> None:
    whole = overlay_net.loops_along
    patch.setattr(overlay_net, "loops_along", lambda *given: whole(*given)[1:])


def lose_a_region(patch: pytest.MonkeyPatch) -> None:
    def fewer(contours: tuple[Contour, ...]) -> NestingResult:
        found = nested(contours)
        return replace(found, regions=found.regions[:-1])

    nested = drawn_contours.nested
    patch.setattr(drawn_contours, "nested", fewer)


def fill_an_island(patch: pytest.MonkeyPatch) -> None:
    def filled(contours: tuple[Contour, ...]) -> NestingResult:
        found = nested(contours)
        return replace(found, regions=tuple(replace(region, islands=()) for region in found.regions))

    nested = drawn_contours.nested
    patch.setattr(drawn_contours, "nested", filled)


def lose_a_contour(patch: pytest.MonkeyPatch) -> None:
    def fewer(entities: list[Entity], join_tolerance: float) -> ChainingResult:
        found = chain.chain(entities, join_tolerance)
        return replace(found, contours=found.contours[:-1])

    patch.setattr(drawn_contours, "chain", fewer)


def bend_a_contour(patch: pytest.MonkeyPatch) -> None:
    def smaller(entities: list[Entity], join_tolerance: float) -> ChainingResult:
        first, *rest = (found := chain.chain(entities, join_tolerance)).contours
        curve = first.primitives[0]
        bent = Circle(curve.centre, curve.radius - 0.01) if isinstance(curve, Circle) else Circle((20, 15), 15)
        return replace(found, contours=(replace(first, primitives=(bent,)), *rest))

    patch.setattr(drawn_contours, "chain", smaller)


def move_a_region(patch: pytest.MonkeyPatch) -> None:
    """The same area in another place."""

    def moved(contours: tuple[Contour, ...]) -> NestingResult:
        found = nested(contours)
        last = found.regions[-1]
        primitives = tuple(drawn_contours.moved(each, 0.01, 0.0) for each in last.boundary.primitives)
        return replace(
            found, regions=(*found.regions[:-1], replace(last, boundary=replace(last.boundary, primitives=primitives)))
        )

    nested = drawn_contours.nested
    patch.setattr(drawn_contours, "nested", moved)


def lose_a_floor(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(witness, "region_shapes", one_less(witness.region_shapes))


LINKS = {
    "overlay": (lose_a_loop, CROSSING),
    "overlay of clamps": (lose_a_loop, CLAMPED),
    "nesting": (lose_a_region, APART),
    "islands": (fill_an_island, APART),
    "chaining": (lose_a_contour, APART),
    "joining": (bend_a_contour, CROSSING),
    "place": (move_a_region, APART),
    "floor": (lose_a_floor, APART),
}


@pytest.mark.parametrize("link", list(LINKS))
def test_a_broken_link_turns_the_verdict_red(link: str, monkeypatch: pytest.MonkeyPatch) -> None:
    damage, text = LINKS[link]
    options = MakeOptions(machining=MachiningOptions.of(keep_out=("clamps",))) if text is CLAMPED else MakeOptions()
    assert not [each for each in made_of(text, options).findings if each.kind is FindingKind.AREA]
    damage(monkeypatch)
    broken = made_of(text, options)
    assert not broken.clean
    assert [each for each in broken.findings if each.kind is FindingKind.AREA and each.counts]


def job_of(curves: list[Curve]) -> Job:
    return Job(Part(tuple(Entity(number, curve) for number, curve in enumerate(curves, 1))))


@pytest.mark.parametrize("seed", range(25))
def test_what_chaining_mends_is_no_loss(seed: int) -> None:
    """Curves out of order, turned round, with gaps, drawn twice, and in two parts that overlap."""
    rng = np.random.default_rng(seed)
    contours, _ = random_part(seed)
    curves: list[Curve] = []
    for curve in (curve for contour in contours for curve in contour.primitives):
        dx, dy = rng.uniform(-0.003, 0.003, 2)
        torn = (
            drawn_contours.moved(curve, float(dx), float(dy))
            if not isinstance(curve, Circle) and rng.random() < 0.5
            else curve
        )
        curves += [torn] * (2 if rng.random() < 0.1 else 1)
    curves = [curves[k] for k in rng.permutation(len(curves))]
    found = drawn_contours.drawn_contours(job_of(curves)).findings
    assert not [each for each in found if each.kind is FindingKind.AREA]


def test_ellipses_and_splines_are_measured_as_they_are() -> None:
    bow = Spline(3, ((0.0, 0.0), (10.0, 20.0), (30.0, -20.0), (40.0, 0.0)), (0, 0, 0, 0, 1, 1, 1, 1))
    curves: list[Curve] = [
        Ellipse((0, 80), (20, 5), 0.4),
        bow,
        Line((40, 0), (40, 30)),
        Line((40, 30), (0, 30)),
        Line((0, 30), (0, 0)),
    ]
    found = drawn_contours.drawn_contours(job_of(curves))
    assert len(found.closed) == 2 and not found.findings
    outlines = [curves[:1], curves[1:]]
    measured = [
        witness.even_odd([Contour(tuple(p for curve in each for p in witness.drawn_as(curve)))]).area
        for each in outlines
    ]
    assert measured == pytest.approx([math.pi * 425 * 0.4, 1200], abs=0.01)


def test_arcs_of_one_circle_that_overlap_are_no_loss() -> None:
    ends = [(10.0, 0.0), (0.0, 10.0), (-10.0, 0.0), (0.0, -10.0)]
    curves: list[Curve] = [Arc(ends[0], ends[2], (0, 0)), Arc(ends[1], ends[3], (0, 0)), Arc(ends[3], ends[0], (0, 0))]
    assert not [
        each for each in drawn_contours.drawn_contours(job_of(curves)).findings if each.kind is FindingKind.AREA
    ]


@pytest.mark.parametrize("over", [0.0, 5e-4])
def test_a_clamp_is_left_out_only_where_another_holds_all_of_it(over: float) -> None:
    clamps = drawn_contours.outermost(
        [square(20), square(10, 10 + over, 5), circle(3, 5, 5), circle(10, 10, 10), square(20)]
    )
    assert len(clamps) == (2 if over else 1)


def test_a_part_of_many_layers_is_asked_area_by_area() -> None:
    part = layered_part({"a": [square(40), circle(5, 20, 20)], "k": [square(10, 35, 5)]})
    made = machining_areas.MachiningAreas(job := Job(part, keep_out_layers=("k",)), drawn_contours.drawn_contours(job))
    made.areas()
    assert made.findings == []


@pytest.mark.parametrize("finest", [1, 3, 14])
def test_chords_of_a_curve_end_on_it_and_are_near_it_but_no_finer_than_asked(finest: int) -> None:
    bow = Spline(
        3,
        ((0.0, 0.0), (10.0, 20.0), (30.0, -20.0), (40.0, 0.0), (60.0, 5.0)),
        (0, 0, 0, 0, 1, 2, 2, 2, 2),
        (1, 2, 0.5, 1, 1),
    )
    pieces = pieces_of(bow)
    places, count = chords(np.ascontiguousarray(pieces.control), 1e-4, finest)
    assert tuple(places[0]) == bow.start and tuple(places[count - 1]) == bow.end
    on = pieces.at(np.linspace(0.0, 2.0, 20_001))[0]
    rows = np.hstack([places[: count - 1], places[1:count], np.zeros((count - 1, 4))])
    off = DistanceField.of(rows).nearest(on)[0].max()
    assert DistanceField.of(np.hstack([on[:-1], on[1:], np.zeros((20_000, 4))])).nearest(places[:count])[0].max() < 1e-6
    if finest < 14:
        assert count == 2 * 2**finest + 1 and off > 1e-3
    else:
        assert 200 < count < 2000 and off < 1.5e-4


def test_a_slot_that_is_not_as_wide_as_its_line_is_grown_is_found() -> None:
    lines = [Contour((Line((0.0, 0.0), (40.0, 0.0)),), False), Contour((Circle((20.0, 0.0), 9.0),))]
    assert not grown_findings(lines, 2.0, grown_lines(lines, 2.0))
    for wrong in (2.003, 1.997):
        (found,) = grown_findings(lines, 2.0, grown_lines(lines, wrong))
        assert found.kind is FindingKind.AREA and found.counts
