"""Random jobs of all kinds of operation, each in a field of its own, and what each may and has to leave: closed forms
over the drawn shapes, which share nothing with the program.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from tests.fuzz.dense_heights import Floats, Shape

FIELD = 40.0
"""mm; each operation has a square of this side, and its shape lies 6 mm within."""
DOUBT = 0.02
"""mm; nearer to the edge of what is wanted a point decides nothing."""
ROUND = 128
"""Chords of a quarter turn."""


@dataclass(frozen=True)
class Wanted:
    """What is wanted at points: no lower than `lowest`, and no higher than `highest`, mm; nan = nothing is asked."""

    lowest: Floats
    highest: Floats


Judge = Callable[[Floats, Floats], Wanted]


@dataclass(frozen=True)
class Work:
    """An operation: its kind, drawing, tables of a job file without curves, tools, and what it has to make."""

    kind: str
    drawing: list[str]
    operations: list[str]
    tools: list[tuple[str, Shape]]
    judge: Judge


def _text(points: list[tuple[float, float]]) -> str:
    return "polyline " + " ".join(f"{x:.4f},{y:.4f}" for x, y in points) + " close"


def _star(rng: random.Random, least: float, most: float, corners: int) -> list[tuple[float, float]]:
    turn = rng.uniform(0, math.tau)
    return [
        (round(r * math.cos(turn + math.tau * k / corners), 4), round(r * math.sin(turn + math.tau * k / corners), 4))
        for k in range(corners)
        for r in [rng.uniform(least, most)]
    ]


def area(rng: random.Random) -> tuple[list[str], BaseGeometry]:
    """Return lines of a drawing about (0, 0), at most 14 mm from there, and the area that they bound, even-odd."""
    sort = rng.randrange(5)
    if sort == 0:
        points = _star(rng, 5, 14, rng.randint(3, 12))
        return [_text(points)], Polygon(points).buffer(0)
    if sort == 1:
        wide, high, turn = rng.uniform(6, 20), rng.uniform(6, 18), rng.uniform(0, math.pi)
        c, s = math.cos(turn), math.sin(turn)
        corners = [(a * wide / 2, b * high / 2) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        points = [(round(c * x - s * y, 4), round(s * x + c * y, 4)) for x, y in corners]
        return [_text(points)], Polygon(points)
    if sort == 2:
        outer, inner = round(rng.uniform(8, 14), 3), round(rng.uniform(1, 4), 3)
        x = round(rng.uniform(0, outer - inner - 1), 3)
        hole = shapely.Point(x, 0).buffer(inner, ROUND)
        return [f"circle 0,0 {outer}", f"circle {x},0 {inner}"], shapely.Point(0, 0).buffer(outer, ROUND) - hole
    if sort == 3:
        a, b = _star(rng, 7, 14, rng.randint(5, 9)), _star(rng, 3, 13, rng.randint(3, 5))
        return [_text(a), _text(b)], Polygon(a).buffer(0) ^ Polygon(b).buffer(0)
    radius = round(rng.uniform(4, 9), 3)
    centres = [(round(rng.uniform(-4, 4), 3), round(rng.uniform(-4, 4), 3)) for _ in range(2)]
    one, two = (shapely.Point(c).buffer(radius, ROUND) for c in centres)
    return [f"circle {x},{y} {radius}" for x, y in centres], one ^ two


def _floor(allowed: BaseGeometry, reached: BaseGeometry, depth: float) -> Judge:
    """What is cut to a level floor: all of what is reached, and nothing beyond what is allowed."""

    def judge(x: Floats, y: Floats) -> Wanted:
        inside = shapely.contains_xy(allowed.buffer(DOUBT), x, y)
        sure = shapely.contains_xy(reached.buffer(-DOUBT), x, y)
        return Wanted(np.where(inside, -depth, 0.0), np.where(sure, -depth, np.nan))

    return judge


def _opened(shape: BaseGeometry, radius: float) -> BaseGeometry:
    return shape.buffer(-radius - 1e-4, ROUND).buffer(radius + 1e-4, ROUND)


def _tool(kind: str, diameter: float, angle: float = 0.0) -> tuple[str, Shape]:
    text = f'kind = "{kind}"\ndiameter = {diameter}\n' + (f"tip_angle = {angle}\n" if angle else "")
    fall = 1 / math.tan(math.radians(angle / 2)) if angle else 0.0
    return text, Shape(diameter / 2, fall)


def _some(rng: random.Random, *lines: str) -> str:
    """Return some of the lines of a table, about half of them."""
    return "".join(f"{line}\n" for line in lines if rng.random() < 0.5)


def _clear(rng: random.Random, kind: str) -> Work:
    lines, shape = area(rng)
    diameter, depth = rng.choice([1.0, 2.0, 3.0, 3.175, 4.0]), rng.choice([1.0, 2.5])
    text = f'kind = "{kind}"\ndepth = {depth}\nstepdown = {rng.choice([1.0, 2.5])}\n'
    entry = rng.choice(['entry = "ramp"', 'entry = "plunge"', "entry_angle = 8"])
    text += _some(rng, 'direction = "conventional"', entry)
    text += _some(rng, "finish_depth = 0.2")
    if kind == "pocket":
        text += _some(rng, "outside_in = true", f"stepover = {round(diameter * rng.uniform(0.2, 1), 3)}")
    leave = rng.choice([0.0, 0.0, 0.25])
    if leave:
        text, shape = f"{text}stock_to_leave = {leave}\n", shape.buffer(-leave, ROUND)
    judge = _floor(shape, _opened(shape, diameter / 2), depth)
    return Work(kind, lines, [text], [_tool("flat", diameter)], judge)


def _rest(rng: random.Random) -> Work:
    lines, shape = area(rng)
    wide, narrow, depth = rng.choice([4.0, 5.0]), rng.choice([1.0, 2.0]), 2.0
    texts = [f'kind = "{kind}"\ndepth = {depth}\n' for kind in ("pocket", "rest")]
    judge = _floor(shape, _opened(shape, wide / 2) | _opened(shape, narrow / 2), depth)
    return Work("rest", lines, texts, [_tool("flat", wide), _tool("flat", narrow)], judge)


def _contour(rng: random.Random) -> Work:
    lines, shape = area(rng)
    side, radius, depth = rng.choice(["inside", "outside", "on"]), rng.choice([0.5, 1.0, 1.5875]), 1.5
    text = f'kind = "contour"\nside = "{side}"\ndepth = {depth}\nstepdown = {rng.choice([0.5, 1.5])}\n'
    text += _some(rng, 'direction = "conventional"', f'lead = "{rng.choice(["line", "none"])}"', "spring_passes = 1")
    if side != "on":
        text += _some(rng, "finish_width = 0.15")
        text += _some(rng, "finish_each_pass = true") if "finish_width" in text else ""
    path = shape.boundary if side == "on" else shape.buffer(radius * (1 if side == "outside" else -1), ROUND).boundary
    swept = path.buffer(radius - 1e-3, ROUND)
    everywhere = shapely.box(-100, -100, 100, 100)
    allowed = {"inside": shape, "outside": everywhere - shape, "on": shape.boundary.buffer(radius, ROUND)}[side]
    return Work(f"contour {side}", lines, [text], [_tool("flat", 2 * radius)], _floor(allowed, swept, depth))


def _slot(rng: random.Random) -> Work:
    points = [(round(rng.uniform(-11, 11), 3), round(rng.uniform(-11, 11), 3)) for _ in range(rng.randint(2, 4))]
    diameter = rng.choice([1.0, 2.0])
    wide, depth = rng.choice([diameter, diameter * 1.7]), 1.5
    text = f'kind = "slot"\ndepth = {depth}\nslot_width = {wide}\n'
    lines = ["polyline " + " ".join(f"{x},{y}" for x, y in points)]
    middle = shapely.LineString(points)
    swept, reached = middle.buffer(wide / 2, ROUND), _opened(middle.buffer(wide / 2, ROUND), diameter / 2)
    return Work("slot", lines, [text], [_tool("flat", diameter)], _floor(swept, reached, depth))


def _holes(rng: random.Random, kind: str) -> Work:
    radius = round(rng.uniform(1.0, 4.0), 2)
    centres = [(x, y) for x in (-9, 0, 9) for y in (-9, 0, 9) if rng.random() < 0.5] or [(0, 0)]
    depth, through = 2.0, rng.choice([0.0, 0.4])
    text = f'kind = "{kind}"\n' + (f"depth = {depth}\nthrough = {through}\n" if kind != "countersink" else "")
    if kind == "bore":
        diameter = round(max(radius * rng.uniform(0.7, 1.5), 0.5), 1)
        tool = _tool("flat", min(diameter, round(2 * radius - 0.2, 2)))
    elif kind == "drill":
        tool = _tool("drill", 2 * radius, 118)
    else:
        tool = _tool("v", 10.0, rng.choice([60, 90]))
    fall = 0.0 if kind == "bore" else tool[1].fall

    def judge(x: Floats, y: Floats) -> Wanted:
        away = np.min([np.hypot(x - a, y - b) for a, b in centres], axis=0)
        # a drill's full width reaches the depth, a countersink is as wide as the circle at the surface
        floor = -(radius - away) * fall - (0.0 if kind == "countersink" else depth + through)
        return Wanted(
            np.where(away <= radius + DOUBT, np.minimum(floor, 0.0), 0.0),
            np.where(away <= radius - DOUBT, floor, np.nan),
        )

    return Work(kind, [f"circle {x},{y} {radius}" for x, y in centres], [text], [tool], judge)


def _ream(rng: random.Random) -> Work:
    radius, depth, through = round(rng.uniform(1, 4), 2), 2.0, rng.choice([0.0, 0.5])
    texts = [f'kind = "{kind}"\ndepth = {depth}\nthrough = {through}\n' for kind in ("drill", "ream")]
    texts[0] += f"least = {1.9 * radius}\nmost = {2.1 * radius}\n"
    drill = _tool("drill", round(2 * radius - 0.2, 2), 118)
    centres = [(-8.0, 1.0), (6.0, -5.0)]

    def judge(x: Floats, y: Floats) -> Wanted:
        away = np.min([np.hypot(x - a, y - b) for a, b in centres], axis=0)
        point = -depth - through - np.maximum(drill[1].radius - away, 0.0) * drill[1].fall
        return Wanted(
            np.where(away <= radius + DOUBT, point, 0.0),
            np.where(away <= radius - DOUBT, -depth - through, np.nan),
        )

    lines = [f"circle {x},{y} {radius}" for x, y in centres]
    return Work("ream", lines, texts, [drill, _tool("reamer", 2 * radius)], judge)


def _face(rng: random.Random) -> Work:
    text = f'kind = "face"\npattern = "{rng.choice(["zigzag", "one-way", "spiral"])}"\n'

    def judge(x: Floats, y: Floats) -> Wanted:
        within = (np.abs(x) < 12) & (np.abs(y) < 12)
        return Wanted(np.zeros_like(x), np.where(within, 0.0, np.nan))

    return Work("face", ["circle 0,0 5"], [text], [_tool("flat", rng.choice([6.0, 10.0]))], judge)


def _vcarve(rng: random.Random) -> Work:
    lines, shape = area(rng)
    angle = rng.choice([60, 90])
    tool = _tool("v", 160.0, angle)  # so wide that nothing but the depth can bind
    depth = 40.0
    text = f'kind = "vcarve"\ndepth = {depth}\nstepdown = 40\n'

    def judge(x: Floats, y: Floats) -> Wanted:
        points = shapely.points(x, y)
        away = np.where(shapely.contains_xy(shape, x, y), shapely.distance(shape.boundary, points), 0.0)
        roof = -away * tool[1].fall
        return Wanted(roof, np.where(away > DOUBT, roof, np.nan))

    return Work("vcarve", lines, [text], [tool], judge)


def _chamfer(rng: random.Random) -> Work:
    lines, shape = area(rng)
    side, angle, width, tip = rng.choice(["inside", "outside"]), 90, rng.choice([0.3, 0.8]), 0.3
    text = f'kind = "chamfer"\nside = "{side}"\nwidth = {width}\ntip_offset = {tip}\n'
    tool = _tool("v", 6.0, angle)

    def judge(x: Floats, y: Floats) -> Wanted:
        points = shapely.points(x, y)
        part = shapely.contains_xy(shape, x, y) ^ (side == "inside")
        away = shapely.distance(shape.boundary, points)
        slant = -np.maximum(width - away, 0.0) * tool[1].fall
        return Wanted(np.where(part, slant, -width * tool[1].fall - tip), np.full_like(away, np.nan))

    return Work(f"chamfer {side}", lines, [text], [tool], judge)


KINDS: dict[str, Callable[[random.Random], Work]] = {
    "pocket": lambda rng: _clear(rng, "pocket"),
    "adaptive": lambda rng: _clear(rng, "adaptive"),
    "rest": _rest,
    "contour": _contour,
    "slot": _slot,
    "drill": lambda rng: _holes(rng, "drill"),
    "bore": lambda rng: _holes(rng, "bore"),
    "countersink": lambda rng: _holes(rng, "countersink"),
    "ream": _ream,
    "face": _face,
    "vcarve": _vcarve,
    "chamfer": _chamfer,
}


@dataclass(frozen=True)
class AnyJob:
    """Works beside one another, the k-th in the k-th field."""

    works: list[Work]
    control: str
    output: str = ""

    @property
    def above(self) -> float:
        """How high the stock stands above zero, mm: where it is faced first."""
        return 1.5 if self.works[0].kind == "face" else 0.0

    @property
    def drawing(self) -> str:
        """Its text; a layer a work."""
        lines = []
        for k, work in enumerate(self.works):
            lines.append(f"layer W{k}")
            lines += [_moved(line, k * FIELD) for line in work.drawing]
        return "\n".join([*lines, ""])

    @property
    def tables(self) -> str:
        """Its job file."""
        made = [f"[stock]\nthickness = 50.0\nmargin = 12.0\nabove = {self.above}\n[heights]\nretract_z = 2.5\n"]
        number = 0
        for k, work in enumerate(self.works):
            for n, (text, _) in enumerate(work.tools, 1):
                made.append(f"[[tool]]\nnumber = {number + n}\n{text}")
            curves = "" if work.kind == "face" else f'curves = ["layer:W{k}"]\n'
            for n, text in enumerate(work.operations, 1):
                made.append(f"[[operation]]\n{text}tool = {number + n}\n" + curves)
            number += len(work.tools)
        return "\n".join([*made, f'[output]\npost = "{self.control}"\n{self.output}'])

    @property
    def shapes(self) -> dict[int, Shape]:
        """The shape of each tool by its number."""
        return dict(enumerate((shape for work in self.works for _, shape in work.tools), 1))


def _moved(line: str, by: float) -> str:
    words = line.split()
    moved = [f"{float(word.split(',')[0]) + by:.4f},{word.split(',')[1]}" if "," in word else word for word in words]
    return " ".join(moved)


def any_job(seed: int, kinds: tuple[str, ...], control: str) -> AnyJob:
    """Return a random job of some kinds for a control."""
    rng = random.Random(f"{seed} {control} {kinds}")
    works = [KINDS[kind](rng) for kind in sorted(kinds, key=lambda kind: kind != "face")]
    output = _some(rng, 'units = "in"', 'order = "1986"', "exact_path = true")
    if rng.random() < 0.5:
        output += f'[origin]\nxy = "{rng.choice(["lower-left", "centre"])}"\nz = "{rng.choice(["top", "bottom"])}"\n'
    return AnyJob(works, control, output)
