"""What happens when: connects the window's parts with the document, the worker and one another."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

from PySide6.QtCore import QByteArray, QObject
from PySide6.QtWidgets import QFileDialog, QMessageBox

from app import __version__
from app.edit.document import Change, LogLine
from app.errors import HitofudeError
from app.model.operation import ContourOperation, PocketOperation
from app.model.part import Part, Units
from app.settings import ThemeChoice, save_settings
from app.ui import opening as opening_files
from app.ui.actions import keys_text
from app.ui.canvas.modes import CanvasTool
from app.ui.exporting import FILTER, Exporting
from app.ui.figures import counted, grouped
from app.ui.main_window import MainWindow
from app.ui.opening import Opened, Opening
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.showing import Showing
from app.ui.verdict import verdict
from app.ui.views import View

FIRST_START = "This is fig. 2 of the 1986 patent. Change the tool and press F5, or draw your own."
TOOLS = {
    "tool_select": CanvasTool.SELECT, "tool_line": CanvasTool.LINE, "tool_polyline": CanvasTool.POLYLINE,
    "tool_arc_centre": CanvasTool.ARC_CENTRE, "tool_arc_three": CanvasTool.ARC_THREE, "tool_circle": CanvasTool.CIRCLE,
    "tool_rectangle": CanvasTool.RECTANGLE,
}
TOOL_WORDS = {
    "line": "tool_line", "li": "tool_line", "polyline": "tool_polyline", "pl": "tool_polyline", "arc": "tool_arc_centre",
    "ar": "tool_arc_centre", "circle": "tool_circle", "ci": "tool_circle", "rect": "tool_rectangle", "re": "tool_rectangle",
}


class Wiring(QObject):
    """The window's behaviour."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self.window_, self.document, self.computation = window, window.document, window.computation
        self.opening = Opening(window.document, window.worker)
        self.exporting = Exporting(window.computation, window.notice, self._choose_nc_file)
        self.showing = Showing(window)
        self._log: list[LogLine] = []
        self._logged = 0
        self._connect_files()
        self._connect_edit()
        self._connect_view()
        self._connect_job()
        self._connect_canvas()
        self._unsubscribe = self.document.subscribe(self._on_change)
        self.showing.show_view(View.DRAW)
        self._on_change(Change.ALL)

    def _on(self, name: str, act: Callable[[], object]) -> None:
        self.window_.actions_[name].triggered.connect(lambda *_: act())

    def _connect_files(self) -> None:
        window = self.window_
        self._on("new", lambda: self._leave_drawing("Begin a new drawing", self.new))
        self._on("open", self._choose_drawing)
        self._on("sample", lambda: self._leave_drawing("Open the sample part", self.open_sample))
        self._on("export", self.exporting.start)
        self._on("quit", window.close)
        window.dropped.connect(lambda path: self.open_file(Path(path)))
        window.closing.connect(self._on_closing)
        self.opening.read.connect(lambda opened: self.showing.know_size(opened.job.part, opened.size))
        self.opening.opened.connect(self._on_opened)
        self.opening.failed.connect(self._say_error)
        self.exporting.failed.connect(self._say_error)
        self.exporting.written.connect(self._on_written)
        self.exporting.show_findings.connect(self.showing.open_findings)

    def _connect_edit(self) -> None:
        self._on("undo", self.document.undo)
        self._on("redo", self.document.redo)
        self._on("delete", lambda: self.run("delete") if self.document.selection else self._say("Nothing is selected; click a line first."))
        self._on("select_all", lambda: self.run("select all"))
        line = self.window_.command_line
        line.entered.connect(self._on_entered)
        line.accepted.connect(self.window_.canvas.accept)
        line.cancelled.connect(self._on_escape)

    def _connect_view(self) -> None:
        canvas, actions = self.window_.canvas, self.window_.actions_
        for view in View:
            self._on(view.value, partial(self.showing.show_view, view))
        self._on("fit", canvas.fit)
        self._on("zoom_in", lambda: canvas.zoom_by(1.5))
        self._on("zoom_out", lambda: canvas.zoom_by(1 / 1.5))
        status = self.window_.status
        switches = (("snap", status.snap, canvas.set_snap), ("ortho", status.ortho, canvas.set_ortho),
                    ("grid", status.grid, canvas.set_grid_snap))
        for name, button, switch in switches:
            actions[name].toggled.connect(switch)
            actions[name].toggled.connect(button.setChecked)
            button.clicked.connect(actions[name].setChecked)
        actions["snap"].setChecked(True)
        actions["log"].toggled.connect(self.window_.command_line.log.setVisible)
        actions["log"].setChecked(True)
        self._on("command", self.window_.command_line.edit.setFocus)
        for choice in ThemeChoice:
            self._on(f"theme_{choice.value}", partial(self.choose_theme, choice))
        self._on("keys", self._show_keys)
        self._on("about", self._show_about)

    def _connect_job(self) -> None:
        panel, computation = self.window_.panel, self.computation
        self._on("job_properties", lambda: panel.choose(Subject(SubjectKind.JOB)))
        self._on("add_tool", panel.tools.added.emit)
        self._on("add_pocket", lambda: panel.operations.added.emit(PocketOperation))
        self._on("add_contour", lambda: panel.operations.added.emit(ContourOperation))
        self._on("compute", self.compute)
        self._on("cancel", self.cancel)
        self._on("findings", self.showing.open_findings)
        panel.refused.connect(self._say_error)
        computation.failed.connect(self._say_error)
        computation.finished.connect(self._on_computed)
        self.window_.status.cancelled.connect(self.cancel)

    def _connect_canvas(self) -> None:
        canvas, window = self.window_.canvas, self.window_
        names = {tool: name for name, tool in TOOLS.items()}
        for name, tool in TOOLS.items():
            self._on(name, partial(canvas.set_tool, tool))
        window.actions_["tool_select"].setChecked(True)
        canvas.cursor_moved.connect(window.status.show_place)
        canvas.cursor_moved.connect(lambda *_: window.status.show_grid(canvas.grid_step))
        canvas.prompt_changed.connect(window.command_line.set_prompt)
        canvas.hovered.connect(self.showing.show_hovered)
        canvas.message.connect(lambda text: window.status.show_message(text, error=True))
        canvas.key_typed.connect(window.command_line.begin)
        canvas.tool_changed.connect(lambda tool: window.actions_[names[tool]].setChecked(True))
        window.command_line.set_prompt(canvas.prompt)

    def run(self, line: str) -> None:
        """Carry out one line of the drawing language; what is wrong with it stands in the log."""
        with suppress(HitofudeError):
            self.document.run(line)

    def compute(self) -> None:
        """Compute the paths and show them."""
        if not self.document.part.entities:
            self._say("Nothing is drawn yet; draw a closed contour or open a drawing first.")
            return
        self.window_.notice.hide()
        self.computation.start()
        if self.showing.view is View.DRAW:
            self.showing.show_view(View.PATHS)

    def cancel(self) -> None:
        """Leave the running job."""
        if self.window_.worker.busy:
            self.window_.worker.cancel()
            self._say("Cancelled; nothing has changed.")

    def open_file(self, path: Path, units: Units | None = None) -> None:
        """Open a drawing, after asking when changes would be lost."""
        self._leave_drawing(f"Open {path.name}", lambda: self.opening.open(path, units))

    def open_sample(self) -> None:
        """Open the sample part; it is computed at once."""
        self.opening.open(opening_files.sample_path())

    def new(self) -> None:
        """Begin an empty drawing with the same tools."""
        self.document.load(replace(self.document.job, part=Part()))
        self.computation.forget()
        self._note("new", "Empty drawing, same tools.")
        self.window_.notice.hide()
        self.showing.show_view(View.DRAW)

    def choose_theme(self, choice: ThemeChoice) -> None:
        """Switch colours and remember it."""
        self.window_.settings = replace(self.window_.settings, theme=choice)
        self.window_.set_theme_choice(choice)
        self.remember()

    def remember(self) -> None:
        """Save the settings; a folder that cannot be written is no reason to bother anybody."""
        geometry = bytes(self.window_.saveGeometry().toBase64().data()).decode()
        self.window_.settings = replace(self.window_.settings, window_geometry=geometry)
        with suppress(HitofudeError):
            save_settings(self.window_.settings)

    def restore_geometry(self) -> None:
        """Put the window where it was the last time."""
        if self.window_.settings.window_geometry:
            self.window_.restoreGeometry(QByteArray.fromBase64(self.window_.settings.window_geometry.encode()))

    def _leave_drawing(self, what: str, act: Callable[[], None]) -> None:
        if not self.document.modified or not self.document.part.entities:
            act()
            return
        self.window_.notice.ask(f"{what}? The changes to this drawing are in no file and will be lost.",
                                [("Give up the changes", act), ("Keep drawing", lambda: None)])

    def _on_closing(self) -> None:
        window = self.window_
        window.may_close = window.may_close and (not self.document.modified or not self.document.part.entities)
        if not window.may_close:
            window.notice.ask("Close? The changes to this drawing are in no file and will be lost.",
                              [("Close", self._close_anyway), ("Keep drawing", lambda: None)])
            return
        self.remember()

    def _close_anyway(self) -> None:
        self.document.mark_saved(self.document.path or Path())
        self.window_.may_close = True
        self.window_.close()

    def _on_written(self, path: str, lines: int) -> None:
        self._note(f"export {Path(path).name}", f"{counted(lines, 'line')} written to {path}")
        self._say(f"{Path(path).name} is written.")

    def _on_computed(self) -> None:
        made = self.computation.made
        if made is not None:
            self._note("compute", f"{counted(len(made.program.moves), 'move')}. {verdict(made.findings, made.report.data).text}")

    def _on_opened(self, opened: Opened) -> None:
        self.window_.settings = self.window_.settings.with_recent_file(opened.path)
        self.computation.forget(opened.drawing.findings)
        self._note(f"open {opened.path.name}", self._size_sentence())
        self.window_.notice.hide()
        self.showing.show_view(View.DRAW)
        if opened.path == opening_files.sample_path():
            self.computation.start()
            self.showing.show_view(View.PATHS)
            self.window_.notice.ask(FIRST_START, [("Draw your own", lambda: self._leave_drawing("Begin a new drawing", self.new))])
        elif not opened.drawing.units_named:
            self._ask_units(opened)
        self.window_.lay_out_now()
        self.window_.canvas.fit()

    def _size_sentence(self) -> str:
        size = self.showing.part_size() or (0.0, 0.0)
        curves = counted(len(self.document.part.entities), "curve")
        findings = len(self.computation.drawing_findings)
        more = f" {counted(findings, 'remark')} on the drawing: see Compute, Findings." if findings else ""
        return f"{curves}, {grouped(size[0])} by {grouped(size[1])} mm.{more}"

    def _ask_units(self, opened: Opened) -> None:
        size = self.showing.part_size()
        read = opened.units or Units.MM
        as_read = "" if size is None else f", which makes it {size[0]:.3f} by {size[1]:.3f} mm"
        name = {Units.MM: "mm", Units.INCH: "inch"}
        other = Units.INCH if read is Units.MM else Units.MM
        self.window_.notice.ask(
            f"{opened.path.name} names no units. It was read in {name[read]}{as_read}. Choose its units.",
            [(f"Keep {name[read]}", lambda: None), (f"Read in {name[other]}", lambda: self.open_file(opened.path, other))])

    def _choose_drawing(self) -> None:
        name, _ = QFileDialog.getOpenFileName(self.window_, "Open drawing", self.window_.settings.last_folder, opening_files.FILTER)
        if name:
            self.open_file(Path(name))

    def _choose_nc_file(self) -> Path | None:
        stem = self.document.path.stem if self.document.path else self.document.part.name
        start = str(Path(self.window_.settings.last_folder) / f"{stem}.ngc")
        name, _ = QFileDialog.getSaveFileName(self.window_, "Export NC", start, FILTER)
        return Path(name) if name else None

    def _on_entered(self, text: str) -> None:
        name = TOOL_WORDS.get(text.lower())
        if name is not None:
            self.window_.actions_[name].trigger()
            self.window_.canvas.setFocus()
        elif not self.window_.canvas.type_text(text):
            self.run(text)

    def _on_escape(self) -> None:
        self.window_.canvas.cancel()
        self.window_.canvas.setFocus()

    def _on_change(self, change: Change) -> None:
        if change & Change.LOG:
            self._logged = min(self._logged, len(self.document.log))
            self._log += self.document.log[self._logged:]
            self._logged = len(self.document.log)
            self.window_.command_line.log.show_lines(self._log)
        self.showing.refresh(change)

    def _note(self, what: str, reply: str) -> None:
        """Put something that is no line of the drawing language in the log that is shown."""
        self._log.append(LogLine(what, reply))
        self.window_.command_line.log.show_lines(self._log)

    def _say(self, text: str) -> None:
        self.window_.status.show_message(text)

    def _say_error(self, text: str) -> None:
        self.window_.status.show_message(text, error=True)
        self.window_.notice.ask(text, error=True)

    def _show_keys(self) -> None:
        QMessageBox(QMessageBox.Icon.NoIcon, "Keys", keys_text(), QMessageBox.StandardButton.Close, self.window_).open()

    def _show_about(self) -> None:
        text = (f"<h3>Hitofude {__version__}</h3><p>From a line drawing to tool paths that can be trusted on a real machine.</p>"
                "<p>Contour and pocket paths after JP H07-107645 (1986), with exact lines and arcs.</p><p>MIT licence.</p>")
        QMessageBox(QMessageBox.Icon.NoIcon, "About Hitofude", text, QMessageBox.StandardButton.Close, self.window_).open()

