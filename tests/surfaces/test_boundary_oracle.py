"""Boundary points CRij against root finding on heights of our own: planes, balls, lying cylinders and a spline patch,
cut by planes side by side, as a fan and square on a guide. No surface of the program is asked.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

from app.formats.scene.toml import read_scene, sources_of
from app.model.motion import Floats
from app.surfaces.sections.compound import BoundaryKind, CompoundSurface
from app.usecases.scene.compute import compute

Height = Callable[[float, float], float]
"""Of a surface over a place, mm; minus infinity beside it."""
Part = tuple[str, Height]
"""A surface as a scene has it, and its height."""

STEP = 0.02
"""mm; surfaces that change places twice within it are not looked for."""
HEAD = 'name = "o"\n[stock]\nbox = [-5, -5, -20, 65, 45, 25]\n[[tool]]\nnumber = 1\ndiameter = 4\nkind = "ball"\n'
FAMILIES = (
    "pitch = 6.3\nangle_deg = 33.0",
    "fan_deg = [0, 170, 37.0]\nthrough = [31.0, 17.0]",
    "guide = [[5, 5], [30, 20], [55, 31]]\npitch = 11.0",
)


def a_plane(random: np.random.Generator) -> Part:
    z, along, across = random.uniform((0, -0.05, -0.05), (5, 0.1, 0.1)).round(3).tolist()
    shape = f'kind = "plane", corner = [0, 0, {z}], along = [60, 0, {60 * along}], across = [0, 40, {40 * across}]'
    return shape, lambda x, y: z + along * x + across * y if 0 <= x <= 60 and 0 <= y <= 40 else -math.inf


def a_ball(random: np.random.Generator) -> Part:
    x0, y0, z0, r = random.uniform((10, 8, -4, 6), (50, 32, 4, 14)).round(3).tolist()

    def height(x: float, y: float) -> float:
        rest = r * r - (x - x0) ** 2 - (y - y0) ** 2
        return z0 + math.sqrt(rest) if rest >= 0 else -math.inf

    return f'kind = "sphere", centre = [{x0}, {y0}, {z0}], radius = {r}', height


def a_cylinder(random: np.random.Generator) -> Part:
    x0, y0, x1, y1, z0, r = random.uniform((0, 0, 40, 0, -3, 4), (20, 40, 60, 40, 4, 9)).round(3).tolist()
    size = math.hypot(x1 - x0, y1 - y0)

    def height(x: float, y: float) -> float:
        along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / size
        off = ((x - x0) * (y1 - y0) - (y - y0) * (x1 - x0)) / size
        return z0 + math.sqrt(r * r - off * off) if 0 <= along <= size and abs(off) <= r else -math.inf

    return f'kind = "cylinder", start = [{x0}, {y0}, {z0}], end = [{x1}, {y1}, {z0}], radius = {r}', height


def bernstein(t: float) -> Floats:
    return np.array([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3])


def a_patch(random: np.random.Generator) -> Part:
    """A bicubic patch over a rectangle: its height is a function of the place."""
    (x0, y0, wide, high), z = random.uniform((0, 0, 30, 20), (10, 8, 48, 30)).round(3), random.uniform(0, 14, (4, 4))
    rows = [[[x0 + wide * i / 3, y0 + high * j / 3, z[i, j]] for j in range(4)] for i in range(4)]

    def height(x: float, y: float) -> float:
        u, v = (x - x0) / wide, (y - y0) / high
        return float(bernstein(u) @ z @ bernstein(v)) if 0 <= u <= 1 and 0 <= v <= 1 else -math.inf

    return f'kind = "bicubic", points = {np.array(rows).tolist()}', height


def family(seed: int) -> tuple[list[Height], list[CompoundSurface]]:
    """Random surfaces, and what they are where planes of one of the rules cut them."""
    random = np.random.default_rng(seed)
    parts = [made(random) for made in (a_plane, a_ball, a_cylinder, a_patch)]
    surfaces = "".join(f'[[surface]]\nname = "S{k}"\nshape = {{ {part[0]} }}\n' for k, part in enumerate(parts))
    text = f"{HEAD}{surfaces}[[passes]]\ntool = 1\n{FAMILIES[seed % 3]}\nchord_tolerance = 0.05\n"
    computed = compute(read_scene("o.toml", text.encode()), sources_of(no_file))
    return [part[1] for part in parts], [each.surface for each in computed.families]


def no_file(name: str) -> bytes:
    raise AssertionError(name)


def crossings(heights: list[Height], start: Floats, along: Floats) -> list[Floats]:
    """Places of a line at which the topmost surface passes to another one that is as high, by Brent's method."""
    at = np.arange(-90.0, 90.0, STEP)
    levels = np.array([[height(*(start + s * along)) for height in heights] for s in at])
    top, found = levels.argmax(axis=1), []
    for k in np.flatnonzero(top[:-1] != top[1:]).tolist():
        i, j = top[k], top[k + 1]

        def apart(s: float, one: Height = heights[i], other: Height = heights[j]) -> float:
            return one(*(start + s * along)) - other(*(start + s * along))

        if np.isfinite(levels[k : k + 2, [i, j]]).all() and apart(at[k]) * apart(at[k + 1]) <= 0:
            found.append(start + brentq(apart, at[k], at[k + 1], xtol=1e-13) * along)
    return found


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in range(1, 9))])
def test_boundary_points_are_where_heights_are_alike_and_none_is_missed(seed: int) -> None:
    heights, families = family(seed)
    count = 0
    for surface in families:
        found, planes = surface.boundaries, surface.planes
        solved = np.flatnonzero(found.kind == BoundaryKind.CROSSING)
        for k in solved.tolist():
            x, y, z = found.place[k].tolist()
            both = [heights[int(number)](x, y) for number in (found.before[k], found.after[k])]
            assert abs(both[0] - both[1]) <= 1e-9 and abs(both[0] - z) <= 1e-9
            assert max(height(x, y) for height in heights) <= z + 1e-9, "another surface is higher"
        along = np.array(planes.along)
        for number, offset in enumerate(planes.offsets):
            start = np.array(planes.origin) + offset * np.array([-along[1], along[0]])
            known = found.place[solved[found.plane[solved] == number]][:, :2]
            for place in crossings(heights, start, along):
                assert len(known) and np.linalg.norm(known - place, axis=1).min() < 1e-8
                count += 1
    assert count > 3
