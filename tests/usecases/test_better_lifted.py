"""Passes of any cutter, bent or straight, over one surface or several, are lifted onto the smooth surfaces behind them.

The programs are made without any of our surfaces: the tip goes over a polyhedron whose corners lie on a known shape,
alone or under a plane that it comes up through.
"""

from __future__ import annotations

import math
import re
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from app.core.errors import InputError
from app.core.resources import resource
from app.fitting.point_surfaces.surface_pieces import NO_PIECE, surface_pieces
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.motion import Floats
from app.model.part import Units
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import BoxStock
from app.usecases.better.area import PassArea
from app.usecases.better.comparison import compared
from app.usecases.better.improve import better
from app.usecases.better.pieces import PassLifter, SmoothedPieces, touched
from app.usecases.better.report import findings, lines, report
from app.usecases.better.result import BetterOptions, BetterProgram
from app.usecases.better.tracks import tracks_of
from app.usecases.cutting.ready_setup import SetupRequest
from app.usecases.cutting.setup_tools import ToolSource
from app.usecases.tolerance_budget import Evidence
from tests import raster_program as made
from tests.usecases.test_better import driven

BULL = "bull,6,1"


def result(text: str, tolerance: float = 0.05) -> BetterProgram:
    return better("passes.ngc", text.encode(), BetterOptions(tolerance, cells=200))


def bent_rows() -> list[Floats]:
    """Passes along circles about one middle, half a millimetre apart."""
    found = []
    for radius in np.arange(20.0, 28.1, 0.5):
        angle = np.linspace(-0.28, 0.28, 90)
        x, y = radius * np.cos(angle) - 18, radius * np.sin(angle) + 8
        found.append(np.column_stack([x, y, made.polyhedron(x, y)]).round(4))
    return found


def plane(x: Floats, y: Floats) -> Floats:
    return 0.55 * x + 0.1 * y - 6.5


def valley_rows() -> list[Floats]:
    """Passes over the topmost of the polyhedron and a plane; what is at their crossing has no point."""
    found = []
    for row in made.rows(wide=14.0, deep=8.0):
        x = np.unique(np.concatenate([row[:, 0], np.linspace(0, 14, 60)]).round(4))
        y = np.full(len(x), row[0, 1])
        found.append(np.column_stack([x, y, np.maximum(made.polyhedron(x, y), plane(x, y))]).round(4))
    return found


def sample() -> str:
    """The sample `valley.ngc`."""
    head = (
        "(Passes of a flat cutter over a polyhedron and, where that is higher, a plane: two surfaces with an edge "
        "between.)",
        "(The lesson: hitofude better valley.ngc -o valley-better.ngc; the passes are lifted onto both smooth "
        "surfaces.)",
    )
    return made.text(valley_rows(), "\n".join(head), tool="flat,4")


@cache
def bent() -> BetterProgram:
    return result(made.text(bent_rows(), tool="ball,6"))


@cache
def valley() -> BetterProgram:
    return result(sample())


def below(data: bytes, step: float = 0.05) -> Floats:
    """Places of the tip that cut, but for the plunge at the beginning and the lift at the end."""
    places = driven(data, step)
    way = np.linalg.norm(np.diff(places[:, :2], axis=0), axis=1) > 1e-9
    return places[1:][way]


def test_the_sample_is_what_it_says() -> None:
    assert resource("samples", "valley.ngc").read_text() == sample()
    done = valley()
    assert done.new.blocks < 0.05 * done.old.blocks and done.new.bend < 0.01 * done.old.bend


@pytest.mark.exhaustive
def test_a_program_that_names_no_units_is_made_better_in_the_ones_told() -> None:
    def inches(word: re.Match[str]) -> str:
        return f"{word[1]}{float(word[2]) / 25.4:.6f}"

    blocks = [line for line in sample().replace("G21 ", "").splitlines() if not line.startswith("(")]
    text = "\n".join(re.sub(r"([XYZF])(-?\d+\.?\d*)", inches, line) for line in blocks) + "\n"
    tools = ToolSource("--tool", {1: Tool(1, diameter=4.0)})
    setup = SetupRequest((tools,), stock=BoxStock(StockBox(-4, -4, -14, 18, 12, 1)))
    done = better("in.ngc", text.encode(), BetterOptions(cells=200, units=Units.INCH), setup)
    assert done.new.length_mm == pytest.approx(valley().new.length_mm, rel=0.001)
    assert done.new.blocks == valley().new.blocks and b"G21" not in done.data


@pytest.mark.exhaustive
def test_bent_passes_come_nearer_to_the_true_shape_in_fewer_blocks() -> None:
    done = bent()
    assert done.scene is None and done.figures.passes == 17 and len(done.figures.spans) == 1
    assert not [each for each in findings(done) if each.counts] and done.budget.kept
    assert done.new.blocks < 0.25 * done.old.blocks
    old, new = np.concatenate(bent_rows()), below(done.data)
    inner = [
        p[(np.abs(np.hypot(p[:, 0] + 18, p[:, 1] - 8) - 24) < 2.5) & (np.abs(p[:, 1] - 8) < 4)] for p in (old, new)
    ]
    before, after = (np.sqrt(np.mean(made.square_off(places) ** 2)) for places in inner)
    assert len(inner[1]) > 500 and after < 0.5 * before


def test_passes_over_two_surfaces_cross_where_both_are_as_high() -> None:
    done = valley()
    assert done.scene is None and len(done.figures.spans) == 2 and done.figures.apart_mm <= 1e-9
    assert done.figures.boundaries >= 15 and not [each for each in findings(done) if each.counts]
    places = below(done.data)
    high = plane(places[:, 0], places[:, 1]) - places[:, 2]
    off = np.minimum(np.abs(made.square_off(places)), np.abs(high) / math.sqrt(1 + 0.55**2 + 0.1**2))
    assert np.median(off) < 0.01 and off.max() < 0.05
    assert any("boundary points" in line for line in lines(done)) and report(done)["lifted"]


def test_chords_of_lifted_passes_are_no_farther_from_the_surfaces_than_proven() -> None:
    """By forty places along every chord, through the joint of both surfaces."""
    done = valley()
    smoothed, [chords] = done.smoothed, [each for each in done.budget.shares if each.name == "chords"]
    assert isinstance(smoothed, SmoothedPieces) and chords.evidence is Evidence.PROVEN
    for allowed in (0.004, 0.0005):
        lifter, worst, crossed = PassLifter(smoothed, allowed), 0.0, 0
        for row in smoothed.tracked.lines:
            lifted = lifter.lifted(row)
            assert lifted.chord_mm <= allowed
            if not len(lifted.boundaries):
                continue
            crossed += 1
            along = np.concatenate([a + np.linspace(0, 1, 41)[:, None] * (b - a) for a, b in pairwise(lifted.points)])
            off = np.min([np.abs(each.spline.heights(along[:, :2]) - along[:, 2]) for each in smoothed.fitted], axis=0)
            inner = (along[:, 0] > 2.1) & (along[:, 0] < 11.9)  # ends stay, and passes come down to them
            assert off[inner].max() <= lifted.chord_mm + 1e-12
            worst = max(worst, off[inner].max() / lifted.chord_mm)
        assert crossed >= 12 and worst > 0.7


def test_the_cut_of_a_flat_cutter_is_that_of_the_old_one_by_another_way_of_cutting() -> None:
    """Of a flat cutter the lowest place of its tip within its radius, by nothing but that."""
    done, random = valley(), np.random.default_rng(2)
    spots = np.column_stack([random.uniform(1, 13, 60), random.uniform(1, 7, 60)])
    texts = made.text(valley_rows(), tool="flat,4").encode(), done.data
    cuts = []
    for data in texts:
        path = driven(data, 0.01)
        near = [(path[:, 0] - x) ** 2 + (path[:, 1] - y) ** 2 < 4.0 for x, y in spots]
        cuts.append(np.array([path[each, 2].min() for each in near]))
    grid = done.old_cut.cut.workpiece.grid
    cells = np.floor((spots - [grid.x0, grid.y0]) / grid.pitch).astype(int)
    told = [each.cut.heights[cells[:, 1], cells[:, 0]] for each in (done.old_cut, done.new_cut)]
    assert np.median(np.abs(cuts[0] - told[0])) < 0.05  # of places, not of cells' middles
    assert np.abs(cuts[1] - cuts[0]).max() <= 0.05 * math.sqrt(1 + 0.6**2) + 0.01


def test_all_that_is_no_pass_stays_as_it_was() -> None:
    text = made.text(valley_rows(), tool="flat,4")
    old, new = (read_program(data, ReadOptions()).motions for data in (text.encode(), valley().data))
    for motions in (old, new):
        assert motions.kind[0] == 0 and motions.end[-1, 2] == 10.0
    assert np.array_equal(old.start[2], new.start[2]) and np.array_equal(old.end[2], new.end[2])
    assert np.allclose(old.end[-2, :2], new.end[-2, :2])


def test_pieces_are_told_apart_at_an_edge_and_nowhere_else() -> None:
    rows = valley_rows()
    found, points = surface_pieces(rows, 0.001), np.concatenate(rows)
    assert len(found.corners) == 2
    over = made.polyhedron(points[:, 0], points[:, 1]) > plane(points[:, 0], points[:, 1]) + 0.01
    under = made.polyhedron(points[:, 0], points[:, 1]) < plane(points[:, 0], points[:, 1]) - 0.01
    on = [set(found.piece[some].tolist()) - {NO_PIECE} for some in (over, under)]
    assert on[0] and on[1] and not on[0] & on[1]
    assert len(surface_pieces(made.rows(), 0.001).corners) == 1


@pytest.mark.parametrize("cutter", [Cutter(3.0, 0.0, 3.0), Cutter(3.0, 2.0, 1.0), Cutter(3.0, 3.0, 0.0)])
def test_a_cutter_touches_where_nothing_of_it_is_below_the_plane(cutter: Cutter) -> None:
    """The plane through that place: no other place of the cutter's profile lies below it."""
    slopes = np.array([[0.3, -0.2], [0.0, 0.7], [1.1, 0.4]])
    places = touched(cutter, np.zeros((3, 3)), slopes)
    radius, turn = (each.ravel() for each in np.meshgrid(np.linspace(0, 3, 400), np.linspace(0, math.tau, 200)))
    body = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), cutter.heights(radius)])
    for place, slope in zip(places, slopes, strict=True):
        over = body[:, 2] - place[2] - (body[:, :2] - place[:2]) @ slope
        assert over.min() > -1e-3 and abs(over.min()) < 2e-3


def test_a_spiral_is_parted_into_turns_and_a_fan_into_its_rays() -> None:
    angle = np.linspace(0, 6 * math.tau, 1200)
    radius = 4 + angle / math.tau
    spiral = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle])
    tracked = tracks_of("s", read_program(made.text([spiral]).encode(), ReadOptions()))
    assert len(tracked.lines) in (6, 7) and abs(tracked.pitch - 1.0) < 0.05
    rays = [
        np.column_stack([np.linspace(20, 40, 30) * math.cos(a), np.linspace(20, 40, 30) * math.sin(a), np.zeros(30)])
        for a in np.arange(0.1, 0.5, 0.03)
    ]
    assert len(tracks_of("f", read_program(made.text(rays).encode(), ReadOptions())).lines) == len(rays)


def test_passes_that_are_few_or_lie_on_one_another_are_refused() -> None:
    one = np.column_stack([np.linspace(0, 20, 40), np.zeros(40), np.zeros(40)])
    for rows, said in (([one, one + [0, 1, 0]], "2 passes are"), ([one] * 6, "lie on one another")):
        with pytest.raises(InputError, match=said):
            tracks_of("p", read_program(made.text(rows).encode(), ReadOptions()))


def test_a_pitch_is_refused_where_passes_stay_where_they_are() -> None:
    with pytest.raises(InputError, match="Leave --pitch out"):
        better("p.ngc", made.text(valley_rows(), tool="flat,4").encode(), BetterOptions(pitch=0.4))


def test_differences_of_cuts_are_never_told_smaller_than_they_are() -> None:
    """In a bowl that a ball has cut, surfaces of its tip are steeper than the metal: the metal's own slope counts."""
    from dataclasses import replace

    old = valley().old_cut.cut.workpiece
    x = old.grid.xs()[None, :] - 7
    bowl = np.sqrt(np.maximum(100 - x**2, 1.0)) * np.ones((old.grid.rows, 1))
    metal = replace(old, heights=(-bowl).astype(np.float32))
    deeper = replace(old, heights=(-bowl - 0.05).astype(np.float32))
    area = PassArea([np.array([[0.0, y, 0.0], [14.0, y, 0.0]]) for y in (2.0, 3.0, 4.0)], 1.0)
    told = compared(metal, deeper, area)
    assert abs(told.deeper.amount_mm - 0.05) < 1e-3  # at the bottom it is level
    edge = replace(old, heights=(-bowl - 0.05 * (np.abs(x) > 5)).astype(np.float32))
    true = 0.05 / math.sqrt(1 + 5.0**2 / 75)  # square to the metal, where it is the least steep
    assert told.left.amount_mm == 0 and compared(metal, edge, area).deeper.amount_mm >= 0.98 * true
