"""Random closed contours of the kinds that fill algorithms fail on. Lengths in pixels of 1 mm."""

import math
from collections.abc import Callable

import numpy as np

from app.model.curves import Arc, Circle, Line, Point, Primitive
from app.model.part import Contour

Rng = np.random.Generator
Shape = list[Contour]


def polygon(points: list[Point]) -> Contour:
    corners = [p for p, q in zip(points, points[1:] + points[:1], strict=True) if p != q]
    return Contour(tuple(Line(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))


def snapped(rng: Rng, points: list[tuple[float, float]]) -> list[Point]:
    """Put points on pixel corners, pixel centres, quarters, or nowhere in particular."""
    grid, shift = [(1.0, 0.0), (1.0, 0.5), (0.25, 0.0), (0.0, 0.0)][int(rng.integers(4))]
    return [
        (round((x - shift) / grid) * grid + shift, round((y - shift) / grid) * grid + shift) if grid else (x, y)
        for x, y in points
    ]


def star(rng: Rng, size: float) -> Shape:
    n, inner = int(rng.integers(3, 30)), rng.uniform(0.05, 0.9)
    turn = rng.uniform(0, math.tau)
    angles = [turn + math.pi * k / n for k in range(2 * n)]
    radii = [size / 2 * (1 if k % 2 else inner) for k in range(2 * n)]
    return [
        polygon(
            snapped(
                rng,
                [(size / 2 + r * math.cos(a), size / 2 + r * math.sin(a)) for r, a in zip(radii, angles, strict=True)],
            )
        )
    ]


def comb(rng: Rng, size: float) -> Shape:
    tooth, gap = rng.uniform(0.3, 3), rng.uniform(0, 3)
    points, x = [(2.0, 2.0)], 2.0
    while x + tooth < size - 2:
        top = rng.uniform(size / 3, size - 2)
        points += [(x, top), (x + tooth, top), (x + tooth, size / 4), (x + tooth + gap, size / 4)]
        x += tooth + gap
    points += [(x, 2.0)]
    if rng.random() < 0.5:
        points = [(y, x) for x, y in points]
    return [polygon(snapped(rng, points))]


def slots(rng: Rng, size: float) -> Shape:
    outer = polygon(snapped(rng, [(1, 1), (size - 1, 1), (size - 1, size - 1), (1, size - 1)]))
    shapes = [outer]
    for _ in range(int(rng.integers(1, 12))):
        x, y, length, turn = *rng.uniform(4, size - 4, 2), rng.uniform(2, size / 2), rng.uniform(0, math.pi)
        width = rng.choice([1.0, 2.0, 3.0, rng.uniform(0.2, 3)])
        if rng.random() < 0.5:
            turn = rng.choice([0, math.pi / 2])
        along, across = (
            (math.cos(turn) * length, math.sin(turn) * length),
            (-math.sin(turn) * width, math.cos(turn) * width),
        )
        shapes.append(
            polygon(
                snapped(
                    rng,
                    [
                        (x, y),
                        (x + along[0], y + along[1]),
                        (x + along[0] + across[0], y + along[1] + across[1]),
                        (x + across[0], y + across[1]),
                    ],
                )
            )
        )
    return shapes


def touching(rng: Rng, size: float) -> Shape:
    """Squares that share edges and corners, some of them twice, some a hair apart."""
    cell = float(rng.integers(3, max(4, size // 5)))
    gap = rng.choice([0.0, 0.0, 0.5, 1.0])
    cells = [
        (float(i) * cell + 1, float(j) * cell + 1)
        for i in range(int(size / cell) - 1)
        for j in range(int(size / cell) - 1)
    ]
    chosen = [cells[k] for k in rng.integers(0, len(cells), min(len(cells), 12))]
    return [
        polygon([(x, y), (x + cell - gap, y), (x + cell - gap, y + cell - gap), (x, y + cell - gap)]) for x, y in chosen
    ]


def spiral(rng: Rng, size: float) -> Shape:
    pitch = rng.uniform(1.5, 6)
    width = pitch * rng.uniform(0.2, 0.9)
    steps = np.arange(0, (size / 2 - 3) / pitch * math.tau, rng.uniform(0.1, 0.7))
    if len(steps) < 3:
        return star(rng, size)
    radii = steps / math.tau * pitch
    out = [(size / 2 + r * math.cos(t), size / 2 + r * math.sin(t)) for r, t in zip(radii, steps, strict=True)]
    back = [
        (size / 2 + (r + width) * math.cos(t), size / 2 + (r + width) * math.sin(t))
        for r, t in zip(radii, steps, strict=True)
    ]
    return [polygon(snapped(rng, out + back[::-1]))]


def rectilinear(rng: Rng, size: float) -> Shape:
    """A skyline above another skyline, every vertex on the grid: plateaus, one-pixel towers, zero-height bridges."""
    n = int(rng.integers(2, 14))
    xs = np.sort(rng.integers(1, int(size) - 1, n + 1)).astype(float)
    up = rng.integers(int(size) // 2, int(size) - 1, n).astype(float)
    down = rng.integers(1, int(size) // 2 + 1, n).astype(float)
    top = [p for k in range(n) for p in ((xs[k], up[k]), (xs[k + 1], up[k]))]
    bottom = [p for k in reversed(range(n)) for p in ((xs[k + 1], down[k]), (xs[k], down[k]))]
    shift = rng.choice([0.0, 0.5])
    points = [(float(x) + shift, float(y) + shift) for x, y in top + bottom]
    return [polygon(points if rng.random() < 0.5 else [(y, x) for x, y in points])]


def tangled(rng: Rng, size: float) -> Shape:
    """Polygons that cross and touch themselves, one of them perhaps drawn twice."""
    points = snapped(rng, [tuple(p) for p in rng.uniform(1, size - 1, (int(rng.integers(3, 25)), 2)).tolist()])
    shape = [polygon(points)]
    if rng.random() < 0.3:
        hub = points[0]
        shape = [polygon([q for p in zip(points[1::2], points[2::2], strict=False) for q in (hub, *p)] or points)]
    return shape * 2 if rng.random() < 0.1 else shape


def arc_through(a: Point, b: Point, bulge: float) -> Primitive:
    """An arc that sweeps 4 atan(bulge) from a to b."""
    if a == b or abs(bulge) < 1e-3:
        return Line(a, b)
    mx, my, dx, dy = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, b[0] - a[0], b[1] - a[1]
    offset = (1 / bulge - bulge) / 4
    return Arc(a, b, (mx - dy * offset, my + dx * offset), bulge > 0)


def arcs(rng: Rng, size: float) -> Shape:
    """Polygons whose edges bulge by up to three quarters of a turn; quadrant points fall on vertices now and then."""
    points = snapped(
        rng, [tuple(p) for p in rng.uniform(size / 4, size * 3 / 4, (int(rng.integers(2, 9)), 2)).tolist()]
    )
    points = [p for k, p in enumerate(points) if p != points[k - 1]]
    if len(points) < 2:
        return circles(rng, size)
    bulges = rng.choice(
        [0.0, 1.0, -1.0, math.tan(math.pi / 8), -math.tan(math.pi / 8), rng.uniform(-2.4, 2.4)], len(points)
    )
    return [
        Contour(
            tuple(arc_through(a, b, float(g)) for a, b, g in zip(points, points[1:] + points[:1], bulges, strict=True))
        )
    ]


def circles(rng: Rng, size: float) -> Shape:
    """Rings of circles, some a pixel or less apart, some smaller than a pixel, some touching."""
    shape = []
    for _ in range(int(rng.integers(1, 8))):
        (x, y), r = (
            snapped(rng, [tuple(rng.uniform(size / 4, size * 3 / 4, 2).tolist())])[0],
            rng.uniform(0.05, size / 4),
        )
        r = round(r) + 0.5 if rng.random() < 0.4 else r
        shape.append(Contour((Circle((x, y), r, bool(rng.random() < 0.5)),)))
        if rng.random() < 0.5:
            shape.append(
                Contour(
                    (
                        Circle(
                            (x, y),
                            max(0.02, r - rng.choice([0.3, 1.0, 1.5])),
                        ),
                    )
                )
            )
    return shape


def stadiums(rng: Rng, size: float) -> Shape:
    """Round-ended slots, level, upright or aslant: tangent joints exactly on quadrant points."""
    shape = []
    for _ in range(int(rng.integers(1, 5))):
        x, y, r, length = (
            *rng.uniform(size / 3, size * 2 / 3, 2),
            rng.uniform(0.5, size / 8),
            rng.uniform(0.5, size / 4),
        )
        x, y, r = (round(x * 2) / 2, round(y * 2) / 2, round(r * 2) / 2 or 0.5) if rng.random() < 0.6 else (x, y, r)
        turn = rng.choice([0.0, math.pi / 2, rng.uniform(0, math.pi)])
        c, s = math.cos(turn), math.sin(turn)
        a, b, p, q = (
            (x + s * r, y - c * r),
            (x + s * r + c * length, y - c * r + s * length),
            (x - s * r, y + c * r),
            (0.0, 0.0),
        )
        q = (p[0] + c * length, p[1] + s * length)
        shape.append(Contour((Line(a, b), Arc(b, q, (x + c * length, y + s * length)), Line(q, p), Arc(p, a, (x, y)))))
    return shape


def beyond(rng: Rng, size: float) -> Shape:
    """A shape of another kind that reaches over the edges of the frame."""
    shift = rng.uniform(-size / 2, size / 2, 2)
    return [
        Contour(
            tuple(
                Line((p.start[0] + shift[0], p.start[1] + shift[1]), (p.end[0] + shift[0], p.end[1] + shift[1]))
                for p in contour.primitives
                if isinstance(p, Line)
            )
        )
        for contour in tangled(rng, size)
    ]


KINDS: dict[str, Callable[[Rng, float], Shape]] = {
    kind.__name__: kind
    for kind in (star, comb, slots, touching, spiral, rectilinear, tangled, arcs, circles, stadiums, beyond)
}
