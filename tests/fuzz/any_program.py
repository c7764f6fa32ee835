"""Random valid programs as different CAM programs write them: subs, loops, compensation, arcs in three planes, cycles,
offsets, both units, and habits of layout.
"""

from __future__ import annotations

import random
from collections.abc import Callable

PLANES = {"G17": "XYIJ", "G18": "XZIK", "G19": "YZJK"}


class ProgramWriter:
    """Writes one program; every block is valid whatever was before it."""

    def __init__(self, seed: int, offsets: bool) -> None:
        self.rng = random.Random(seed)
        self.lines: list[str] = []
        self.subs: list[str] = []
        self.offsets = offsets
        self.labels = 100

    def text(self, count: int = 25) -> str:
        """Return the program of so many pieces."""
        self.lines = ["%", "G21 G90 G17 G40 G49 G80 G94", "S1000 M3", "F300", "G0 X1 Y2 Z5"]
        pieces: list[Callable[[], None]] = [self.line, self.line, self.arc, self.helix, self.radius_arc]
        pieces += [self.holes, self.loop, self.call, self.compensated, self.units, self.choice, self.relative]
        pieces += [self.shift, self.shift, self.length] if self.offsets else []
        for _ in range(count):
            self.rng.choice(pieces)()
        return self._spelled("\n".join([*self.lines, "M5", "M2", *self.subs, "%", ""]))

    def _spelled(self, text: str) -> str:
        """Write as somebody's post does: small letters, no blanks, numbers of blocks, ends of lines."""
        rng = self.rng
        if rng.random() < 0.2:
            text = text.lower()
        if rng.random() < 0.2:
            text = "\n".join(
                line if "o" in line.lower() or "(" in line else line.replace(" ", "") for line in text.split("\n")
            )
        if rng.random() < 0.2:
            lines = text.split("\n")
            plain = [bool(line) and line[0] not in "%oO#(" for line in lines]
            text = "\n".join(
                f"N{10 * k} {line}" if is_plain else line
                for k, (line, is_plain) in enumerate(zip(lines, plain, strict=True))
            )
        return text.replace("\n", rng.choice(["\n", "\n", "\r\n"]))

    def number(self, low: float = -20, high: float = 20) -> str:
        value = self.rng.uniform(low, high)
        forms = [f"{value:.3f}", f"{value:.1f}", f"[{value:.2f}+1]", f"{value:+.2f}", f"{round(value)}."]
        return self.rng.choice(forms)

    def put(self, *lines: str) -> None:
        self.lines += lines

    def line(self) -> None:
        letters = self.rng.sample("XYZ", self.rng.randint(1, 3))
        word = self.rng.choice(["G0 ", "G1 ", "G1 ", "G01 ", ""])
        if not word:
            self.put(self.rng.choice(["G0", "G1"]))
        self.put(word + " ".join(letter + self.number() for letter in letters))

    def arc(self) -> None:
        plane = self.rng.choice(list(PLANES))
        a, b, i, j = PLANES[plane]
        r = self.rng.randint(1, 9)
        word, turn = self.rng.choice(["G2", "G3", "G02"]), self.rng.choice(["", " P2"])
        sort = self.rng.randrange(3)
        if sort == 0:  # a quarter, in increments
            centre = f"{i}0 {j}{r}" if word == "G3" else f"{i}{r} {j}0"
            self.put(f"{plane} G91", f"{word} {a}{r} {b}{r} {centre}", "G90 G17")
        elif sort == 1:  # centres in program coordinates
            self.put(f"{plane} G0 {a}0 {b}0", f"G90.1 {word} {a}{2 * r} {b}0 {i}{r} {j}0{turn}", "G91.1 G17")
        else:
            self.put(f"{plane} {word} {i}{r} {j}-{r / 2}{turn}", "G17")

    def helix(self) -> None:
        plane = self.rng.choice(list(PLANES))
        a, b, i, _ = PLANES[plane]
        (w,) = set("XYZ") - {a, b}
        r = self.rng.randint(1, 9)
        self.put(
            f"{plane} G91 {self.rng.choice(['G2', 'G3'])} {a}{2 * r} {b}0 {w}{self.number(-3, 3)} {i}{r}", "G90 G17"
        )

    def radius_arc(self) -> None:
        r = self.rng.uniform(5, 20)
        turn = self.rng.choice([1, -1])
        self.put(f"G91 {self.rng.choice(['G2', 'G3'])} X{r:.3f} Y{r / 2:.3f} R{turn * r:.4f}", "G90")

    def holes(self) -> None:
        cycle = self.rng.choice(["G81", "G82 P0.2", "G83 Q1.5", "G73 Q1.5", "G85", "G89 P0.1"])
        level = self.rng.choice(["G98 ", "G99 ", ""])
        self.put(
            "G0 Z30", f"{level}{cycle} X{self.number()} Y{self.number()} Z{self.number(-9, -1)} R{self.number(1, 9)}"
        )
        self.put(*(f"{self.rng.choice('XY')}{self.number()}" for _ in range(self.rng.randint(0, 3))))
        if self.rng.random() < 0.3:
            self.put("G91", f"X3 Y1 L{self.rng.randint(1, 3)}", "G90")
        self.put("G80")

    def loop(self) -> None:
        self.labels += 1
        k = self.labels
        self.put(
            self.rng.choice(
                [
                    f"#1=0\nO{k} while [#1 LT {self.rng.randint(0, 4)}]\n"
                    f"G1 X[#1*1.5] Y[sin[#1*10]]\n#1=[#1+1]\nO{k} endwhile",
                    f"O{k} repeat [{self.rng.randint(0, 3)}]\nG91 G1 X1.5 Z-0.1\nG90\nO{k} endrepeat",
                    f"#2=3\nO{k} do\nG1 X#2 Y[#2*2]\n#2=[#2-1]\nO{k} while [#2 GT 0]",
                ]
            )
        )

    def choice(self) -> None:
        self.labels += 1
        k, value = self.labels, self.number()
        self.put(
            f"#<v>={value}", f"O{k} if [#<v> GT 0]", "G1 X#<v>", f"O{k} else", "G1 Y#<v> Z[abs[#<v>]]", f"O{k} endif"
        )

    def call(self) -> None:
        self.labels += 1
        k = self.labels
        self.subs += [
            f"O{k} sub",
            "G1 X#1 Y[#2+#1]",
            f"O{k + 50000} if [#3 GT 0]",
            f"O{k} call [#1+1] [#2] [#3-1]",
            f"O{k + 50000} endif",
            "G91 G3 X4 I2",
            "G90",
            f"O{k} endsub",
        ]
        self.put(f"O{k} call [{self.number()}] [{self.number()}] [{self.rng.randint(0, 3)}]")

    def compensated(self) -> None:
        side = self.rng.choice(["G41.1", "G42.1"])
        turn = "G3" if self.rng.random() < 0.5 else "G2"
        way = -1 if turn == "G2" else 1
        self.put(
            "G0 X0 Y-20 Z5",
            f"{side} D{self.rng.choice([1, 2, 3.175])}",
            "G1 X20 Y-10",
            f"G1 X30 Y{self.rng.randint(-10, 0)}",
        )
        self.put(
            f"{turn} X30 Y{20} R{self.rng.randint(20, 30)}" if way else "",
            "G1 X0 Y25",
            "G1 Y0",
            "G40 G1 X-20 Y-20",
            "G0 Z9",
        )

    def units(self) -> None:
        """Without a tool length: the interpreter without a machine forgets in which units that was."""
        self.put("G49", "G20" if self.rng.random() < 0.4 else "G21", "F30")

    def relative(self) -> None:
        self.put("G91", f"G1 X{self.number(-3, 3)} Z{self.number(-1, 1)}", f"Y{self.number(-3, 3)}", "G90")

    def shift(self) -> None:
        rng = self.rng
        words = " ".join(letter + self.number() for letter in rng.sample("XYZ", rng.randint(1, 3)))
        self.put(
            rng.choice(
                [f"G92 {words}", "G92.1", "G92.2", "G92.3", f"G52 {words}", f"G10 L2 P{rng.randint(1, 9)} {words}"]
                + [
                    f"G10 L20 P{rng.randint(1, 9)} {words}",
                    *(f"G5{k}" for k in (4, 5, 9)),
                    "G59.1",
                    "G59.3",
                    "G53 G0 X1",
                ]
                + [f"G28 {words}", "G30", "G28.1", "#5241=0"]
            )
        )

    def length(self) -> None:
        self.put(self.rng.choice([f"G43.1 Z{self.number()}", "G49", "G43 H1", "G43 H2"]))
