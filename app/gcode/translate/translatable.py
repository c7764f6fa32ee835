"""What a program may say so that another control can be told it; what has no counterpart there is refused by its
name.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ...core.errors import InputError
from ...model.motion import Plane
from ..interpreter.block import ALWAYS, POLAR, BlockStep
from ..interpreter.codes import CYCLES, ROTARY, TAKES, ModalGroup
from ..interpreter.dialect import DIALECT_RULES, Dialect
from ..interpreter.foreign_codes import UNITS_OF_MACH3
from ..interpreter.program import ProgramProblem
from ..interpreter.text import column_of
from ..posts import Post

ARC_MODES = (Dialect.LINUXCNC, Dialect.GRBL, Dialect.MACH3)
"""They know G91.1 and G92.1."""
_ALIKE_TEXT = """G0 G1 G2 G3 G4 G17 G18 G19 G20 G21 G40 G49 G54 G55 G56 G57 G58 G59 G61 G61.1 G64 G80 G90 G91 G90.1
G91.1 G93 G94 G97
G98 G99 G187 G15 G50 G50.1 G67 G69 M0 M1 M2 M30 M3 M4 M5 M7 M8 M9"""
ALIKE = frozenset(_ALIKE_TEXT.split())
"""Codes that mean the same everywhere, are said in another way, or end what is never in force in a program that can be
read.
"""
_SAID_OTHERWISE = ("G61.1", "G64", "G90.1", "G91.1", "G97", "G98", "G99", "G187")
"""Of these only what they mean is written, so that it is nothing whether the other control has the word."""
WRITTEN_OUT = ("G73", "G81", "G82", "G83", "G85", "G86", "G89")
"""Cycles that can be written as moves, dwells and M words, and mean the same."""
TAPPING = ("G74", "G84")
TAPS = {Dialect.LINUXCNC: (Dialect.FANUC, Dialect.HAAS), Dialect.FANUC: (Dialect.LINUXCNC, Dialect.HAAS)}
"""Controls whose tapping does with a floating holder what another one's does; Haas taps rigidly, and moves and M words
would let the feed override tear a tap.
"""
_BY_HAND = {
    "G87": "{0} goes in beside the axis with a spindle that stands at a known angle, for which {1} is told otherwise",
    "G88": "behind {0} the operator takes the tool out by hand, and where it then is {1} takes otherwise",
}
NO_SWITCH = (Dialect.GRBL,)
"""They do blocks with a slash whatever is asked for."""
SPLINES = frozenset({"G5", "G5.1", "G5.2", "G5.3", "G6.2"})
"""What they draw is written as lines and arcs."""
WRITTEN_AS_MOTIONS = frozenset({"G41", "G42", "G41.1", "G42.1", "G65", "M97", "M98", "M99"})
"""Cutter compensation and calls: what they make of the path is written."""
TABLE_LETTERS = frozenset("lpxyz")


@dataclass(frozen=True)
class TranslationSource:
    """A program in its own control's words.

    Attributes:
        name: of its file. lines: of its text.
        dialect: of its control.
        post: the words that it is to be written in.
    """

    name: str
    lines: tuple[str, ...]
    dialect: Dialect
    post: Post

    def refusal(self, line: int, text: str, word: tuple[int, int] | None = None) -> InputError:
        """Return the error that something cannot be said.

        Args:
            line: 1-based.
            text: why, without its end.
            word: where it begins and ends in the line's code; None = the whole line.
        """
        written = self.lines[line - 1]
        column, shown = 0, ""
        if word is not None:
            column, last = column_of(written, word[0]), column_of(written, word[1] - 1)
            shown = written[column - 1 : last]
        keep = f"take it out, or keep the program for {DIALECT_RULES[self.dialect].title}"
        return InputError(ProgramProblem(line, column, shown, f"{text}; {keep}.").message(self.name))

    def refuse(self, step: BlockStep, letter: str, code: str, text: str) -> InputError:
        """Return the error that a word of a block cannot be said; `code` = "" where the letter alone finds it."""
        words = [word for word in step.parsed.words if word.letter == letter]
        said = [
            word
            for word in words
            if isinstance(word.value, float) and code == f"{letter.upper()}{round(word.value, 2):g}"
        ]
        found = next(iter(said or words), None)
        return self.refusal(step.line, text, None if found is None else (found.begin, found.end))


def check_step(step: BlockStep, source: TranslationSource) -> None:
    """Refuse a block that the other control cannot be told.

    Raises:
        InputError: it names line, word and why.
    """
    title = source.post.title
    for key, line in step.requested:
        named = f"#{key}" if isinstance(key, int) else f"#<{key}>"
        raise source.refusal(
            line, f"what {named} is the program does not say, so what it makes of it cannot be written for {title}"
        )
    for code in [*step.block.codes.values(), *step.block.coolant, *step.block.unknown]:
        why = _missing(code, step, source)
        if why:
            raise source.refuse(step, code[0].lower(), code, why)
    for letter, why in _odd_words(step):
        raise source.refuse(step, letter, "", why.format(title))


def _missing(code: str, step: BlockStep, source: TranslationSource) -> str:
    """Return why a code cannot be said in the other control's words, or ""."""
    post, rules = source.post, DIALECT_RULES[source.post.dialect]
    if code == "M6":
        return "" if rules.tool_changes else f"{post.title} changes no tools, so each needs a file of its own"
    if code in TAPPING:
        return _untapped(code, step, source)
    if code in _BY_HAND:
        return _BY_HAND[code].format(code, post.title)
    if code in WRITTEN_OUT or code in SPLINES or (source.dialect is Dialect.MACH3 and code in UNITS_OF_MACH3):
        return ""
    if code in rules.missing and code not in _SAID_OTHERWISE and code not in WRITTEN_AS_MOTIONS:
        return f"{post.title} has no {code}"
    if code in ALIKE or code in WRITTEN_AS_MOTIONS or code in ("G43", "G95"):
        return ""
    special = _SPECIAL.get(code)
    if special is not None and special(step, source):
        return ""
    return f"{code} has no counterpart on {post.title} that is known to do the same"


def _untapped(code: str, step: BlockStep, source: TranslationSource) -> str:
    """Return why a tapping cycle cannot be said as the other control's own, or ""."""
    title, state = source.post.title, step.states[1]
    if source.post.dialect not in TAPS.get(source.dialect, ()):
        return f"{code} does not tap alike on {title}: how feed and spindle are coupled differs"
    if step.block.get("p"):
        return f"the dwell of {code} is at another place on {title}"
    if not state.absolute or state.plane is not Plane.XY or step.block.has("l"):
        return f"{code} under G91, in another plane or with L is not written for {title}"
    return ""


def _same_zero(step: BlockStep, source: TranslationSource) -> bool:
    """It changes nothing, and so need not be said."""
    return step.states[0].shift == step.states[1].shift


def _arc_mode_control(step: BlockStep, source: TranslationSource) -> bool:
    return _same_zero(step, source) or {source.dialect, source.post.dialect} <= set(ARC_MODES)


def _fanuc_likes(step: BlockStep, source: TranslationSource) -> bool:
    return _same_zero(step, source) or not {source.dialect, source.post.dialect} & {Dialect.LINUXCNC, Dialect.GRBL}


def _extended(step: BlockStep, source: TranslationSource) -> bool:
    return {source.dialect, source.post.dialect} <= {Dialect.FANUC, Dialect.HAAS}


def _home(step: BlockStep, source: TranslationSource) -> bool:
    """Without axis words every control means other axes."""
    return step.block.has("xyz") and not step.block.has("p")


def _machine(step: BlockStep, source: TranslationSource) -> bool:
    """Fanuc goes under G53 at rapid rate whatever else is said."""
    return step.motion == "G0" and step.states[1].absolute and step.block.has("xyz")


def _table(step: BlockStep, source: TranslationSource) -> bool:
    values = step.block.values
    return (
        values.get("l") == 2
        and values.get("p", 0) in range(1, 7)
        and values.keys() <= TABLE_LETTERS
        and step.states[1].absolute
    )


def _here(step: BlockStep, source: TranslationSource) -> bool:
    return step.block.has("xyz")


_SPECIAL = {
    "G10": _table,
    "G28": _home,
    "G30": _home,
    "G53": _machine,
    "G92": _here,
    "G92.1": _arc_mode_control,
    "G52": _fanuc_likes,
    "G54.1": _extended,
}


def _odd_words(step: BlockStep) -> Iterator[tuple[str, str]]:
    """Yield words that no code of the block takes, or that turn another axis, with the reason to refuse them."""
    block, codes = step.block, [*step.block.codes.values(), *step.block.coolant]
    taken = set(ALWAYS).union(*(TAKES.get(code, "") for code in [*codes, step.motion]))
    taken |= {"u"} if "G4" in codes else {"k"} if step.motion in CYCLES else set()
    for letter, value in block.values.items():
        if letter in POLAR:
            yield letter, "polar coordinates are not written for {}"
        elif letter in ROTARY and not (letter == "u" and block.codes.get(ModalGroup.ONCE) == "G4"):
            yield letter, f"the axis {letter.upper()} is not written for {{}}"
        elif letter not in taken:
            yield letter, "no code here takes this word, so it cannot be said for {}"
        elif (
            letter == "p"
            and step.motion in ("G2", "G3")
            and not block.codes.keys() & {ModalGroup.ONCE, ModalGroup.PATH, ModalGroup.CALL}
            and value != 1
        ):
            yield letter, "several turns in one block have no counterpart on {}"
