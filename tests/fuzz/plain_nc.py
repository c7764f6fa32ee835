"""A reader of NC texts that shares nothing with the program's own: words by a pattern, motions as straight lines."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

SAGITTA = 1e-4
"""mm; chords of arcs."""
THOUSANDTHS = ("fanuc", "haas")
"""Controls to whom a length without a point counts thousandths of a millimetre."""
_WORD = re.compile(r"([A-Z])([-+]?(?:\d+\.?\d*|\.\d+))")
_CYCLES = ("G73", "G81", "G82", "G83", "G85")

Place = tuple[float, float, float]


@dataclass(frozen=True)
class Cut:
    """A straight motion of a tool, mm."""

    tool: int
    start: Place
    end: Place
    rapid: bool


_ORIGIN = re.compile(r"ORIGIN_MM=([-\d.]+),([-\d.]+),([-\d.]+)")


class PlainReader:
    """Follows one text; the tool begins high above zero. Motions are in the drawing's coordinates."""

    def __init__(self, control: str, tool: int) -> None:
        self.control, self.tool = control, tool
        self.at: Place = (0.0, 0.0, 100.0)
        self.origin: Place = (0.0, 0.0, 0.0)
        self.cuts: list[Cut] = []
        self.motion, self.unit = "G0", 1.0
        self.cycle: dict[str, float] = {}
        self.initial, self.to_r = 0.0, control == "linuxcnc"

    def read(self, text: str) -> list[Cut]:
        """Return all motions."""
        if found := _ORIGIN.search(text.upper()):
            self.origin = (float(found[1]), float(found[2]), float(found[3]))
        for line in text.splitlines():
            code = re.sub(r"\(.*?\)|;.*", "", line.upper()).strip()
            if code and code[0] not in "%O":
                self._block([(letter, value) for letter, value in _WORD.findall(code)])
        return self.cuts

    def _block(self, words: list[tuple[str, str]]) -> None:
        codes = [f"{letter}{float(value):g}" for letter, value in words if letter in "GM"]
        values = {letter: self._length(letter, value) for letter, value in words if letter not in "GMN"}
        for code, unit in (("G20", 25.4), ("G21", 1.0)):
            self.unit = unit if code in codes else self.unit
        if {"G28", "G53", "G30"} & set(codes):
            self.at = (*self.at[:2], 100.0)
            return
        if "T" in values and ("M6" in codes or self.control != "grbl"):
            self.tool = int(values["T"])
        if {"G4", "G92", "G10", "G64", "G91", "M98", "G54", "G43"} & set(codes) and not {"X", "Y", "Z"} & set(values):
            return
        for code in codes:
            if code in ("G98", "G99"):
                self.to_r = code == "G99"
            if code in ("G0", "G1", "G2", "G3"):
                self.motion, self.cycle = code, {}
            elif code == "G80":
                self.motion, self.cycle = "G0", {}
            elif code in _CYCLES:
                self.initial = self.at[2] if self.motion not in _CYCLES else self.initial
                self.motion = code
        if {"X", "Y", "Z"} & set(values) or (self.motion in ("G2", "G3") and {"I", "J"} & set(values)):
            self._move(values)

    def _length(self, letter: str, value: str) -> float:
        if letter in "XYZIJKRQ":
            return float(value) * self.unit * (0.001 if self.control in THOUSANDTHS and "." not in value else 1.0)
        return float(value)

    def _move(self, values: dict[str, float]) -> None:
        goal: Place = (values.get("X", self.at[0]), values.get("Y", self.at[1]), values.get("Z", self.at[2]))
        if self.motion in _CYCLES:
            self.cycle |= {key: values[key] for key in ("Z", "R") if key in values}
            x, y, bottom, clear = goal[0], goal[1], self.cycle["Z"], self.cycle["R"]
            self._to((x, y, self.at[2]), True)
            self._to((x, y, clear), True)
            self._to((x, y, bottom), False)
            self._to((x, y, clear if self.to_r else max(self.initial, clear)), False)
        elif self.motion in ("G0", "G1"):
            self._to(goal, self.motion == "G0")
        else:
            self._arc(goal, values.get("I", 0.0), values.get("J", 0.0))

    def _arc(self, goal: Place, i: float, j: float) -> None:
        (x, y, z), radius = self.at, math.hypot(i, j)
        centre = x + i, y + j
        first = math.atan2(-j, -i)
        sweep = math.atan2(goal[1] - centre[1], goal[0] - centre[0]) - first
        turn = 1 if self.motion == "G3" else -1
        sweep = turn * ((turn * sweep) % math.tau)
        if math.dist((x, y), goal[:2]) < 1e-9:
            sweep = turn * math.tau
        last = math.dist(centre, goal[:2])
        step = 2 * math.acos(max(1 - SAGITTA / max(radius, 1e-3), -1.0))
        count = max(2, math.ceil(abs(sweep) / max(step, 1e-3)))
        for k in range(1, count + 1):
            share = k / count
            angle, r = first + share * sweep, radius + share * (last - radius)
            place = (centre[0] + r * math.cos(angle), centre[1] + r * math.sin(angle), z + share * (goal[2] - z))
            self._to(place, False)

    def _to(self, goal: Place, rapid: bool) -> None:
        if goal != self.at:
            self.cuts.append(Cut(self.tool, self._drawn(self.at), self._drawn(goal), rapid))
            self.at = goal

    def _drawn(self, place: Place) -> Place:
        x, y, z = self.origin
        return place[0] + x, place[1] + y, place[2] + z
