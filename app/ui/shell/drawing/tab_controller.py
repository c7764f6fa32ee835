"""Tabs by hand: clicks beside contours put them, clicks on them take them away; each is an undoable change of the
operation.
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
from ...views.canvas.marker_mode import MarkerMode

_PLACES = "tab_places"
"""Key of the parameter that says where tabs are."""


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
            prompt = "Tabs: click beside a contour, or on a tab to take it away; Esc ends"
            canvas.mark(MarkerMode(prompt, self._places, self._click))
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
        operation = self._operation
        if operation is None:
            return
        places = self._places()
        near = [place for place in places if math.dist(place, at) <= reach]
        kept = (
            tuple(place for place in places if place not in near)
            if near
            else (*places, (round(at[0], 3), round(at[1], 3)))
        )

        def make(job: Job) -> Job:
            return with_operation(job, self._index, with_values(operation, {_PLACES: kept}))

        self._panel.change("Remove tab" if near else "Put tab", make)
