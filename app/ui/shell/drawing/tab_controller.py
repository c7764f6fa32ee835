"""Tabs by hand: clicks beside contours put them, drags move them, clicks on them take them away; each is an undoable
change of the operation.
"""

from __future__ import annotations

import math

from ....drafting.document import Document
from ....model.curves import Point
from ....model.fields import parameters_of, with_values
from ....model.job import Job
from ....model.operation import Operation
from ...panels.changes import with_operation
from ...panels.operation_groups import BY_HAND
from ...panels.side_panel import SidePanel
from ...views.canvas.canvas import Canvas
from ...views.canvas.marker_mode import MarkerMode, place_near

_PLACES = "tab_places"
"""Key of the parameter that says where tabs are."""

_PROMPT = "Tabs: click beside a contour; drag a tab to move it, click it to take it away; Esc ends"


class TabController:
    """Lets the canvas put the tabs of the operation that the panel shows."""

    def __init__(self, panel: SidePanel, canvas: Canvas, document: Document) -> None:
        self._panel, self._canvas, self._document, self._index = panel, canvas, document, 0
        panel.operation_form.tabs.connect(self.start)
        canvas.prompt_changed.connect(lambda _: self._show())

    def _show(self) -> None:
        """Have the button say what a click on it does."""
        self._panel.operation_form.hand.setText(BY_HAND if self._canvas.marker_mode is None else "Done")

    def start(self) -> None:
        """Begin, or end when it had begun."""
        canvas = self._canvas
        if canvas.marker_mode is not None:
            canvas.mark(None)
            return
        self._index = self._panel.operation_form.index
        if self._operation is not None:
            canvas.mark(MarkerMode(_PROMPT, self._places, self._click, move=self._move))
            canvas.setFocus()

    @property
    def _operation(self) -> Operation | None:
        """The operation, where it is of a kind that has tabs."""
        operations = self._document.job.operations
        operation = operations[self._index] if self._index < len(operations) else None
        return operation if operation is not None and _PLACES in parameters_of(type(operation)) else None

    def _places(self) -> tuple[Point, ...]:
        operation = self._operation
        return parameters_of(type(operation))[_PLACES].of(operation) if operation is not None else ()

    def _click(self, at: Point, reach: float) -> None:
        places = self._places()
        near = [place for place in places if math.dist(place, at) <= reach]
        if near:
            self._keep("Remove tab", tuple(place for place in places if place not in near))
        else:
            self._keep("Put tab", (*places, _rounded(at)))

    def _move(self, start: Point, end: Point, reach: float) -> None:
        """Move the tab that a drag began on; a drag from elsewhere is a click."""
        places = self._places()
        near = place_near(places, start, reach)
        if near is None:
            self._click(start, reach)
        else:
            self._keep("Move tab", tuple(_rounded(end) if place == near else place for place in places))

    def _keep(self, change: str, places: tuple[Point, ...]) -> None:
        """Give the operation other places of tabs, as one step that can be undone."""
        operation = self._operation
        if operation is None:
            return

        def make(job: Job) -> Job:
            return with_operation(job, self._index, with_values(operation, {_PLACES: places}))

        self._panel.change(change, make)


def _rounded(at: Point) -> Point:
    """Return a place to 0.001 mm."""
    return (round(at[0], 3), round(at[1], 3))
