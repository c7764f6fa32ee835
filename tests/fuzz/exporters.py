"""The same shapes as different CAD programs write them, DXF and SVG, and the area that they bound in closed form."""

from __future__ import annotations

import io
import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import ezdxf


@dataclass(frozen=True)
class Disc:
    """A circle, mm."""

    x: float
    y: float
    r: float

    @property
    def area(self) -> float:
        """In mm2."""
        return math.pi * self.r**2


@dataclass(frozen=True)
class Slot:
    """Two half circles and the lines between, mm, turned by an angle, radians."""

    x: float
    y: float
    r: float
    length: float
    turn: float

    @property
    def area(self) -> float:
        """In mm2."""
        return math.pi * self.r**2 + 2 * self.r * self.length

    @property
    def corners(self) -> list[tuple[float, float]]:
        """From where a half circle ends to where the next one begins, counter-clockwise."""
        c, s, half = math.cos(self.turn), math.sin(self.turn), self.length / 2
        local = [(-half, -self.r), (half, -self.r), (half, self.r), (-half, self.r)]
        return [(self.x + c * a - s * b, self.y + s * a + c * b) for a, b in local]


@dataclass(frozen=True)
class Loop:
    """A polygon without crossings, mm."""

    points: tuple[tuple[float, float], ...]

    @property
    def area(self) -> float:
        """In mm2."""
        ends = self.points[1:] + self.points[:1]
        return abs(sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(self.points, ends, strict=True))) / 2


Drawn = Disc | Slot | Loop


def drawn(rng: random.Random) -> list[Drawn]:
    """Return shapes that lie apart from one another, so that areas add up."""
    found: list[Drawn] = []
    for k in range(rng.randint(1, 6)):
        x, y = 40.0 * (k % 3) + rng.uniform(-3, 3), 40.0 * (k // 3) + rng.uniform(-3, 3)
        sort = rng.randrange(3)
        if sort == 0:
            found.append(Disc(x, y, rng.uniform(1, 15)))
        elif sort == 1:
            found.append(Slot(x, y, rng.uniform(1, 6), rng.uniform(2, 18), rng.uniform(0, math.tau)))
        else:
            count = rng.randint(3, 9)
            reach = [rng.uniform(4, 15) for _ in range(count)]
            corners = [math.tau * k / count for k in range(count)]
            found.append(
                Loop(tuple((x + r * math.cos(a), y + r * math.sin(a)) for r, a in zip(reach, corners, strict=True)))
            )
    return found


# DXF


def _loose(space: Any, shape: Drawn, rng: random.Random, digits: int, layer: dict[str, str]) -> None:
    """Lines and arcs one by one, in any order and either way."""

    def at(p: tuple[float, float]) -> tuple[float, float]:
        return round(p[0], digits), round(p[1], digits)

    makers: list[Callable[[], Any]] = []
    if isinstance(shape, Disc):
        parts = rng.choice([1, 1, 2, 3])
        start = rng.uniform(0, 360)
        if parts == 1:
            makers.append(lambda: space.add_circle(at((shape.x, shape.y)), round(shape.r, digits), dxfattribs=layer))
        for k in range(parts if parts > 1 else 0):
            span = (start + 360 * k / parts, start + 360 * (k + 1) / parts)
            makers.append(lambda s=span: space.add_arc((shape.x, shape.y), shape.r, *s, dxfattribs=layer))
    else:
        corners = shape.corners if isinstance(shape, Slot) else list(shape.points)
        ends = corners[1:] + corners[:1]
        for k, (a, b) in enumerate(zip(corners, ends, strict=True)):
            if isinstance(shape, Slot) and k % 2:
                middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
                first = math.degrees(math.atan2(a[1] - middle[1], a[0] - middle[0]))
                makers.append(
                    lambda m=middle, f=first: space.add_arc(
                        at(m), shape.r, round(f, 6), round(f + 180, 6), dxfattribs=layer
                    )
                )
            else:
                ends2 = (a, b) if rng.random() < 0.5 else (b, a)
                makers.append(lambda e=ends2: space.add_line(at(e[0]), at(e[1]), dxfattribs=layer))
    rng.shuffle(makers)
    for make in makers:
        make()


def _bulged(shape: Drawn) -> list[tuple[float, float, float]]:
    if isinstance(shape, Disc):
        return [(shape.x - shape.r, shape.y, 1.0), (shape.x + shape.r, shape.y, 1.0)]
    if isinstance(shape, Slot):
        return [(x, y, float(k % 2)) for k, (x, y) in enumerate(shape.corners)]
    return [(x, y, 0.0) for x, y in shape.points]


def _polyline(space: Any, shape: Drawn, rng: random.Random, layer: dict[str, str]) -> None:
    points, repeat, old = _bulged(shape), rng.random() < 0.3, space.doc.dxfversion < "AC1015"
    begin = rng.randrange(len(points))
    points = points[begin:] + points[:begin]
    if repeat:  # the first point again, and not closed, as some write it
        points = [*points, points[0]]
    if rng.random() < 0.5 and not old:
        space.add_lwpolyline(points, format="xyb", close=not repeat, dxfattribs=layer)
    else:
        space.add_polyline2d(points, format="xyb", close=not repeat, dxfattribs=layer)


def dxf(rng: random.Random, shapes: list[Drawn]) -> bytes:
    """Return a DXF in the habits of some exporter."""
    version = rng.choice(["R12", "R2000", "R2007", "R2010", "R2018"])
    inches = rng.random() < 0.3 and version != "R12"
    document = ezdxf.new(version, units=1 if inches else 4)
    factor = 1 / 25.4 if inches else 1.0
    block = document.blocks.new("PART") if rng.random() < 0.4 else None
    mirrored = block is not None and rng.random() < 0.5
    space = block if block is not None else document.modelspace()
    digits = rng.choice([4, 5, 6, 8]) if inches else rng.choice([3, 4, 6, 12])
    for shape in shapes:
        own = _scaled(shape, -factor if mirrored else factor)
        layer = {"layer": rng.choice(["0", "CUT", "Kontur-Außen", "cut"])}
        if rng.random() < 0.5:
            _loose(space, own, rng, digits, layer)
        else:
            _polyline(space, own, rng, layer)
        if rng.random() < 0.2:
            space.add_text("x", dxfattribs={"layer": "NOTES"})
    if block is not None:
        scale = (
            {"xscale": -1, "yscale": -1} if mirrored and rng.random() < 0.5 else {"rotation": 180 if mirrored else 0}
        )
        document.modelspace().add_blockref("PART", (0, 0), dxfattribs=scale)
    if rng.random() < 0.2:
        stream = io.BytesIO()
        document.write(stream, fmt="bin")
        return stream.getvalue()
    text = io.StringIO()
    document.write(text)
    made = text.getvalue()
    if rng.random() < 0.3:
        made = made.replace("\n", "\r\n")
    if rng.random() < 0.2:  # codes without blanks before them
        lines = made.splitlines()
        made = "\n".join(line.strip() if k % 2 == 0 else line for k, line in enumerate(lines)) + "\n"
    return made.encode(document.encoding if version in ("R12", "R2000") else "utf-8", "replace")


def _scaled(shape: Drawn, by: float) -> Drawn:
    if isinstance(shape, Disc):
        return Disc(shape.x * by, shape.y * by, shape.r * abs(by))
    if isinstance(shape, Slot):
        return Slot(shape.x * by, shape.y * by, shape.r * abs(by), shape.length * abs(by), shape.turn)
    return Loop(tuple((x * by, y * by) for x, y in shape.points))


# SVG


def _path(shape: Drawn, rng: random.Random) -> str:
    if isinstance(shape, Disc):
        r = f"{shape.r:.6f}"
        sort = rng.randrange(3)
        if sort == 0:
            return f'<circle cx="{shape.x:.6f}" cy="{shape.y:.6f}" r="{r}"/>'
        if sort == 1:
            return f'<ellipse cx="{shape.x:.6f}" cy="{shape.y:.6f}" rx="{r}" ry="{r}"/>'
        begin, wide = f"m{shape.x - shape.r:.6f} {shape.y:.6f}", f"{2 * shape.r:.6f}"
        return f'<path d="{begin}a{r} {r} 0 1 0 {wide} 0a{r} {r} 0 10-{wide} 0z"/>'
    if isinstance(shape, Slot):
        (a, b), (c, d), (e, f), (g, h) = shape.corners
        r = f"{shape.r:.6f}"
        if rng.random() < 0.3:
            turn = math.degrees(shape.turn)
            wide, high = shape.length + 2 * shape.r, 2 * shape.r
            place = f'x="{shape.x - wide / 2:.6f}" y="{shape.y - shape.r:.6f}" width="{wide:.6f}" height="{high:.6f}"'
            return f'<rect {place} rx="{r}" transform="rotate({turn:.9f} {shape.x:.6f} {shape.y:.6f})"/>'
        first, last = f"{c:.6f},{d:.6f}A{r},{r} 0 0 1 {e:.6f},{f:.6f}", f"{g:.6f},{h:.6f}A{r} {r} 0 0,1 {a:.6f},{b:.6f}"
        return f'<path d="M{a:.6f},{b:.6f} L{first}L{last}Z"/>'
    points = list(shape.points)
    if rng.random() < 0.4:
        return '<polygon points="' + " ".join(f"{x:.6f},{y:.6f}" for x, y in points) + '"/>'
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)]
    return (
        f'<path d="m {points[0][0]:.6f},{points[0][1]:.6f} ' + " ".join(f"{x:.7f},{y:.7f}" for x, y in steps) + ' z"/>'
    )


def svg(rng: random.Random, shapes: list[Drawn]) -> bytes:
    """Return an SVG in the habits of some editor."""
    unit, size = rng.choice([("mm", 1.0), ("mm", 1.0), ("in", 25.4), ("cm", 10.0), ("pt", 25.4 / 72)])
    wide = 200 / size
    scale = rng.choice([1.0, 96 / 25.4, 3.7795276])  # user units a mm
    body = []
    for shape in shapes:
        text = _path(_scaled(shape, scale), rng)
        style = rng.choice(
            ["", ' style="fill:none;stroke:#000;stroke-width:.1mm"', ' fill="none" stroke="black"', ' class="c"']
        )
        text = text.replace("/>", f"{style}/>", 1)
        wrap = rng.randrange(4)
        if wrap == 1:
            text = f'<g transform="translate(30,-7)"><g transform="translate(-30 7)">{text}</g></g>'
        elif wrap == 2:
            text = f'<g transform="matrix(0,1,-1,0,0,0)"><g transform="rotate(-90)">{text}</g></g>'
        elif wrap == 3:
            text = f'<defs><g id="s{len(body)}">{text}</g></defs><use xlink:href="#s{len(body)}"/>'
        body.append(text)
    head = rng.choice(['<?xml version="1.0" encoding="UTF-8" standalone="no"?>\n', "", "\ufeff"])
    spaces = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    inkscape = 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
    box = f'width="{wide:.6f}{unit}" height="{wide:.6f}{unit}" viewBox="0 0 {200 * scale:.6f} {200 * scale:.6f}"'
    layer = f'<g {inkscape} inkscape:groupmode="layer" inkscape:label="CUT">'
    sheet = "<style>.c{fill:none;stroke:#f00}</style>"
    return f"{head}<svg {spaces} {box}>{sheet}{layer}{''.join(body)}</g></svg>".encode()
