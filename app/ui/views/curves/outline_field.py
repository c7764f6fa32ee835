"""The region's outline, r = f(z): a formula, or places and radii."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QLineEdit, QWidget

from ...framework.boxes import h_box
from ...framework.fields import field_name

if TYPE_CHECKING:
    from ....fitting.point_curves.region_profile import RegionProfile

USUAL = "0.01 + 0.02 * sin(pi * z)"


class OutlineField(QWidget):
    """One line of text; what it means is asked of the engine."""

    def __init__(self) -> None:
        super().__init__()
        self.edit = QLineEdit(USUAL)
        self.edit.setAccessibleName("r = f(z)")
        self.edit.setToolTip(
            "Radius, mm, from one point (z = 0) to the next (z = 1): a formula, or places: 0=0.01,0.5=0.03,1=0.01"
        )
        row = h_box(self, (0, 1, 0, 1), 8)
        row.addWidget(field_name("f(z)", self.edit))
        row.addWidget(self.edit, 1)

    def profile(self) -> RegionProfile:
        """Return the region that is asked for.

        Raises:
            ParameterError: it is no formula and no table, or not in range.
        """
        from ....fitting.point_curves.region_profile import profile_of_formula, profile_of_table

        text = self.edit.text().strip()
        return profile_of_table(text) if "=" in text else profile_of_formula(text)
