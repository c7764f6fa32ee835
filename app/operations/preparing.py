"""Operations one after the other, and beside them the strokes of the next one that asks nothing of what was cut."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from typing import NamedTuple

from ..core.beside import BesideWork, beside
from ..core.progress import Progress
from ..toolpath.operation_context import OperationContext, PreparedStrokes
from .from_outside import emit_prepared
from .registry import method_of

_PREPARED = 0.7
"""Share of an operation's progress at which its strokes are there."""


class _PreparedApart(NamedTuple):
    """Strokes, and what was collected beside them."""

    context: OperationContext
    strokes: PreparedStrokes | None


def carry_out(context: OperationContext, operations: Sequence[int], progress: Progress) -> None:
    """Make the moves of operations, in the order given.

    Where strokes need no earlier operation they are made while the ones before are still at work, one operation at a
    time: what comes out is what one after the other gives. Whoever observes steps sees them in their order, so then
    nothing is done ahead.

    Args:
        operations: indices in the job.

    Raises:
        ParameterError: an operation's parameters do not fit its tool.
        Cancelled: by progress.
    """
    with ExitStack() as begun:
        ahead = _Ahead(context, operations, progress, begun)
        for place, index in enumerate(operations):
            share = ahead.share(place)
            waiting = ahead.begun_for(place)
            if waiting is None:
                method_of(context.job.operations[index]).paths(context, index, share)
                continue
            apart, prepared = waiting.result()
            ahead.begin(place + 1)
            context.take(apart)
            if prepared is not None:
                emit_prepared(context, index, prepared, share.part(_PREPARED, 1.0))


class _Ahead:
    """The next operation that can be prepared beside those before it."""

    def __init__(
        self, context: OperationContext, operations: Sequence[int], progress: Progress, begun: ExitStack
    ) -> None:
        self._context, self._operations, self._progress, self._begun = context, operations, progress, begun
        self._place = -1
        self._work: BesideWork[_PreparedApart] | None = None
        self.begin(1)  # the first has nothing to be beside

    def share(self, place: int) -> Progress:
        """Return the progress of the operation at a place in the order."""
        count = len(self._operations)
        return self._progress.part(place / count, (place + 1) / count)

    def begun_for(self, place: int) -> BesideWork[_PreparedApart] | None:
        """Return the work that prepares the operation at a place, if it was begun."""
        return self._work if place == self._place else None

    def begin(self, first: int) -> None:
        """Begin with the first operation from a place on that can be prepared."""
        self._place, self._work = -1, None
        if self._context.observer is not None:
            return
        for place in range(first, len(self._operations)):
            index = self._operations[place]
            prepared = method_of(self._context.job.operations[index]).prepared
            if prepared is not None:
                self._make_areas(place)
                work = partial(_prepare, self._context, index, prepared)
                self._place = place
                self._work = self._begun.enter_context(beside(work, self.share(place).part(0.0, _PREPARED)))
                return

    def _make_areas(self, place: int) -> None:
        """Make the areas up to a place, in the order in which they are asked for, as both sides ask for them."""
        for index in self._operations[: place + 1]:
            operation = self._context.job.operations[index]
            if not (operation.HOLES or operation.FACES):
                self._context.areas.of(operation)


def _prepare(
    context: OperationContext,
    index: int,
    prepared: Callable[[OperationContext, int, Progress], PreparedStrokes | None],
    progress: Progress,
) -> _PreparedApart:
    apart = context.apart()
    return _PreparedApart(apart, prepared(apart, index, progress))
