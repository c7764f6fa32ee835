"""Millimetres or inches: on rulers, raster and status bar, in fields, at the mouse, and for what is typed; a drawing is
in mm.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from PySide6.QtWidgets import QWidget

from ....core.settings import ShownUnits
from ....drafting.language.unit_of_line import in_unit
from ...framework.commands import Commands, on_trigger
from ...framework.display_unit import set_display_unit
from ...framework.fields import NumberField
from ...framework.preferences import Preferences
from ...panels.drawing_page import DrawingPage
from ...views.canvas.viewport import Viewport
from .status_bar import StatusBar

SIZES = {ShownUnits.MM: 1.0, ShownUnits.INCH: 25.4}
"""Size of each, mm."""


class UnitChoice:
    """Lets the user choose the units that are shown, and remembers them."""

    def __init__(self, root: QWidget, status: StatusBar, preferences: Preferences, commands: Commands) -> None:
        """Show what was chosen the last time in every field and viewport below `root`."""
        self._root, self._status, self._preferences, self._commands = root, status, preferences, commands
        for units in ShownUnits:
            on_trigger(commands, f"units_{units.value}", partial(self._choose, units))
        self._show(preferences.settings.units)

    def meant(self, line: str) -> str:
        """Return a typed line of the shape language so that it says in which unit it is meant, where that is not mm."""
        return line if self._preferences.settings.units is ShownUnits.MM else in_unit(line, "in")

    def _choose(self, units: ShownUnits) -> None:
        self._preferences.keep(replace(self._preferences.settings, units=units))
        self._show(units)

    def _show(self, units: ShownUnits) -> None:
        self._commands[f"units_{units.value}"].setChecked(True)
        self._status.set_unit(SIZES[units], {ShownUnits.MM: "mm", ShownUnits.INCH: "in"}[units])
        set_display_unit(SIZES[units])
        for field in self._root.findChildren(NumberField):
            field.follow_unit()
        for page in self._root.findChildren(DrawingPage):
            page.refresh()
        for viewport in self._root.findChildren(Viewport):
            viewport.set_unit(SIZES[units])
