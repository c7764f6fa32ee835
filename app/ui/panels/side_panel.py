"""The right side of the window: lists of job, tools and operations, and the form of what is chosen in them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QResizeEvent

from ...core.errors import HitofudeError
from ...drafting.document import Document, DocumentChange
from ...formats.tools.library import load_libraries
from ...model.job import Job
from ...model.tool import Tool
from ..framework.form import JobEdit
from ..framework.section import hairline
from ..framework.side_scroll import SideScroll
from . import changes
from .advice import AdviceSection
from .changes import Subject, SubjectKind
from .job_form import JobForm
from .library import LibrarySection
from .lists import JobSection, OperationSection, OperationTimes, ToolSection
from .operation_form import OperationForm
from .tool_form import ToolForm


class SidePanel(SideScroll):
    """Shows the document's job and turns what the user does into undoable changes of it.

    Signals:
        refused(sentence): a change that the job does not allow. advice_shown(): the sheet "Which tool?" has been
        opened. shown(): the job, or another subject of it, is shown.
    """

    refused = Signal(str)
    advice_shown = Signal()
    shown = Signal()

    def __init__(self, document: Document) -> None:
        super().__init__((0, 4, 0, 8))
        self._document = document
        self._size: tuple[float, float, float] | None = None
        self._times = OperationTimes()
        self._strokes: int | None = None
        self.subject = Subject(SubjectKind.OPERATION, 0)
        self.job, self.tools, self.operations = JobSection(), ToolSection(), OperationSection()
        self.job_form, self.tool_form, self.operation_form = JobForm(), ToolForm(), OperationForm()
        self.library, self.advice = LibrarySection(), AdviceSection()
        self._follows_advice = False
        self._lay_out()
        self._connect()
        self.refresh()

    def _lay_out(self) -> None:
        column = self.column
        for section in (self.job, self.tools, self.operations):
            column.addWidget(section)
            column.addWidget(hairline())
        for form in (self.job_form, self.tool_form, self.operation_form):
            column.addWidget(form)
        for sheet in (self.library, self.advice):
            column.addWidget(sheet)
            sheet.hide()
            sheet.installEventFilter(self)
        column.addStretch(1)

    def _connect(self) -> None:
        for section in (self.job, self.tools, self.operations):
            section.chosen.connect(self.choose)
        self.tools.added.connect(self._add_tool)
        self.tools.removed.connect(self._remove)
        self.tool_form.removed.connect(lambda: self._remove(self.subject))
        self.operation_form.removed.connect(lambda: self._remove(self.subject))
        self.operations.added.connect(self._add_operation)
        self.operations.removed.connect(self._remove)
        self.operations.switched.connect(self._switch)
        self.operations.moved.connect(self._move)
        self.operations.copied.connect(self._copy)
        self.operation_form.copied.connect(lambda: self._copy(self.subject.key))
        self.operation_form.moved.connect(lambda way: self._move(self.subject.key, way))
        for form in (self.job_form, self.tool_form, self.operation_form):
            form.edited.connect(self._on_edited)
        self.tools.library.connect(self.switch_library)
        self.library.closed.connect(self.switch_library)
        self.tools.advice.connect(self.switch_advice)
        self.advice.closed.connect(self.switch_advice)
        self.library.added.connect(self._add_from_library)
        self.library.put.connect(self._put_from_library)
        self.verticalScrollBar().actionTriggered.connect(lambda _: self._let_user_scroll())
        self._document.subscribe(self._on_change)

    def choose(self, subject: Subject) -> None:
        """Show the properties of a subject; the library stays open beside tools alone."""
        self.subject = subject
        self.advice.hide()
        if subject.kind is not SubjectKind.TOOL:
            self.library.hide()
        self.refresh()

    def switch_library(self) -> None:
        """Show the tool library in the place of the properties, or these again."""
        opened = self.library.isHidden()
        if opened:
            self.advice.hide()
            self.read_libraries()
        self.library.setVisible(opened)
        self.refresh()
        if opened:
            self.library.search.setFocus(Qt.FocusReason.OtherFocusReason)
            QTimer.singleShot(0, self, self._fit_library)

    def switch_advice(self) -> None:
        """Show "Which tool?" in the place of the properties, or these again."""
        opened = self.advice.isHidden()
        self.library.hide()
        self.advice.setVisible(opened)
        self._follows_advice = opened
        self.refresh()
        if opened:
            self.advice_shown.emit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Keep a sheet that was opened in sight while it grows: advice comes later, other languages are longer."""
        if event.type() == QEvent.Type.Resize:
            QTimer.singleShot(0, self, self._fit_library if watched is self.library else self._show_advice)
        return super().eventFilter(watched, event)

    def _show_advice(self) -> None:
        """Bring all of the advice into sight, or its head where it is longer than the panel."""
        if self._follows_advice and not self.advice.isHidden():
            bar, sheet = self.verticalScrollBar(), self.advice.geometry()
            bar.setValue(min(sheet.top(), max(bar.value(), sheet.bottom() + 1 - self.viewport().height())))

    def focusNextPrevChild(self, forward: bool) -> bool:  # noqa: N802 (Qt's name)
        """Go to the next field, and scroll to it."""
        self._let_user_scroll()
        return super().focusNextPrevChild(forward)

    def _let_user_scroll(self) -> None:
        """From now on the user says what is in sight."""
        self._follows_advice = False

    def _fit_library(self) -> None:
        """Give the library's list the room that is left, and bring it into sight."""
        if not self.library.isHidden():
            others = self.column.totalSizeHint().height() - self.library.area.height()
            self.library.fit_into(self.viewport().height() - others)
            QTimer.singleShot(0, self, self._show_library)

    def _show_library(self) -> None:
        self.ensureWidgetVisible(self.library, 0, 0)
        self.library.reveal()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Give the library's list the room that is left."""
        super().resizeEvent(event)
        self._fit_library()

    def read_libraries(self) -> None:
        """Take the libraries as their files are now; what is wrong with one is said by `refused`."""
        libraries, problems = load_libraries()
        self.library.show_libraries(libraries)
        for problem in problems[:1]:
            self.refused.emit(problem)

    def show_results(self, times: OperationTimes, strokes: int | None) -> None:
        """Show what was computed: what takes how long, and pocket strokes; None = not computed."""
        self._times, self._strokes = times, strokes
        self.refresh()

    def show_size(self, part: tuple[float, float] | None, stock: tuple[float, float, float] | None) -> None:
        """Show the stock's size.

        Args:
            part: size of one part, mm; None while nothing is drawn.
            stock: size of the stock round all copies, mm.
        """
        self.job_form.show_size(part)
        self._size = stock
        self.job.show_job(self._document.job, stock)

    def change(self, name: str, make: Callable[[Job], Job]) -> None:
        """Change the job, undoably; what it does not allow is said by `refused`."""
        self._change(JobEdit(name, make))

    def _change(self, edit: JobEdit) -> None:
        """Change the job, undoably; what it does not allow is said at the field, or by `refused`."""
        try:
            job = edit.make(self._document.job)
            if job != self._document.job:
                self._document.change_job(edit.name, job)
        except HitofudeError as wrong:
            if edit.field is not None:
                edit.field.refuse(str(wrong))
            else:
                self.refused.emit(str(wrong))

    def refresh(self) -> None:
        """Show the job as it is now."""
        job = self._document.job
        self.subject = self.subject.in_job(job)
        self.job.show_job(job, self._size)
        self.tools.show_job(job)
        self.operations.show_job(job, self._times)
        for section in (self.job, self.tools, self.operations):
            section.show_chosen(self.subject)
        kind = self.subject.kind
        if kind is SubjectKind.JOB:
            self.job_form.show_job(job)
        elif kind is SubjectKind.TOOL:
            self.tool_form.show_tool(job, self.subject.key)
        else:
            pocket = job.operations[self.subject.key].COARSE
            self.operation_form.show_operation(job, self.subject.key, self._strokes if pocket else None)
        self.tools.library_button.setChecked(not self.library.isHidden())
        self.tools.advice_button.setChecked(not self.advice.isHidden())
        opened = not (self.library.isHidden() and self.advice.isHidden())
        self.library.show_place(self.subject.key if kind is SubjectKind.TOOL else 0)
        self.job_form.setVisible(kind is SubjectKind.JOB and not opened)
        self.tool_form.setVisible(kind is SubjectKind.TOOL and not opened)
        self.operation_form.setVisible(kind is SubjectKind.OPERATION and not opened)
        self.shown.emit()

    def _on_change(self, change: DocumentChange) -> None:
        if change & DocumentChange.JOB:
            self.refresh()

    def _on_edited(self, edit: JobEdit) -> None:
        before = self.subject
        if edit.field is self.tool_form.number:
            self.subject = Subject(SubjectKind.TOOL, int(edit.field.value or 0))
        revision = self._document.revision
        self._change(edit)
        if self._document.revision == revision:
            self.subject = before

    def _remove(self, subject: Subject) -> None:
        remove = changes.without_tool if subject.kind is SubjectKind.TOOL else changes.without_operation
        self.change(f"Remove {subject.kind.value}", lambda job: remove(job, subject.key))

    def _add_tool(self) -> None:
        def make(job: Job) -> Job:
            new, number = changes.with_new_tool(job)
            self.subject = Subject(SubjectKind.TOOL, number)
            return new

        self.change("Add tool", make)

    def _add_from_library(self, tool: Tool) -> None:
        def make(job: Job) -> Job:
            new, number = changes.with_library_tool(job, tool)
            self.subject = Subject(SubjectKind.TOOL, number)
            return new

        self.change("Add tool", make)

    def _put_from_library(self, tool: Tool) -> None:
        number = self.subject.key
        self.change(f"Replace T{number}", lambda job: changes.with_tool(job, number, replace(tool, number=number)))

    def _add_operation(self, kind: type) -> None:
        def make(job: Job) -> Job:
            new, index = changes.with_new_operation(job, kind, _library)
            self.subject = Subject(SubjectKind.OPERATION, index)
            return new

        self.change("Add operation", make)

    def _move(self, index: int, way: int) -> None:
        def make(job: Job) -> Job:
            new, place = changes.with_moved_operation(job, index, index + way)
            self.subject = Subject(SubjectKind.OPERATION, place)
            return new

        self.change("Move operation", make)
        self.operations.focus(self.subject)

    def _copy(self, index: int) -> None:
        def make(job: Job) -> Job:
            new, place = changes.with_copied_operation(job, index)
            self.subject = Subject(SubjectKind.OPERATION, place)
            return new

        self.change("Duplicate operation", make)

    def _switch(self, index: int, on: bool) -> None:
        name = "Switch operation on" if on else "Switch operation off"
        self.change(name, lambda job: changes.with_cut(job, index, replace(job.operations[index].cut, enabled=on)))


def _library() -> list[Tool]:
    """Return the tools of all libraries as their files are now."""
    return [tool for library in load_libraries().libraries.values() for tool in library.tools]
