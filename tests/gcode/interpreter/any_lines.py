"""Random lines of every kind that the reader knows, right and wrong ones: for reading them in two ways."""

import random

NUMBERS = ["0", "1", "2", "-1", "1.5", "-2.25", "3.", "-.5", "10", "0.001", "12.3456", "7"]
OPERATORS = ["+", "-", "*", "/", " mod ", "MOD", "**", " eq ", "NE", " gt ", "ge", " lt ", "le", " and ", " or ", "xor"]
FUNCTIONS = ["sin", "COS", "tan", "sqrt", "abs", "exp", "ln", "fix", "fup", "round", "acos", "asin"]
MODES = [
    "G17",
    "G18",
    "G19",
    "G90",
    "G91",
    "G90.1",
    "G91.1",
    "G94",
    "G21",
    "G20",
    "G40",
    "G49",
    "G54",
    "G98",
    "G99",
    "G97",
    "M3",
    "M4",
    "M5",
    "M7",
    "M8",
    "M9",
    "S100",
    "S0",
    "S2500",
    "S[1+#1]",
    "T1",
    "T4",
    "M6",
    "F10",
    "F1.5",
    "M48",
    "G80",
    "G8",
    "G55",
    "G92 X1",
    "G10 L2 P1 X1",
    "G64 P0.1",
    "M0",
    "M1",
]
CYCLES = ["G81", "G82", "G83", "G73", "G85", "G89", "", "G98 G81", "G99 G83", "G91 G81", "G90 G82", "G84", "G86"]
ODD = [
    "#<a>=1",
    "G1 X#<a>",
    "X1 A2",
    "G53 G0 X1",
    "G28",
    "Q1",
    "R2",
    "P3",
    "L1",
    "X1 X2",
    "G1 G0",
    "H1 G43",
    "D1",
    "X",
    "X[1",
    "X1]",
    "#=1",
    "#1",
    "G1.5",
    "(a(b)",
    "/G1 X1",
    "G4 P1 X1",
    "G4",
]
DWELLS = ["G4 P1", "G4 P0.5", "G4 P[1/2]", "G80", "M1", "M0", "M9"]
BLANK = ["(hi)", "; x", "", "  ", "(a) ;b"]


class AnyLines:
    """Lines of one random sequence."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)

    def program(self, count: int) -> list[str]:
        """Return a program's lines, but for its end."""
        head = self._random.choice(
            ["", "G21 G90 F100", "G20 F10", "G91 F50 G0 X0", "S100 M3 F200", "G18 F100", "F100 G0 X1 Y1 Z5"]
        )
        return [head, "#1=1", "#3=2", *(self._line() for _ in range(count))]

    def _number(self) -> str:
        return self._random.choice(NUMBERS)

    def _value(self) -> str:
        return self._expression(0) if self._random.random() < 0.3 else self._number()

    def _expression(self, depth: int) -> str:
        kind = self._random.random() if depth < 4 else 0.0
        if kind < 0.35:
            return self._random.choice([*NUMBERS, *(f"#{k}" for k in (1, 2, 3, 7, 31))])
        inner = self._expression(depth + 1)
        if kind < 0.6:
            return f"[{inner}{self._random.choice(OPERATORS)}{self._expression(depth + 1)}]"
        if kind < 0.75:
            return f"{self._random.choice(FUNCTIONS)}[{inner}]"
        if kind < 0.8:
            return f"atan[{inner}]/[{self._expression(depth + 1)}]"
        return (
            f"-{inner}"
            if kind < 0.85
            else f"#[{self._random.choice(['1+1', '#3', '7'])}]"
            if kind < 0.9
            else f"[{inner}]"
        )

    def _line(self) -> str:
        pick = self._random.choices(
            [
                self._setting,
                self._straight,
                self._arc,
                self._modes,
                self._cycle,
                lambda: [self._random.choice(DWELLS)],
                lambda: [self._random.choice(BLANK)],
                lambda: [self._random.choice(ODD)],
            ],
            [12, 28, 15, 15, 15, 5, 7, 3],
        )[0]
        number = ["N7"] if self._random.random() < 0.1 else []
        return self._random.choice([" ", "", "  "]).join([*number, *pick()]) + self._random.choice(["", "", "", "(c)"])

    def _setting(self) -> list[str]:
        return [f"#{self._random.choice(['1', '2', '3', '7', '31', '#3', '[1+1]', '5000'])}={self._value()}"]

    def _straight(self) -> list[str]:
        code = [self._random.choice(["G0", "G1", "g01", "G 1", "G00"])] if self._random.random() < 0.6 else []
        letters = self._random.sample("XYZxyz", self._random.randint(0, 3))
        axes = [letter + self._value() for letter in letters]
        return [*code, *axes, *(["F" + self._value()] if self._random.random() < 0.3 else [])]

    def _arc(self) -> list[str]:
        code = self._random.choice(["G2", "G3", "g03", ""])
        words = self._random.choice(
            [
                [f"X{self._number()}", f"I{self._number()}"],
                [f"I{self._random.choice('12345')}"],
                [f"X{self._number()}", f"Y{self._number()}", f"R{self._random.choice(['5', '-5', '[3*2]', '20'])}"],
            ]
        )
        return [code, *words, *(["Z" + self._number()] if self._random.random() < 0.2 else [])]

    def _modes(self) -> list[str]:
        return self._random.sample(MODES, self._random.randint(1, 3))

    def _cycle(self) -> list[str]:
        axes = [letter + self._value() for letter in self._random.sample("XYZ", self._random.randint(1, 3))]
        others = [letter + self._random.choice(["1", "2", "3"]) for letter in "RPQL" if self._random.random() < 0.55]
        return [self._random.choice(CYCLES), *axes, *others]
