"""What happens with scenes: opened, changed in panel and text, computed, saved, shown as NC and as a cut."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog

from ....core.atomic import write_atomically
from ....core.errors import HitofudeError, InputError
from ....core.resources import resource
from ....formats.scene.edit import line_of, with_table, with_table_moved
from ....model.finding import Finding, FindingKind
from ....model.scene import Scene
from ....usecases.scene.solid_files import SOLIDS, STEPS
from ....usecases.step_extra import fetch_step_reader, step_files_readable
from ...framework.controller import Controller, OfferedMend, ShownDocument
from ...framework.figures import counted
from ...framework.workspace import Workspace
from ..nc.program_reader import ProgramReader, ProgramSource
from .new_parts import (
    NEW_SCENE,
    Table,
    free_name,
    new_passes,
    new_surface,
    new_tool,
    passes_across,
    roughing_passes,
    surface_from_curves,
)
from .scene_computation import SceneComputation, SceneState
from .scene_document import UNTITLED, SceneDocument
from .scene_fields import SHAPES
from .scene_tabs import POINTS, TEXT, SceneTabs
from .shown_scene import ShownScene, read_file
from .view import SurfacesView

if TYPE_CHECKING:
    from ....gcode.interpreter.dialect import Dialect
    from ....usecases.scene.solid_scene import OpenedSolid
    from ....verify.parts import Part

SAMPLES = ("compound", "spheres", "torus", "die")
FILTER = "Scenes (*.toml)"
_SOLIDS = f"Meshes and STEP files ({' '.join(f'*{suffix}' for suffix in SOLIDS)})"


@dataclass(frozen=True, eq=False)
class SceneProgram:
    """A scene's program: its text and how it is read, what it is to come to, and how many there are of it; the first is
    told of.
    """

    source: ProgramSource
    dialect: Dialect
    part: Callable[[], Part]
    files: int


class SceneController(Controller):
    """Everything between a scene, its view and its files.

    Signals:
        nc_requested(ProgramSource): to be shown in the NC view. cut_requested(SceneProgram): in the Cut view.
        close_requested(): the user has answered, and the window may close.

    Attributes:
        work: reads and computes. choose_file: asks for a path to save to, given a first choice; choose_mesh: for one to
            read.
    """

    nc_requested = Signal(object)
    cut_requested = Signal(object)
    close_requested = Signal()

    def __init__(self, view: SurfacesView, side: SceneTabs, document: SceneDocument, workspace: Workspace) -> None:
        super().__init__(view)
        self._view, self._side, self.document, self._workspace = view, side, document, workspace
        self._preferences, self._log = workspace.preferences, workspace.log
        self.work = SceneComputation(self.document, self)
        self._solids = ProgramReader(self)
        self._solids.failed.connect(self.failed)
        workspace.activity.follow(self._solids.worker)
        self._given_up = False
        self.choose_file: Callable[[Path], Path | None] = self._choose_file
        self.choose_mesh: Callable[[], Path | None] = self._choose_mesh
        self._connect_work()
        self._connect_side()

    def _connect_work(self) -> None:
        work, activity = self.work, self._workspace.activity
        work.began.connect(self._view.show_nothing)
        work.began.connect(self.changed)
        work.read.connect(self._on_read)
        work.wrong.connect(self._on_wrong)
        work.computed.connect(self._on_computed)
        work.failed.connect(self.failed)
        work.stands.connect(self._on_stands)
        activity.cancelled.connect(work.cancel)
        activity.follow(work.reading.worker)

    def _connect_side(self) -> None:
        panel, side = self._side.panel, self._side
        panel.changed.connect(self._change)
        panel.surface_requested.connect(
            lambda kind: self._add("surface", lambda scene: new_surface(kind, scene, self._box))
        )
        panel.curves_requested.connect(self.add_from_curves)
        panel.file_requested.connect(self.add_from_file)
        panel.passes_requested.connect(lambda: self._add("passes", new_passes))
        panel.tool_requested.connect(lambda: self._add("tool", new_tool))
        panel.text_requested.connect(self._show_in_text)
        side.text.left.connect(self._view.setFocus)
        side.points.chosen.connect(self._view.show_point)
        self._view.point_picked.connect(self._on_point_picked)
        self._view.surface_picked.connect(lambda number: panel.choose(("surface", number)))

    @property
    def shown_document(self) -> ShownDocument | None:
        """The open scene; None while none is."""
        if not self.document.open:
            return None
        work = self.work
        return ShownDocument(
            self.document.name,
            self.document.modified,
            None if work.busy else work.verdict,
            work.findings,
            mends=self._mends,
        )

    def open(self, path: Path) -> None:
        """Open a scene file, after asking when changes to another one would be lost."""
        self.leave(f"Open {path.name}?", partial(self._open, path))

    def open_solid(self, path: Path) -> None:
        """Open a mesh or a STEP file as a scene of its own, after asking when changes to another one would be lost;
        what reads STEP files is fetched first where it is missing.
        """
        if not path.name.lower().endswith(STEPS) or step_files_readable():
            self.leave(f"Open {path.name}?", partial(self._read_solid, path))
            return
        self._workspace.notice.ask(
            f"{path.name} is a STEP file. What reads these, Open CASCADE, is not installed yet; it takes some 150 MB.",
            [("Fetch it and open", partial(self._fetch_for, path)), ("Not now", lambda: None)],
            stays=True,
        )

    def _fetch_for(self, path: Path) -> None:
        self._solids.start(lambda progress: fetch_step_reader(progress=progress), lambda _: self.open_solid(path))

    def _read_solid(self, path: Path) -> None:
        from ....formats.scene.toml import sources_of
        from ....usecases.scene.solid_scene import open_solid

        whole = path.absolute()
        sources = sources_of(lambda name: read_file(Path(name)))
        self._solids.start(lambda progress: open_solid(path.name, str(whole), sources, progress), self._on_solid)

    def _on_solid(self, solid: OpenedSolid) -> None:
        """Show a solid, and ask about its units where its file does not tell."""
        from ....usecases.scene.solid_scene import INCH

        stem = Path(solid.name).stem
        self._preferences.add_recent(Path(solid.path))
        self._begin(solid.text(), None, stem)
        if question := solid.question():
            self._workspace.notice.ask(
                question,
                [
                    ("It is in inches", lambda: self._change(lambda _: solid.text(INCH))),
                    ("It is in millimetres", lambda: None),
                ],
                stays=True,
            )
            self._workspace.notice.show_with(self._view)

    def new(self) -> None:
        """Begin a scene, after asking when changes to another one would be lost."""
        self.leave("Begin a new scene?", lambda: self._begin(NEW_SCENE, None))

    def open_sample(self, name: str) -> None:
        """Open a scene that comes with the program."""
        self.open(resource("samples", f"{name}.toml"))

    def compute(self) -> None:
        """Compute the scene again; one whose file another program has changed is read anew, unless it is changed here
        too.
        """
        document = self.document
        if not document.open:
            return
        if document.path is not None and not document.modified:
            try:
                text = _decoded(document.path)
            except HitofudeError as error:
                self.failed.emit(str(error))
                return
            document.replace(text)
            document.mark_saved(document.path)
        self.work.compute()

    def save(self, then: Callable[[], None] | None = None) -> None:
        """Save to the scene's own file, or ask for one; samples are not written over."""
        path = self.document.path
        if path is None or path.parent == resource("samples", "compound.toml").parent:
            self.save_as(then)
        else:
            self._save(path, then)

    def save_as(self, then: Callable[[], None] | None = None) -> None:
        """Ask for a file, and save to that from now on."""
        folder = self._preferences.last_folder
        path = self.document.path
        first = (
            folder / self.document.name
            if path is None or path.parent == resource("samples", "compound.toml").parent
            else path
        )
        chosen = self.choose_file(first)
        if chosen is not None:
            self._save(chosen if chosen.suffix else chosen.with_suffix(".toml"), then)

    def leave(self, question: str, act: Callable[[], None]) -> None:
        """Do what ends the work on this scene, after asking when changes would be lost."""
        if not self.document.modified:
            act()
            return
        self._workspace.notice.ask(
            f"{question} The changes to the scene {self.document.name} are not saved.",
            [
                ("Save", lambda: self.save(lambda: self.leave(question, act))),
                ("Give up the changes", act),
                ("Keep the scene", lambda: None),
            ],
            stays=True,
        )

    def may_close(self) -> bool:
        """Return whether the window may close; ask when changes would be lost, and emit `close_requested` later."""
        if not self.document.modified or self._given_up:
            return True
        self.leave("Close?", self._close_anyway)
        return False

    def show_nc(self) -> None:
        """Show the scene's program in the NC view."""
        program = self._program()
        if program is not None:
            self.nc_requested.emit(program.source)

    def show_cut(self) -> None:
        """Show what the scene's program leaves of its stock, beside the surfaces."""
        program = self._program()
        if program is not None and program.files > 1:
            self.failed.emit(
                f"This control takes {program.files} programs, one a tool, and the Cut view cuts one; "
                "choose a control that changes tools to see the whole cut."
            )
        elif program is not None:
            self.cut_requested.emit(program)

    def add_from_curves(self, kind: str) -> None:
        """Add a surface made of the curves that are selected in the drawing, in the order in which they were drawn."""
        from ....usecases.scene.drawn_sections import drawn_sections

        document = self._workspace.document
        wanted = {"loft": 2, "ruled": 2, "revolved": 1, "swept": 2}[kind]
        curves = drawn_sections(document.part, document.selection)
        if len(curves) < wanted:
            said = "a curve" if wanted == 1 else f"{wanted} curves"
            self.failed.emit(f"{SHAPES[kind]} needs {said}: select them in the Draw view, then add the surface here.")
            return
        self._add("surface", lambda scene: surface_from_curves(kind, curves, scene))

    def add_from_file(self) -> None:
        """Ask for a mesh or a STEP file and add it."""
        path = self.choose_mesh()
        if path is None:
            return
        kind = "step" if path.suffix.lower() in (".step", ".stp") else "mesh"
        base = self.document.path.parent if self.document.path is not None else None
        named = path.name if base is not None and path.parent == base else str(path)
        self._add(
            "surface",
            lambda scene: {
                "name": free_name(path.stem, (each.name for each in scene.surfaces)),
                "shape": {"kind": kind, "file": named},
            },
        )

    @property
    def _box(self) -> tuple[float, ...]:
        """The stock's box, mm, as far as it is known."""
        if self.work.shown is None:
            return (-50.0, -50.0, -20.0, 50.0, 50.0, 0.0)
        stock = self.work.shown.computed.stock
        return (stock.x0, stock.y0, stock.z0, stock.x1, stock.y1, stock.z1)

    def _open(self, path: Path) -> None:
        try:
            text = _decoded(path)
        except HitofudeError as error:
            self.failed.emit(str(error))
            return
        self._preferences.add_recent(path)
        self._begin(text, path)

    def _begin(self, text: str, path: Path | None, stem: str = UNTITLED) -> None:
        self._workspace.notice.turn_over()
        self.front_requested.emit()
        self._side.panel.subject = ("scene", 0)
        self.work.begin(text, path, stem)
        if self.work.state is SceneState.WRONG:
            self.failed.emit(self.work.problem)

    def _save(self, path: Path, then: Callable[[], None] | None) -> None:
        try:
            write_atomically(path, self.document.text.encode())
        except (HitofudeError, OSError) as error:
            self.failed.emit(f"{path.name} was not saved: {error}")
            return
        moved = self.document.path is not None and self.document.path.parent != path.parent
        self.document.mark_saved(path)
        self._preferences.add_recent(path)
        self._preferences.save()
        self._log.note(f"save {path.name}", f"Saved to {path.parent}.")
        self.said.emit(f"{path.name} is saved.")
        if moved:
            self.work.compute()  # files that it names are looked for beside it
        if then is not None:
            then()

    def _close_anyway(self) -> None:
        self._given_up = True
        self.close_requested.emit()

    def _change(self, change: Callable[[str], str]) -> None:
        try:
            self.document.edit(change)
        except InputError as error:
            self.failed.emit(str(error))

    def _add(self, name: str, table: Callable[[Scene], Table]) -> None:
        scene = self.work.scene
        if scene is None:
            self.failed.emit("The scene's text is wrong at the moment; correct it first.")
            return
        made = table(scene)
        number = len({"surface": scene.surfaces, "passes": scene.passes, "tool": scene.tools}[name])
        self._side.panel.awaited = (name, number)
        self._change(lambda text: with_table(text, name, made))

    def _mends(self, finding: Finding) -> tuple[OfferedMend, ...]:
        """Return what clears metal that passes have left, or takes it in depths where they take too much at once."""
        if finding.kind is FindingKind.ENGAGEMENT:
            return self._roughing()
        across = passes_across(self.work.scene) if self.work.scene is not None else None
        if finding.kind is not FindingKind.LEFT_REACHABLE or across is None or self.work.busy:
            return ()
        change = f"T{across['tool']} at {across['angle_deg']:g} degrees"
        return (OfferedMend("Add passes across", change, lambda: self._add("passes", lambda _: across)),)

    def _roughing(self) -> tuple[OfferedMend, ...]:
        scene = self.work.scene
        made = roughing_passes(scene, self._box) if scene is not None and not self.work.busy else ()
        if scene is None or not made:
            return ()
        many = len(scene.passes)

        def put_first(text: str) -> str:
            for number, table in enumerate(made):
                text = with_table_moved(with_table(text, "passes", table), "passes", many + number, -many)
            return text

        change = f"T{made[0]['tool']} in {counted(len(made), 'depth')}"
        return (OfferedMend("Rough it first", change, lambda: self._change(put_first)),)

    def _show_in_text(self, name: str, number: int) -> None:
        self._side.show_page(TEXT)
        self._side.text.editor.go_to(1 if name == "scene" else line_of(self.document.text, name, number))

    def _on_point_picked(self, number: int) -> None:
        self._side.show_page(POINTS)
        self._side.points.choose(number)

    def _on_read(self, scene: Scene) -> None:
        from ....gcode.posts import post_titles

        self._side.panel.show_posts(tuple(post_titles().items()))
        self._side.panel.show_scene(scene)
        self._side.text.show_right(_made_of(scene))
        self.changed.emit()

    def _on_wrong(self, line: int, sentence: str) -> None:
        self._side.text.show_problem(line, sentence)
        if self.work.scene is None:
            self._side.show_page(TEXT)
        self.changed.emit()

    def _on_computed(self, shown: ShownScene, again: bool) -> None:
        from ....usecases.scene.picture import boundary_points

        points = boundary_points(shown.computed)
        self._view.show_scene(shown, points, again)
        self._side.panel.show_block(self._box)
        self._side.points.show_points(points)
        if not again:
            self._log.note(f"open {shown.path.name}", _made_of(self.work.scene or shown.computed.scene))
        self.changed.emit()

    def _on_stands(self) -> None:
        self._view.at_once = self.work.at_once
        self._view.show_standing(self.work.state, self.work.verdict, self.work.findings, self.work.may_retry)
        self.changed.emit()

    def _program(self) -> SceneProgram | None:
        program = self.program()
        if program is None:
            self.failed.emit("The scene's program is not proven yet; wait until it is, or compute it with F5.")
        return program

    def program(self) -> SceneProgram | None:
        """Return the scene's program; None while it is not proven."""
        proven, shown = self.work.proven, self.work.shown
        if proven is None or shown is None:
            return None
        written, computed = proven.written, shown.computed
        file = written.files[0]
        source = ProgramSource(file.named(shown.path.with_suffix(".ngc")).name, data=file.nc.text.encode())

        def part() -> Part:
            from ....formats.scene.toml import sources_of
            from ....usecases.scene.part import scene_part

            return scene_part(
                computed.scene, sources_of(lambda name: read_file(shown.path.parent / name)), None, None, None
            )

        return SceneProgram(source, written.post.dialect, part, len(written.files))

    def _choose_file(self, first: Path) -> Path | None:
        name, _ = QFileDialog.getSaveFileName(self._view, "Save scene", str(first), FILTER)
        return Path(name) if name else None

    def _choose_mesh(self) -> Path | None:
        name, _ = QFileDialog.getOpenFileName(
            self._view, "Add a surface from a file", self._preferences.settings.last_folder, _SOLIDS
        )
        return Path(name) if name else None


def _decoded(path: Path) -> str:
    """Return the text of a file.

    Raises:
        InputError: it cannot be read, or is no UTF-8.
    """
    try:
        return read_file(path).decode("utf-8").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path.name} is no UTF-8 text (byte {error.start}), so it is no scene; choose another file."
        ) from error


def _made_of(scene: Scene) -> str:
    on = sum(passes.enabled for passes in scene.passes)
    parts = (counted(len(scene.surfaces), "surface"), counted(len(scene.tools), "tool"))
    return f"{', '.join(parts)}, {on} of {counted(len(scene.passes), 'family', 'families')} of passes switched on"
