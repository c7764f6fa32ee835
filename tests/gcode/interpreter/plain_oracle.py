"""What plain blocks mean, once more and slowly: strings, regular expressions and float(text)."""

import math
import re
from dataclasses import dataclass, field

import numpy as np

from app.gcode.interpreter.arc_kernels import centre_by_radius
from app.gcode.interpreter.program import MotionColumns
from app.model.motion import Motions, Plane
from tests.gcode.interpreter.plain_lane import LaneState, plain_blocks

WORD = re.compile(r"([A-Z])([+-]?(?:\d+\.?\d*|\.\d+))")
Row = tuple[float, ...]


@dataclass
class Oracle:
    """Does lines of text one by one; every line must be plain."""

    plain: LaneState = field(default_factory=LaneState)
    rows: list[Row] = field(default_factory=list)

    def do(self, text: str, number: int) -> None:
        text = re.sub(r"\([^)]*\)", "", text)
        if self.plain.semicolon_comments:
            text = text.partition(";")[0]
        text = re.sub(r"[ \t]", "", text).upper()
        words = dict(WORD.findall(text))
        assert sum(map(len, map("".join, words.items()))) == len(text), text
        plain = self.plain
        if "F" in words:
            plain.feed = float(words["F"]) * plain.scale
        if "G" in words:
            plain.motion = int(words["G"])
        if not words.keys() & set("XYZ"):
            return
        lengths = {
            c: float(w) * (plain.scale if "." in w else plain.bare_scale) for c, w in words.items() if c in "XYZIJKR"
        }
        start = [float(c) for c in plain.position]
        end = [self._reached(k, c, lengths) for k, c in enumerate("XYZ")]
        for k, c in enumerate("XYZ"):
            entry = k if plain.absolute else 3 + k
            if c in lengths and plain.known[k] < 0 and plain.known[entry] < 0:
                plain.known[entry] = len(self.rows)
        centre = [math.nan] * 3 if plain.motion < 2 else self._centre(start, end, lengths)
        feed = plain.feed if plain.motion else 0.0
        self.rows.append(
            (*start, *end, *centre, plain.motion, plain.plane, plain.motion > 1, feed, number, plain.state)
        )
        plain.position[:] = end

    def _reached(self, axis: int, letter: str, lengths: dict[str, float]) -> float:
        before, shift = float(self.plain.position[axis]), float(self.plain.shift[axis])
        if letter not in lengths:
            return before
        return lengths[letter] + shift if self.plain.absolute else before + lengths[letter]

    def _centre(self, start: list[float], end: list[float], lengths: dict[str, float]) -> list[float]:
        u, v, _ = Plane(self.plain.plane).axes
        centre = list(start)
        if "R" in lengths:
            turn = 1 if self.plain.motion == 3 else -1
            centre[u], centre[v] = centre_by_radius(start[u], start[v], end[u], end[v], lengths["R"], turn, 1e-6)
            return centre
        for k in (u, v):
            offset = lengths.get("IJK"[k], 0.0)
            centre[k] = offset + float(self.plain.shift[k]) if self.plain.arc_absolute else start[k] + offset
        return centre


def rows_of(motions: Motions) -> list[Row]:
    """Return motions as rows of numbers, in the oracle's order."""
    whole = zip(motions.kind, motions.plane, motions.turns, motions.feed, motions.line, motions.state, strict=True)
    places = np.hstack([motions.start, motions.end, motions.centre]).tolist()
    return [(*place, *numbers) for place, numbers in zip(places, whole, strict=True)]


def same_bits(a: list[Row], b: list[Row]) -> bool:
    """Whether rows are the same to the last bit and to the sign of zero; NaN is NaN."""
    return np.array(a, float).tobytes() == np.array(b, float).tobytes()


def lane(
    text: str | bytes, plain: LaneState | None = None, most_lines: int = 10**9
) -> tuple[list[Row], tuple[int, int]]:
    """Let the lane do a text from its first line; return the rows and where it stopped."""
    data = text if isinstance(text, bytes) else text.encode()
    columns = MotionColumns()
    at = plain_blocks(np.frombuffer(data, np.uint8), (0, 1), plain or LaneState(), columns, most_lines)
    return rows_of(columns.motions()), at
