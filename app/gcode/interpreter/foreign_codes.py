"""What Fanuc, Haas and Mach3 write beside the codes that move the tool: modes to pass over, other spellings, cycles of
their own.
"""

from __future__ import annotations

import math
import re

from .block import Block, ParsedLine
from .codes import AXES, ROTARY, ModalGroup
from .control import Control
from .dialect import Dialect
from .expression import Key, ValueReader, evaluated, whole
from .flow import Flow, Subroutine
from .program import BlockFault

REMEDY = "write out the moves that it makes: the reader stops here."
"""What to do about a code that is known and not followed."""

_MODES = {"G5", "G5.1"}
"""High-speed machining (G5 P10000, G5.1 Q1): how exactly the control follows the path, not which."""

ENDS_NOTHING = frozenset({"G67"})
"""Ends of calls, which are never in force in a program that can be read."""

_PASSED = {
    "G8": "look-ahead",
    "G22": "a zone of the machine",
    "G23": "a zone of the machine",
    "G103": "look-ahead",
    "G107": "a cylinder",
    "G108": "look-ahead",
}

_ALARM = 3000
"""The parameter that stops the program with a message, whatever it is set to."""

_RIGID = "M29"
"""The spindle of the next tapping cycle follows the axis: how it turns, not where the tool goes."""

_CALL_FROM_FILES = "M198"
"""Fanuc's M98 of a program that lies on a card or a server."""

_CYCLES = {
    "G12": "a circular pocket",
    "G13": "a circular pocket",
    "G47": "engraved text",
    "G70": "a circle of holes",
    "G71": "an arc of holes",
    "G72": "a line of holes",
    "G31": "a move until a probe touches",
    "G36": "a tool that is measured",
    "G37": "a tool that is measured",
    "G66": "a program that is called behind each move",
    "G76": "a bore that the tool leaves beside its wall",
    "G77": "a bore from behind",
    "G150": "a pocket of the control's own",
    "G43.4": "a tool that tilts",
    "G43.5": "a tool that tilts",
}

_OTHERWISE = {
    "G30.1": "the way to a floating reference point",
    "G41.1": "a blade that is turned along the path",
    "G42.1": "a blade that is turned along the path",
    "G43.1": "a length along a tool that tilts",
}
"""What Fanuc does by codes that LinuxCNC uses for something else."""

_STARTS = {"M13": "M3", "M14": "M4"}
"""What builders of Fanuc's and Haas' machines start the spindle by, and the coolant with it."""

_BUILDERS_GROUPS = frozenset({ModalGroup.PINS, ModalGroup.STATE})
"""Groups of M codes that LinuxCNC has for its own, and other controls leave to who builds the machine: pins, saved
states.
"""
_BUILDERS_CODES = frozenset({"M50", "M51", "M52", "M53", "M61"})
"""Single ones of the same kind: overrides, a tool's number."""

_POLAR_TOO = frozenset({"G112", "G113"})
"""Work offsets of Haas that are polar interpolation on its newer controls, as on Fanuc's."""

UNITS_OF_MACH3 = {"G70": "G20", "G71": "G21"}
"""Its older names of the units."""

_ARGUMENTS: dict[str, int] = {
    letter: number for number, letter in enumerate("abcijkdef.h.m...qrstuvwxyz", 1) if letter != "."
}

LOOKED_AT = 200_000
"""Bytes in which numbers without a point are looked for."""

_BLOCK_TEXT = re.compile(
    rb"^[ \t]*(?:/[ \t]*)?(?:[:o][ \t]*[0-9]|[a-z#][ \t]*[-+.]?[0-9])", re.IGNORECASE | re.MULTILINE
)

_WHOLE_LENGTH = re.compile(rb"^[^(;\n]*[xyzijr][ \t]*+[-+]?0*+[1-9][0-9]*+(?!\.)", re.IGNORECASE | re.MULTILINE)

_WHOLE_FEED = re.compile(rb"^[^(;\n]*f[ \t]*+0*+[1-9][0-9]*+(?!\.)", re.IGNORECASE | re.MULTILINE)

_FEED_IN_STEPS = re.compile(rb"g[ \t]*(?:20|93|95)(?![0-9.])", re.IGNORECASE)
"""Inch, inverse time, a revolution: where Fanuc takes a feed without a point in steps, and not in mm/min."""

_LATHE = "this is a program for a lathe, whose X is a diameter, which is not read"

_LATHE_TOOL = re.compile(rb"^[^(;\n]*t[ \t]*[0-9]{4}(?![0-9.])", re.IGNORECASE | re.MULTILINE)
"""A tool with its offset, as T0101."""

_MILLS = re.compile(rb"^[^(;\n]*(?:y[ \t]*[-+.#\[0-9]|m[ \t]*0*6(?![0-9.]))", re.IGNORECASE | re.MULTILINE)
"""What no lathe has: a Y word, a tool change by M6."""

_BLOCK_BEHIND = re.compile(
    rb"[0-9.][ \t]*;[ \t]*(?:[a-z][ \t]*[-+]?[0-9.]+[ \t]*)+;?[ \t]*$", re.IGNORECASE | re.MULTILINE
)
"""A block, and behind the sign that ends it on Fanuc and Haas another one in the same line."""

_PROGRAM_FIRST = re.compile(rb"(?:\s|\([^)\n]*\)|;[^\n]*\n)*[:o][ \t]*[0-9]", re.IGNORECASE)
"""Blanks and comments, and behind them the number of a program."""

_UNITS = re.compile(rb"g[ \t]*[27][01](?![0-9.])", re.IGNORECASE)
"""G70 and G71 too: what they are on other controls than Mach3 is refused there."""


def is_leader(text: bytes) -> bool:
    """Tell whether nothing in a text looks like a block, so that it is the leader before a program's per cent sign."""
    return _BLOCK_TEXT.search(text) is None


def warn_behind_percent(control: Control, rest: bytes) -> None:
    """Tell that blocks behind a per cent sign are not read; programs of their own are told, or called, elsewhere."""
    if not is_leader(rest) and not (control.rules.fanuc_flow and _PROGRAM_FIRST.match(rest)):
        control.warn("the per cent sign ends the program here; the blocks behind it are not read.", "%")


def names_units(data: bytes) -> bool:
    """Tell whether a program says somewhere what its lengths are in."""
    return _UNITS.search(data) is not None


def warn_of_numbers(control: Control, data: bytes) -> None:
    """Tell what a program leaves to the control's settings: what a number without a point counts in, and its units."""
    whole_length = _WHOLE_LENGTH.search(data, 0, LOOKED_AT) if control.rules.least_mm != 1.0 else None
    if whole_length is not None:
        control.line = data.count(b"\n", 0, whole_length.end()) + 1
        control.warn(
            f"lengths without a decimal point count in {control.rules.least_mm:g} mm or {control.rules.least_inch:g} "
            "in here."
        )
    _warn_of_whole_feed(control, data)
    _warn_of_lathe(control, data)
    second = _BLOCK_BEHIND.search(data, 0, LOOKED_AT) if control.rules.macro_b else None
    if second is not None:
        control.line = data.count(b"\n", 0, second.end()) + 1
        control.warn(
            "what stands behind ; is passed over as a comment, and looks like a block; write it in a line.", ";"
        )
    if control.rules.fanuc_flow and data and not names_units(data) and control.options.units is None:
        control.line = 1
        control.warn("the program names no units (G20, G21); mm are taken.")


def _warn_of_whole_feed(control: Control, data: bytes) -> None:
    """Tell of a feed without a point, which a setting of the machine may take in steps far below its unit."""
    haas = control.options.dialect is Dialect.HAAS
    found = _WHOLE_FEED.search(data, 0, LOOKED_AT) if control.rules.macro_b else None
    if found is None or not (haas or _FEED_IN_STEPS.search(data, 0, LOOKED_AT)):
        return
    control.line = data.count(b"\n", 0, found.end()) + 1
    steps = "0.001 mm/min or 0.0001 in/min (Setting 77)" if haas else "0.01 in/min, 0.01 mm or 0.0001 in a revolution"
    control.warn(
        f"a feed without a decimal point is taken as it stands; the control may count it in {steps}. Write the point.",
        "f",
    )


def _warn_of_lathe(control: Control, data: bytes) -> None:
    """Tell of a program that changes tools as lathes do, and knows no Y."""
    found = _LATHE_TOOL.search(data, 0, LOOKED_AT) if control.rules.macro_b else None
    if found is not None and _MILLS.search(data) is None:
        control.line = data.count(b"\n", 0, found.end()) + 1
        control.warn(f"{_LATHE}: it has tools with offsets (T0101), and no Y.", "t")


def warn_of_uncalled(control: Control, flow: Flow) -> None:
    """Tell of programs behind the end that the program does not call."""
    others = flow.places.uncalled(flow.here)
    if others:
        control.line = others[0].at.line
        more = (
            f" and {len(others) - 1} more are programs of their own" if len(others) > 1 else " is a program of its own"
        )
        control.warn(f"O{others[0].label}{more} that nothing here calls; what stands there is not read.")


def warn_of_rotary(control: Control, block: Block) -> None:
    """Tell of axes that are not followed."""
    for letter in ROTARY:
        if letter in block.values:
            control.warn(f"the axis {letter.upper()} is not followed, only X, Y and Z are.", letter)


def adapt(control: Control, block: Block) -> None:
    """Take out of a block what does not change the path, and spell as LinuxCNC does what it spells otherwise.

    Raises:
        Fault: a cycle of the control's own, whose path the reader does not know.
    """
    if control.rules.splines != "G5" and block.codes.get(ModalGroup.MOTION) in _MODES and not block.has("xyzij"):
        code = block.codes.pop(ModalGroup.MOTION)
        _drop(block, "pqr")
        control.warn(f"{code} chooses how the control follows the path; it is passed over.", "g")
    if control.rules.macro_b:
        _pass_look_ahead(control, block)
        _refuse_lathe(block)
        _keep_cutter(control, block)
    _leave_to_builder(control, block)
    if control.options.dialect is Dialect.FANUC:
        _refuse_otherwise(block)
    if control.options.dialect is Dialect.MACH3:
        _take_radius(block)
        _go_to_switches(control, block)
    for code in list(block.unknown):
        if control.options.dialect is Dialect.MACH3 and code in UNITS_OF_MACH3:
            block.unknown.remove(code)
            _set_units(block, UNITS_OF_MACH3[code])
        elif code in _CYCLES:
            raise BlockFault(f"{code} is {_CYCLES[code]}, which is not followed; {REMEDY}", letter="g")
        if control.options.dialect is Dialect.HAAS and _is_work_offset_of_haas(code):
            block.unknown.remove(code)
            if code in _POLAR_TOO:
                control.warn(
                    f"{code} is a work offset of older Haas mills, and polar interpolation of newer ones.", "g"
                )
            block.codes[ModalGroup.OFFSET] = "G54.1"
            block.values.setdefault("p", float(code[1:]) - 109)
        elif code == _CALL_FROM_FILES and control.options.dialect is Dialect.FANUC:
            block.unknown.remove(code)
            block.codes[ModalGroup.CALL] = "M98"
        elif code in ENDS_NOTHING or code == _RIGID:
            block.unknown.remove(code)
        elif code in _PASSED:
            block.unknown.remove(code)
            _drop(block, "pq")
            control.warn(f"{code} ({_PASSED[code]}) is passed over.", "g")


def _leave_to_builder(control: Control, block: Block) -> None:
    """Take the M codes that LinuxCNC alone gives a meaning for unknown ones, and what is likely of others."""
    for group, code in list(block.codes.items()):
        if group in _BUILDERS_GROUPS or code in _BUILDERS_CODES:
            del block.codes[group]
            block.unknown.append(code)
    for code in [each for each in block.unknown if each in _STARTS]:
        block.unknown.remove(code)
        block.codes.setdefault(ModalGroup.SPINDLE, _STARTS[code])
        control.warn(f"{code} is the machine builder's own; it is taken for {_STARTS[code]} with coolant.", "m")


def _refuse_otherwise(block: Block) -> None:
    """Refuse what Fanuc does otherwise than LinuxCNC.

    Raises:
        Fault: the block has such a code.
    """
    for code in block.codes.values():
        if code in _OTHERWISE:
            raise BlockFault(f"{code} is {_OTHERWISE[code]}, which is not followed; {REMEDY}", letter="g")


def _pass_look_ahead(control: Control, block: Block) -> None:
    """Pass over G8 P, which is no mode of lathes here."""
    if block.codes.get(ModalGroup.LATHE) == "G8":
        del block.codes[ModalGroup.LATHE]
        block.unknown.append("G8")


def _is_work_offset_of_haas(code: str) -> bool:
    """Tell whether a code chooses one of its additional zeros; to Fanuc G112 and G113 are polar interpolation."""
    return code == "G154" or (code.startswith("G") and 110 <= float(code[1:]) <= 129)


def _keep_cutter(control: Control, block: Block) -> None:
    """Keep the number of a D word, which counts until another one: for each G41 and G42 behind it that has none."""
    if block.codes.get(ModalGroup.ONCE) == "G65" or "G96" in block.codes.values():
        return
    if "d" in block.values:
        control.cutter_register = block.values["d"]
        if ModalGroup.RADIUS not in block.codes and not block.unknown:
            _drop(block, "d")


def _refuse_lathe(block: Block) -> None:
    """Refuse the largest speed of a lathe's spindle, G50 S or G92 S.

    In a mill's safety line G50 ends scaling, among other codes or beside the M3 that S belongs to.

    Raises:
        Fault: the block is one.
    """
    code = next((code for code in block.codes.values() if code in ("G50", "G92")), "")
    alone = len(block.codes) == 1
    if code and alone and "s" in block.values and not block.has(AXES):
        raise BlockFault(f"{_LATHE}: {code} with S is the largest speed of its spindle.", letter="g")


def _take_radius(block: Block) -> None:
    """Spell G41 and G42 with P, a radius on Mach3, as LinuxCNC does with a diameter."""
    code = block.codes.get(ModalGroup.RADIUS)
    if code in ("G41", "G42") and "p" in block.values and "d" not in block.values:
        block.codes[ModalGroup.RADIUS] = f"{code}.1"
        block.values["d"] = 2.0 * block.values.pop("p")


def _go_to_switches(control: Control, block: Block) -> None:
    """Take G28.1 with axes for the way home that it is on Mach3: on others it notes where the tool is."""
    if block.codes.get(ModalGroup.ONCE) == "G28.1" and block.has(AXES):
        block.codes[ModalGroup.ONCE] = "G28"
        control.warn(
            "G28.1 sends its axes to their switches; where these are the machine alone knows, and what counts from "
            "there is read as if they were at its zero.",
            "g",
        )


def _set_units(block: Block, code: str) -> None:
    """Take a unit by another name.

    Raises:
        Fault: the block has both units.
    """
    if block.codes.setdefault(ModalGroup.UNITS, code) != code:
        raise BlockFault("the block says both inch and mm; keep one of G20, G21, G70 and G71.", letter="g")


def _drop(block: Block, letters: str) -> None:
    for letter in letters:
        block.values.pop(letter, None)


def stop_at_alarm(parsed: ParsedLine) -> None:
    """Stop where a program raises an alarm of its own.

    Raises:
        Fault: it does.
    """
    if any(key == _ALARM for key, _ in parsed.settings):
        raise BlockFault(f"the program stops here with an alarm of its own (#{_ALARM}).", column=-1)


def call_macro(flow: Flow, control: Control, block: Block) -> None:
    """Obey G65: call a program with arguments, which become #1 to #26 by their letters.

    Raises:
        Fault: the program is not in this file.
    """
    number = whole(block.need("p", "G65"), "P of G65")
    count = whole(block.values.get("l", 1.0), "L of G65")
    arguments: dict[Key, float] = {
        _ARGUMENTS[letter]: value for letter, value in block.values.items() if letter in _ARGUMENTS
    }
    if count > 0:
        flow.call(subroutine(flow, control, number), arguments, count)


# Jumps in the manner of Fanuc and Haas: GOTO, IF, WHILE ... DO, M97, M98, M99.


_WORDS = re.compile(r"/?(?:n[0-9]+)?(goto|if|while|end)(?![a-z])|/?(?:n[0-9]+)?(end|if|while)")

_DO = re.compile(r"do([0-9])$")

MOST_CALLS = 99_999
"""Of a subroutine in one block: L has five digits."""


def is_macro(code: str) -> bool:
    """Tell whether a line is a jump of macro B."""
    return _WORDS.match(code) is not None


def obey_macro(flow: Flow, control: Control, code: str) -> int:
    """Obey GOTO, IF, WHILE or END; return the index of what is left to obey, the settings behind THEN: the code's
    length = nothing.

    Raises:
        Fault: it is not one, or its goal is missing.
    """
    begun = _WORDS.match(code)
    assert begun is not None
    word = begun[1] or begun[2]
    values = ValueReader(code, control.options.limits.nesting, control.rules.macro_b)
    values.at = begun.end()
    if word == "goto":
        _goto(flow, control, values)
        return len(code)
    if word == "end":
        _end(flow, code[values.at :])
        return len(code)
    if code[values.at : values.at + 1] != "[":
        raise BlockFault(f"expected [ with a condition behind {word.upper()}.", column=-1 - values.at)
    value = evaluated(flow.first_value(values), control.parameters)
    holds = value != 0 and not math.isnan(value)
    if word == "while":
        _while(flow, code[values.at :], holds)
        return len(code)
    return _if(flow, control, values, holds)


def _if(flow: Flow, control: Control, values: ValueReader, holds: bool) -> int:
    code = values.code
    if code.startswith("then", values.at):
        return values.at + 4 if holds else len(code)
    if not code.startswith("goto", values.at):
        raise BlockFault("expected GOTO or THEN behind the condition.", column=-1 - values.at)
    values.at += 4
    if holds:
        _goto(flow, control, values)
    return len(code)


def _goto(flow: Flow, control: Control, values: ValueReader) -> None:
    go_to(flow, whole(evaluated(values.value(), control.parameters), "the number behind GOTO"))


def go_to(flow: Flow, number: int, at: int | None = None) -> None:
    """Go on at the block with an N word.

    Args:
        at: an offset in the program that the block is looked for in; None = in the one that is running.

    Raises:
        Fault: there is none.
    """
    to = flow.places.number(number, flow.here.offset if at is None else at)
    if to is None:
        raise BlockFault(f"there is no block N{number} to go to.")
    flow.jump(to)


def _while(flow: Flow, rest: str, holds: bool) -> None:
    number = _DO.fullmatch(rest)
    if number is None:
        raise BlockFault("expected DO 1, DO 2 or DO 3 behind the condition.")
    end = flow.places.loop_end(int(number[1]), flow.here.offset)
    if end is None:
        raise BlockFault(f"the loop DO {number[1]} has no END {number[1]}.")
    if holds:
        flow.frames[-1].ends[end.offset] = flow.here
    else:
        flow.frames[-1].ends.pop(end.offset, None)
        flow.next = flow.places.after(end)


def _end(flow: Flow, rest: str) -> None:
    begin = flow.frames[-1].ends.get(flow.here.offset)
    if begin is None:
        raise BlockFault(f"END {rest.upper()} ends no loop that is running.")
    flow.check_end(begin, begin)
    flow.jump(begin)


def call_or_return(flow: Flow, control: Control, block: Block) -> bool:
    """Obey M97, M98 and M99 of a block; False where M99 ends the program itself.

    Raises:
        Fault: what is called is missing.
    """
    code = block.codes.get(ModalGroup.CALL)
    if code is None:
        return True
    if code == "M99":
        if flow.frames[-1].label or len(flow.frames) > 1:
            if flow.frames[-1].called:
                raise BlockFault(
                    f"O{flow.frames[-1].label} is called by an O word, so endsub or return must end it, not M99.",
                    letter="m",
                )
            back = block.get("p")
            flow.leave()
            if back is not None and control.rules.fanuc_flow:
                go_to(flow, whole(back, "P of M99"), flow.next.offset - 1)  # in the line that called
            return True
        if block.has("p"):
            go_to(flow, whole(block.values["p"], "P of M99"))
            return True
        return False
    number, count = _called(flow, control, block, code)
    if count:
        flow.call(_begun_at(flow, block, _goal(flow, control, code, number)), None, count)
    return True


def _begun_at(flow: Flow, block: Block, called: Subroutine) -> Subroutine:
    """Return a subroutine from the block on that Q numbers, as Fanuc's M98 has it.

    Raises:
        Fault: there is no such block in it.
    """
    if not block.has("q"):
        return called
    number = whole(block.values["q"], f"Q of {block.codes[ModalGroup.CALL]}")
    to = flow.places.number(number, called.begin.offset - 1)  # in the line of the program's own number
    if to is None:
        raise BlockFault(f"there is no block N{number} in the program that is called.", letter="q")
    return called._replace(begin=to)


def _called(flow: Flow, control: Control, block: Block, code: str) -> tuple[int, int]:
    """Return which subroutine is called and how often; Fanuc writes both in P too: four digits of number, where no
    program has all the digits for its own.
    """
    number = whole(block.need("p", code), f"P of {code}")
    count = whole(block.values.get("l", 1.0), f"L of {code}")
    fanuc = code == "M98" and control.options.dialect is Dialect.FANUC
    if fanuc and not block.has("l") and number > 9999 and flow.places.subroutine(str(number)) is None:
        number, count = number % 10_000, number // 10_000
    if not 0 <= count <= MOST_CALLS:
        raise BlockFault(f"a subroutine cannot be called {count} times; use 1 to {MOST_CALLS}.", letter="l")
    return number, count


def _goal(flow: Flow, control: Control, code: str, number: int) -> Subroutine:
    if code == "M97":
        to = flow.places.number(number, flow.here.offset)
        if to is None:
            raise BlockFault(f"there is no block N{number} to call.", letter="p")
        return Subroutine(f"N{number}", to)
    return subroutine(flow, control, number, plain=control.rules.ngc_flow)


def subroutine(flow: Flow, control: Control, number: int, plain: bool = False) -> Subroutine:
    """Return a program to call.

    Args:
        plain: one that begins with sub is not for M98.

    Raises:
        Fault: it is not in this file, or not for M98.
    """
    found = flow.places.subroutine(str(number))
    if found is None:
        raise BlockFault(
            f"there is no subroutine O{number} in this file; a file of its own is not read, so put it into this one.",
            letter="p",
        )
    if plain and found.keyword == "sub":
        raise BlockFault(f"O{number} begins with sub, so O{number} call must call it, not M98.", letter="p")
    if flow.places.is_behind_the_end(found.at):
        control.warn(
            f"O{number} stands behind the per cent sign that ends the program; load it into the control by itself.", "p"
        )
    return Subroutine(str(number), flow.places.after(found.at))
