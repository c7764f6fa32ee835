"""Codes that set what is in force, in the order in which a control obeys those of one block."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from ...model.motion import Plane
from ...model.part import Units
from .block import Block
from .codes import ModalGroup
from .compensation import Compensation
from .control import Control
from .dialect import Dialect
from .expression import whole
from .foreign_codes import REMEDY
from .offsets import ZERO, Place, added, offset_name, replaced, taken
from .options import ToolOffset
from .program import BlockFault, EventKind, FeedMode
from .scaled_program import mirror, scale
from .turned_program import choose_polar, turn_program

PLANES = {"G17": Plane.XY, "G18": Plane.ZX, "G19": Plane.YZ}

LARGEST_SPEED = 1e7
"""rpm; more is a slip of the keyboard."""

LARGEST_DWELL_S = 1e6
"""Seconds; more is a slip of the keyboard."""


def before_motion(control: Control, block: Block) -> None:
    """Obey everything of a block that comes before its motion, and is no offset.

    Raises:
        Fault: a word is missing or out of range, or there is something that no milling machine can do.
    """
    if control.compensation is not None and ModalGroup.RADIUS not in block.codes:
        _check_compensation(control, block)
    set_feed(control, block)
    _speed(control, block)
    _tool_word(control, block)
    for group, step in _STEPS:
        if group in block.codes:
            step(control, block)


def _speed(control: Control, block: Block) -> None:
    if ModalGroup.SPINDLE_MODE in block.codes:
        control.change(constant_surface=block.codes[ModalGroup.SPINDLE_MODE] == "G96")
    value = block.values.get("s")
    if value is None:
        return
    if not 0 <= value < LARGEST_SPEED:
        raise BlockFault(f"the spindle speed is {value:g}; it must be 0 or more.", letter="s")
    if value != control.modal.speed:
        control.change(speed=value)


def _tool_word(control: Control, block: Block) -> None:
    value = block.get("t")
    if value is None:
        return
    number = whole(value, "the tool number")
    if not 0 <= number < 10**8:
        raise BlockFault(f"the tool number is {number}; it must be 0 or more.", letter="t")
    control.selected = number


def _tool_change(control: Control, block: Block) -> None:
    code = block.codes[ModalGroup.TOOL]
    if not control.rules.tool_changes:
        raise BlockFault(f"{control.rules.title} changes no tools; write one file for each tool.", letter="m")
    number = control.selected
    if code == "M61":
        number = whole(block.need("q", code), "the tool number")
    stops = code != "M61" and control.rules.stops_at_change
    control.change(tool=number, spindle=0 if stops else control.modal.spindle)
    control.event(EventKind.TOOL_CHANGE, float(number))


def _spindle(control: Control, block: Block) -> None:
    code = block.codes[ModalGroup.SPINDLE]
    if code in ("M3", "M4", "M5"):
        control.change(spindle={"M3": 1, "M4": -1, "M5": 0}[code])
    elif code == "M19":
        control.change(spindle=0)


def _coolant(control: Control, block: Block) -> None:
    for code in block.coolant:
        control.change(**{"M7": {"mist": True}, "M8": {"flood": True}, "M9": {"mist": False, "flood": False}}[code])


def _dwell(control: Control, block: Block) -> None:
    if block.codes.get(ModalGroup.ONCE) != "G4":
        return
    letter = next((letter for letter in "pxu" if block.has(letter)), "")
    if not letter or (letter != "p" and not control.rules.fanuc_flow):
        raise BlockFault("G4 needs how long to wait; write P.", letter="g")
    rules = control.rules
    unit = rules.dwell_unit_s if letter in block.whole else rules.dwell_unit_with_point_s
    seconds = block.values.pop(letter) * unit
    if not 0 <= seconds <= LARGEST_DWELL_S:
        raise BlockFault(f"the dwell is {seconds:g} s; it must be 0 or more.", letter=letter)
    control.event(EventKind.DWELL, seconds)


def _plane(control: Control, block: Block) -> None:
    control.change(plane=PLANES[block.codes[ModalGroup.PLANE]])


def _units(control: Control, block: Block) -> None:
    control.change(units=Units.INCH if block.codes[ModalGroup.UNITS] == "G20" else Units.MM)


def _radius(control: Control, block: Block) -> None:
    code = block.codes[ModalGroup.RADIUS]
    if code == "G40":
        control.end_compensation()
        return
    if control.compensation is not None:
        raise BlockFault(f"{code}: cutter compensation is on already; write G40 before.", letter="g")
    if control.modal.plane is Plane.YZ:
        raise BlockFault(f"{code} works in the planes G17 and G18.", letter="g")
    radius = _cutter_diameter(control, block, code) / 2
    control.side = code
    if radius:
        sign = 1 if code.startswith("G41") else -1
        place = control.stray or control.at
        control.compensation = Compensation(sign * radius, control.modal.plane, place, control.rules.macro_b)


def _cutter_diameter(control: Control, block: Block, code: str) -> float:
    """Return the diameter that G41 or G42 means, mm."""
    if code.endswith(".1"):
        value = control.length(block, "d")
        if value is None:
            raise BlockFault(f"{code} needs a word D with the diameter.", letter="g")
        return value
    kept = float(control.modal.tool) if control.cutter_register is None else control.cutter_register
    number = whole(block.values.get("d", kept), "the D number")
    if number == 0:
        if not block.has("d") and control.cutter_register is None:
            control.warn(
                f"{code} without D offsets by the tool that is in the spindle, and the program names none; the path is "
                "read without it.",
                "g",
            )
        return 0.0
    row = control.tool_table.get(number)
    if row is None or not (row.diameter or row.diameter_known):
        if number in control.register_diameters:
            return control.register_diameters[number]
        if control.registers_hold_wear:
            return 0.0
        letter = "d" if block.has("d") else "g"
        raise BlockFault(
            f"{code} needs the diameter of tool {number}, which is in no tool table; read the program with one.", letter
        )
    return row.diameter


def _check_compensation(control: Control, block: Block) -> None:
    """Refuse what cannot be done while cutter compensation is on."""
    for group in (ModalGroup.PLANE, ModalGroup.OFFSET, ModalGroup.LENGTH, ModalGroup.TOOL, ModalGroup.TURNING):
        code = block.codes.get(group)
        if code not in (None, "G17", "G18", "G19") or (
            code is not None and PLANES.get(code) is not control.modal.plane
        ):
            raise BlockFault(
                f"{code} cannot be while cutter compensation is on; write G40 before.", letter=code[0].lower()
            )
    once = block.codes.get(ModalGroup.ONCE)
    if once not in (None, "G4", "G9"):
        raise BlockFault(f"{once} cannot be while cutter compensation is on; write G40 before.", letter="g")


def _length(control: Control, block: Block) -> None:
    code = block.codes[ModalGroup.LENGTH]
    number, tool = 0, ZERO
    if code == "G43.1":
        tool = _replaced_by_words(control, block, control.offsets.tool)
        if ModalGroup.MOTION not in block.codes:  # else the motion takes the axis words too
            for letter in "xyz":
                block.values.pop(letter, None)
    elif code != "G49":
        number = _length_number(control, block, code)
        tool = _table_offset(control, number)
        tool = added(control.offsets.tool, tool) if code == "G43.2" else tool
        tool = taken(ZERO, tool) if code == "G44" else tool
        _warn_of_length(control, code, number)
    moved = taken(control.offsets.tool, tool)
    if moved != ZERO:
        control.at = added(control.at, moved)
    control.offsets.tool = tool
    control.change(length_offset=number)


def _warn_of_length(control: Control, code: str, number: int) -> None:
    """Tell of a length that is not that of the tool in the spindle; G43.2 adds another one on purpose."""
    tool = control.modal.tool
    if code != "G43.2" and number and tool and number != tool:
        control.warn(f"{code} H{number} takes the length of another tool than T{tool}, which is in the spindle.", "h")


def _length_number(control: Control, block: Block, code: str) -> int:
    """Return the H number that a G43 means."""
    value = block.get("h")
    if value is None:
        if control.rules.macro_b and control.modal.length_offset:
            return control.modal.length_offset  # H stays until another one
        if not control.rules.length_from_tool:
            raise BlockFault(f"{code} needs a word H on a {control.rules.title} control.", letter="g")
        return control.modal.tool
    number = whole(value, "the H number")
    if number < 0:
        raise BlockFault(f"the H number is {number}; it must be 0 or more.", letter="h")
    return number


def _table_offset(control: Control, number: int) -> Place:
    if number == 0 or not control.tool_table:
        return ZERO
    row = control.tool_table.get(number)
    if row is None:
        raise BlockFault(f"tool {number} is not in the tool table.", letter="h")
    return row.offset


def _replaced_by_words(control: Control, block: Block, place: Place) -> Place:
    for axis, value in control.axis_words(block):
        place = replaced(place, axis, value)
    return place


def _work_offset(control: Control, block: Block) -> None:
    code = block.codes[ModalGroup.OFFSET]
    if code == control.offsets.name and control.options.dialect is Dialect.LINUXCNC:
        return  # it goes on with the same one, whatever was set of it
    control.offsets.name = code
    if code == "G54.1":
        number = block.values.pop("p", None)
        if number is None:
            raise BlockFault("G54.1 needs a word P.", letter="g")
        control.offsets.name = offset_name(whole(number, "P of G54.1"), extended=True)
    control.set_parameters.choose(control.offsets, control.offsets.name)
    control.offsets_changed()


def _path(control: Control, block: Block) -> None:
    code = block.codes[ModalGroup.PATH]
    words, tolerance = [code], 0.0 if code != "G64" else None
    if code == "G64":
        if block.has("r"):
            control.warn("R of G64 is LinuxCNC's from 2.10 on; older ones refuse it.", "r")
        for letter in "pqr":
            value = block.values.pop(letter, None) if block.has(letter) else None
            if value is not None:
                words.append(f"{letter.upper()}{value:g}")
                tolerance = max(value * control.unit, 0.0) if letter == "p" else tolerance
    control.change(path=" ".join(words), path_tolerance=tolerance)


def _distance(control: Control, block: Block) -> None:
    control.change(absolute=block.codes[ModalGroup.DISTANCE] == "G90")


def _arc_distance(control: Control, block: Block) -> None:
    control.change(arc_absolute=block.codes[ModalGroup.ARC_DISTANCE] == "G90.1")


def _return_level(control: Control, block: Block) -> None:
    control.change(retract_to_r=block.codes[ModalGroup.RETURN] == "G99")


def _refused(control: Control, block: Block) -> None:
    """Refuse what would move the tool in a way that the reader does not follow."""
    refused = {"G7": "the diameter mode of lathes"}
    for code in block.codes.values():
        if code in refused:
            raise BlockFault(f"{refused[code]} ({code}) is not followed; {REMEDY}", letter="g")


_STEPS: tuple[tuple[ModalGroup, Callable[[Control, Block], None]], ...] = (
    (ModalGroup.TOOL, _tool_change),
    (ModalGroup.SPINDLE, _spindle),
    (ModalGroup.COOLANT, _coolant),
    (ModalGroup.ONCE, _dwell),
    (ModalGroup.PLANE, _plane),
    (ModalGroup.UNITS, _units),
    (ModalGroup.RADIUS, _radius),
    (ModalGroup.LENGTH, _length),
    (ModalGroup.OFFSET, _work_offset),
    (ModalGroup.PATH, _path),
    (ModalGroup.DISTANCE, _distance),
    (ModalGroup.ARC_DISTANCE, _arc_distance),
    (ModalGroup.RETURN, _return_level),
    (ModalGroup.ONCE, _refused),
    (ModalGroup.LATHE, _refused),
    (ModalGroup.POLAR, choose_polar),
    (ModalGroup.MIRRORING, mirror),
    (ModalGroup.SCALING, scale),
    (ModalGroup.TURNING, turn_program),
)
"""What each group does, in the order in which a control does it."""


def set_once(control: Control, block: Block) -> None:
    """Obey what changes offsets or tables at once: G10, G52, G92 and their like; takes their axis words.

    Raises:
        Fault: a word is missing or out of range.
    """
    code = block.codes.get(ModalGroup.ONCE)
    act = _ONCE.get(code or "")
    if code is None or act is None:
        return
    act(control, block)
    control.offsets_changed()
    if code in ("G10", "G52", "G92"):
        for letter in "xyz":
            block.values.pop(letter, None)


def _set_local(control: Control, block: Block) -> None:
    _need_axes(block, "G52")
    if control.offsets.local_is_set_here:
        control.set_parameters.forget_here()
    for axis, value in control.axis_words(block):
        control.offsets.set_local(axis, value)


def _call_here(control: Control, block: Block) -> None:
    if not block.has("xyz"):
        if control.rules.fanuc_flow and block.has("s"):
            return
        _need_axes(block, "G92")
    control.set_parameters.forget_here()
    for axis, value in control.axis_words(block):
        control.offsets.call_here(control.at, axis, value)


def _need_axes(block: Block, code: str) -> None:
    if not block.has("xyzabcuvw"):
        raise BlockFault(f"{code} needs axis words.", letter="g")


def _forget_here(control: Control, block: Block) -> None:
    control.set_parameters.forget_here()
    control.offsets.set_here, control.offsets.set_here_on = ZERO, True


def _suspend_here(control: Control, block: Block) -> None:
    control.offsets.set_here_on = False


def _restore_here(control: Control, block: Block) -> None:
    control.offsets.set_here = control.set_parameters.set_here(control.offsets.set_here)
    control.offsets.set_here_on = True


def _home_here(name: str) -> Callable[[Control, Block], None]:
    def act(control: Control, block: Block) -> None:
        control.set_parameters.forget_home(name)
        control.homes[name] = added(control.at, control.offsets.tool)

    return act


def _set_table(control: Control, block: Block) -> None:
    """Obey G10: L2 and L20 set a work offset, L1 and L10 to L13 the tool table."""
    kind = whole(block.need("l", "G10"), "L of G10")
    number = whole(block.need("p", "G10"), "P of G10")
    if kind in (2, 20):
        _set_work(control, block, kind, number)
    elif kind in (1, 10, 11, 12, 13):
        _set_tool(control, block, kind, number)
    elif not control.rules.fanuc_flow:
        raise BlockFault(f"G10 L{kind} is not known; expected L1, L2, L10, L11 or L20.", letter="l")


def _set_work(control: Control, block: Block, kind: int, number: int) -> None:
    offsets = control.offsets
    values = dict(control.axis_words(block))
    if number == 0 and control.rules.fanuc_flow:
        offsets.common = _replaced_by_words(control, block, offsets.common)
        return
    extended = kind == 20 and control.rules.fanuc_flow
    name = offsets.name if number == 0 else offset_name(number, extended)
    control.set_parameters.choose(offsets, name)
    if kind == 20 and not extended:
        offsets.call_work(name, control.at, values)
        return
    place = offsets.work.get(name, ZERO)
    for axis, value in values.items():
        place = replaced(
            place, axis, value if control.modal.absolute or not control.rules.fanuc_flow else place[axis] + value
        )
    offsets.work[name] = place
    if block.has("r"):
        offsets.turned[name] = math.radians(block.values["r"])


def _set_tool(control: Control, block: Block, kind: int, number: int) -> None:
    """Obey G10 L1 (LinuxCNC's row), or Fanuc's L10 to L13 (length, its wear, radius, its wear; wear is added)."""
    before = control.tool_table.get(number, ToolOffset())
    radius = control.length(block, "r")
    if control.rules.fanuc_flow:
        if radius is None:
            raise BlockFault("G10 needs a word R with the tool's value.", letter="g")
        if kind in (10, 11):
            z = radius + (before.offset[2] if kind == 11 else 0.0)
            control.tool_table[number] = replace(before, offset=replaced(before.offset, 2, z))
        return
    place = before.offset
    for axis, value in control.axis_words(block):
        tip = control.at[axis] + control.offsets.tool[axis]
        place = replaced(place, axis, value if kind == 1 else tip - _goal(control, kind, axis, value))
    control.tool_table[number] = ToolOffset(place, before.diameter if radius is None else 2 * radius)


def _goal(control: Control, kind: int, axis: int, value: float) -> float:
    """Return where G10 L10 (in program coordinates) and L11 (from G59.3) say that the tool's tip is, table
    coordinates.
    """
    if kind == 10:
        return value + control.modal.shift[axis]
    return value + control.offsets.work.get("G59.3", ZERO)[axis]


_ONCE: dict[str, Callable[[Control, Block], None]] = {
    "G10": _set_table,
    "G52": _set_local,
    "G92": _call_here,
    "G92.1": _forget_here,
    "G92.2": _suspend_here,
    "G92.3": _restore_here,
    "G28.1": _home_here("G28"),
    "G30.1": _home_here("G30"),
}


# What is fed at: G93 to G95 and F words, and in which units they are.


def _set_mode(control: Control, block: Block) -> None:
    code = block.codes[ModalGroup.FEED]
    mode = FeedMode(code)
    if mode is not control.modal.feed_mode or control.options.dialect is Dialect.LINUXCNC:
        control.change(feed_mode=mode)
        control.feed = math.nan


def set_feed(control: Control, block: Block) -> None:
    """Obey the feed mode and the F word of a block.

    Raises:
        Fault: the feed is less than 0.
    """
    if ModalGroup.FEED in block.codes:
        _set_mode(control, block)
    value = block.get("f")
    inverse = control.modal.feed_mode is FeedMode.INVERSE_TIME
    if value is None:
        control.feed = math.nan if inverse else control.feed
        return
    if value < 0:
        raise BlockFault(f"the feed rate is {value:g}; it must be greater than 0.", letter="f")
    control.feed = value * (1.0 if inverse else control.feed_unit(block)) or math.nan
    _warn_of_units(control, block, value)


def _warn_of_units(control: Control, block: Block, value: float) -> None:
    """Tell of an F that LinuxCNC takes in the units before those of its own block: 25 times as fast, or as slow, as it
    reads.
    """
    said = {"G20": Units.INCH, "G21": Units.MM}.get(block.codes.get(ModalGroup.UNITS, ""))
    if said is None or said is control.modal.units or control.options.dialect is not Dialect.LINUXCNC or not value:
        return
    if control.modal.feed_mode is not FeedMode.INVERSE_TIME:
        before, after = ("mm", "in") if said is Units.INCH else ("in", "mm")
        control.warn(
            f"F{value:g} stands in the block that changes the units, so LinuxCNC takes it as {value:g} {before}, not "
            f"{after}, a minute; write it in the next block.",
            "f",
        )
