"""Faces with many corners as triangles: they cover what lies within the face, in its sense, whatever its form."""

import numpy as np
import pytest
import shapely

from app.surfaces.meshes.polygons import triangulated

SQUARE = [(0, 0), (9, 0), (9, 9), (0, 9)]
HOLE = [(3, 3), (3, 6), (6, 6), (6, 3)]
FORMS = {
    "bent inwards": [(0, 0), (9, 0), (9, 9), (8, 1), (0, 1)],
    "corners along its sides": [(0, 0), (4, 0), (9, 0), (9, 9), (5, 5), (5, 2), (0, 2), (0, 1)],
    "a corner twice": [(0, 0), (9, 0), (9, 0), (9, 9), (8, 1), (0, 1)],
    "round a hole": [*SQUARE, SQUARE[0], *HOLE, HOLE[0]],
}


def placed(places: list[tuple[float, float]], turned: bool, upright: bool) -> np.ndarray:
    flat = np.array(places, float)[:: -1 if turned else 1]
    return np.insert(flat, 1 if upright else 2, 0.3 * flat[:, 0] + 5.0, axis=1)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("upright", [False, True])
def test_triangles_cover_a_face_in_its_sense(form: str, turned: bool, upright: bool) -> None:
    points = placed(FORMS[form], turned, upright)
    found = points[triangulated(points, [np.arange(len(points))[None]])]
    middle = points - points.mean(axis=0)
    whole = np.cross(middle, np.roll(middle, -1, axis=0)).sum(axis=0) / 2  # Newell
    each = np.cross(found[:, 1] - found[:, 0], found[:, 2] - found[:, 0]) / 2
    assert each.sum(axis=0) == pytest.approx(whole)
    assert np.linalg.norm(each, axis=1).sum() == pytest.approx(np.linalg.norm(whole)), "none lies over another one"


def test_a_face_of_thousands_of_corners_is_covered() -> None:
    """A comb: cutting ear by ear took minutes for it."""
    x = np.arange(4000.0)
    places = np.concatenate([np.column_stack([x, 0 * x]), np.column_stack([x[::-1], 5 + 4 * (x[::-1] % 2)])])
    points = np.column_stack([places, 0 * places[:, 0]])
    found = points[triangulated(points, [np.arange(len(points))[None]])]
    areas = np.cross(found[:, 1] - found[:, 0], found[:, 2] - found[:, 0])[:, 2] / 2
    assert (areas > 0).all() and areas.sum() == pytest.approx(shapely.Polygon(places).area)


@pytest.mark.parametrize("odd", [(0.0, 0.0), (np.nan, 1.0), (np.inf, 1.0)])
def test_what_has_no_inside_is_a_fan(odd: tuple[float, float]) -> None:
    """A face that crosses itself, and one with a corner that is no place, which the reader refuses."""
    points = np.array([(*place, 0.0) for place in ((0, 0), (9, 9), (9, 0), (0, 5), odd)], float)
    assert triangulated(points, [np.arange(5)[None]]).tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
