"""Records a cut from its start to its end, as it is looked at: asks how and where to, and has it written on another
thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtWidgets import QFileDialog

from ....core.progress import Progress
from ....model.tool import Tool
from ...framework.controller import Controller
from ...framework.worker import Answer, Worker
from ...framework.workspace import Workspace
from .colouring import CutColour, Inks, colouring
from .cut_page import CutPage
from .frame import Frame
from .inks import inks_of
from .live_cells import LiveCells, Wish
from .player import Pace
from .playing import drawn_tool
from .record_sheet import RecordForm, RecordPlan
from .recording import Reel, Shot, Whole, record
from .shown_cut import ShownCut
from .surface import pixel_size
from .tool_outline import DrawnTool


@dataclass(frozen=True, eq=False)
class Recording:
    """What is recorded, and how.

    Attributes:
        shown: the cut. frame: how it is looked at. plan: how long. pace: what goes on evenly.
        colour, inks: what its colours tell. wedges: the facets of the sweep are seen.
        target: a file that ends in ".gif", or a folder.
    """

    shown: ShownCut
    frame: Frame
    plan: RecordPlan
    pace: Pace
    colour: CutColour
    inks: Inks
    wedges: bool
    target: Path


def write_recording(wanted: Recording, progress: Progress) -> Recording:
    """Record, and return what was; runs on the worker's thread.

    Raises:
        HitofudeError: it cannot be painted, or not be written. Cancelled: nothing was written.
    """
    record(
        _shots(wanted, progress.part(0.0, 0.1)),
        wanted.frame,
        wanted.target,
        Reel(wanted.plan.count, wanted.plan.per_second),
        progress.part(0.1, 1.0),
    )
    return wanted


def _shots(wanted: Recording, progress: Progress) -> Iterator[Shot]:
    """Yield what each picture shows, from the start to the end; what waits takes none."""
    from ....usecases.playback import ONCE, Playback
    from ....usecases.timeline import TimelinePlace

    shown, plan = wanted.shown, wanted.plan
    cells = LiveCells(Playback(shown.cut, options=ONCE, progress=progress), shown.picture, shown.cut.setup.tools)
    timeline, drawn = cells.playback.timeline, dict[int, DrawnTool | None]()
    colours = colouring(replace(shown.picture, values={}), wanted.colour, wanted.inks)
    for k in range(plan.count):
        share = k / (plan.count - 1)
        moment = timeline.at_share(share) if wanted.pace is Pace.TIME else TimelinePlace(round(share * len(timeline)))
        frame = cells.frame(Wish(moment, wanted.colour, wanted.wedges))
        patches = (frame.patch,) if frame.patch is not None else ()
        shot = Shot(
            Whole(shown.picture, colours) if k == 0 else None,
            patches,
            _drawn(frame.tool, shown, drawn),
            wedges=frame.wedges,
        )
        yield replace(shot, tip=frame.tip) if frame.tip is not None else shot


def _drawn(tool: Tool | None, shown: ShownCut, drawn: dict[int, DrawnTool | None]) -> DrawnTool | None:
    """Return a tool as it is painted, the same thing every time."""
    if tool is None:
        return None
    if tool.number not in drawn:
        drawn[tool.number] = drawn_tool(tool, shown.picture)
    return drawn[tool.number]


class Recorder(Controller):
    """Asks how and where to, and records."""

    def __init__(self, page: CutPage, workspace: Workspace) -> None:
        super().__init__(page)
        self._page, self._sheet = page, page.sheet
        self._preferences, self._log = workspace.preferences, workspace.log
        self.worker = Worker(self)
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(lambda answer: self.failed.emit(answer.error or ""))
        workspace.activity.follow(self.worker)
        self._page.transport.record_wanted.connect(self.ask)
        self._sheet.wanted.connect(self.choose)

    def ask(self) -> None:
        """Ask how it shall be recorded."""
        player = self._page.player
        if self.worker.busy:
            self.failed.emit("A recording is being written; wait for it, or cancel it.")
            return
        if player.shown is None:
            self.failed.emit("There is nothing to record yet; press F5, then open the Cut view.")
            return
        self.front_wanted.emit()
        player.pause()
        self._page.open_sheet()

    def choose(self, form: RecordForm) -> None:
        """Ask for a file or a folder, and record."""
        folder = self._preferences.last_folder
        if form is RecordForm.GIF:
            name, _ = QFileDialog.getSaveFileName(self._page, "Record the cut", str(folder / "cut.gif"), "GIF (*.gif)")
        else:
            name, _ = QFileDialog.getSaveFileName(
                self._page, "New folder for the pictures", str(folder / "cut"), "Folder (*)"
            )
        if name:
            path = Path(name)
            self.start(
                path.with_suffix(".gif") if form is RecordForm.GIF and path.suffix.casefold() != ".gif" else path
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
        frame = Frame(camera, size, view.painting.look, 0, seen.section, seen.looks)
        wanted = Recording(
            shown,
            frame,
            plan,
            self._page.player.pace,
            seen.told,
            inks_of(view.colours.theme),
            view.playing.wedges_on,
            target,
        )
        self.worker.start(lambda progress: write_recording(wanted, progress), 0)

    def _on_done(self, answer: Answer) -> None:
        done = answer.value
        if isinstance(done, Recording):
            self._log.note(
                f"record {done.target.name}", f"{done.plan.count} pictures of the cut written to {done.target}"
            )
