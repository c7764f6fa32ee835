"""Which points the curves go by: all, or those on the true shape where a program was made from a polyhedron (method
D).
"""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from ....fitting.point_curves.correction import CorrectionMove, CorrectionOptions, CorrectionScope
from ....fitting.point_curves.effective_method import EffectiveMethod, second_embodiment
from ....fitting.point_curves.effective_points import EffectiveOptions, RangeEnds
from ...framework.boxes import v_box
from ...framework.fields import ChoiceField, NumberField, NumberSpec

_USUAL = CorrectionOptions()
_EPSILON = 0.005
_LEFT_OUT, _CORRECTED = "left out", "corrected"


class PointsForm(QWidget):
    """Fields of which those are seen that matter."""

    def __init__(self) -> None:
        super().__init__()
        self.points = ChoiceField("Points", [(False, "All"), (True, "Effective")])
        self.epsilon = NumberField(
            NumberSpec(
                "Epsilon", low=1e-4, high=9.0, decimals=4, tip="Points so near to one segment belong to one facet"
            )
        )
        self.nearness = NumberField(
            NumberSpec(
                "Nearness", low=1e-4, high=9.0, decimals=4, tip="How near to these points the curve goes", auto="auto"
            )
        )
        self.ends = ChoiceField(
            "Ends", [(RangeEnds.OUTER, "Outer"), (RangeEnds.RATIO, "Ratio"), (RangeEnds.DISTANCE, "Distance")]
        )
        self.share = NumberField(
            NumberSpec(
                "Share", "", 0.0, 0.5, 3, False, "Points in so much of a facet from either end count as its ends"
            )
        )
        self.reach = NumberField(
            NumberSpec("Reach", high=1000.0, decimals=4, tip="Points so near to an end of a facet count as its end")
        )
        self.others = ChoiceField("Others", [(_LEFT_OUT, "Left out"), (_CORRECTED, "Corrected")])
        self.before = NumberField(
            NumberSpec("Before", "", 0, 50, 0, False, "Effective points before a facet that its correction goes by")
        )
        self.after = NumberField(
            NumberSpec("After", "", 1, 50, 0, False, "Effective points after a facet that its correction goes by")
        )
        self.move_to = ChoiceField(
            "Move", [(CorrectionMove.NEAREST, "Nearest"), (CorrectionMove.PERPENDICULAR, "Square")]
        )
        self.select = ChoiceField(
            "Correct", [(None, "All"), (CorrectionScope.RATIO, "Ratio"), (CorrectionScope.DISTANCE, "Distance")]
        )
        self.near = NumberField(
            NumberSpec("Share", "", 0.0, 1.0, 3, False, "Points in so much of a facet from either end are corrected")
        )
        self.moved = NumberField(
            NumberSpec(
                "At most", high=10.0, decimals=4, tip="Points that move no farther are corrected, others left out"
            )
        )
        column = v_box(self, spacing=4)
        for field in (
            self.points,
            self.epsilon,
            self.nearness,
            self.ends,
            self.share,
            self.reach,
            self.others,
            self.before,
            self.after,
            self.move_to,
            self.select,
            self.near,
            self.moved,
        ):
            column.addWidget(field)
        for choice in (self.points, self.ends, self.others, self.select):
            choice.chosen.connect(lambda _: self._show_what_matters())
        self._fill()

    def _fill(self) -> None:
        """Show what is usual."""
        for choice, value in (
            (self.points, False),
            (self.ends, RangeEnds.OUTER),
            (self.others, _LEFT_OUT),
            (self.move_to, CorrectionMove.NEAREST),
            (self.select, None),
        ):
            choice.show_value(value)
        for field, number in (
            (self.epsilon, _EPSILON),
            (self.share, 0.1),
            (self.reach, 0.1),
            (self.before, _USUAL.before),
            (self.after, _USUAL.after),
            (self.near, 0.5),
            (self.moved, 0.01),
        ):
            field.show_value(number)
        self.nearness.show_value(None)
        self._show_what_matters()

    def _show_what_matters(self) -> None:
        effective = self.points.value is True
        corrected = effective and self.others.value == _CORRECTED
        for field in (self.epsilon, self.nearness, self.ends, self.others):
            field.setVisible(effective)
        self.share.setVisible(effective and self.ends.value is RangeEnds.RATIO)
        self.reach.setVisible(effective and self.ends.value is RangeEnds.DISTANCE)
        for field in (self.before, self.after, self.move_to, self.select):
            field.setVisible(corrected)
        self.near.setVisible(corrected and self.select.value is CorrectionScope.RATIO)
        self.moved.setVisible(corrected and self.select.value is CorrectionScope.DISTANCE)

    def method(self) -> EffectiveMethod | None:
        """Return method D as the fields ask for it; None: the curves go by all points.

        Raises:
            ParameterError: it cannot be so; a sentence.
        """
        if not self.points.value:
            return None
        ends = self.ends.value
        assert isinstance(ends, RangeEnds)
        limit = {RangeEnds.OUTER: 0.0, RangeEnds.RATIO: self.share.number, RangeEnds.DISTANCE: self.reach.number}[ends]
        choose, nearness = EffectiveOptions(self.epsilon.number, ends, limit), self.nearness.value
        if self.others.value == _LEFT_OUT:
            return EffectiveMethod(choose, nearness=nearness)
        kind, move = self.select.value, self.move_to.value
        assert isinstance(move, CorrectionMove)
        select = (
            (kind, self.near.number if kind is CorrectionScope.RATIO else self.moved.number)
            if isinstance(kind, CorrectionScope)
            else None
        )
        correct = second_embodiment(select, round(self.before.number), round(self.after.number), move)
        return EffectiveMethod(choose, correct, nearness)
