"""The picture of a made program holds every move once, in the style of its purpose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.formats.plot.picture import CONTOUR, LINK, POCKET, RAPID
from app.geometry.primitives import lengths
from app.model.moves import Moves, Program, Purpose
from app.toolpath.coverage.coverage import Coverage, UncutPlace
from app.usecases.making.picture import picture_of
from tests.gcode.programs import Path, square


def moves() -> Moves:
    made = (
        Path()
        .into_work(5, 5)
        .line(15, 5, -1)
        .line(15, 9, -1)
        .arc((15, 9, -1), (12, 9))
        .out_of_work()
        .rapid(25, 5, 5)
        .moves()
    )
    purpose = made.purpose.copy()
    purpose[[2, 3, 4, 5]] = Purpose.PLUNGE, Purpose.POCKET, Purpose.LINK, Purpose.CONTOUR
    return replace(made, purpose=purpose)


def test_runs_by_purpose() -> None:
    picture = picture_of("plate", Program(moves(), (square(),)), Coverage())
    assert [style for style, _ in picture.paths] == [RAPID, LINK, POCKET, CONTOUR]
    assert [float(np.sum(lengths(rows))) for _, rows in picture.paths] == pytest.approx(
        [np.hypot(10, 4), 4, 10, 6 * np.pi]
    )
    assert picture.plunges.tolist() == [[5.0, 5.0]]
    assert len(picture.contours) == 1
    assert (picture.left, picture.unreachable) == ((), ())


def test_what_is_left_is_shown_by_its_sort() -> None:
    outline = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    places = tuple(
        UncutPlace(0.2, 0.2, 0.5, 0.5, reachable, outline + reachable, (outline / 9,) * reachable)
        for reachable in (True, False)
    )
    picture = picture_of("plate", Program(moves(), (square(),)), Coverage(places=places))
    assert [ring.max() for ring in picture.left] == pytest.approx([2.0, 1 / 9])
    assert [ring.max() for ring in picture.unreachable] == [1.0]
