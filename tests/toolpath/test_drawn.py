"""What of a drawing is machined: layers, copies, and clamps that hold all that is in them."""

from __future__ import annotations

from dataclasses import replace

import pytest
import shapely

from app.core.errors import ParameterError
from app.geometry.outlines import polygon_contour
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import on_layers
from app.model.curves import Circle, Line
from app.model.finding import FindingKind
from app.model.job import Copies, Job
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Contour, Entity
from app.toolpath.coverage.areas import region_shapes
from app.toolpath.drawn_contours import DrawnContours, drawn_contours, layers_of, outermost
from tests.part_shapes import circle, layered_part, square


def held(parts: DrawnContours) -> float:
    return float(shapely.union_all(region_shapes(parts.clamps, 1e-4)).area)


def text_of(parts: DrawnContours, kind: FindingKind, counts: bool = True) -> str:
    return " ".join(finding.text for finding in parts.findings if finding.kind is kind and finding.counts is counts)


def test_layers_of_a_job() -> None:
    part = layered_part({"a": [square()], "b": [square(5, 50)], "c": [square(5, 80)]}, hidden=("b",))
    assert layers_of(Job(part)) == {"a", "c"}
    assert layers_of(Job(part, layer_names=("b",))) == {"b"}
    assert layers_of(Job(part, keep_out_layers=("c",))) == {"a"}
    asked = (
        PocketOperation(CutParameters(1, curves=on_layers(("b",)))),
        ContourOperation(CutParameters(2, enabled=False, curves=on_layers(("nowhere",)))),
    )
    assert layers_of(Job(part, operations=asked)) == {"a", "b", "c"}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"keep_out_layers": ("d",)}, "no layer 'd'; it has a, b, c"),
        ({"operations": (PocketOperation(CutParameters(1, curves=on_layers(("A",)))),)}, "no layer 'A'"),
        ({"layer_names": ("a",), "keep_out_layers": ("a",)}, "Layer 'a' is to be machined and to be kept off"),
        (
            {"operations": (PocketOperation(CutParameters(1, curves=on_layers(("b",)))),), "keep_out_layers": ("b",)},
            "Layer 'b' is to be machined and to be kept",
        ),
    ],
)
def test_layers_that_cannot_be(changes: dict[str, object], words: str) -> None:
    part = layered_part({"a": [square()], "b": [square(5, 50)], "c": []})
    with pytest.raises(ParameterError, match=words):
        drawn_contours(replace(Job(part), **changes))  # type: ignore[arg-type]


def clamped(*clamps: Contour, part: tuple[Contour, ...] = (), **changes: object) -> DrawnContours:
    layers = {"part": list(part) or [square(100)], "clamps": list(clamps)}
    return drawn_contours(replace(Job(layered_part(layers)), keep_out_layers=("clamps",), **changes))  # type: ignore[arg-type]


def test_a_bolt_in_a_clamp_is_no_hole_in_it() -> None:
    parts = clamped(square(20, 10, 10), circle(4, 20, 20), circle(1, 20, 20))
    assert len(parts.clamps) == 1
    assert held(parts) == pytest.approx(400)


def test_clamps_over_one_another_leave_no_gap() -> None:
    parts = clamped(square(20, 10, 10), square(20, 20, 20))
    assert held(parts) == pytest.approx(700)
    twice = clamped(square(20, 10, 10), square(20, 10, 10))
    assert held(twice) == pytest.approx(400)


def test_an_outline_that_crosses_itself_holds_both_of_its_loops() -> None:
    bow = polygon_contour([(10, 10), (30, 30), (30, 10), (10, 30)])
    assert held(clamped(bow)) == pytest.approx(200)


def test_outermost_of_alike_ones_is_one() -> None:
    regions = outermost([circle(3, 5, 5), circle(3, 5, 5), circle(2, 5, 5), circle(3, 15, 5)])
    assert len(regions) == 2
    assert all(region.islands == () for region in regions)
    assert outermost([]) == ()


def test_clamps_without_an_outline_are_told() -> None:
    part = layered_part({"part": [square(50)], "clamps": []})
    open_clamp = replace(part, entities=(*part.entities, Entity(99, Line((5, 5), (20, 5)), "clamps")))
    parts = drawn_contours(Job(open_clamp, keep_out_layers=("clamps",)))
    assert parts.clamps == ()
    assert "is open at" in text_of(parts, FindingKind.OPEN_CONTOUR)
    assert "have no closed outline" in text_of(parts, FindingKind.LEFT_OUT)


def test_what_lies_under_clamps_is_told() -> None:
    parts = clamped(square(30, 100, 0), part=(square(20, 105, 5), circle(3, 110, 10), square(40)))
    assert "2 contours, of which the first begins" in text_of(parts, FindingKind.LEFT_OUT)
    assert "wholly under clamps" in text_of(parts, FindingKind.LEFT_OUT)
    over = clamped(square(30, 30, 0), part=(square(40),))
    assert "over parts of 1 contour" in text_of(over, FindingKind.LEFT_OUT, counts=False)
    beside = clamped(square(30, 10, 10), part=(square(60),))
    assert [finding for finding in beside.findings if finding.kind is FindingKind.LEFT_OUT] == []


def test_copies_are_moved_and_clamps_are_not() -> None:
    parts = clamped(square(5, 0, -10), part=(square(10), circle(2, 5, 5)), copies=Copies(3, 2, 20.0, -30.0))
    assert len(parts.closed) == 12
    assert len(parts.clamps) == 1
    centres = {each.primitives[0].centre for each in parts.closed if isinstance(each.primitives[0], Circle)}
    assert centres == {(5.0 + 20 * i, 5.0 - 30 * j) for i in range(3) for j in range(2)}


@pytest.mark.parametrize(
    ("copies", "meet"),
    [
        (Copies(2, 1, 10.0), True),
        (Copies(2, 1, 9.0), True),
        (Copies(2, 1, 10.1), False),
        (Copies(1, 2, 0.0, -10.0), True),
        (Copies(1, 2, 0.0, -10.1), False),
        (Copies(2, 2, 11.0, 11.0), False),
        (Copies(3, 1, 4.0), True),
    ],
)
def test_copies_that_meet_are_told(copies: Copies, meet: bool) -> None:
    parts = drawn_contours(Job(layered_part({"a": [square(10)]}), copies=copies))
    assert parts.crossing is meet
    assert bool(text_of(parts, FindingKind.OVERLAP)) is meet


def test_copies_that_reach_into_one_another_do_not_meet() -> None:
    angle = polygon_contour([(0, 0), (30, 0), (30, 5), (5, 5), (5, 30), (0, 30)])
    parts = drawn_contours(Job(layered_part({"a": [angle]}), copies=Copies(2, 1, 8.0, 0.0)))
    assert parts.crossing
    nested = drawn_contours(Job(layered_part({"a": [angle]}), copies=Copies(1, 1)))
    assert not nested.crossing
    stairs = polygon_contour([(0, 0), (10, 0), (10, 4), (4, 4), (4, 10), (0, 10)])
    apart = drawn_contours(Job(layered_part({"a": [stairs, square(3, 6, 6)]}), copies=Copies(2, 1, 11.0, 0.0)))
    assert not apart.crossing


def test_diagonal_copies_that_meet_are_told() -> None:
    """Neighbours along X and Y keep off one another; those across the corner do not."""
    bar = polygon_contour([(0, 0), (2, 0), (22, 20), (20, 20)])
    parts = drawn_contours(Job(layered_part({"a": [bar]}), copies=Copies(2, 2, 10.0, 10.0)))
    assert "10.000 mm apart along X and 10.000 mm along Y meet" in text_of(parts, FindingKind.OVERLAP)


def test_the_witness_measures_for_whoever_looks_at_what_it_says() -> None:
    parts = drawn_contours(Job(layered_part({"a": [square(40), circle(5, 20, 20)]})))
    made = parts.regions
    assert "findings" not in vars(parts) and "findings" not in vars(made)
    assert parts.findings == made.findings == ()
    assert "findings" in vars(parts) and "findings" in vars(made)
