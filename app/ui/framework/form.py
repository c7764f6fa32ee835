"""What forms have in common: fields that say what the user wants instead, groups that fold, pictures beside them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QLabel, QSizePolicy, QToolButton, QWidget

from ...model.job import Job
from .boxes import h_box, v_box
from .fields import ChoiceField, ListField, NumberField, NumberSpec, TextField, field_name
from .icons import IconButton, icon
from .labels import Elided, muted
from .samples import Switch
from .section import EDGE, PanelSection
from .theme import LIGHT, Theme

Edit = Callable[[Job, float], Job]
MaybeEdit = Callable[[Job, float | None], Job]


class FoldButton(QToolButton):
    """The head of a group: a click shows or hides its rows."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self._theme = LIGHT
        self.setCheckable(True)
        self.setIconSize(QSize(14, 14))
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.setText(title)
        self.setProperty("role", "fold")
        self.setAccessibleName(title)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.toggled.connect(lambda _: self.set_theme(self._theme))

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self.setIcon(icon("down" if self.isChecked() else "right", theme, theme.muted))


class FieldGroup(QWidget):
    """Rows of a form under a head that folds them."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self.fold, self.summary, self.body = FoldButton(title), Elided(role="muted"), QWidget()
        self.summary.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        head = h_box(margins=(EDGE - 6, 4, EDGE, 0))
        head.addWidget(self.fold, 0, Qt.AlignmentFlag.AlignLeft)
        head.addWidget(self.summary, 1)
        column = v_box(self, spacing=0)
        column.addLayout(head)
        column.addWidget(self.body)
        self.rows = v_box(self.body, (EDGE, 0, EDGE, 4), 0)
        self.body.hide()
        self.fold.toggled.connect(self._unfold)

    def _unfold(self, on: bool) -> None:
        self.body.setVisible(on)
        self.summary.setVisible(not on)

    def say(self, text: str) -> None:
        """Show what is set, in a few words, while the group is folded."""
        self.summary.setText(text)


class SwitchField(QWidget):
    """A yes or no."""

    chosen = Signal(object)

    def __init__(self, name: str, tip: str = "") -> None:
        super().__init__()
        row = h_box(self, (0, 3, 0, 3), 8)
        self.switch = Switch(name)
        self.setToolTip(tip)
        self.switch.clicked.connect(lambda on: self.chosen.emit(on))
        row.addWidget(field_name(name))
        row.addWidget(self.switch)
        row.addStretch(1)

    def show_value(self, on: bool) -> None:
        """Show the job's value."""
        self.switch.setChecked(on)


@dataclass(frozen=True, eq=False)
class JobEdit:
    """What the user wants of a job.

    Attributes:
        name: for the undo list. make: gives the job as it shall be.
        field: where it was typed, which says what the job does not allow; None = that is said elsewhere.
    """

    name: str
    make: Callable[[Job], Job]
    field: NumberField | None = None


class FormSection(PanelSection):
    """A section of fields.

    Signals:
        edited(JobEdit): the user wants another job.
        removed(): the user wants what the form shows gone.
    """

    edited = Signal(object)
    removed = Signal()

    def __init__(self, title: str, removable: str = "") -> None:
        super().__init__(title)
        self.remark = muted()
        self.head.addWidget(self.remark)
        if removable:
            self.remove_button = IconButton("remove", f"Remove this {removable} (Del in the list)")
            self.remove_button.clicked.connect(self.removed)
            self.head.addWidget(self.remove_button)
        else:
            self.head.addSpacing(4)

        self._group: FieldGroup | None = None

    def begin_group(self, title: str) -> FieldGroup:
        """Begin a group: what is added next is in it."""
        self._group = FieldGroup(title)
        self.rows.addWidget(self._group)
        return self._group

    def add(self, widget: QWidget) -> None:
        """Add a row to the group that was begun last, or to the form itself."""
        if self._group is None:
            self.add_indented(widget)
        else:
            self._group.rows.addWidget(widget)

    def add_number(self, spec: NumberSpec, edit: Edit | MaybeEdit) -> NumberField:
        """Add a number field; `edit(job, value)` gives the job with that value, None where the field may be left
        empty.
        """
        field = NumberField(spec)
        self._add_number(spec.name, field, edit)
        return field

    def add_field(
        self, name: str, field: NumberField | ChoiceField | ListField | SwitchField, edit: Callable[[Job, Any], Job]
    ) -> None:
        """Add a field of any sort; `edit(job, value)` gives the job with that value."""
        if isinstance(field, NumberField):
            self._add_number(name, field, edit)
        else:
            self.add_choice(name, field, edit)

    def _add_number(self, name: str, field: NumberField, edit: Callable[[Job, Any], Job]) -> None:
        field.committed.connect(lambda value: self._ask(name, lambda job: edit(job, value), field))
        self.add(field)

    def add_choice(
        self, name: str, field: ChoiceField | ListField | SwitchField | TextField, edit: Callable[[Job, object], Job]
    ) -> None:
        """Add a choice; `edit(job, value)` gives the job with that value."""
        field.chosen.connect(lambda value: self._ask(name, lambda job: edit(job, value)))
        self.add(field)

    def _ask(self, name: str, make: Callable[[Job], Job], field: NumberField | None = None) -> None:
        self.edited.emit(JobEdit(f"Change {name.lower()}", make, field))

    def add_picture(self, picture: QWidget, *beside: QWidget) -> QWidget:
        """Add a drawing with a few words beside it."""
        whole = QWidget()
        row = h_box(whole, (0, 4, 0, 6), 12)
        row.addWidget(picture)
        words = v_box(spacing=2)
        words.addStretch(1)
        for each in beside:
            if isinstance(each, QLabel):
                each.setWordWrap(True)
            words.addWidget(each)
        words.addStretch(1)
        row.addLayout(words, 1)
        self.add(whole)
        return whole
