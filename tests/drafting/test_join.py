"""Curves joined into fewer: gaps close where they meet, and pieces of one line, circle or ellipse become one; and the
way back.
"""

import math
import random
from itertools import pairwise
from pathlib import Path

import pytest

from app.core.errors import InputError
from app.drafting.commands.defects import DefectKind, find_defects
from app.drafting.commands.explode import exploded
from app.drafting.commands.measure import measures
from app.drafting.curves.chains import chained
from app.drafting.curves.intersections import nearest_point
from app.drafting.curves.shapes import middle_of
from app.drafting.document import Document
from app.drafting.expressions.words import point_text
from app.formats.dxf.dxf import read_dxf
from app.geometry.sample import sample
from app.model.curves import Arc, Circle, Curve, Ellipse, Line
from app.model.job import Job
from app.model.part import Entity, Part
from tests.drafting.documents import drawn


def curves(document: Document) -> dict[int, Curve]:
    return {e.id: e.curve for e in document.part.entities}


@pytest.mark.parametrize(
    ("lines", "join", "left"),
    [
        (["line 0,0 10,0 25,0 30,0"], "join 1-3", {1: Line((0, 0), (30, 0))}),
        (["line 10,0 0,0", "line 10,0 20,0"], "join 1-2", {1: Line((20, 0), (0, 0))}),
        (["line 0,0 10,0", "line 10.006,0 20,0"], "join 1-2", {1: Line((0, 0), (20, 0))}),
        (["line 0,0 10,0", "line 10.2,0 20,0"], "join within 0.3 1-2", {1: Line((0, 0), (20, 0))}),
        (
            ["line 0,0 10,0", "line 10.05,0.05 10.05,20"],
            "join within 0.2 1-2",
            {1: Line((0, 0), (10.05, 0)), 2: Line((10.05, 0), (10.05, 20))},
        ),
        (
            ["arc 5,0 0,5 centre 0,0", "arc 0,5 -5,0 centre 0,0", "line -5,0 -9,0"],
            "join 1-3",
            {1: Arc((5, 0), (-5, 0), (0, 0)), 3: Line((-5, 0), (-9, 0))},
        ),
        (["arc 5,0 0,5 centre 0,0", "arc 5,0 0,5 centre 0,0 cw"], "join 1-2", {1: Circle((0, 0), 5)}),
        (
            ["line 5,0 10,0 10,10 0,10 0,0 5,0"],
            "join 1-5",
            {
                1: Line((0, 0), (10, 0)),
                2: Line((10, 0), (10, 10)),
                3: Line((10, 10), (0, 10)),
                4: Line((0, 10), (0, 0)),
            },
        ),
    ],
)
def test_pieces_of_one_curve_become_one(lines: list[str], join: str, left: dict[int, Curve]) -> None:
    document = drawn(*lines)
    document.run(join)
    made = curves(document)
    assert made.keys() == left.keys()
    for number, curve in left.items():
        assert type(made[number]) is type(curve)
        assert sample(made[number]) == pytest.approx(sample(curve))


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        (["line 0,0 10,0", "line 10.02,0 20,0"], "too far apart"),
        (["line 0,0 10,0", "line 10,0 20,0.01"], "not one line"),
        (["line 0,0 10,0", "line 10,0 4,0"], "back again"),
        (["arc 5,0 0,5 centre 0,0", "arc 0,5 -5,0 radius 5.01"], "not one circle"),
        (["line 0,0 10,0", "layer cut", "line 10,0 20,0"], "two layers"),
        (["line 0,0 10,0", "line 10,0 20,0", "line 10,0 10,9"], "a branch"),
    ],
)
def test_what_is_not_one_stays(lines: list[str], why: str) -> None:
    document = drawn(*lines)
    before = len(document.part.entities)
    document.run(f"join 1-{before}")
    assert len(document.part.entities) == before, why


def test_an_ellipse_that_was_broken_is_whole_again() -> None:
    document = drawn("ellipse 0,0 50,0 30", "break 1 0,30 -50,0", "ellipse 0,0 50,0 30 from 90 to 180")
    document.run("join 1-2")
    (whole,) = curves(document).values()
    assert isinstance(whole, Ellipse) and whole.end_parameter - whole.start_parameter == math.tau


def test_the_reply_counts_and_one_undo_takes_it_back() -> None:
    document = drawn("line 0,0 10,0 20,0", "line 20,0.004 20,9 0,9 0,0")
    before = document.part
    assert document.run("join 1-5") == "1 gap closed, 5 curves became 4; 1 closed contour, 0 open."
    document.undo()
    assert document.part == before


def test_joining_within_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="greater than 0"):
        drawn("line 0,0 9,0").run("join within 0 1")


@pytest.mark.parametrize("seed", range(6))
def test_a_contour_cut_and_shaken_joins_to_what_it_was(seed: int) -> None:
    dice = random.Random(seed)
    document = drawn("rect 0,0 60,40 round 6")
    for _ in range(12):
        entity = dice.choice(document.part.entities)
        document.run(f"break {entity.id} {point_text(middle_of(entity.curve))}")
    shaken = [Entity(e.id, _shaken(e.curve, dice), e.layer) for e in document.part.entities]
    dice.shuffle(shaken)
    document.load(Job(Part(tuple(shaken))))
    document.run(f"join within 0.1 1-{max(document.part.ids())}")
    assert len(document.part.entities) == 8
    assert not [fault for fault in find_defects(document.part, 0.1) if fault.kind is DefectKind.GAP]
    (chain,) = chained(curves(document))
    assert chain.closed


def _shaken(curve: Curve, dice: random.Random) -> Curve:
    """Turn some curves round and shorten lines a little."""
    if isinstance(curve, Line):
        share = 0.02 / math.dist(curve.start, curve.end) * dice.random()
        end = (
            curve.end[0] + share * (curve.start[0] - curve.end[0]),
            curve.end[1] + share * (curve.start[1] - curve.end[1]),
        )
        return Line(curve.start, end) if dice.random() < 0.5 else Line(end, curve.start)
    return curve


def test_chains_run_the_way_of_their_lowest_number_and_end_at_branches() -> None:
    document = drawn("line 10,0 0,0", "line 20,0 10,0", "line 20,0 20,9", "line 20,0 30,0", "circle 50,50 5")
    found = [(chain.numbers, chain.closed) for chain in chained(curves(document))]
    assert found == [((2, 1), False), ((3,), False), ((4,), False), ((5,), True)]


def test_a_circle_explodes_into_two_arcs_and_the_rest_into_lines_and_arcs_within_a_micrometre() -> None:
    document = drawn("circle 0,0 5", "ellipse 40,0 60,0 10", "spline 0,50 20,70 40,50 60,70", "line 0,0 9,9")
    before = curves(document)
    document.run("explode 1-4")
    made = curves(document)
    assert all(isinstance(curve, Line | Arc) for curve in made.values())
    assert [type(c) for c in exploded(before[1])] == [Arc, Arc] and made[4] == before[4]
    for number in (2, 3):
        pieces = exploded(before[number])
        for x, y in sample(before[number])[::7]:
            assert min(_away(piece, (float(x), float(y))) for piece in pieces) < 1.05e-3
        assert all(a.end == b.start for a, b in pairwise(pieces))


def _away(piece: Line | Arc, point: tuple[float, float]) -> float:
    return math.dist(nearest_point(piece, point), point)


@pytest.mark.parametrize("name", ["gear.dxf", "apu-mount.dxf"])
def test_what_a_real_drawing_encloses_stays_when_it_is_joined(data: Path, name: str) -> None:
    part = read_dxf((data / "dxf" / name).read_bytes()).part
    document = Document(Job(part))
    before = measures(curves(document))
    document.run("select all")
    document.run("join")
    after = measures(curves(document))
    assert after.length == pytest.approx(before.length, rel=1e-4)
    assert after.closed >= before.closed
    assert len(document.part.entities) <= len(part.entities)
