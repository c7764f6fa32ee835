"""Growing columns: what went in comes out, at exact size, and room that is made keeps what is there."""

import numpy as np

from app.gcode.interpreter.program import Motion, MotionColumns
from app.model.motion import MotionKind, Motions, Plane


def line(number: int) -> Motion:
    return Motion(
        MotionKind.LINE, (number - 1.0, 0.0, 0.0), (number, 0.5, -number), 100.0 + number, number, number // 7
    )


def test_rows_come_out_as_they_went_in() -> None:
    columns = MotionColumns()
    arc = Motion(MotionKind.ARC_CW, (0.0, 1.0, 2.0), (3.0, 4.0, 5.0), 60.0, 8, 2, Plane.YZ, (6.0, 7.0, 8.0), 3)
    columns.add(line(1))
    columns.add(arc)
    motions = columns.motions({1: None}, (0, 1, 2))  # type: ignore[dict-item]
    assert len(motions) == 2 and motions.known_from == (0, 1, 2) and list(motions.splines) == [1]
    assert motions.start[1].tolist() == [0.0, 1.0, 2.0] and motions.end[1].tolist() == [3.0, 4.0, 5.0]
    assert motions.centre[1].tolist() == [6.0, 7.0, 8.0] and np.isnan(motions.centre[0]).all()
    numbers = [
        column.tolist()
        for column in (motions.kind, motions.plane, motions.turns, motions.feed, motions.line, motions.state)
    ]
    assert numbers == [[1, 2], [0, 2], [0, 3], [101.0, 60.0], [1, 8], [0, 2]]


def test_growing_keeps_what_is_there() -> None:
    columns = MotionColumns()
    for number in range(1, 10_001):
        columns.add(line(number))
    assert len(columns) == 10_000
    motions = columns.motions()
    assert np.array_equal(motions.line, np.arange(1, 10_001)) and np.array_equal(motions.end[:, 0], motions.line)
    assert np.array_equal(motions.state, motions.line // 7)
    assert all(getattr(motions, name).base is None for name in ("start", "end", "centre", "kind", "feed", "line"))


def test_room_is_made_for_many_at_once() -> None:
    columns = MotionColumns()
    columns.add(line(1))
    columns.reserve(500_000)
    assert len(columns.kind) >= 500_001 and columns.end[0].tolist() == [1.0, 0.5, -1.0] and len(columns) == 1


def test_it_is_empty_after_the_motions_are_taken() -> None:
    columns = MotionColumns()
    columns.add(line(1))
    taken = columns.motions()
    columns.add(line(2))
    again = columns.motions()
    assert taken.line.tolist() == [1] and again.line.tolist() == [2]
    assert len(columns.motions()) == len(Motions.none()) == 0
