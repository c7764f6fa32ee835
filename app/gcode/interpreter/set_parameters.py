"""Parameters of the control's own that a program sets: places of G28 and G30, the offset of G92, work offsets.

As LinuxCNC has it they are kept, and count from the code that asks for them on: G28 and G30 at once, a work offset when
it is chosen the next time, G92's offset with G92.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from .block_fault import BlockFault
from .offsets import OFFSETS, Place, WorkOffsets, replaced

_AXES = range(3)
_HOMES = {"G28": 5161, "G30": 5181}
_SET_HERE = 5211
_WORK, _APART, _TURN = 5221, 20, 9
_READ_ONLY = (range(5400, 5414), range(5420, 5429))
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
