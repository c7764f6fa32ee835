"""Records a cut from its start to its end, as it is looked at: asks how and where to, and has it written on another
thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PySide6.QtWidgets import QFileDialog

from ....core.progress import Progress
from ....model.tool import Tool
from ...framework.controller import Controller
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from .cell_colours import Colormap, CutColourBy, cell_colours
from .cut_player import PlaybackPace
from .live_cells import FrameRequest, LiveCells
from .model import middle
from .page import CutPage
from .playback_overlay import drawn_tool
from .record_sheet import RecordedMotion, RecordFormat, RecordPlan
from .recording import CutSnapshot, FrameChange, RecordingLength, record
from .rendering.cut_frame import CutFrame
from .shown_cut import ShownCut
from .surface import pixel_size
from .theme_colours import colormap_of
from .tool_outline import DrawnTool


@dataclass(frozen=True, eq=False)
class RecordingRequest:
    """What is recorded, and how.

    Attributes:
        shown: the cut. frame: how it is looked at. plan: how long. pace: what goes on evenly.
        colour, inks: what its colours tell. wedges: the facets of the sweep are seen.
        target: a file that ends in ".gif", or a folder.
    """

    shown: ShownCut
    frame: CutFrame
    plan: RecordPlan
    pace: PlaybackPace
    colour: CutColourBy
    inks: Colormap
    wedges: bool
    target: Path


def write_recording(requested: RecordingRequest, progress: Progress) -> RecordingRequest:
    """Record, and return what was; runs on the worker's thread.

    Raises:
        HitofudeError: it cannot be painted, or not be written. Cancelled: nothing was written.
    """
    turns = requested.plan.motion is RecordedMotion.TURNTABLE
    record(
        turntable(requested) if turns else _shots(requested, progress.part(0.0, 0.1)),
        requested.frame,
        requested.target,
        RecordingLength(requested.plan.count, requested.plan.per_second),
        progress.part(0.1, 1.0),
    )
    return requested


def _shots(requested: RecordingRequest, progress: Progress) -> Iterator[FrameChange]:
    """Yield what each picture shows, from the start to the end; what waits takes none."""
    from ....usecases.cutting.playback import ONCE, Playback
    from ....usecases.cutting.timeline import TimelinePlace

    shown, plan = requested.shown, requested.plan
    cells = LiveCells(Playback(shown.cut, options=ONCE, progress=progress), shown.picture, shown.cut.setup.tools)
    timeline, drawn = cells.playback.timeline, dict[int, DrawnTool | None]()
    colours = cell_colours(replace(shown.picture, values={}), requested.colour, requested.inks)
    for k in range(plan.count):
        share = k / (plan.count - 1)
        moment = (
            timeline.at_share(share)
            if requested.pace is PlaybackPace.TIME
            else TimelinePlace(round(share * len(timeline)))
        )
        frame = cells.frame(FrameRequest(moment, requested.colour, requested.wedges))
        patches = (frame.patch,) if frame.patch is not None else ()
        shot = FrameChange(
            CutSnapshot(shown.picture, colours) if k == 0 else None,
            patches,
            _drawn(frame.tool, shown, drawn),
            wedges=frame.wedges,
        )
        yield replace(shot, tip=frame.tip) if frame.tip is not None else shot


def turntable(requested: RecordingRequest) -> Iterator[FrameChange]:
    """Yield the whole cut, turned once round its middle; the last picture is a step before the first."""
    shown, count, camera = requested.shown, requested.plan.count, requested.frame.camera
    colours = cell_colours(replace(shown.picture, values={}), requested.colour, requested.inks)
    centre = middle(shown.picture)
    for k in range(count):
        whole = CutSnapshot(shown.picture, colours) if k == 0 else None
        yield FrameChange(whole, camera=camera.orbited(2 * np.pi * k / count, 0.0, centre))


def _drawn(tool: Tool | None, shown: ShownCut, drawn: dict[int, DrawnTool | None]) -> DrawnTool | None:
    """Return a tool as it is painted, the same thing every time."""
    if tool is None:
        return None
    if tool.number not in drawn:
        drawn[tool.number] = drawn_tool(tool, shown.picture)
    return drawn[tool.number]


class RecordingController(Controller):
    """Asks how and where to, and records."""

    def __init__(self, page: CutPage, workspace: Workspace) -> None:
        super().__init__(page)
        self._page, self._sheet = page, page.sheet
        self._preferences, self._log = workspace.preferences, workspace.log
        self.worker = Worker(self)
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(lambda answer: self.failed.emit(answer.error or ""))
        workspace.activity.follow(self.worker)
        self._page.transport.record_requested.connect(self.ask)
        self._sheet.requested.connect(self.choose)

    def ask(self) -> None:
        """Ask how it shall be recorded."""
        player = self._page.player
        if self.worker.busy:
            self.failed.emit("A recording is being written; wait for it, or cancel it.")
            return
        if player.shown is None:
            self.failed.emit("There is nothing to record yet; press F5, then open the Cut view.")
            return
        self.front_requested.emit()
        player.pause()
        self._page.open_sheet()

    def choose(self, form: RecordFormat) -> None:
        """Ask for a file or a folder, and record."""
        folder = self._preferences.last_folder
        if form is RecordFormat.GIF:
            name, _ = QFileDialog.getSaveFileName(self._page, "Record the cut", str(folder / "cut.gif"), "GIF (*.gif)")
        else:
            name, _ = QFileDialog.getSaveFileName(
                self._page, "New folder for the pictures", str(folder / "cut"), "Folder (*)"
            )
        if name:
            path = Path(name)
            self.start(
                path.with_suffix(".gif") if form is RecordFormat.GIF and path.suffix.casefold() != ".gif" else path
            )

    def start(self, target: Path) -> None:
        """Record to a file that ends in ".gif", or else to single pictures in a folder."""
        shown, view = self._page.player.shown, self._page.view
        if shown is None or self.worker.busy:
            return
        self._page.close_sheet()
        # before it begins: should the program be killed, the next start knows where to sweep
        self._preferences.keep(replace(self._preferences.settings, last_folder=str(target.absolute().parent)))
        plan, view_size = self._sheet.plan, pixel_size(view)
        size = plan.size(view_size)
        seen = view.model
        camera = replace(seen.camera, scale=seen.camera.scale * size[0] / view_size[0])
        frame = CutFrame(camera, size, view.render_scheduler.look, 0, seen.section, seen.looks)
        requested = RecordingRequest(
            shown,
            frame,
            plan,
            self._page.player.pace,
            seen.colour_shown,
            colormap_of(view.colours.theme),
            view.playback.wedges_on,
            target,
        )
        self.worker.start(lambda progress: write_recording(requested, progress), 0)

    def _on_done(self, answer: JobOutcome) -> None:
        done = answer.value
        if isinstance(done, RecordingRequest):
            self._log.note(
                f"record {done.target.name}", f"{done.plan.count} pictures of the cut written to {done.target}"
            )
