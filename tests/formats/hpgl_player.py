"""A pen plotter of our own: plays HP-GL/2 back into strokes in mm, knowing nothing of how the program writes it."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from itertools import pairwise

Point = tuple[float, float]


@dataclass
class Stroke:
    pen: int
    width: float
    dashed: float
    points: list[Point]
    arcs: list[tuple[Point, float]] = field(default_factory=list)
    line: int = 0

    @property
    def length(self) -> float:
        return sum(math.dist(a, b) for a, b in pairwise(self.points))


@dataclass
class Sheet:
    size: Point = (0.0, 0.0)
    strokes: list[Stroke] = field(default_factory=list)
    circles: list[tuple[int, Point, float]] = field(default_factory=list)
    labels: list[tuple[Point, str, float]] = field(default_factory=list)
    windows: list[tuple[float, ...]] = field(default_factory=list)


class Plotter:
    """Obeys IN PS PG SP PW LT PU PD PA AA CI IW SI DI LO LB; whatever else is a fault."""

    def __init__(self, data: bytes) -> None:
        self.sheets = [Sheet()]
        self.at, self.down, self.pen, self.width, self.dashed, self.angle = (0.0, 0.0), False, 0, 0.35, 0.0, 0.0
        self.line = 0
        self.stroke: Stroke | None = None
        text = data.decode("ascii")
        at = 0
        while at < len(text):
            if text[at] in "\n;":
                at += 1
                continue
            word = text[at : at + 2]
            if word == "LB":
                end = text.index("\x03", at)
                self.sheets[-1].labels.append((self.at, text[at + 2 : end], self.angle))
                at = end + 1
                continue
            numbers = re.match(r"[-\d.,]*", text[at + 2 :])
            assert numbers is not None
            getattr(self, f"_{word.lower()}")([float(n) for n in numbers.group().split(",") if n])
            at += 2 + numbers.end()

    def _in(self, _: list[float]) -> None:
        self.down, self.dashed, self.stroke = False, 0.0, None

    def _ps(self, numbers: list[float]) -> None:
        self.sheets[-1].size = (numbers[1] / 40, numbers[0] / 40)

    def _pg(self, _: list[float]) -> None:
        self.sheets.append(Sheet())

    def _sp(self, numbers: list[float]) -> None:
        self.pen, self.stroke = int(numbers[0]), None

    def _pw(self, numbers: list[float]) -> None:
        self.width = numbers[0]

    def _lt(self, numbers: list[float]) -> None:
        assert not numbers or numbers[2] == 1
        self.line, self.dashed = (int(numbers[0]), numbers[1]) if numbers else (0, 0.0)

    def _pa(self, numbers: list[float]) -> None:
        assert not numbers

    def _pu(self, numbers: list[float]) -> None:
        self.down, self.stroke = False, None
        self._go(numbers)

    def _pd(self, numbers: list[float]) -> None:
        self.down = True
        self._go(numbers)

    def _aa(self, numbers: list[float]) -> None:
        assert self.down
        (cx, cy), angle = (n / 40 for n in numbers[:2]), math.radians(numbers[2])
        x, y = self.at[0] - cx, self.at[1] - cy
        steps = max(2, math.ceil(abs(angle) / math.radians(1)))
        for k in range(1, steps + 1):
            c, s = math.cos(angle * k / steps), math.sin(angle * k / steps)
            self._to((cx + c * x - s * y, cy + s * x + c * y))
        assert self.stroke is not None
        self.stroke.arcs.append(((cx, cy), angle))

    def _ci(self, numbers: list[float]) -> None:
        self.sheets[-1].circles.append((self.pen, self.at, numbers[0] / 40))

    def _iw(self, numbers: list[float]) -> None:
        self.sheets[-1].windows.append(tuple(n / 40 for n in numbers))

    def _si(self, numbers: list[float]) -> None:
        assert min(numbers) > 0

    def _di(self, numbers: list[float]) -> None:
        self.angle = math.atan2(numbers[1], numbers[0])

    def _lo(self, numbers: list[float]) -> None:
        assert numbers[0] in (1, 4, 7)

    def _go(self, numbers: list[float]) -> None:
        for x, y in zip(numbers[::2], numbers[1::2], strict=True):
            self._to((x / 40, y / 40))

    def _to(self, point: Point) -> None:
        if self.down:
            if self.stroke is None:
                self.stroke = Stroke(self.pen, self.width, self.dashed, [self.at], line=self.line)
                self.sheets[-1].strokes.append(self.stroke)
            self.stroke.points.append(point)
        self.at = point
