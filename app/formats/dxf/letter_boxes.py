"""What stands in the lines of a text: boxes of words and of fractions, and lines of boxes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ...model.curves import Curve
from .letters import LetterRun, LetterStyle, bar_curves


@dataclass(frozen=True)
class LetterBox:
    """Something that stands in a line: words, or a fraction of two rows.

    Attributes:
        rows: words and where they begin, from the box's beginning and from the baseline.
        advance, ink: along the baseline, drawing units.
        look: of the letters beside it. lift: where it stands between the bottom (0) and the top (1) of its line.
        bar: whether a line parts the rows.
    """

    rows: tuple[tuple[LetterRun, float, float], ...]
    advance: float
    ink: float
    look: LetterStyle
    lift: float = 0.0
    bar: bool = False

    @staticmethod
    def of(run: LetterRun, lift: float = 0.0) -> LetterBox:
        """Return the box of words alone."""
        return LetterBox(((run, 0.0, 0.0),), run.advance, run.ink, run.look, lift)

    def curves(self, x: float, y: float) -> Iterator[tuple[Curve, bool]]:
        """Yield its curves, begun at (x, y) on the baseline, and whether each is a stroke."""
        for run, right, up in self.rows:
            yield from run.curves(x + right, y + up)
        if self.bar:
            strokes = not any(run.letters.font for run, _, _ in self.rows)
            yield from bar_curves((x, y + self.look.height / 2), self.ink, self.look.height, strokes)


@dataclass
class LetterLine:
    """A line of boxes.

    Attributes:
        boxes: and where each begins. nominal: height of its capitals where it is empty.
        begin, end: between which the line lies, from the left edge of its column; end <= begin: it goes on without end.
        align: "l", "c" or "r". y: of its baseline.
        opens: it begins a column, because the text says so.
    """

    nominal: float
    begin: float = 0.0
    end: float = 0.0
    align: str = "l"
    boxes: list[tuple[LetterBox, float]] = field(default_factory=list)
    x: float = 0.0
    y: float = 0.0
    opens: bool = False

    @property
    def height(self) -> float:
        """Of its highest capitals, drawing units."""
        return max((box.look.height for box, _ in self.boxes), default=self.nominal)

    @property
    def ink(self) -> float:
        """From its beginning to the end of what is drawn, drawing units."""
        return max((at + box.ink for box, at in self.boxes), default=0.0)

    @property
    def runs(self) -> list[LetterRun]:
        """All the words in it."""
        return [run for box, _ in self.boxes for run, _, _ in box.rows]
