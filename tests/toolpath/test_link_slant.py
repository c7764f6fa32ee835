"""Slants: excursions that leave a piece of a ring out cut all of it themselves, and make the path no longer than its
rings need.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core import tolerances
from app.formats.readers import read_drawing
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import offset_levels
from app.geometry.outlines import nest
from app.geometry.overlay.overlay import without_crossings
from app.geometry.primitives import lengths, pack, points_at
from app.model.job import Job
from app.model.moves import Purpose
from app.model.operation import Direction
from app.model.part import Region
from app.operations.compute import regions_of
from app.operations.pocket.paths import PocketStrokes, PocketTarget, shortest
from app.toolpath.linking.link import LinkOptions, covers
from app.toolpath.machining_areas import MachiningArea
from tests import plain_distance
from tests.conftest import ROOT
from tests.examples import examples
from tests.part_shapes import fig2, random_part
from tests.toolpath.uncut_squares import uncut

R = 1.0


def cleared(
    regions: tuple[Region, ...], stepover: float, manner: LinkOptions | None = None
) -> tuple[PocketStrokes, MachiningArea]:
    primitives = pack(regions)
    sheet = MachiningArea(
        regions, primitives, DistanceField.of(primitives.rows), np.zeros(len(primitives.rows), np.bool_)
    )
    return shortest(sheet, PocketTarget(1.5 * R, R, manner or LinkOptions()), (stepover,)), sheet


def nothing_left(made: PocketStrokes, sheet: MachiningArea) -> bool:
    (frame,) = offset_levels(sheet.primitives, [1.5 * R], frame=True)
    left = uncut(sheet.distances, frame, R, [(stroke.rows, R) for stroke in made.strokes])
    return not left.sure.any()


def rings(made: PocketStrokes) -> float:
    return sum(ring.length for level in made.levels for ring in level.rings)


@pytest.mark.parametrize(
    "name", ["resources/samples/fig2.dxf", pytest.param("tests/data/dxf/complex.dxf", marks=pytest.mark.exhaustive)]
)
@pytest.mark.parametrize("stepover", [0.8, 1.0])
def test_bridges_are_less_than_two_hundredths_of_the_path_and_nothing_is_left(name: str, stepover: float) -> None:
    path = ROOT / name
    made, sheet = cleared(regions_of(Job(read_drawing(path.name, path.read_bytes(), None, ()).part))[0], stepover)
    assert len(made.strokes) == sum(ring.area > 0 for ring in made.levels[0].rings)
    assert 0 < made.linked <= 0.02
    assert nothing_left(made, sheet)


@settings(max_examples=examples(25), deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(list(Direction)), st.booleans())
def test_random_parts(seed: int, direction: Direction, outside_in: bool) -> None:
    contours, crossing = random_part(seed)
    contours = list(without_crossings(contours).contours) if crossing else contours
    stepover = float(np.random.default_rng(seed).uniform(0.4, 1.0))
    made, sheet = cleared(nest(contours), stepover, LinkOptions(direction, outside_in))
    if not made.levels:
        return
    assert nothing_left(made, sheet)
    for stroke in made.strokes:
        assert np.array_equal(stroke.rows[1:, :2], stroke.rows[:-1, 2:4])
        for fraction in np.linspace(0, 1, 9):
            points = points_at(stroke.rows, np.full(len(stroke.rows), fraction))
            assert plain_distance.distance(points, contours).min() >= 1.5 * R - tolerances.LEVEL


def test_the_outermost_rings_are_cut_whole() -> None:
    made, _ = cleared(nest(fig2()), 1.0)
    frame = np.concatenate([ring.rows for ring in made.levels[0].rings])
    points = np.concatenate([points_at(frame, np.full(len(frame), part)) for part in np.linspace(0, 1, 41)])
    path = DistanceField.of(np.concatenate([stroke.rows for stroke in made.strokes]))
    assert path.nearest(points)[0].max() < 1e-6


def test_rings_farther_apart_than_the_radius_are_all_cut_whole() -> None:
    made, _ = cleared(nest(fig2()), 1.6)
    cut = sum(float(lengths(s.rows[s.purpose == Purpose.POCKET]).sum()) for s in made.strokes)
    assert cut >= rings(made) - 1e-6


@pytest.mark.parametrize(
    ("end", "step", "good"), [((0.0, 1.0), 1.0, True), ((0.0, 1.0), 0.2, False), ((0.0, 3.0), 1.0, False)]
)
def test_a_slant_covers_what_it_comes_near_to_all_of(end: tuple[float, float], step: float, good: bool) -> None:
    left = np.array([[-1.5, 0.0, 0.0, 0.0, 0, 0, 0, 0]])
    assert covers(np.array([-1.5, 0.0]), np.array(end), left, step) == good


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_the_strip_beside_an_arc_is_covered_or_not_as_points_of_it_tell(turn: float) -> None:
    """A quarter of circles: what `covers` says holds at points all over the strip."""
    for radius in (0.3, 1.0, 4.0, 20.0):
        for part in (0.02, 0.1, 0.4):
            low, high = (0.0, part) if turn > 0 else (part, 0.0)
            row = np.array(
                [
                    [
                        radius * np.cos(low),
                        radius * np.sin(low),
                        radius * np.cos(high),
                        radius * np.sin(high),
                        0,
                        0,
                        radius,
                        turn,
                    ]
                ]
            )
            inward = min(1.0, radius) if turn > 0 else 1.0
            start, end = row[0, :2], row[0, 2:4] * (1 - turn * inward / radius)
            angles, heights = np.meshgrid(np.linspace(0, part, 40), np.linspace(0, inward, 40))
            points = np.stack(
                [(radius - turn * heights) * np.cos(angles), (radius - turn * heights) * np.sin(angles)], -1
            ).reshape(-1, 2)
            t = np.clip((points - start) @ (end - start) / ((end - start) @ (end - start)), 0, 1)
            worst = np.hypot(*(points - start - t[:, None] * (end - start)).T).max()
            if covers(start, end, row, 1.0):
                assert worst <= 1.0
            else:
                assert worst > 0.9
