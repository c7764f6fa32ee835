"""Takes a picture in: reads it in the background, shows how it is read, and makes it the part of the job."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QTimer, Signal

from ....core.errors import HitofudeError
from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....model.part import Part
from ....raster.frame import PixelCode
from ...framework.controller import Controller, ShownDocument
from ...framework.figures import counted
from ...framework.theme import Theme
from ...framework.verdict import VerdictLevel, VerdictSummary
from ...framework.worker import Answer, JobOutcome, Worker
from ...framework.workspace import Workspace
from . import code_colours
from .import_panel import ImportPanel, PictureAspect
from .painting.code_key import CodeRow
from .painting.pixel_painter import PixelPaint
from .picture_preview import PicturePreview, PictureSettings, open_picture, part_of, preview_of
from .pixel_view import PixelMark
from .view import StagesView

if TYPE_CHECKING:
    from ....usecases.making.bitmap_job import BitmapJob

_REST_MS = 60
_WORDS = {PixelCode.EMPTY: "paper", PixelCode.CONTOUR: "lines of ink", PixelCode.INSIDE: "to be machined"}


class ImportController(Controller):
    """One picture at a time, from its file to the part.

    Signals:
        shown(): a preview came, changed or went. taken(path): it is the part now.

    Attributes:
        preview: how it is read; None = there is none.
    """

    shown = Signal()
    taken = Signal(Path)

    def __init__(self, view: StagesView, panel: ImportPanel, workspace: Workspace) -> None:
        super().__init__(view)
        self._view, self._panel, self._workspace = view, panel, workspace
        self._document, self._log = workspace.document, workspace.log
        self.worker = Worker(self)
        self.preview: PicturePreview | None = None
        self._see, self._chosen = PictureAspect.READING, -1
        self._taken: Part | None = None
        self._rest = QTimer(self, singleShot=True, interval=_REST_MS)
        self._connect()

    def _connect(self) -> None:
        panel, worker = self._panel, self.worker
        worker.failed.connect(self._on_failed)
        self._workspace.activity.follow(worker)
        self._rest.timeout.connect(self._read)
        panel.requested.connect(self._want)
        panel.see_chosen.connect(self._choose_see)
        panel.place_picked.connect(self._go_to)
        panel.accepted.connect(self.take)
        panel.left.connect(self.leave)
        self._view.preview_clicked.connect(self._point)
        self._document.subscribe(self._on_change)
        self._view.theme_changed.connect(lambda _: self._show())

    @property
    def shown_document(self) -> ShownDocument | None:
        """The picture that is looked at; None while there is none."""
        if self.preview is None:
            return None
        verdict = VerdictSummary(VerdictLevel.NONE, "A picture, not taken yet")
        return ShownDocument(self.preview.reading.path.name, False, verdict)

    def open(self, path: Path) -> None:
        """Read a picture and show it beside its fields."""
        self.take_from(lambda progress: open_picture(path, progress), self.show_preview)

    def leave(self) -> None:
        """Show the stages again."""
        self.worker.cancel()
        self._rest.stop()
        self.preview = self._panel.reading = None
        self._view.show_preview(None)
        self.shown.emit()

    def _on_change(self, change: DocumentChange) -> None:
        """Leave the picture for another document; say once when the part is no longer the picture that was taken."""
        if change & DocumentChange.LOADED:
            self._taken = None
            if self.preview is not None:
                self.leave()
        elif change & DocumentChange.PART and self._taken is not None and self._document.part is not self._taken:
            self._taken = None
            self._log.note(
                "picture",
                "The drawing was changed: from here on it is an ordinary drawing, no longer the picture's pixels. "
                "Undo the change to have them back.",
            )

    def take_from(self, function: Callable[[Progress], Answer], take: Callable[[Answer], None]) -> None:
        """Run a function beside the window and take what it returns; what cannot be taken is said in the panel."""

        def take_or_say(made: Answer) -> None:
            try:
                take(made)
            except HitofudeError as error:
                self._say(str(error))

        self.worker.start(function, self._document.revision, take_or_say)

    def _want(self, reading: PictureSettings) -> None:
        """Read it otherwise, when the field rests for a moment."""
        self._rest.start()

    def _read(self) -> None:
        reading = self._panel.reading
        if reading is not None:
            self.take_from(lambda progress: preview_of(reading, progress), self.show_preview)

    def take(self, then: Callable[[], None] = lambda: None) -> None:
        """Make the picture the part, and go on; what is still to be read is read first."""
        reading, preview, before = self._panel.reading, self.preview, self._document.job
        if reading is None or preview is None:
            return
        self._rest.stop()
        stale = preview.reading is not reading
        self.take_from(
            lambda progress: part_of(preview_of(reading, progress) if stale else preview, before, progress),
            lambda ready: self._load(ready, preview, then),
        )

    def show_preview(self, preview: PicturePreview) -> None:
        """Show what was read, with its fields when it is another picture."""
        fresh = self.preview is None or preview.reading.path != self.preview.reading.path
        self.preview, self._chosen = preview, -1
        if fresh or self._panel.reading is None:
            self._see = PictureAspect.READING
            self._panel.begin(preview)
            self._workspace.notice.dismiss()
        else:
            self._panel.show_preview(preview)
        self._show()
        self.shown.emit()

    def _load(self, ready: BitmapJob, preview: PicturePreview, then: Callable[[], None]) -> None:
        path, computation = preview.reading.path, self._workspace.computation
        computation.pixels = (ready.job.part, ready.part)
        self.leave()
        self._document.load(ready.job, path)
        self._taken = ready.job.part
        computation.forget(ready.findings)
        frame = ready.part.frame
        ambiguities = (
            f" {counted(len(preview.places), 'doubtful place')}: see Compute, Findings." if preview.places else ""
        )
        self._log.note(
            f"open {path.name}",
            f"{counted(len(ready.part.regions), 'region')} on {frame.cols} by {frame.rows} px.{ambiguities}",
        )
        self.taken.emit(path)
        then()

    def _on_failed(self, answer: JobOutcome) -> None:
        self._say(answer.error or "")

    def _say(self, sentence: str) -> None:
        """Say what went wrong, in the panel where it is shown."""
        if self.preview is not None:
            self._panel.refuse(sentence)
            self.shown.emit()
        else:
            self.failed.emit(sentence)

    def _choose_see(self, see: PictureAspect) -> None:
        self._see = see
        self._show()

    def _go_to(self, index: int) -> None:
        """Glide to a doubtful place."""
        self._chosen = index
        if self.preview is not None and index >= 0:
            self._view.pixels.go_to(self.preview.at(self.preview.places[index]))
        self._show_marks()

    def _point(self, x: float, y: float) -> None:
        """One of the two points was clicked, at a place in mm."""
        if self.preview is None:
            return
        frame = self.preview.reading.frame
        self._panel.add_point(x / frame.pitch, frame.rows - y / frame.pitch)
        self._show_marks()

    def _show(self) -> None:
        """Show the picture, or how it is read."""
        if self.preview is None:
            return
        theme: Theme = self._view.theme
        frame = self.preview.reading.frame
        if self._see is PictureAspect.PICTURE:
            greys = [0xFF000000 | level * 0x010101 for level in range(256)]
            self._view.show_preview(PixelPaint(frame, self.preview.picture.gray, greys))
        else:
            colours = code_colours.code_colours(theme)
            pixels = PixelPaint(frame, self.preview.plane, code_colours.table(colours), {}, code_colours.rank_of_code())
            rows = tuple(CodeRow(code, "", words, colours[code]) for code, words in _WORDS.items())
            self._view.show_preview(pixels, rows)
        self._show_marks()

    def _show_marks(self) -> None:
        if self.preview is None:
            return
        frame, reading = self.preview.reading.frame, self._panel.reading
        points = reading.measure.points if reading is not None else ()
        ends = [PixelMark((col * frame.pitch, (frame.rows - row) * frame.pitch), True) for col, row in points]
        ambiguities = [
            PixelMark(self.preview.at(place), k == self._chosen) for k, place in enumerate(self.preview.places)
        ]
        self._view.pixels.show_marks((*ambiguities, *ends))
