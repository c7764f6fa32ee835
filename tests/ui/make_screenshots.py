"""Takes the pictures of the window: `python -m tests.ui.make_screenshots [FOLDER]`.

Without a folder it renews the pictures of the manual and the README, resources/docs/window.png and cut.png; with one it
writes every view there, light and dark, at 1280 x 800 and 1920 x 1080.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from itertools import chain
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtCore import QEventLoop, QTimer
from PySide6.QtWidgets import QApplication

from app.core.settings import ThemeChoice
from app.fitting.point_curves.correction import CorrectionScope
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View, views
from app.ui.shell.start import build
from app.ui.shell.window_controller import WindowController
from app.ui.views.nc.motion_shapes import ViewSide
from app.ui.views.nc.painting.motion_layer import MotionColourBy
from tests.ui.curves.facets import facets
from tests.ui.drawing_states import DrawingStates
from tests.ui.stages.scan import scan
from tests.ui.window_picture import seen

SIZES = ((1280, 800), (1920, 1080))
PROGRAMS = Path(__file__).resolve().parents[1] / "data" / "nc"
DOCUMENT = Path(__file__).resolve().parents[2] / "resources" / "docs" / "window.png"


def wait(milliseconds: int) -> None:
    """Let the window live for a while."""
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def computed_sample() -> WindowController:
    """Return a shown window with the sample part, computed."""
    window, wiring = build()
    window.resize(1440, 900)
    window.show()
    wiring.files.open_sample()
    end = time.monotonic() + 120
    while wiring.computation.state is not ComputationState.CURRENT:
        if time.monotonic() > end:
            raise SystemExit(
                f"the sample was not computed: {wiring.computation.state.value} {wiring.computation.error}"
            )
        wait(20)
    return wiring


def take(wiring: WindowController, path: Path) -> None:
    """Save what the window looks like, with what is open over it."""
    wait(400)
    seen(wiring.window_).save(str(path))
    print(path)


def wait_until(done: Callable[[], bool]) -> None:
    """Let the window live until something is so."""
    end = time.monotonic() + 60
    while not done():
        if time.monotonic() > end:
            raise SystemExit("what the picture should show did not come")
        wait(20)


def open_program(wiring: WindowController, path: Path) -> None:
    """Show a program in the NC view."""
    wiring.nc.open(path)
    wait_until(lambda: wiring.window_.views.nc.shown is not None and wiring.window_.views.nc.shown.source.path == path)


def nc_states(wiring: WindowController, folder: Path) -> dict[str, Callable[[], None]]:
    """Return what the NC view is photographed with: own program, foreign ones, a side, an error, find, two programs."""
    nc = wiring.window_.views.nc
    changed = folder / "changed.ngc"
    changed.write_bytes(
        (PROGRAMS / "tux.ngc").read_bytes().replace(b"Y 2.500000", b"Y 2.650000").replace(b"F     200", b"F 250")
    )

    def own() -> None:
        wiring.display_controller.show_view(View.NC)
        wiring.nc.back()
        wait_until(lambda: nc.shown is not None and nc.shown.source.path is None)
        nc.set_side(ViewSide.XY)
        nc.pane.text.pick(95)

    def foreign() -> None:
        open_program(wiring, PROGRAMS / "test_pycam.ngc")
        nc.pane.text.pick(5000)

    def front() -> None:
        nc.set_side(ViewSide.XZ)
        wait_until(lambda: nc.path.picture is not None and nc.path.picture.side is ViewSide.XZ)
        nc.set_colour(MotionColourBy.MOTION)

    def find() -> None:
        nc.set_colour(MotionColourBy.TOOL)
        nc.set_side(ViewSide.XY)
        nc.pane.begin_find("X22.9")
        nc.pane.find_next()

    def error() -> None:
        open_program(wiring, PROGRAMS / "helical-thread-milling.gcode")

    def compare() -> None:
        open_program(wiring, PROGRAMS / "tux.ngc")
        wiring.nc.compare(changed)
        wait_until(lambda: nc.compared is not None)
        nc.differences.step(1)
        nc.differences.step(1)

    return {"own": own, "foreign": foreign, "front": front, "find": find, "error": error, "compare": compare}


def cut_states(wiring: WindowController) -> dict[str, Callable[[], None]]:
    """Return what the Cut view is photographed with: a moment on the way, a picked place, another program, what is
    asked of one.
    """
    panel, cutting, view = wiring.window_.cut_panel, wiring.cut_controller, wiring.window_.views.cut

    def rest() -> None:
        wait(400)
        wait_until(lambda: view.render_scheduler.fine and not cutting.zoom_controller.worker.busy)

    def place() -> None:
        wiring.display_controller.show_view(View.CUT)
        wiring.window_.views.cut_page.player.go(10**9)
        panel.rows[0].clicked.emit()
        rest()

    def program(name: str) -> None:
        open_program(wiring, PROGRAMS / name)
        wiring.window_.actions_["nc_cut"].trigger()
        wait_until(lambda: not cutting.foreign_worker.busy)

    def foreign() -> None:
        program("test_pycam.ngc")
        view.fit()
        rest()

    def played() -> None:
        wiring.display_controller.show_view(View.CUT)
        player = wiring.window_.views.cut_page.player
        wait_until(lambda: player.timeline is not None)
        if player.timeline is not None:
            player.seek(0.4 * player.timeline.total)
        wait_until(lambda: not player.worker.busy and not player.at_end)
        view.fit()
        rest()

    return {"played": played, "place": place, "foreign": foreign, "asked": lambda: program("tux.ngc")}


def curves_states(wiring: WindowController) -> dict[str, Callable[[], None]]:
    """Return what the Curves view is photographed with: an engraving as arcs, and the place where both paths are
    farthest apart.
    """
    view, panel = wiring.window_.views.curves, wiring.window_.curves_panel

    def arcs() -> None:
        panel.points.points.buttons[False].click()
        open_program(wiring, PROGRAMS / "jsdc.gcode")
        wiring.display_controller.show_view(View.CURVES)
        panel.preset.buttons[0.05].click()
        panel.smooth.click()
        wait_until(lambda: view.curves is not None and not wiring.smoothing_controller.reading.worker.busy)

    def farthest() -> None:
        spot = view.curves.track.farthest() if view.curves is not None else None
        if spot is not None:
            view.go_to(spot)
        wait(400)
        view.path.zoom_by(40.0)

    def points() -> None:
        path = Path(os.environ["HITOFUDE_CONFIG"]) / "facets.ngc"
        path.write_text(facets())
        open_program(wiring, path)
        wiring.display_controller.show_view(View.CURVES)
        panel.tolerance.show_value(0.2)
        panel.tolerance.committed.emit(0.2)
        panel.points.points.buttons[True].click()
        panel.points.others.buttons["corrected"].click()
        panel.points.select.buttons[CorrectionScope.RATIO].click()
        panel.points.near.show_value(0.3)
        panel.smooth.click()
        wait_until(lambda: view.curves is not None and not wiring.smoothing_controller.reading.worker.busy)
        farthest()

    return {"arcs": arcs, "farthest": farthest, "points": points}


def stage_states(wiring: WindowController, folder: Path) -> dict[str, Callable[[], None]]:
    """Return what the Stages view is photographed with: traced lines, a peel, paths, fitted lines, letters, a picture
    taken in.
    """
    view, panel = wiring.window_.views.stages, wiring.window_.stages_panel
    path = scan(folder / "scan.png")

    def step(number: int) -> None:
        wiring.import_controller.leave()
        wiring.display_controller.show_view(View.STAGES)
        wait_until(lambda: view.film is not None and not wiring.stages_controller.worker.busy)
        view.show_stage(view.film.seek_step(number, -1) if view.film is not None else 0)
        view.pixels.fit_now()

    def traced() -> None:
        step(203)
        panel.chains.list.setCurrentRow(0)

    def letters() -> None:
        step(206)
        view.pixels.go_to((46.0, 68.0), 13)

    def picture() -> None:
        wiring.import_controller.open(path)
        wait_until(lambda: wiring.import_controller.preview is not None and not wiring.import_controller.worker.busy)
        wiring.window_.import_panel.list.setCurrentRow(-1)

    return {
        "traced": traced,
        "peel": lambda: step(304),
        "frame": lambda: step(143),
        "paths": lambda: step(140),
        "fitted": lambda: step(406),
        "letters": letters,
        "picture": picture,
    }


def take_cut(wiring: WindowController, path: Path) -> None:
    """Take the cut on its way, the tool in it, at rest."""
    wiring.display_controller.show_view(View.CUT)
    view, page = wiring.window_.views.cut, wiring.window_.views.cut_page
    wiring.window_.notice.hide()
    wait_until(lambda: page.player.length > 0)
    page.player.go(round(0.45 * page.player.length))
    wait(1500)
    wait_until(lambda: view.render_scheduler.fine and not wiring.cut_controller.zoom_controller.worker.busy)
    take(wiring, path)


def take_drawing(wiring: WindowController, folder: Path) -> None:
    """Take every tool, page and menu of the drawing workstation; what was open is not kept."""
    states = DrawingStates(wiring, wait)
    for theme in (ThemeChoice.LIGHT, ThemeChoice.DARK):
        wiring.window_.choose_theme(theme)
        for width, height in SIZES:
            wiring.window_.resize(width, height)
            states.begin()
            for name in chain(states.tools(), states.pages(), states.over(), states.printing()):
                take(wiring, folder / f"draw-{name}-{theme.value}-{width}.png")
            states.windows(folder, f"{theme.value}.png")


def main() -> None:
    """Take the pictures."""
    os.environ["HITOFUDE_CONFIG"] = tempfile.mkdtemp()
    application = QApplication.instance() or QApplication([])
    wiring = computed_sample()
    if len(sys.argv) < 2:
        wiring.window_.choose_theme(ThemeChoice.LIGHT)
        take(wiring, DOCUMENT)
        wiring.window_.choose_theme(ThemeChoice.DARK)
        take_cut(wiring, DOCUMENT.with_name("cut.png"))
        return
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for theme in (ThemeChoice.LIGHT, ThemeChoice.DARK):
        wiring.window_.choose_theme(theme)
        for width, height in SIZES:
            wiring.window_.resize(width, height)
            wiring.open_start()
            wait_until(lambda: not wiring.start_controller.worker.busy)
            take(wiring, folder / f"start-{theme.value}-{width}.png")
            for view in views():
                wiring.display_controller.show_view(view)
                wait(50)
                wiring.window_.canvas.fit()
                if view is View.STAGES:
                    wait_until(lambda: wiring.window_.views.stages.film is not None)
                if view is View.CUT:
                    wait_until(lambda: wiring.window_.views.cut.render_scheduler.fine)
                take(wiring, folder / f"{view.value.removeprefix('view_')}-{theme.value}-{width}.png")
            for name, arrange in stage_states(wiring, Path(os.environ["HITOFUDE_CONFIG"])).items():
                arrange()
                take(wiring, folder / f"stages-{name}-{theme.value}-{width}.png")
            wiring.import_controller.leave()
            for name, arrange in nc_states(wiring, Path(os.environ["HITOFUDE_CONFIG"])).items():
                arrange()
                take(wiring, folder / f"nc-{name}-{theme.value}-{width}.png")
            for name, arrange in curves_states(wiring).items():
                arrange()
                take(wiring, folder / f"curves-{name}-{theme.value}-{width}.png")
            for name, arrange in cut_states(wiring).items():
                arrange()
                take(wiring, folder / f"cut-{name}-{theme.value}-{width}.png")
            wiring.cut_controller.back()
            wiring.nc.back()
    take_drawing(wiring, folder)
    wiring.window_.close()
    application.quit()


if __name__ == "__main__":
    main()
