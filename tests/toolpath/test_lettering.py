"""Strokes of letters are lines to follow, and bound nothing wherever they meet, cross or close."""

from dataclasses import replace

import pytest

from app.geometry.stroke_font import engraving
from app.model.contour_operation import ContourOperation
from app.model.curves import Arc, Circle
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.operation import CutParameters, Operation, PocketOperation, Side
from app.model.part import Entity, Part
from app.model.tool import Tool
from app.operations.compute import compute, drawing_findings, followed_lines
from app.toolpath.drawn_contours import drawn_contours, strokes_of

PLATE = Circle((5.0, 7.0), 60.0)


def job(letters: str, *operations: Operation) -> Job:
    """A round plate, and letters of the engraving face over one another in it."""
    strokes = [curve for letter in letters for curve in engraving().glyphs[letter].curves]
    entities = [Entity(1, PLATE), *(Entity(k, curve, lettering=True) for k, curve in enumerate(strokes, 2))]
    return Job(Part().with_entities(tuple(entities)), (Tool(1, 3.0), Tool(2, 0.2)), operations)


@pytest.mark.parametrize("letters", ["O", "ABO8&%", "".join(sorted(engraving().glyphs))])
def test_no_letter_changes_what_is_cleared(letters: str) -> None:
    """Letters close, cross and meet in threes, and all the same the plate is whole; one remark says that nobody follows
    them.
    """
    written, plain = (job(words, PocketOperation(CutParameters(1))) for words in (letters, ""))
    parts = drawn_contours(written)
    assert parts.regions.regions == drawn_contours(plain).regions.regions
    (found,) = drawing_findings(written, parts, followed_lines(written, parts))
    assert found.kind is FindingKind.OPEN_CONTOUR and not found.counts
    assert found.text.startswith("Layer 0 has ") and "no operation follows; --side on" in found.text
    assert {e.id for e in written.part.entities if e.lettering} >= set(found.entity_ids)


def test_an_operation_on_the_lines_follows_them_all() -> None:
    written = job("OX", ContourOperation(CutParameters(2, depth=0.2, stepdown=0.2), Side.ON))
    parts = drawn_contours(written)
    lines = followed_lines(written, parts)
    strokes = sorted(number for line in lines for number in line.entity_ids)
    assert strokes == [e.id for e in written.part.entities if e.lettering] and not drawing_findings(
        written, parts, lines
    )
    program = compute(written)
    low = program.moves.end[:, 2] <= -0.2 + 1e-9
    assert [9.4, 14.0] in program.moves.end[low, :2].round(6).tolist()


def test_closed_strokes_are_open_lines_that_end_where_they_begin() -> None:
    lines, findings = strokes_of([Entity(3, Circle((1.0, 2.0), 4.0, False), "words", True)], 0.01)
    ((right, left),) = (line.primitives for line in lines)
    assert isinstance(right, Arc) and isinstance(left, Arc) and not lines[0].closed and not right.ccw
    assert right.start == left.end == (5.0, 2.0) and right.end == left.start == (-3.0, 2.0)
    assert [f.text for f in findings] == [
        "Layer words has 1 stroke of a letter, which bounds nothing and that no operation follows; "
        "--side on engraves along them."
    ]
    assert strokes_of([], 0.01) == ((), [])


def test_letters_on_a_layer_of_clamps_keep_nothing_off() -> None:
    written = job("O", PocketOperation(CutParameters(1)))
    part = replace(
        written.part, entities=tuple(replace(e, layer="clamps") if e.lettering else e for e in written.part.entities)
    )
    part = replace(part, layers=(*part.layers, replace(part.layers[0], name="clamps")))
    assert drawn_contours(replace(written, part=part, keep_out_layers=("clamps",), keep_out_height=5.0)).clamps == ()
