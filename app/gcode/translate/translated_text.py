"""The text in the other control's words, and what that control has in force behind each block of it."""

from __future__ import annotations

import math
import textwrap
from dataclasses import replace

from ...model.motion import Plane
from ...model.part import Units
from ..interpreter.block import BlockStep
from ..interpreter.codes import ModalGroup
from ..interpreter.dialect import DIALECT_RULES, Dialect
from ..interpreter.program import FeedMode, ModalState
from ..writer.blocks import Blocks
from ..writer.template_fields import spelled
from .translatable import TAPPING, TranslationSource

PLANES = {Plane.XY: "G17", Plane.ZX: "G18", Plane.YZ: "G19"}
JOINED = (Dialect.FANUC, Dialect.HAAS, Dialect.MACH3)
"""Alone their G43 and G49 may move Z, so that they stand in the block of the next move along Z."""
_TURNS = {1: "M3", -1: "M4", 0: "M5"}
MOST_DWELL_OFF_S = 1e-6
"""Seconds that a dwell may be off by the decimals of its word; more is a dwell of another length."""
MOST_FEED_OFF = 0.05
"""mm/min; where a feed would be rounded by more it has more digits than the post's."""
RARE_DIGITS = 4
"""Of S, and of F where it is no feed per minute, or a slow one."""


class TranslatedText:
    """Lines of the new program.

    Attributes:
        lines: the text so far.
        modal: what is in force behind them. motion: the G word that axis words obey, "" = say it.
        length: H of the length in force; waiting: that the next move along Z has to take with it, None = none.
        cycle: the drilling cycle in force, or "".
        optional: whether a switch may leave out the blocks to come.
    """

    def __init__(self, source: TranslationSource, units: Units, number: int) -> None:
        """Begin with the post's own first blocks, which bring the control to what a reader takes to be in force."""
        self.source, self.post = source, source.post
        self.modal = ModalState(units=units)
        self.motion = self.cycle = self.feed = ""
        self.length = 0
        self.waiting: int | None = None
        self.optional = False
        self._blocks = Blocks(self.post, units)
        self._path = self._blending(None, "G64")
        self._number = number
        for template in self.post.program.top:
            self.emit(self._filled(template))

    @property
    def lines(self) -> list[str]:
        """The text so far."""
        return self._blocks.lines

    def begin(self) -> None:
        """Write the blocks before the first one of the program."""
        for template in self.post.program.start:
            self.emit(self._filled(template))

    def end(self) -> None:
        """Write the blocks behind the last one."""
        self.leave_cycle()
        for template in self.post.program.end:
            self.emit(self._filled(template))

    def _filled(self, template: str) -> str:
        units = self.post.units.inch if self.modal.units is Units.INCH else self.post.units.mm
        return template.format(units=units, blending=self._path, program=self._number).strip()

    def emit(self, text: str) -> None:
        """Write a block; nothing where there is no text."""
        (self._blocks.optional_block if self.optional else self._blocks.block)(text)

    def choose(self, optional: bool) -> None:
        """Write blocks that a switch may leave out, or again those that it may not; these say anew how and how fast to
        move, since nobody knows what was done before them.
        """
        if self.optional and not optional:
            self.motion = self.feed = ""
        self.optional = optional

    def comment(self, text: str) -> None:
        """Write a comment in as many lines as the control needs; what a program reads goes on so that it can be put
        together.
        """
        if text.lower().startswith("hitofude"):
            self._blocks.note(text)
            return
        for line in textwrap.wrap(text, self.post.comments.width) or [""]:
            self._blocks.comment(line)

    def leave_cycle(self) -> None:
        """End the cycle that is in force."""
        if self.cycle:
            self.emit(self.post.drilling.cancel)
            self.cycle = self.motion = ""

    def modes(self, step: BlockStep) -> None:
        """Write what a block sets before its motion, in the order in which every control obeys it.

        Raises:
            InputError: it cannot be said.
        """
        after = step.states[1]
        if step.motion in TAPPING and ModalGroup.SPINDLE not in step.block.codes:
            after = replace(after, spindle=self.modal.spindle)  # the cycle itself may start it, over the hole
        self._tool(step)
        self._spindle(step, after)
        self._coolant(after)
        self._dwell(step)
        self.emit(" ".join(self._changed(after)))
        if after.work_offset != self.modal.work_offset:
            self.emit(after.work_offset)
        self._path_mode(step, after)
        self._length(after)
        self.modal = after

    def _changed(self, after: ModalState) -> list[str]:
        """Return the words of the modes that are others than before."""
        words, before = [], self.modal
        if after.units is not before.units:
            words.append(self.post.units.inch if after.units is Units.INCH else self.post.units.mm)
        if after.plane is not before.plane:
            words.append(PLANES[after.plane])
        if after.absolute is not before.absolute:
            words.append("G90" if after.absolute else "G91")
        if after.feed_mode is not before.feed_mode:
            words.append(after.feed_mode.value)
        if words:
            self.leave_cycle()
        if after.units is not before.units or after.feed_mode is not before.feed_mode:
            self.feed = ""
        return words

    def _tool(self, step: BlockStep) -> None:
        number, changes = step.block.get("t"), step.block.codes.get(ModalGroup.TOOL) == "M6"
        if number is None and not changes:
            return
        self.leave_cycle()
        self.emit(" ".join([*([f"T{round(number)}"] if number is not None else []), *(["M6"] if changes else [])]))
        if changes:
            self.modal = replace(self.modal, tool=step.states[1].tool, spindle=0)

    def _spindle(self, step: BlockStep, after: ModalState) -> None:
        words = []
        if after.speed != self.modal.speed:
            if DIALECT_RULES[self.post.dialect].fanuc_flow and after.speed != round(after.speed):
                raise self.source.refuse(step, "s", "", f"{self.post.title} takes whole speeds only")
            words.append(f"S{plain(after.speed)}")
        if after.spindle != self.modal.spindle:
            words.append(_TURNS[after.spindle])
        if words:
            self.leave_cycle()
        self.emit(" ".join(words))

    def spin(self, turning: int) -> None:
        """Have the spindle turn so within a block; its speed stays."""
        if turning != self.modal.spindle:
            self.emit(_TURNS[turning])
            self.modal = replace(self.modal, spindle=turning)

    def _coolant(self, after: ModalState) -> None:
        before, words = self.modal, self.post.coolant
        if (before.flood and not after.flood) or (before.mist and not after.mist):
            self.emit(words.off)
            before = replace(before, flood=False, mist=False)
        self.emit(words.flood if after.flood and not before.flood else "")
        self.emit(words.mist if after.mist and not before.mist else "")

    def _dwell(self, step: BlockStep) -> None:
        block = step.block
        if block.codes.get(ModalGroup.ONCE) != "G4":
            return
        letter = next(letter for letter in "pxu" if block.has(letter))
        rules = DIALECT_RULES[self.source.dialect]
        seconds = block.values[letter] * (
            rules.dwell_unit_s if letter in block.whole else rules.dwell_unit_with_point_s
        )
        self.dwell(step, seconds, letter)

    def dwell(self, step: BlockStep, seconds: float, letter: str = "p") -> None:
        """Write a dwell.

        Raises:
            InputError: the control counts it in coarser steps.
        """
        self.leave_cycle()
        unit = DIALECT_RULES[self.post.dialect].dwell_unit_s
        text = plain(seconds, 6) if unit == 1.0 else f"{round(seconds / unit)}"
        if abs(float(text) * unit - seconds) > MOST_DWELL_OFF_S:
            raise self.source.refuse(step, letter, "", f"{self.post.title} counts dwells in {unit:g} s")
        self.emit(f"G4 P{text}")

    def _path_mode(self, step: BlockStep, after: ModalState) -> None:
        """Say how corners may be rounded, where the block says it."""
        block, tolerance = step.block, after.path_tolerance
        if block.codes.get(ModalGroup.SMOOTHING) == "G187":
            text = self._blending(block.values["e"] * after.units.value if block.has("e") else None, "G64")
        elif ModalGroup.PATH in block.codes:
            code = block.codes[ModalGroup.PATH]
            text = self._blending(tolerance, code)
            if code != "G64" and not text:
                raise self.source.refuse(step, "g", code, f"{self.post.title} has no word for an exact path")
        else:
            return
        if text != self._path:
            self.emit(text)
            self._path = text

    def _blending(self, tolerance: float | None, code: str) -> str:
        """Return the post's word for a path mode; a tolerance that nobody says is the post's own, mm."""
        words, unit = self.post.blending, self.modal.units
        if code != "G64":
            return words.exact
        digits = self.post.digits(unit).X
        least = words.tolerance_mm if tolerance is None else tolerance
        return words.blend.format(blend=spelled(math.floor(least / unit.value * 10**digits + 1e-6), digits))

    def _length(self, after: ModalState) -> None:
        if after.length_offset == (self.length if self.waiting is None else self.waiting):
            return
        if self.post.dialect in JOINED:
            self.waiting = None if after.length_offset == self.length else after.length_offset
        else:
            self.emit(length_word(after.length_offset))
            self.length = after.length_offset

    def taken_length(self) -> str:
        """Return the length word that the next move along Z has to take with it, or "", and take it for said."""
        if self.waiting is None:
            return ""
        self.length, self.waiting = self.waiting, None
        return length_word(self.length)

    def feed_word(self, step: BlockStep, feed: float) -> str:
        """Return the F word of a motion of some feed, mm/min, "" where it is in force.

        Raises:
            InputError: the control has too few digits for it.
        """
        inverse = self.modal.feed_mode is FeedMode.INVERSE_TIME
        per_minute = self.modal.feed_mode is FeedMode.PER_MINUTE
        value = (feed if per_minute else step.feed) / (1.0 if inverse else self.modal.units.value)
        digits = self.post.digits(self.modal.units).F if per_minute else RARE_DIGITS
        if abs(round(value, digits) - value) * self.modal.units.value > MOST_FEED_OFF:
            digits = RARE_DIGITS
        text = plain(value, digits)
        if not float(text) > 0:
            raise self.source.refuse(step, "f", "", f"{self.post.title} has too few digits for the feed")
        text += "." if self.post.words.feed_point and "." not in text else ""
        if text == self.feed and not inverse:
            return ""
        self.feed = text
        return f"F{text}"


def length_word(number: int) -> str:
    """Return the word for a tool length, G49 for none."""
    return f"G43 H{number}" if number else "G49"


def plain(value: float, digits: int = RARE_DIGITS) -> str:
    """Return a number with no more digits than it needs."""
    text = f"{value:.{digits}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
