"""What was, so that it can be again: whole frozen states, shared between entries."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.edit.syntax import Define
from app.edit.values import Value
from app.model.curves import Point
from app.model.job import Job

_LONGEST = 500


@dataclass(frozen=True, slots=True)
class State:
    """Everything that undo brings back.

    Attributes:
        layer: where new curves go.
        last: the point given last, mm.
        names: what the shape language has named. commands: what it has defined.
    """

    job: Job
    layer: str = "0"
    last: Point = (0.0, 0.0)
    names: Mapping[str, Value] = field(default_factory=dict)
    commands: Mapping[str, Define] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class _Step:
    name: str
    before: State


class History:
    """The last 500 changes and those taken back, each by name.

    Attributes:
        state: what is now.
    """

    def __init__(self, state: State) -> None:
        """Begin with a state that cannot be undone."""
        self.state = state
        self._undo: list[_Step] = []
        self._redo: list[_Step] = []
        self._open = False

    @property
    def undo_name(self) -> str | None:
        """Name of the change that undo takes back."""
        return self._undo[-1].name if self._undo else None

    @property
    def redo_name(self) -> str | None:
        """Name of the change that redo does again."""
        return self._redo[-1].name if self._redo else None

    def change(self, name: str, state: State, merge: bool = False) -> None:
        """Go to a new state.

        Args:
            name: shown in the Edit menu.
            merge: part of one longer edit: joined with the step before when that has the same name and was merged too.
        """
        if not (merge and self._open and self.undo_name == name):
            self._undo.append(_Step(name, self.state))
            del self._undo[:-_LONGEST]
        self._redo.clear()
        self._open = merge
        self.state = state

    def undo(self) -> str | None:
        """Go back one step and return its name, or None when there is none."""
        return self._swap(self._undo, self._redo)

    def redo(self) -> str | None:
        """Go forward one step and return its name, or None when there is none."""
        return self._swap(self._redo, self._undo)

    def _swap(self, source: list[_Step], target: list[_Step]) -> str | None:
        if not source:
            return None
        step = source.pop()
        target.append(_Step(step.name, self.state))
        self.state = step.before
        self._open = False
        return step.name
