"""Millimetres or inches: on rulers, raster and status bar, in fields, at the mouse, and for what is typed; a drawing is
in mm.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from ...core.settings import ShownUnits
from ...drafting.language.unit_of_line import in_unit
from ..framework.fields import NumberField
from ..framework.shown_unit import show_in
from ..views.canvas.viewport import Viewport
from .main_window import MainWindow

SIZES = {ShownUnits.MM: 1.0, ShownUnits.INCH: 25.4}
"""Size of each, mm."""


class UnitChoice:
    """Lets the user choose the units that are shown, and remembers them."""

    def __init__(self, window: MainWindow) -> None:
        """Show what was chosen the last time."""
        self._preferences = window.preferences
        self._window = window
        for units in ShownUnits:
            window.actions_[f"units_{units.value}"].triggered.connect(partial(self._choose, units))
        self._show(window.preferences.settings.units)

    def meant(self, line: str) -> str:
        """Return a typed line of the shape language so that it says in which unit it is meant, where that is not mm."""
        return line if self._preferences.settings.units is ShownUnits.MM else in_unit(line, "in")

    def _choose(self, units: ShownUnits, *_: object) -> None:
        self._preferences.keep(replace(self._preferences.settings, units=units))
        self._show(units)

    def _show(self, units: ShownUnits) -> None:
        self._window.actions_[f"units_{units.value}"].setChecked(True)
        self._window.status.set_unit(SIZES[units], {ShownUnits.MM: "mm", ShownUnits.INCH: "in"}[units])
        show_in(SIZES[units])
        for field in self._window.findChildren(NumberField):
            field.follow_unit()
        self._window.drawing_page.refresh()
        for viewport in self._window.findChildren(Viewport):
            viewport.set_unit(SIZES[units])
