"""What was, so that it can be again: whole frozen states, shared between entries."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain, compress
from operator import is_not
from typing import Any, NamedTuple, TypeVar

from ..model.curves import Curve, Point, Spline
from ..model.job import Job
from ..model.part import Entity, Part
from ..model.reading import DrawingSource
from .expressions.syntax import CommandDefinition
from .expressions.values import Value
from .recorded_lines import RecordedLine

MOST_BYTES = 256 * 2**20
"""What steps may hold together; beyond that the oldest go."""

_STEP_BYTES, _ENTITY_BYTES, _POINT_BYTES, _POINTER_BYTES = 2000, 400, 160, 8
"""What a step takes by itself, and for each entity of its own, each of its points, and each entity that is shared with
others.
"""


Kind = TypeVar("Kind")


@dataclass(frozen=True, slots=True)
class HistoryState:
    """Everything that undo brings back.

    Attributes:
        layer: where new curves go.
        last: the point given last, mm.
        names: what the shape language has named. commands: what it has defined.
        recorded: the lines that drew the part.
        source: the drawing that the part was read from; None where it was drawn here.
    """

    job: Job
    layer: str = "0"
    last: Point = (0.0, 0.0)
    names: Mapping[str, Value] = field(default_factory=dict)
    commands: Mapping[str, CommandDefinition] = field(default_factory=dict)
    recorded: RecordedLine = field(default_factory=lambda: RecordedLine(Part()))
    source: DrawingSource | None = None

    def named(self, name: str) -> HistoryState:
        """Return it with another name of the part."""
        return replace(self, job=replace(self.job, part=replace(self.job.part, name=name)))


@dataclass(frozen=True, slots=True)
class _Step:
    """A change: its name, the state at its other end, and about how many bytes the two states do not share."""

    name: str
    other: HistoryState
    size: int


class ChangeNames(NamedTuple):
    """Names of all changes, the oldest first, and how many of them are done; the rest is what redo brings."""

    names: tuple[str, ...]
    done: int


class UndoHistory:
    """Changes done and those taken back, each by name, as many as `most_bytes` hold; the latest one always.

    Attributes:
        state: what is now.
    """

    def __init__(self, state: HistoryState, most_bytes: int = MOST_BYTES) -> None:
        """Begin with a state that cannot be undone."""
        self.state = state
        self._undo: list[_Step] = []
        self._redo: list[_Step] = []
        self._open = False
        self._most, self._bytes = most_bytes, 0

    @property
    def undo_name(self) -> str | None:
        """Name of the change that undo takes back."""
        return self._undo[-1].name if self._undo else None

    @property
    def redo_name(self) -> str | None:
        """Name of the change that redo does again."""
        return self._redo[-1].name if self._redo else None

    @property
    def names(self) -> ChangeNames:
        """Names of all changes."""
        return ChangeNames(tuple(step.name for step in (*self._undo, *reversed(self._redo))), len(self._undo))

    def change(self, name: str, state: HistoryState, merge: bool = False) -> None:
        """Go to a new state.

        Args:
            name: shown in the Edit menu.
            merge: part of one longer edit: joined with the step before when that has the same name and was merged too.
        """
        before = self.state
        if merge and self._open and self.undo_name == name:
            step = self._undo.pop()
            before, self._bytes = step.other, self._bytes - step.size
        self._bytes -= sum(step.size for step in self._redo)
        self._redo.clear()
        self._undo.append(_Step(name, before, _unshared(before, state)))
        self._bytes += self._undo[-1].size
        self._open = merge
        self.state = state
        self._forget_oldest()

    def undo(self) -> str | None:
        """Go back one step and return its name, or None when there is none."""
        return self._swap(self._undo, self._redo)

    def redo(self) -> str | None:
        """Go forward one step and return its name, or None when there is none."""
        return self._swap(self._redo, self._undo)

    def rename(self, name: str, kept: HistoryState) -> HistoryState:
        """Let the part have this name in all that was, is and will be again, which is no step; return what becomes of
        the state `kept`.
        """
        known: dict[int, Any] = {}

        def part(old: Part) -> Part:
            return replace(old, name=name)

        def job(old: Job) -> Job:
            return replace(old, part=once(old.part, part))

        def state(old: HistoryState) -> HistoryState:
            return replace(old, job=once(old.job, job))

        def once(old: Kind, change: Callable[[Kind], Kind]) -> Kind:
            if id(old) not in known:
                known[id(old)] = change(old)
            made: Kind = known[id(old)]
            return made

        before = (self.state, *(step.other for step in (*self._undo, *self._redo)), kept)
        after = [once(each, state) for each in before]
        self._undo = [replace(step, other=other) for step, other in zip(self._undo, after[1:], strict=False)]
        self._redo = [
            replace(step, other=other) for step, other in zip(self._redo, after[1 + len(self._undo) :], strict=False)
        ]
        self.state = after[0]
        return after[-1]

    def _swap(self, source: list[_Step], target: list[_Step]) -> str | None:
        if not source:
            return None
        step = source.pop()
        target.append(_Step(step.name, self.state, step.size))
        self.state = step.other
        self._open = False
        return step.name

    def _forget_oldest(self) -> None:
        gone = 0
        while self._bytes > self._most and gone < len(self._undo) - 1:
            self._bytes -= self._undo[gone].size
            gone += 1
        del self._undo[:gone]


def _unshared(one: HistoryState, other: HistoryState) -> int:
    """Return about how many bytes the first state holds beside what it shares with the other."""
    mine, theirs = one.job.part.entities, other.job.part.entities
    if mine is theirs:
        return _STEP_BYTES
    elsewhere = set(map(id, _moved(theirs, mine)))
    own = sum(
        _ENTITY_BYTES + _points(entity.curve) * _POINT_BYTES
        for entity in _moved(mine, theirs)
        if id(entity) not in elsewhere
    )
    return _STEP_BYTES + _POINTER_BYTES * len(mine) + own


def _moved(mine: tuple[Entity, ...], theirs: tuple[Entity, ...]) -> Iterator[Entity]:
    """Yield the entities that the other drawing has not at the same place."""
    return chain(compress(mine, map(is_not, mine, theirs)), mine[len(theirs) :])


def _points(curve: Curve) -> int:
    return len(curve.control_points) + len(curve.knots) if isinstance(curve, Spline) else 0
