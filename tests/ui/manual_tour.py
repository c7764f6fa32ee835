"""What the manual's tutorials and pages show, done in the real window: the pictures are taken on the way.

Each method is a page. A tutorial types the lines that stand in the page, so that what a reader is told is what was
done; `make_manual_pictures.py` saves what `take` is called with, the tests look whether it came out as the page says.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from PySide6.QtWidgets import QWidget

from app.core.resources import resource
from app.formats.job.toml import read_job
from app.model.curve_selectors import read_selector
from app.model.hole_operations import BoreOperation
from app.model.operation import Operation
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.shell.window_controller import WindowController
from app.ui.views.nc.motion_shapes import ViewSide
from app.ui.views.surfaces.scene_computation import SceneState

DOCS = resource("docs")
SAMPLES = resource("samples")
OPERATION_PAGES = (
    ("adaptive", "fig2.dxf", "adaptive.toml", View.PATHS),
    ("bore", "holes.draw", "holes.toml", View.PATHS),
    ("chamfer", "holes.draw", "holes.toml", View.CUT),
    ("contour", "plate.draw", "", View.PATHS),
    ("counterbore", "holes.draw", "holes.toml", View.CUT),
    ("countersink", "holes.draw", "holes.toml", View.CUT),
    ("drill", "holes.draw", "holes.toml", View.PATHS),
    ("engrave", "nameplate.draw", "", View.PATHS),
    ("face", "holes.draw", "holes.toml", View.PATHS),
    ("holes", "holes.draw", "holes.toml", View.PATHS),
    ("inlay", "inlay.draw", "inlay.toml", View.CUT),
    ("open_edges", "open.draw", "open.toml", View.CUT),
    ("pocket", "fig2.dxf", "", View.PATHS),
    ("ream", "holes.draw", "holes.toml", View.PATHS),
    ("slots", "slots.draw", "slots.toml", View.PATHS),
    ("spot", "holes.draw", "spot.toml", View.CUT),
    ("tap", "holes.draw", "holes.toml", View.PATHS),
    ("thread", "holes.draw", "holes.toml", View.PATHS),
    ("vcarve", "fig2.dxf", "vcarve.toml", View.CUT),
)
"""Page, sample and job (none: what the window proposes), and the view that is photographed."""

_LAYER_OF = {
    "bore": "bored",
    "counterbore": "bored",
    "countersink": "countersunk",
    "ream": "reamed",
    "tap": "tapped",
    "thread": "threaded",
}
"""The layer of holes.toml whose operations a page shows; together they lie one over the other."""


def _shown_on(page: str, operation: Operation) -> bool:
    """Return whether a page shows an operation of holes.toml."""
    if page == "face" or operation.FACES:
        return page == "face" and operation.FACES
    if page == "drill":
        return operation.WORD == "drill"
    if page == "bore" and isinstance(operation, BoreOperation) and operation.diameter is not None:
        return False
    return page not in _LAYER_OF or operation.cut.curves == (read_selector(f"layer:{_LAYER_OF[page]}"),)


def typed_lines(page: str) -> list[str]:
    """Return the lines of the shape language that a tutorial has its reader type: those set off that call nothing."""
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    lines = [line[4:] for line in text.splitlines() if line.startswith("    ")]
    return [line.partition("  #")[0].rstrip() for line in lines if not line.startswith("./")]


@dataclass(frozen=True)
class ManualTour:
    """The pages, played in a window.

    Attributes:
        wiring: the window's. until: lives on until something is so. pause: lives on for so many ms, so that what
            glides or sharpens has begun to. take: what becomes of a widget's picture, by its name.
    """

    wiring: WindowController
    until: Callable[[Callable[[], bool]], None]
    pause: Callable[[int], None]
    take: Callable[[str, QWidget], None]

    # tutorials

    def first_part(self) -> None:
        """Draw a bracket, have operations proposed, compute, see it cut."""
        self.wiring.files.new()
        for line in typed_lines("first_part"):
            self._after_change(partial(self.wiring.window_.command_line.entered.emit, line))
        self.wiring.window_.canvas.fit()
        self._show(View.DRAW, "first-drawn")
        self._propose()
        self._show(View.DRAW, "first-proposed")
        self._compute()
        self._show(View.PATHS, "first-paths")
        self._show(View.CUT, "first-cut")

    def sign(self) -> None:
        """The sample sign: proposed, engraved, cut out."""
        self._sample("nameplate.draw")
        self._show(View.DRAW, "sign-drawn")
        self._compute()
        self._show(View.CUT, "sign-cut")

    def mould(self) -> None:
        """A scene of three surfaces, its passes and its cut."""
        self.wiring.scenes.open(SAMPLES / "compound.toml")
        self.until(lambda: self.wiring.scenes.work.state is SceneState.PROVEN)
        self._show(View.SURFACES, "mould-scene")
        self.wiring.window_.actions_["scene_cut"].trigger()
        self.until(lambda: not self._busy() and not self.wiring.cut_controller.foreign_worker.busy)
        self._show(View.CUT, "mould-cut")
        self.wiring.cut_controller.back()

    def foreign_program(self) -> None:
        """A program that another system wrote: read, cut, smoothed."""
        nc = self.wiring.window_.views.nc
        self.wiring.files.open_file(SAMPLES / "raster.ngc")
        self.until(lambda: nc.shown is not None and nc.shown.source.path == SAMPLES / "raster.ngc")
        nc.set_side(ViewSide.XY)
        nc.pane.text.pick(300)
        self._show(View.NC, "foreign-nc")
        self.wiring.window_.actions_["nc_cut"].trigger()
        self.until(lambda: not self.wiring.cut_controller.foreign_worker.busy)
        self._show(View.CUT, "foreign-cut")
        self.wiring.display_controller.show_view(View.CURVES)
        panel, view = self.wiring.window_.curves_panel, self.wiring.window_.views.curves
        panel.preset.buttons[0.05].click()
        panel.smooth.click()
        self.until(lambda: view.curves is not None and not self.wiring.smoothing_controller.reading.worker.busy)
        self._show(View.CURVES, "foreign-curves")
        self.wiring.cut_controller.back()
        self.wiring.nc.back()

    def five_texts(self) -> None:
        """The film of 1986 at three of its steps."""
        self._sample("fig2.dxf")
        self._compute()
        view = self.wiring.window_.views.stages
        self.wiring.display_controller.show_view(View.STAGES)
        self.until(lambda: view.film is not None and not self.wiring.stages_controller.worker.busy)
        for step, name in ((203, "texts-traced"), (208, "texts-filled"), (406, "texts-fitted")):
            view.show_stage(view.film.seek_step(step, -1) if view.film is not None else 0)
            view.pixels.fit_now()
            self._show(View.STAGES, name)

    # pages of operations

    def operation(self, page: str, drawing: str, job: str, view: View) -> None:
        """Open a page's sample with its job, and photograph it."""
        self._sample(drawing)
        if job:
            read = read_job(job, (SAMPLES / job).read_bytes()).job
            if job == "holes.toml":  # it makes both pages' paths, one over the other
                read = replace(read, operations=tuple(each for each in read.operations if _shown_on(page, each)))
            self.wiring.document.change_job("job", replace(read, part=self.wiring.document.part))
        self._compute()
        self._show(view, page, self.wiring.window_.views)

    def lettering(self) -> None:
        """Tags with words round their rims."""
        self._sample("tags.draw")
        self.wiring.window_.canvas.fit()
        self._show(View.DRAW, "lettering", self.wiring.window_.views)

    def _sample(self, name: str) -> None:
        self.wiring.document.mark_saved(Path(name))
        self._after_change(partial(self.wiring.files.open_sample, SAMPLES / name))
        if not name.endswith(".dxf") and not self.wiring.document.job.operations:
            self._propose()

    def _propose(self) -> None:
        self._after_change(self.wiring.window_.actions_["propose"].trigger)

    def _after_change(self, act: Callable[[], None]) -> None:
        """Do something, and wait until the document has changed by it."""
        before = self.wiring.document.job
        act()
        self.until(lambda: self.wiring.document.job is not before and not self._busy())

    def _busy(self) -> bool:
        return self.wiring.workspace.activity.busy

    def _compute(self) -> None:
        self.wiring.window_.actions_["compute"].trigger()
        self.until(lambda: self.wiring.computation.state is ComputationState.CURRENT)

    def _show(self, view: View, name: str, widget: QWidget | None = None) -> None:
        """Bring a view to the front, at rest, and take it: the whole window, or a part of it."""
        window = self.wiring.window_
        window.notice.hide()
        self.wiring.display_controller.show_view(view)
        if view is View.CUT:
            cut, page = window.views.cut, window.views.cut_page
            self.until(lambda: page.player.length > 0 and not self._busy())
            page.player.go(10**9)
            cut.fit()
            self.pause(1500)
            self.until(lambda: cut.render_scheduler.fine and not self.wiring.cut_controller.zoom_controller.worker.busy)
        elif view in (View.DRAW, View.PATHS):
            window.canvas.fit()
        self.take(name, widget or window)
