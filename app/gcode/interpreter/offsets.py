"""Where zero is: work offsets with their rotation, G52, G92 and tool length, from program coordinates to the table's
and back.

As LinuxCNC has it: table = work offset + rotated (program + G52 + G92). The table's coordinates are those of the
machine less the tool's length.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from .program import BlockFault

Place = tuple[float, float, float]

ZERO: Place = (0.0, 0.0, 0.0)

OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
"""Their numbers in G10 L2 P are 1 to 9."""


@dataclass(slots=True)
class WorkOffsets:
    """Every offset that is set.

    Attributes:
        work: origin of each work offset by its name, mm. turned: its rotation about Z, radians.
        common: of all work offsets (Fanuc's external offset).
        name: of the one in force.
        local: G52. set_here: G92, kept while it is switched off. set_here_on: whether it is in force.
        tool: what G43 takes off.
        turn, pivot: what G68 turns the program by, radians, and about, program coordinates.
        local_is_set_here: G52 writes what G92 writes, as in LinuxCNC.
    """

    local_is_set_here: bool
    work: dict[str, Place] = field(default_factory=dict)
    turned: dict[str, float] = field(default_factory=dict)
    common: Place = ZERO
    name: str = "G54"
    local: Place = ZERO
    set_here: Place = ZERO
    set_here_on: bool = True
    tool: Place = ZERO
    turn: float = 0.0
    pivot: Place = ZERO

    @property
    def rotation(self) -> float:
        """Rotation of the program in force, radians: that of its work offset, and its own."""
        return self._offset_rotation + self.turn

    @property
    def _offset_rotation(self) -> float:
        return self.turned.get(self.name, 0.0)

    @property
    def within(self) -> Place:
        """What is added to program coordinates before they are turned with the work offset."""
        shifted = added(self.local, self.set_here if self.set_here_on else ZERO)
        return added(shifted, taken(self.pivot, turned(self.pivot, self.turn)))

    @property
    def shift(self) -> Place:
        """What is added to program coordinates after they are turned: all offsets together."""
        return added(self._origin, turned(self.within, self._offset_rotation))

    @property
    def _origin(self) -> Place:
        return added(self.work.get(self.name, ZERO), self.common)

    def to_table(self, program: Place) -> Place:
        """Return program coordinates as the table's."""
        return added(turned(program, self.rotation), self.shift)

    def to_program(self, table: Place) -> Place:
        """Return table coordinates as the program's."""
        return turned(taken(table, self.shift), -self.rotation)

    def set_local(self, axis: int, value: float) -> None:
        """Obey G52 for one axis."""
        if self.local_is_set_here:
            before = self.set_here if self.set_here_on else ZERO
            self.set_here, self.set_here_on = replaced(before, axis, value), True
        else:
            self.local = replaced(self.local, axis, value)

    def call_here(self, table: Place, axis: int, value: float) -> None:
        """Obey G92: from now on the point has this program coordinate."""
        if not self.set_here_on:
            self.set_here, self.set_here_on = ZERO, True
        now = self.to_program(table)[axis]
        self.set_here = replaced(self.set_here, axis, self.set_here[axis] + now - value)

    def call_work(self, name: str, table: Place, values: dict[int, float]) -> None:
        """Obey G10 L20: under this work offset the point has these program coordinates."""
        before, self.name = self.name, name
        goal = self.to_program(table)
        for axis, value in values.items():
            goal = replaced(goal, axis, value)
        moved = taken(table, self.to_table(goal))
        self.work[name] = added(self.work.get(name, ZERO), moved)
        self.name = before


def place_of(values: list[float]) -> Place:
    """Return three coordinates as a place."""
    x, y, z = values
    return (x, y, z)


def added(a: Place, b: Place) -> Place:
    """Return the sum."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def taken(a: Place, b: Place) -> Place:
    """Return the difference."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def replaced(place: Place, axis: int, value: float) -> Place:
    """Return a place with another value of one axis."""
    return (value if axis == 0 else place[0], value if axis == 1 else place[1], value if axis == 2 else place[2])


def turned(place: Place, angle: float) -> Place:
    """Return a place turned about Z, radians; by 0 it stays exactly as it is."""
    if angle == 0.0:
        return place
    c, s = math.cos(angle), math.sin(angle)
    return (place[0] * c - place[1] * s, place[0] * s + place[1] * c, place[2])


def offset_name(number: int, extended: bool = False) -> str:
    """Return the name of a work offset by its P number.

    Args:
        number: 1 to 9; with `extended` 1 to 300.
        extended: of G54.1 P.

    Raises:
        Fault: there is no such offset.
    """
    if extended and 1 <= number <= 300:
        return f"G54.1 P{number}"
    if not extended and 1 <= number <= len(OFFSETS):
        return OFFSETS[number - 1]
    raise BlockFault(f"there is no work offset P{number}; use 1 to {300 if extended else len(OFFSETS)}.", letter="p")


# Parameters of the control's own that a program sets: places of G28 and G30, the offset of G92, work offsets.
#
# As LinuxCNC has it they are kept, and count from the code that asks for them on: G28 and G30 at once, a work offset
# when it is chosen the next time, G92's offset with G92.3.


_AXES = range(3)

_HOMES = {"G28": 5161, "G30": 5181}

_SET_HERE = 5211
"""Number of the first parameter of G92."""

_WORK, _APART, _TURN = 5221, 20, 9
"""Number of the first parameter of G54, how many a work offset has, and which of them is its rotation."""

_READ_ONLY = (range(5400, 5414), range(5420, 5429))
"""Parameters of the tool in the spindle and of where it is."""

SETTABLE = frozenset(
    [first + axis for first in (*_HOMES.values(), _SET_HERE) for axis in _AXES]
    + [_WORK + _APART * k + item for k in range(len(OFFSETS)) for item in (*_AXES, _TURN)]
)
"""Numbers of what is followed; the axes X, Y and Z, and the rotation about Z."""


def counts_from(key: int) -> str:
    """Return the code that asks for a parameter."""
    homes = (code for code, first in _HOMES.items() if first <= key < first + len(_AXES))
    return next(homes, "G92.3" if key < _WORK else OFFSETS[(key - _WORK) // _APART])


@dataclass(slots=True)
class SetParameters:
    """What a program has set and no code has asked for yet: by number, in mm or degrees."""

    values: dict[int, float] = field(default_factory=dict)

    def set(self, key: int, value: float) -> bool:
        """Keep a value; return False where the number is none of these.

        Raises:
            BlockFault: it can only be read.
        """
        if any(key in numbers for numbers in _READ_ONLY):
            raise BlockFault(f"#{key} tells what the control knows and cannot be set; take the line out.")
        if key not in SETTABLE:
            return False
        self.values[key] = value
        return True

    def home(self, code: str, place: Place) -> Place:
        """Return the place of G28 or G30, that is `place` where nothing was set, machine coordinates."""
        return self._with(_HOMES[code], place)

    def forget_home(self, code: str) -> None:
        """A code of its own has set the place."""
        self._forget(_HOMES[code])

    def set_here(self, place: Place) -> Place:
        """Return the offset that G92.3 brings back, and forget what was set of it."""
        made = self._with(_SET_HERE, place)
        self.forget_here()
        return made

    def forget_here(self) -> None:
        """A code of its own has set the offset of G92."""
        self._forget(_SET_HERE)

    def choose(self, offsets: WorkOffsets, name: str) -> None:
        """Give a work offset what was set of it, and forget that."""
        if not self.values or name not in OFFSETS:
            return
        first = _WORK + _APART * OFFSETS.index(name)
        offsets.work[name] = self._with(first, offsets.work.get(name, (0.0, 0.0, 0.0)))
        if first + _TURN in self.values:
            offsets.turned[name] = math.radians(self.values.pop(first + _TURN))
        self._forget(first)

    def _with(self, first: int, place: Place) -> Place:
        for axis in _AXES:
            place = replaced(place, axis, self.values.get(first + axis, place[axis]))
        return place

    def _forget(self, first: int) -> None:
        for axis in _AXES:
            self.values.pop(first + axis, None)
