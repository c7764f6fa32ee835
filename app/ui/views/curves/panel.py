"""Beside the curves: how to smooth, the button that does, and the certificate of what was done."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QPushButton, QWidget

from ...framework.boxes import empty, h_box, v_box
from ...framework.fields import ChoiceField, ListField, NumberField, NumberSpec, reason_label
from ...framework.figures import counted, grouped
from ...framework.labels import muted, set_role, show_words
from ...framework.section import EDGE, hairline, heading
from ...framework.side_scroll import SideScroll
from .better_form import BetterForm
from .outline_field import OutlineField
from .points_form import PointsForm

if TYPE_CHECKING:
    from ....usecases.smoothing.result import SmoothedProgram, SmoothOptions

PRESETS = (("Fine", 0.002), ("Finishing", 0.01), ("Semi", 0.05))
"""Name and tolerance, mm."""
FORMS = (("lines", "Lines only"), ("arcs", "Arcs"), ("nurbs", "NURBS"))
_BARREL = 2.0
"""A barrel is offered so many tolerances wide in the middle."""


class CurvesPanel(SideScroll):
    """A form of how to smooth, and what came of it.

    Signals:
        smooth_requested(): do it, or leave it while it is done. save_requested(), nc_requested(): with the new text.

    Attributes:
        figures: the certificate, by the name of each figure.
    """

    smooth_requested = Signal()
    save_requested = Signal()
    nc_requested = Signal()

    def __init__(self) -> None:
        super().__init__((EDGE + 1, 12, EDGE, 12), 4)
        self.preset = ChoiceField("Preset", [(value, name) for name, value in PRESETS])
        self.tolerance = NumberField(
            NumberSpec(
                "Tolerance", low=1e-4, high=10.0, decimals=4, tip="How far curve and moves may be apart, both ways"
            )
        )
        self.form = ChoiceField("Write", FORMS)
        self.insist = ChoiceField("Splines", [(False, "Where shorter"), (True, "All along")])
        self.insist.setToolTip("All along: however many blocks they take; else arcs stand where these take fewer")
        self.region = ChoiceField("Region", [("cylinder", "Cylinder"), ("barrel", "Barrel"), ("outline", "r = f(z)")])
        self.outline = OutlineField()
        self.middle = NumberField(
            NumberSpec(
                "Middle",
                low=1e-4,
                high=10.0,
                decimals=4,
                tip="How far the curve may be away half way between two points",
            )
        )
        self.degree = ChoiceField("Degree", [(3, "3"), (5, "5")])
        self.corner = NumberField(
            NumberSpec("Corner", "°", 0.1, 180.0, 1, False, "Bends of more than this are kept exactly")
        )
        self.bend = NumberField(
            NumberSpec(
                "Bend", "°", 0.01, 180.0, 2, False, "By how much neighbouring blocks may bend where that saves blocks"
            )
        )
        self.points = PointsForm()
        self.post = ListField("Control", [(None, "As the program looks")])
        self.smooth, self.save, self.nc = QPushButton("Smooth"), QPushButton("Save as…"), QPushButton("Open in NC")
        self.smooth.setProperty("role", "primary")
        self.reason, self.program, self.title, self.finding = reason_label(), muted(), QLabel(), reason_label()
        self.better = BetterForm()
        self.figures: dict[str, QLabel] = {}
        self._grid = QGridLayout()
        self._result = QWidget()
        self._lay_out()
        self._connect()

    def _lay_out(self) -> None:
        column = self.column
        self.program.setWordWrap(True)
        self.title.setWordWrap(True)
        fields = (
            self.preset,
            self.tolerance,
            self.form,
            self.insist,
            self.degree,
            self.region,
            self.middle,
            self.outline,
            self.corner,
            self.bend,
            self.points,
            self.post,
        )
        for widget in (heading("Proven curves"), self.program, *fields):
            column.addWidget(widget)
        column.addSpacing(6)
        for button in (self.smooth, self.save, self.nc):
            button.setFixedHeight(32)
        column.addWidget(self.smooth)
        column.addWidget(self.reason)
        told = v_box(self._result, (0, 6, 0, 0), 6)
        self._grid.setHorizontalSpacing(12)
        self._grid.setVerticalSpacing(4)
        self._grid.setColumnStretch(1, 1)
        buttons = h_box(spacing=8)
        buttons.addWidget(self.save, 1)
        buttons.addWidget(self.nc, 1)
        told.addWidget(hairline())
        told.addWidget(heading("Certificate"))
        told.addWidget(self.title)
        told.addLayout(self._grid)
        told.addWidget(self.finding)
        told.addSpacing(4)
        told.addLayout(buttons)
        column.addWidget(self._result)
        column.addWidget(self.better)
        column.addStretch(1)
        self._result.hide()

    def _connect(self) -> None:
        self.smooth.clicked.connect(self.smooth_requested)
        self.save.clicked.connect(self.save_requested)
        self.nc.clicked.connect(self.nc_requested)
        self.preset.chosen.connect(self._take_preset)
        self.tolerance.committed.connect(lambda _: self._show_preset())
        self.region.chosen.connect(self._show_region)
        self.form.chosen.connect(self._show_form)
        for field in (self.tolerance, self.middle, self.corner, self.bend):
            field.edit.returnPressed.connect(self.smooth.setFocus)

    def show_options(self, options: SmoothOptions, posts: dict[str, str]) -> None:
        """Fill the form.

        Args:
            options: how to smooth. posts: title of each control by its name.
        """
        self.post.set_choices([(None, "As the program looks"), *posts.items()])
        self.post.show_value(None)
        self.tolerance.show_value(options.tolerance)
        self.form.show_value(options.form.value)
        self.insist.show_value(options.insist)
        self.degree.show_value(options.degree)
        self._show_form(options.form.value)
        self.bend.show_value(math.degrees(options.bend))
        self.corner.show_value(math.degrees(options.corner))
        self.region.show_value("cylinder" if options.middle is None else "barrel")
        self.middle.show_value(options.middle or _BARREL * options.tolerance)
        self.middle.setVisible(options.middle is not None)
        self.outline.setVisible(False)
        self._show_preset()

    def options(self, base: SmoothOptions) -> SmoothOptions:
        """Return what the form asks for; what it does not ask is as in `base`.

        Raises:
            HitofudeError: it cannot be so; a sentence.
        """
        from ....gcode.posts import load_post
        from ....usecases.smoothing.result import OutputForm

        name, profile = self.post.value, self.outline.profile() if self.region.value == "outline" else None
        return replace(
            base,
            tolerance=profile.radius if profile is not None else self.tolerance.number,
            profile=profile,
            form=OutputForm(self.form.value),
            degree=5 if self.degree.value == 5 else 3,
            middle=self.middle.number if self.barrel else None,
            corner=math.radians(self.corner.number),
            bend=math.radians(self.bend.number),
            post=load_post(str(name)) if name is not None else None,
            effective=self.points.method(),
            insist=self.form.value == "nurbs" and self.insist.value is True,
        )

    @property
    def barrel(self) -> bool:
        """Whether the tube is wider between the points than at them."""
        return self.region.value == "barrel"

    def show_program(self, name: str) -> None:
        """Name the program that would be smoothed, "" = there is none."""
        show_words(self.program, name)
        self.smooth.setEnabled(bool(name))
        self.better.show_program(bool(name))

    def show_busy(self, busy: bool) -> None:
        """Offer to leave what is being done."""
        self.smooth.setText("Cancel" if busy else "Smooth")
        set_role(self.smooth, "" if busy else "primary")

    def show_reason(self, sentence: str) -> None:
        """Say why it could not be done, "" = nothing is wrong."""
        show_words(self.reason, sentence)

    def show_result(self, done: SmoothedProgram | None) -> None:
        """Show the certificate, or none."""
        self._result.setVisible(done is not None)
        if done is None:
            return
        from ....usecases.smoothing.report import findings, report

        told = report(done)
        changed = told["stretches"]["changed"]
        self.title.setText(_headline(told, {piece.kept for piece in done.pieces}))
        empty(self._grid)
        self.figures = {}
        for row, (name, value, tip) in enumerate(_figures(told) if changed else ()):
            name_label, value_label = muted(name), QLabel(value)
            value_label.setAlignment(Qt.AlignmentFlag.AlignRight)
            value_label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            name_label.setToolTip(tip)
            value_label.setToolTip(tip)
            self._grid.addWidget(name_label, row, 0)
            self._grid.addWidget(value_label, row, 1)
            self.figures[name] = value_label
        lost = findings(done)
        self.finding.setText(
            f"{lost[0].text}{f' {len(lost) - 1} more like it.' if len(lost) > 1 else ''}" if lost else ""
        )
        self.finding.setVisible(bool(lost))
        self.save.setEnabled(changed > 0)
        self.nc.setEnabled(changed > 0)

    def _take_preset(self, tolerance: float) -> None:
        self.tolerance.show_value(tolerance)
        self.middle.show_value(max(self.middle.number, _BARREL * tolerance) if self.barrel else _BARREL * tolerance)

    def _show_preset(self) -> None:
        """Underline the preset that the tolerance is, if it is one."""
        group = next(iter(self.preset.buttons.values())).group()
        group.setExclusive(False)
        for value, button in self.preset.buttons.items():
            button.setChecked(value == self.tolerance.number)
        group.setExclusive(True)

    def _show_form(self, form: str) -> None:
        self.degree.setVisible(form == "nurbs")
        self.insist.setVisible(form == "nurbs")
        self.bend.setVisible(form == "arcs")

    def _show_region(self, region: str) -> None:
        self.middle.setVisible(region == "barrel")
        self.outline.setVisible(region == "outline")
        for field in (self.preset, self.tolerance):
            field.setVisible(region != "outline")
        if region == "barrel":
            self.middle.show_value(max(self.middle.number, _BARREL * self.tolerance.number))


def _headline(told: dict[str, Any], kept: set[str]) -> str:
    """Return what was done in a sentence.

    Args:
        told: the report. kept: why stretches stayed as they were.
    """
    changed, found = told["stretches"]["changed"], told["stretches"]["found"]
    of = counted(found, "stretch", "stretches")
    if not found:
        return "No straight feed moves follow one another here, so there is nothing to smooth."
    if not changed:
        return f"Nothing was written anew: {'; '.join(sorted(kept))}."
    words = told["written"]["words"]
    return f"{changed} of {of} written anew as {words}, and proven as written."


def _figures(told: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Return name, value and meaning of each figure of a report."""
    apart, blocks, bend, step = (
        told["tolerance"],
        told["blocks"],
        told["largest_bend_deg"],
        told["largest_curvature_step_per_mm"],
    )
    arrow = " → "
    points = (
        []
        if told["points"] is None
        else [
            (
                "Effective",
                f"{grouped(told['points']['effective'], 0)} of {grouped(told['points']['all'], 0)}",
                "Points on the true shape",
            ),
            ("Corrected", grouped(told["points"]["corrected"], 0), "Points within facets that were moved to it"),
            (
                "Nearness",
                f"{told['points']['farthest_mm']:.6f} of {told['points']['nearness_mm']:g} mm",
                "How far from these points the curve was found, and may be",
            ),
        ]
    )
    return [
        ("Tolerance", f"{apart['asked_mm']:g} mm", "What was asked for"),
        ("Proven", f"{apart['proven_mm']:.6f} mm", "Nowhere are curve and moves farther apart, both ways"),
        ("Curve to moves", f"{apart['curve_to_moves_found_mm']:.6f} mm", "The largest distance that was found"),
        (
            "Moves to curve",
            f"{apart['moves_to_curve_found_mm']:.6f} mm",
            "The largest distance of a point from its place on the curve",
        ),
        (
            "Blocks",
            f"{grouped(blocks['before'], 0)}{arrow}{grouped(blocks['after'], 0)}",
            "Of all stretches, before and after",
        ),
        (
            "Largest bend",
            f"{bend['before']:.2f}°{arrow}{bend['after']:.2f}°",
            "Change of direction at one place, corners left out",
        ),
        (
            "Curvature step",
            f"{step['before']:.3g}{arrow}{step['after']:.3g} /mm",
            "Change of curvature at one place, corners left out",
        ),
        *points,
    ]
