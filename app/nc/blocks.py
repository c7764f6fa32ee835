"""The text of a program block by block, knowing what the control knows: position, motion and feed are modal."""

from __future__ import annotations

from app.model.moves import MoveKind
from app.model.part import Units
from app.nc.drilling import Hole
from app.nc.grid import Position, numeral, spelled
from app.nc.post import ArcCentre, Post

CONTINUED = "hitofude+"
"""What the second and later comments of a note begin with."""

Reached = tuple[int | None, int | None, int | None]
"""A position of which some axes may be unknown."""


class Blocks:
    """Lines of a program as they are written; words that would say what the control knows already are left out.

    Attributes:
        lines: the text so far.
        motion_line: 1-based line of the last motion block; 0 before the first.
        home_lines: 1-based lines that send the tool to the machine's own home, where no move of the program goes.
    """

    def __init__(self, post: Post, units: Units) -> None:
        """Begin an empty program."""
        self.lines: list[str] = []
        self.motion_line = 0
        self.home_lines: list[int] = []
        self._post = post
        self._digits = post.digits(units)
        self._number = post.numbers.start
        self.forget()

    def forget(self) -> None:
        """Take nothing for granted any more: at the start, and after a tool change."""
        self._position: Reached = (None, None, None)
        self._motion = ""
        self._cycle = ""
        self._feed: int | None = None

    def comment(self, text: str) -> None:
        """Write a comment, in several lines if it is wider than the control takes."""
        for line in _wrapped(text, self._post.comments.width):
            self._comment(line)

    def note(self, text: str) -> None:
        """Write a comment that a program reads; what is wider than the control takes goes on behind "hitofude+"."""
        for line in continued(text, self._post.comments.width):
            self._comment(line)

    def _comment(self, text: str) -> None:
        """Write one comment in the signs that the control takes."""
        comments = self._post.comments
        text = "".join(c if (c.isascii() and c.isalnum()) or c in comments.signs else "," for c in text)
        self.lines.append(f"{comments.open}{text.upper() if comments.capitals else text}{comments.close}")

    @property
    def z(self) -> int:
        """Where the tool is along Z, counts of the last decimal."""
        assert self._position[2] is not None
        return self._position[2]

    def block(self, text: str) -> None:
        """Write a block that is no motion; an empty text is left out."""
        if text:
            self._end_cycle()
            self.lines.append(text if text.startswith(("%", "O")) else self._numbered(text))

    def home(self, text: str) -> None:
        """Write a block that goes to the machine's own home."""
        self.block(text)
        self.home_lines.append(len(self.lines))

    def clearance(self, text: str, z: int) -> None:
        """Write a block that is the rapid to a height, in the post's own words."""
        self.block(text)
        self._moved(MoveKind.RAPID, (self._position[0], self._position[1], z))

    def rapid_z(self, z: int) -> None:
        """Go straight up or down at rapid rate."""
        self._write(MoveKind.RAPID, (self._position[0], self._position[1], z), {})

    def straight(self, kind: MoveKind, end: Position, feed: int = 0) -> None:
        """Go straight, by a rapid or a line; a move that is none after rounding is left out."""
        self._write(kind, end, {}, None if kind is MoveKind.RAPID else feed)

    def arc(self, kind: MoveKind, end: Position, centre: tuple[int, int], feed: int) -> None:
        """Go along an arc; X, Y, I and J are always written.

        Args:
            kind: clockwise or counter-clockwise.
            end: where to.
            centre: from the start to the centre, counts of the last decimal of I and J.
            feed: count of the last decimal of F.
        """
        digits = self._digits
        if self._post.arcs.centre is ArcCentre.ABSOLUTE:
            finer = 10 ** (digits.I - digits.X)
            centre = (centre[0] + (self._position[0] or 0) * finer, centre[1] + (self._position[1] or 0) * finer)
        words = {"X": self.number(end[0], digits.X), "Y": self.number(end[1], digits.Y)}
        self._write(kind, end, words | {"I": self.number(centre[0], digits.I), "J": self.number(centre[1], digits.J)}, feed)

    def hole(self, hole: Hole, steps: list[tuple[MoveKind, Position]]) -> None:
        """Write a hole as a canned cycle; its G words and its feed are left out where they are in force.

        Args:
            hole: its words.
            steps: the moves that the control makes of it.
        """
        words = []
        if hole.cycle != self._cycle:
            self._end_cycle()
            words.append(hole.cycle)
        words += [f"X{self.number(hole.x, self._digits.X)}", f"Y{self.number(hole.y, self._digits.Y)}"]
        heights = {"Z": hole.z, "R": hole.r} | ({"Q": hole.peck} if hole.peck else {})
        words += [letter + self.number(count, self._digits.Z) for letter, count in heights.items()]
        if hole.feed != self._feed:
            words.append(f"F{self._rate(hole.feed)}")
        self.lines.append(self._numbered(" ".join(words)))
        for kind, end in steps:
            if end != self._position:
                self._moved(kind, end)
        self._cycle, self._motion, self._feed = hole.cycle, "", hole.feed

    def _end_cycle(self) -> None:
        """Cancel the canned cycle that is in force."""
        if self._cycle:
            self.lines.append(self._numbered(self._post.drilling.cancel))
            self._cycle = ""

    def number(self, count: int, decimals: int) -> str:
        """Return a count of the last decimal as the control wants it in an axis word."""
        return numeral(count, decimals, self._post.words.trailing_zeros)

    def _write(self, kind: MoveKind, end: Reached, words: dict[str, str], feed: int | None = None) -> None:
        """Write a motion block with the axes and the feed that change, and remember what it did."""
        for letter, new, old in zip("XYZ", end, self._position, strict=True):
            if new is not None and new != old:
                words[letter] = self.number(new, getattr(self._digits, letter))
        if not words:
            return
        self._end_cycle()
        motion = self._post.words.motion[kind]
        if motion != self._motion or not self._post.words.modal_motion:
            words["G"] = motion
        if feed is not None and feed != self._feed:
            words["F"] = self._rate(feed)
            self._feed = feed
        block = (words[letter] if letter == "G" else letter + words[letter] for letter in self._post.words.order if letter in words)
        self.lines.append(self._numbered(" ".join(block)))
        self._moved(kind, end)

    def _moved(self, kind: MoveKind, end: Reached) -> None:
        """Remember what the last line did."""
        self._motion, self._position, self.motion_line = self._post.words.motion[kind], end, len(self.lines)

    def _rate(self, feed: int) -> str:
        """Return a feed rate without the zeros behind its point; and without the point, if the control can do so."""
        text = spelled(feed, self._digits.F)
        short = text.rstrip("0") if "." in text else f"{text}."
        return short if self._post.words.feed_point else short.rstrip(".")

    def _numbered(self, text: str) -> str:
        """Return a block with its N word, if the post wants one; LinuxCNC and Fanuc end at N99999, so it starts again there."""
        if not self._post.numbers.use:
            return text
        number, self._number = self._number, self._number + self._post.numbers.step
        if self._number > 99999:
            self._number = self._post.numbers.start
        return f"N{number} {text}"


def _wrapped(text: str, width: int) -> list[str]:
    """Return the text in lines of at most `width` characters, broken at spaces where there are any."""
    lines: list[str] = []
    while len(text) > width:
        cut = text.rfind(" ", 1, width + 1)
        cut = cut if cut > 0 else width
        lines.append(text[:cut])
        text = text[cut:].lstrip()
    return [*lines, text]


def continued(text: str, width: int) -> list[str]:
    """Return a note in lines of at most `width` characters; all but the first begin with CONTINUED.

    Nothing is lost: put together again the lines are the text, and none begins or ends in a space.
    """
    lines: list[str] = []
    room = width
    while len(text) > room:
        cut = next((k for k in range(room, 1, -1) if " " not in text[k - 1 : k + 1]), room)
        lines.append(text[:cut])
        text, room = text[cut:], width - len(CONTINUED)
    lines.append(text)
    return [lines[0], *(CONTINUED + line for line in lines[1:])]
