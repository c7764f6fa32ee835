"""Parameters: numbers with numbers or names, some of a subroutine alone, some that the control itself sets."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...model.motion import Floats
from .block_fault import BlockFault

Key = int | str
Assign = Callable[[int, float], bool]
"""Sets a parameter of the control's own; False = it is none that can be set."""
System = Callable[[Key], float | None]
"""What the control says of a parameter of its own; None = it is none."""

LARGEST = 99_999
PLAIN = 5000
"""Up to this number no parameter is the control's own."""
MOST = 200_000
"""So many parameters may be set; a real program sets some hundred."""


class _CallersParameters(NamedTuple):
    """What is kept of a caller while a subroutine runs: its own parameters by name, and those by number."""

    named: dict[str, float]
    numbered: Floats


class Parameters:
    """Values by number or name.

    Attributes:
        plain: (5001,) values by number, NaN = not set; compiled code reads and writes them, too.
        changes: how often a value became another one; alike at two times = nothing has changed between.
    """

    def __init__(self, system: System, local_numbers: int, assign: Assign) -> None:
        """Begin with every parameter 0.

        Args:
            system: asked first. assign: told first of a value that is set.
            local_numbers: #1 to this one belong to the subroutine that is running.
        """
        self._system, self._assign = system, assign
        self._local = slice(1, local_numbers + 1)
        self.plain: Floats = np.full(PLAIN + 1, math.nan)
        self._everywhere: dict[Key, float] = {}
        self._here: dict[str, float] = {}
        self._callers: list[_CallersParameters] = []
        self.changes = 0

    def get(self, key: Key) -> float:
        """Return a value.

        Raises:
            Fault: a name that was never set, or a number out of range.
        """
        if isinstance(key, int) and 0 < key <= PLAIN:
            number = float(self.plain[key])
            if math.isnan(number):
                self._system(key)  # which is told that somebody asks for what nobody has set
                return 0.0
            return number
        own = self._system(key)
        if own is not None:
            return own
        value = self._place(key).get(key)
        if value is not None:
            return value
        if isinstance(key, str) and key.startswith(("_hal[", "_ini[")):
            raise BlockFault(f"the value of #<{key}> is known to the machine alone; write a number in its place.")
        if isinstance(key, str):
            raise BlockFault(f"the parameter #<{key}> has no value here; set it before.")
        if not 0 <= key <= LARGEST:
            raise BlockFault(f"there is no parameter #{key}; use 1 to {LARGEST}.")
        return 0.0

    def exists(self, key: str) -> bool:
        """Tell whether a named parameter has a value."""
        return self._system(key) is not None or key in self._place(key)

    def set(self, key: Key, value: float) -> None:
        """Give a parameter a value.

        Raises:
            Fault: the control's own cannot be set; the number is out of range; there are too many.
        """
        if isinstance(key, int) and not 0 < key <= LARGEST:
            raise BlockFault(f"there is no parameter #{key} to set; use 1 to {LARGEST}.")
        if isinstance(key, str) and self._system(key) is not None:
            raise BlockFault(f"#<{key}> is the control's own and cannot be set.")
        if isinstance(key, int) and key <= PLAIN:
            if self.plain[key] != value:
                self.changes += 1
                self.plain[key] = value
            return
        if isinstance(key, int) and self._assign(key, value):
            self.changes += 1
            return
        place = self._place(key)
        if place.get(key) != value:
            self.changes += 1
            place[key] = value
            if len(place) > MOST:
                raise BlockFault(f"the program sets more than {MOST} parameters; the reader stops here.")

    def values(self) -> tuple[tuple[Key, float], ...]:
        """Return every parameter that the program has set and can use here."""
        numbers = np.flatnonzero(~np.isnan(self.plain))
        plain = zip(numbers.tolist(), self.plain[numbers].tolist(), strict=True)
        return (*plain, *self._everywhere.items(), *self._here.items())

    def enter(self, arguments: dict[Key, float]) -> None:
        """Begin a subroutine with parameters of its own.

        Args:
            arguments: their values, by numbers that belong to the subroutine.
        """
        self._callers.append(_CallersParameters(self._here, self.plain[self._local].copy()))
        self._here = {}
        self.plain[self._local] = math.nan
        for key, value in arguments.items():
            assert isinstance(key, int)
            self.plain[key] = value
        self.changes += 1

    def leave(self) -> None:
        """Go back to the caller's parameters."""
        self._here, self.plain[self._local] = self._callers.pop()
        self.changes += 1

    def _place(self, key: Key) -> dict[Key, float]:
        named_here = isinstance(key, str) and not key.startswith("_")
        return self._here if named_here else self._everywhere  # type: ignore[return-value]  # names alone are kept here
