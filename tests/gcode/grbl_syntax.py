"""What grbl 1.1 takes, from its documentation alone: doc/markdown/commands.md and the error codes of the project
gnea/grbl.
"""

from __future__ import annotations

import math
import re

MODAL_GROUPS = {
    "motion": "G0 G1 G2 G3 G38.2 G38.3 G38.4 G38.5 G80",
    "offset": "G54 G55 G56 G57 G58 G59",
    "plane": "G17 G18 G19",
    "distance": "G90 G91",
    "arc distance": "G91.1",
    "feed": "G93 G94",
    "units": "G20 G21",
    "radius": "G40",
    "length": "G43.1 G49",
    "program": "M0 M1 M2 M30",
    "spindle": "M3 M4 M5",
    "path": "G61",
    "once": "G4 G10 G28 G28.1 G30 G30.1 G53 G92 G92.1",
}
GROUP_OF = {code: group for group, codes in MODAL_GROUPS.items() for code in codes.split()} | {
    "M7": "M7",
    "M8": "coolant",
    "M9": "coolant",
}
VALUES = set("FIJKLNPRSTXYZ")
LINE = 70
"""Characters of a line with its comments; the buffer holds 80, that of some senders less."""


def grbl_errors(text: str) -> list[str]:
    """Return everything in a program that grbl would refuse, with its error number where it has one."""
    state = _State()
    return [
        f"{number}: {line}: {error}"
        for number, line in enumerate(text.splitlines(), start=1)
        for error in state.errors(line)
    ]


class _State:
    """What is in force."""

    def __init__(self) -> None:
        self.motion, self.feed, self.spindle, self.unit = "G0", 0.0, 0.0, 1.0
        self.at = {"X": math.nan, "Y": math.nan, "Z": math.nan}

    def errors(self, line: str) -> list[str]:
        bare = re.sub(r"\([^()]*\)", "", line).replace(" ", "")
        found = ["longer than a line may be (11)"] if len(line) > LINE else []
        found += ["a sign that acts at once"] if re.search(r"[?~!$\x18\x80-\uffff]", line) else []
        words = re.findall(r"([A-Z])([-+]?\d+\.?\d*|[-+]?\.\d+)", bare)
        if "".join(letter + number for letter, number in words) != bare:
            return [*found, "no words of letter and number (1, 2)"]
        return found + self._words(words) if words else found

    def _words(self, words: list[tuple[str, str]]) -> list[str]:
        codes = [letter + f"{float(number):g}" for letter, number in words if letter in "GM"]
        values = {letter: float(number) for letter, number in words if letter not in "GM"}
        found = [f"{code} is not supported (20)" for code in codes if code not in GROUP_OF]
        groups = [GROUP_OF.get(code, code) for code in codes]
        found += ["two words of a modal group (21)"] if len(groups) != len(set(groups)) else []
        found += ["a word twice (25)"] if len(values) + len(codes) != len(words) else []
        found += [f"{letter} is not known (20)" for letter in values if letter not in VALUES]
        found += ["a value below zero (4)"] if any(values.get(letter, 0) < 0 for letter in "FNPST") else []
        return found + self._carry_out(codes, values)

    def _carry_out(self, codes: list[str], values: dict[str, float]) -> list[str]:
        self.unit = 25.4 if "G20" in codes else 1.0 if "G21" in codes else self.unit
        self.feed, self.spindle = values.get("F", self.feed), values.get("S", self.spindle)
        self.motion = next((code for code in codes if GROUP_OF.get(code) == "motion"), self.motion)
        found = ["M3 without a speed"] if "M3" in codes and self.spindle <= 0 else []
        if "G4" in codes:
            return found + ([] if "P" in values else ["G4 without P (28)"])
        axes = {letter: values[letter] for letter in "XYZ" if letter in values}
        if axes and self.motion == "G80":
            found.append("axis words under G80 (31)")
        if axes and self.motion != "G0" and self.feed <= 0:
            found.append("no feed rate (22)")
        if self.motion in ("G2", "G3") and (axes or "I" in values or "J" in values):
            found += self._arc(axes, values)
        elif {"I", "J", "K", "R"} & values.keys():
            found.append("words that nothing uses (36)")
        self.at |= axes
        return found

    def _arc(self, axes: dict[str, float], values: dict[str, float]) -> list[str]:
        if not {"X", "Y"} & axes.keys():
            return ["an arc without an end (32)"]
        if not {"I", "J"} & values.keys():
            return ["an arc without a centre (35)"]
        start = complex(self.at["X"], self.at["Y"])
        end = complex(axes.get("X", start.real), axes.get("Y", start.imag))
        centre = start + complex(values.get("I", 0.0), values.get("J", 0.0))
        radius, off = abs(start - centre) * self.unit, abs(abs(end - centre) - abs(start - centre)) * self.unit
        return [] if off <= 0.005 or (off <= 0.5 and off <= 0.001 * radius) else [f"radii differ by {off:.4f} mm (33)"]
