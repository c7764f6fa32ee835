"""The lists of the side panel: the job in two lines, its tools, its operations."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import accumulate, pairwise

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QLabel, QMenu, QWidget

from ...model.job import Job
from ...model.operation import Operation
from ...model.operation_kinds import OPERATION_KINDS
from ...model.tool import Tool
from ..framework.boxes import h_box, put_away
from ..framework.computation import WaitingTimes
from ..framework.dropping import drop
from ..framework.figures import TIMES, clock, grouped
from ..framework.icons import IconButton, IconLabel
from ..framework.labels import Elided, muted
from ..framework.samples import LineSample, Switch, sample_of
from ..framework.section import EDGE, ListRow, PanelSection, theme_children
from ..framework.themed import Themed
from .changes import Subject, SubjectKind, kind_name, operation_name, refusal
from .tool_kinds import icon_of


def _bold(text: str) -> QLabel:
    made = QLabel(text)
    made.setStyleSheet("font-weight: 600;")
    return made


class ListSection(Themed, PanelSection):
    """A heading and rows, each with its own subject.

    Signals:
        chosen: the user chose a subject. removed: wants it gone.
    """

    chosen = Signal(Subject)
    removed = Signal(Subject)

    def __init__(self, title: str) -> None:
        super().__init__(title)
        self._rows: dict[Subject, ListRow] = {}

    def clear_rows(self) -> None:
        """Take every row away."""
        for row in self._rows.values():
            self.rows.removeWidget(row)
            put_away(row)
        self._rows = {}

    def add_row(self, subject: Subject, row: ListRow) -> None:
        """Put a row at the end; the Tab key comes to it after what stands above."""
        self.rows.addWidget(row)
        for before, after in pairwise([*self._last_stop(), *row.stops]):
            QWidget.setTabOrder(before, after)
        self._rows[subject] = row
        row.clicked.connect(lambda: self.chosen.emit(subject))
        row.removed.connect(lambda: self.removed.emit(subject))
        row.stepped.connect(lambda way: self._step(subject, way))
        theme_children(row, self._theme)

    def _last_stop(self) -> list[QWidget]:
        """Return what the Tab key comes to last so far: of the last row, else of the heading."""
        if self._rows:
            return list(self._rows.values())[-1].stops[-1:]
        buttons = self.findChildren(IconButton, options=Qt.FindChildOption.FindDirectChildrenOnly)
        return list[QWidget](buttons[-1:])

    def show_chosen(self, subject: Subject) -> None:
        """Mark the row whose properties are shown."""
        for key, row in self._rows.items():
            row.set_chosen(key == subject)

    def focus(self, subject: Subject) -> None:
        """Give a row the keyboard, when it is still there."""
        if subject in self._rows:
            self._rows[subject].show()
            self._rows[subject].setFocus(Qt.FocusReason.OtherFocusReason)

    def _step(self, subject: Subject, way: int) -> None:
        keys = list(self._rows)
        at = keys.index(subject) + way
        if 0 <= at < len(keys):
            self._rows[keys[at]].setFocus()
            self.chosen.emit(keys[at])


class JobSection(ListSection):
    """Stock and origin; a click shows the job's properties."""

    def __init__(self) -> None:
        super().__init__("Job")
        self.stock, self.origin = Elided(), Elided()
        for name, value in (("Stock", self.stock), ("Origin", self.origin)):
            label = muted(name)
            label.setFixedWidth(56)
            row = ListRow(label, value, stretch_after=1)
            row.setFixedHeight(24)
            row.setAccessibleName(name)
            self._add_job_row(row)

    def _add_job_row(self, row: ListRow) -> None:
        subject = Subject(SubjectKind.JOB, len(self._rows))
        self._rows[subject] = row
        row.clicked.connect(lambda: self.chosen.emit(Subject(SubjectKind.JOB)))
        row.stepped.connect(lambda way: self._step(subject, way))
        self.rows.addWidget(row)

    def show_chosen(self, subject: Subject) -> None:
        """Mark both rows when the job is chosen."""
        for row in self._rows.values():
            row.set_chosen(subject.kind is SubjectKind.JOB)

    def show_job(self, job: Job, size: tuple[float, float, float] | None) -> None:
        """Show the stock's size, mm, and where the work origin is.

        Args:
            job: whose stock and origin to show.
            size: of the stock, mm, or None while nothing is drawn.
        """
        if size is None:
            self.stock.setText(f"nothing drawn · {job.stock.thickness:.3f} mm thick")
        else:
            self.stock.setText(f" {TIMES} ".join(grouped(v, 3) for v in size) + " mm")
        self.origin.setText(f"{job.origin_xy.value.capitalize()}, {job.origin_z.value}")


class ToolSection(ListSection):
    """Every tool of the job.

    Signals:
        added(): the user wants another one. library(), advice(): wants the tool library, or the advice, shown, or
            hidden again.
    """

    added = Signal()
    library = Signal()
    advice = Signal()

    def __init__(self) -> None:
        super().__init__("Tools")
        self.library_button = IconButton("library", "Tool library (F6)")
        self.library_button.setCheckable(True)
        self.library_button.clicked.connect(self.library)
        self.advice_button = IconButton(
            "advice", "Which tool? Passages, corners, and what each tool reaches (Shift+F6)"
        )
        self.advice_button.setCheckable(True)
        self.advice_button.clicked.connect(self.advice)
        self.head.addWidget(self.advice_button)
        self.head.addWidget(self.library_button)
        self.add_button = IconButton("add", "Add a tool")
        self.add_button.clicked.connect(self.added)
        self.head.addWidget(self.add_button)
        self._tools: tuple[Tool, ...] = ()

    def show_job(self, job: Job) -> None:
        """Rebuild the rows when the tools have changed."""
        if job.tools == self._tools and self._rows:
            return
        self._tools = job.tools
        self.clear_rows()
        for tool in job.tools:
            number = _bold(f"T{tool.number}")
            number.setMinimumWidth(24)
            speed = muted(f"{grouped(tool.spindle_speed, 0)} rpm")
            row = ListRow(IconLabel(icon_of(tool.kind)), number, Elided(tool.label), speed, stretch_after=2)
            row.setToolTip(tool.kind.title)
            self.add_row(Subject(SubjectKind.TOOL, tool.number), row)


@dataclass(frozen=True)
class OperationTimes:
    """What takes how long; nothing while the paths are out of date.

    Attributes:
        of: seconds of each operation, by its index. beside: of what is none.
    """

    of: dict[int, float] = field(default_factory=dict)
    beside: WaitingTimes | None = None

    def whole(self) -> OperationTimes:
        """Return them in whole seconds that add up to the whole time as it is rounded."""
        beside = self.beside
        rest = [beside.changing, beside.dwelling, beside.travelling] if beside is not None else []
        ends = [round(end) for end in accumulate([0.0, *self.of.values(), *rest])]
        seconds = [float(after - before) for before, after in pairwise(ends)]
        of = dict(zip(self.of, seconds, strict=False))
        return OperationTimes(of, WaitingTimes(beside.changes, *seconds[len(of) :]) if beside is not None else None)


class WaitingRow(QWidget):
    """What takes time and is no operation: name, how often, time; it is only read."""

    def __init__(self, name: str, how: str, time: str) -> None:
        super().__init__()
        line = h_box(self, (EDGE, 0, EDGE, 0), 8)
        self.setFixedHeight(24)
        self.time = muted(time)
        line.addWidget(muted(name))
        line.addWidget(Elided(how, "muted"), 1)
        line.addWidget(self.time)


class OperationSection(ListSection):
    """Every operation in the order of cutting: switch, line sample, name, tool, time.

    Signals:
        added(kind): the user wants another one. switched(index, on). moved(index, way): earlier (-1) or later (1).
        copied(index): wanted twice. proposal(), rule_of_1986(): wants operations proposed for the drawing, or those of
            the rule of 1986.
    """

    added = Signal(type)
    proposal = Signal()
    rule_of_1986 = Signal()
    switched = Signal(int, bool)
    moved = Signal(int, int)
    copied = Signal(int)

    def __init__(self) -> None:
        super().__init__("Operations")
        self.add_button = IconButton("add", "Add an operation")
        menu = QMenu(self.add_button)
        for kind in OPERATION_KINDS.values():
            action = QAction(kind_name(kind), menu)
            action.triggered.connect(lambda _=False, k=kind: self.added.emit(k))
            menu.addAction(action)
        menu.addSeparator()
        menu.addAction("Propose operations").triggered.connect(lambda *_: self.proposal.emit())
        menu.addAction("Operations as in 1986").triggered.connect(lambda *_: self.rule_of_1986.emit())
        self.menu = menu
        self.add_button.clicked.connect(lambda: drop(menu, self.add_button))
        self.head.addWidget(self.add_button)
        self._shown: object = None
        self.waiting: list[WaitingRow] = []
        self.switches: list[Switch] = []

    def show_job(self, job: Job, times: OperationTimes) -> None:
        """Rebuild the rows when operations, tools or times have changed; with what is waited for beside the operations
        the rows add up to the program's time.
        """
        times = times.whole()
        shown = (job.operations, job.tools, times)
        if shown == self._shown:
            return
        self._shown = shown
        self.clear_rows()
        self.switches = []
        for index, operation in enumerate(job.operations):
            seconds = times.of.get(index) if operation.cut.enabled else None
            time = QLabel(clock(seconds)) if seconds is not None else muted("-")
            row = self._operation_row(index, operation, job, time)
            row.moved.connect(lambda way, i=index: self.moved.emit(i, way))
            row.copied.connect(lambda i=index: self.copied.emit(i))
            row.setToolTip("Drag, or Alt+Up and Alt+Down: cut earlier or later; Ctrl+D: duplicate; Del: remove")
            self.add_row(Subject(SubjectKind.OPERATION, index), row)
        self._show_waiting(times.beside)

    def _show_waiting(self, waiting: WaitingTimes | None) -> None:
        """List what takes time and is no operation's."""
        for row in self.waiting:
            self.rows.removeWidget(row)
            put_away(row)
        self.waiting = []
        if waiting is None:
            return
        each = waiting.changing / max(waiting.changes, 1)
        for name, how, seconds in (
            ("Tool changes", f"{waiting.changes} {TIMES} {each:.0f} s", waiting.changing),
            ("Dwell", "spindle starts", waiting.dwelling),
            ("Approach and retract", "", waiting.travelling),
        ):
            if seconds > 0:
                row = WaitingRow(name, how, clock(seconds))
                self.waiting.append(row)
                self.rows.addWidget(row)

    def _operation_row(self, index: int, operation: Operation, job: Job, time: QLabel) -> ListRow:
        cut = operation.cut
        name = operation_name(operation)
        switch = Switch(f"{name} on or off")
        switch.setChecked(cut.enabled)
        switch.toggled.connect(lambda on: self.switched.emit(index, on))
        self.switches.append(switch)
        sample = LineSample(sample_of(operation))
        sample.setEnabled(cut.enabled)
        tool = next((t for t in job.tools if t.number == cut.tool), None)
        text = f"T{cut.tool} {tool.label}" if tool is not None else f"T{cut.tool} is missing"
        shorter = (f"T{cut.tool} {tool.diameter:g} mm", f"T{cut.tool}") if tool is not None else ()
        return ListRow(
            switch,
            sample,
            QLabel(name),
            Elided(text, "error" if refusal(job, operation) else "muted", shorter),
            time,
            stretch_after=3,
        )
