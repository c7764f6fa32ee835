"""Jumps in the manner of Fanuc and Haas: GOTO, IF, WHILE ... DO, M97, M98, M99."""

from __future__ import annotations

import re

from .block import Block
from .block_fault import BlockFault
from .codes import ModalGroup
from .control import Control
from .expression import ValueReader, evaluated, whole
from .flow import Flow, Subroutine

_WORDS = re.compile(r"/?(?:n[0-9]+)?(goto|if|while|end)(?![a-z])|/?(?:n[0-9]+)?(end|if|while)")
_DO = re.compile(r"do([0-9])$")
MOST_CALLS = 99_999


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
    values = ValueReader(code, control.options.limits.nesting)
    values.at = begun.end()
    if word == "goto":
        _goto(flow, control, values)
        return len(code)
    if word == "end":
        _end(flow, code[values.at :])
        return len(code)
    if code[values.at : values.at + 1] != "[":
        raise BlockFault(f"expected [ with a condition behind {word.upper()}.", column=-1 - values.at)
    holds = evaluated(flow.first_value(values), control.parameters) != 0
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


def go_to(flow: Flow, number: int) -> None:
    """Go on at the block with an N word.

    Raises:
        Fault: there is none.
    """
    to = flow.places.number(number, flow.here.offset)
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
                go_to(flow, whole(back, "P of M99"))
            return True
        if block.has("p"):
            go_to(flow, whole(block.values["p"], "P of M99"))
            return True
        return False
    number, count = _called(control, block, code)
    if count:
        flow.call(_goal(flow, control, code, number), None, count)
    return True


def _called(control: Control, block: Block, code: str) -> tuple[int, int]:
    """Return which subroutine is called and how often; Fanuc writes both in P too: four digits of number."""
    number = whole(block.need("p", code), f"P of {code}")
    count = whole(block.values.get("l", 1.0), f"L of {code}")
    if code == "M98" and control.rules.fanuc_flow and not block.has("l") and number > 9999:
        number, count = number % 10_000, number // 10_000
    if not 0 <= count <= MOST_CALLS:
        raise BlockFault(f"a subroutine cannot be called {count} times; use 1 to {MOST_CALLS}.", letter="l")
    return number, count


def _goal(flow: Flow, control: Control, code: str, number: int) -> Subroutine:
    if code == "M97":
        to = flow.places.number(number, -1)
        if to is None:
            raise BlockFault(f"there is no block N{number} to call.", letter="p")
        return Subroutine(f"N{number}", to)
    return subroutine(flow, number, plain=control.rules.ngc_flow)


def subroutine(flow: Flow, number: int, plain: bool = False) -> Subroutine:
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
    return Subroutine(str(number), flow.places.after(found.at))
