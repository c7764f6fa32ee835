"""The pages of the views: what each puts into the window, what it lacks, and what stands beside it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from PySide6.QtWidgets import QWidget

from ..framework.computation import ComputationState
from ..framework.missing import NOTHING, MissingHint, failed_hint
from ..framework.view import View, ViewPage, views
from ..views.canvas.modes import CanvasTool
from ..views.surfaces.scene_computation import SceneState
from .main_window import MainWindow

NO_DRAWING = MissingHint(
    "Nothing is drawn yet. Pick a tool at the left, type  rect 0,0 60,40  or open a drawing.", "Open a drawing"
)
NO_PART = MissingHint("Nothing is drawn yet. Draw a part, type  rect 0,0 60,40  or open a drawing.", "Open a drawing")
NO_PATHS = MissingHint("There are no tool paths yet.", "Compute  F5", "compute")
NO_CUT = MissingHint("There is no cut yet.", "Compute  F5", "compute")
CUTTING = MissingHint("The program is being cut.", "Cancel  Shift+F5", "cancel")
CUT_PREPARED = MissingHint("The cut is being made ready to be looked at.")
NO_NC = MissingHint("There is no NC program yet.", "Compute  F5", "compute")
NO_PROGRAM = MissingHint(
    "There is no NC program yet. Draw a part and compute it, or open a program.", "Open an NC program", "nc_open"
)
NO_SCENE = MissingHint(
    "No scene is open. Open one, begin one (File, New scene), or look at figure 1 of the 1986 patent.",
    "Open figure 1",
    "scene_compound",
)
WRONG_SCENE = MissingHint("The scene's text is wrong; the line is marked at the right.", "Open another scene")
SCENE_WAITS = MissingHint("The scene is not computed yet.", "Compute  F5", "compute")
SCENE_COMPUTING = MissingHint("The scene is being computed.", "Cancel  Shift+F5", "cancel")
SCENE_UNPROVEN = MissingHint(
    "The scene's program is shown here when it is computed and proven.", "Show the scene", View.SURFACES.value
)
SCENE_CUT = MissingHint("The scene's cut is not shown.", "Show the scene's cut", "scene_cut")
SCENE_NC = MissingHint("The scene's program is not shown.", "Show the scene's NC program", "scene_nc")
NC_PROMPT = "Commands draw and set up the job; Ctrl+F finds in the program"
CUT_PROMPT = (
    "Space plays, . and , step; drag turns the cut, the middle button shifts it, Ctrl+drag measures; a click marks "
    "the line that cut there"
)
CURVES_PROMPT = "Say how near curves must keep to the moves, then Smooth; click the deviation to see the place"
SURFACES_PROMPT = (
    "Drag turns the scene, the middle button shifts it; what is set at the right is computed at once; Ctrl+E writes it"
)
NO_SCENE_PROMPT = "Open a scene, drop a solid anywhere, or begin one with File, New scene"
SLOW_SURFACES_PROMPT = (
    "Drag turns the scene, the middle button shifts it; F5 computes what is set at the right; Ctrl+E writes it"
)
_NO_SCENE = {
    SceneState.NONE: NO_SCENE,
    SceneState.WRONG: WRONG_SCENE,
    SceneState.CHANGED: SCENE_WAITS,
    SceneState.COMPUTING: SCENE_COMPUTING,
    SceneState.PROVING: SCENE_COMPUTING,
    SceneState.PROVEN: SCENE_COMPUTING,
}
STAGES_PROMPT = "Space plays, Left and Right step; click a traced line to see its chain code"
FILM_PROMPT = "Space plays, Left and Right step; Save all steps writes pictures and figures"
PICTURE_PROMPT = "Say what is ink and how large a pixel is; what lies green is machined"
COMPUTING = MissingHint("The paths are being computed.", "Cancel  Shift+F5", "cancel")


class WindowState(Protocol):
    """What pages are told of the window's state."""

    stages_missing: MissingHint
    film_missing: MissingHint
    writing: bool
    opening: str


def pages_of(window: MainWindow, told: WindowState) -> dict[View, ViewPage]:
    """Return the page of every view; those that were registered beside the window's own are made."""
    pages = {**_drawing_pages(window, told), **_program_pages(window), **_bitmap_and_scene_pages(window, told)}
    return {view: pages[view] if view.make is None else view.make(window.workspace) for view in views()}


def _drawing_pages(window: MainWindow, told: WindowState) -> dict[View, ViewPage]:
    canvas, document, computation = window.canvas, window.document, window.computation

    def none_drawn() -> MissingHint:
        if told.opening:
            return MissingHint(f"{told.opening} is being read.", "Cancel  Shift+F5", "cancel")
        return NOTHING if told.writing or canvas.tool is not CanvasTool.SELECT else NO_DRAWING

    def drawing_missing() -> MissingHint:
        computed = computation.made is not None or computation.state is ComputationState.RUNNING
        return NOTHING if computed or document.part.entities else none_drawn()

    def paths_missing() -> MissingHint:
        return _of_job(window, computation.made is not None, none_drawn, NO_PATHS)

    def cut_missing() -> MissingHint:
        asked = window.cut_form.asked
        shows = window.views.cut.model.picture is not None or bool(window.views.cut.sentence.text())
        if window.views.cut_page.cutting and not shows:
            return CUTTING
        if asked is not None and not shows:
            return MissingHint(f"{asked.foreign.source.name} is not cut yet: say at the right what cuts, and of what.")
        otherwise = CUT_PREPARED if window.views.cut_page.preparing else NO_CUT
        return _of_job(window, shows, lambda: _of_scene(window, SCENE_CUT, NO_PART), otherwise)

    def beside_cut() -> QWidget | None:
        if window.cut_form.asked is not None:
            return window.cut_form
        return window.cut_panel if window.cut_panel.shown is not None else _beside_nothing(window)

    def prompt() -> str:
        return canvas.prompt

    cut = ViewPage(window.views.cut_page, window.views.cut, lambda: CUT_PROMPT, cut_missing, side=beside_cut)
    return {
        View.DRAW: ViewPage(canvas, canvas, prompt, drawing_missing, side=lambda: window.side),
        View.PATHS: ViewPage(canvas, canvas, prompt, paths_missing, side=lambda: window.side),
        View.CUT: cut,
    }


def _program_pages(window: MainWindow) -> dict[View, ViewPage]:
    nc, curves = window.views.nc, window.views.curves

    def missing() -> MissingHint:
        shows = window.computation.made is not None or len(nc.pane.text.text) > 0
        return _of_job(window, shows, lambda: _of_scene(window, SCENE_NC, NO_PROGRAM), NO_NC)

    return {
        View.CURVES: ViewPage(
            curves,
            curves.path,
            lambda: CURVES_PROMPT,
            missing,
            lambda: curves.summary,
            lambda: window.curves_panel,
        ),
        View.NC: ViewPage(
            nc,
            nc.path,
            lambda: NC_PROMPT,
            missing,
            lambda: nc.summary,
            lambda: nc.beside if nc.foreign else _beside_nothing(window),
        ),
    }


def _bitmap_and_scene_pages(window: MainWindow, told: WindowState) -> dict[View, ViewPage]:
    stages, surfaces, drawn = window.views.stages, window.views.surfaces, window.document

    def picture() -> bool:
        return window.import_panel.reading is not None

    def stages_missing() -> MissingHint:
        if stages.text != "A":
            return NOTHING if stages.films.film is not None else told.film_missing
        shows = stages.film is not None or picture()
        if not shows and drawn.part.entities:
            return told.stages_missing
        return _of_job(window, shows, lambda: NOTHING if told.writing else NO_PART, NOTHING)

    def beside_stages() -> QWidget | None:
        if picture():
            return window.import_panel
        if stages.text != "A":
            return window.film_panel
        return window.stages_panel if drawn.part.entities else window.side

    def scene_prompt() -> str:
        if surfaces.state is SceneState.NONE:
            return NO_SCENE_PROMPT
        return SURFACES_PROMPT if surfaces.at_once else SLOW_SURFACES_PROMPT

    def scene_missing() -> MissingHint:
        if surfaces.shown is not None:
            return NOTHING
        if surfaces.state is SceneState.FAILED:
            return failed_hint(surfaces.verdict.tip, surfaces.may_retry, "compute")
        return _NO_SCENE[surfaces.state]

    return {
        View.STAGES: ViewPage(
            stages,
            stages,
            lambda: PICTURE_PROMPT if picture() else STAGES_PROMPT if stages.text == "A" else FILM_PROMPT,
            stages_missing,
            lambda: stages.summary,
            beside_stages,
        ),
        View.SURFACES: ViewPage(
            surfaces,
            surfaces.canvas,
            scene_prompt,
            scene_missing,
            lambda: surfaces.summary,
            lambda: window.scene_side if window.scene.open else None,
        ),
    }


def _beside_nothing(window: MainWindow) -> QWidget:
    """Return what stands beside a view that shows no program of its own: the job, or, where nothing is drawn, the open
    scene.
    """
    return window.scene_side if window.scene.open and not window.document.part.entities else window.side


def _of_scene(window: MainWindow, closed: MissingHint, otherwise: MissingHint) -> MissingHint:
    """Return what a view says that shows no program, where nothing is drawn: what is to come of a scene, if one is
    open.
    """
    if not window.scene.open:
        return otherwise
    return closed if window.views.surfaces.state is SceneState.PROVEN else SCENE_UNPROVEN


def _of_job(
    window: MainWindow, shows: bool, none_drawn: Callable[[], MissingHint], otherwise: MissingHint
) -> MissingHint:
    """Return what is missing of what is made of the job, when a view shows it or not."""
    if shows:
        return NOTHING
    if window.computation.state is ComputationState.RUNNING:
        return COMPUTING
    if window.computation.state is ComputationState.FAILED:
        return failed_hint(window.computation.error, window.computation.may_retry, "compute")
    return otherwise if window.document.part.entities else none_drawn()
