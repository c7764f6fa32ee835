"""The dialogue with the operator: which question comes next, what its answer sets off, and what the display shows
meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QObject, Signal

from ....core.errors import InputError
from ....core.progress import Progress
from ....model.job import Job
from ....raster.frame import POINTS
from ...framework.figures import counted
from ...framework.worker import Answer, JobOutcome, Worker
from .answers import amount, offered
from .draft import ShapeDraft
from .players import ListingPlayer, StillPlayer
from .processing import EnteredShape, ShapeOutline, ShapePaths, outline_of, paths_of, sample_job, shape_of
from .questions import BACK, BUSY, SessionQuestion, prompt
from .screen import BOTTOM, TOP, Place, TerminalScreen, card
from .stills import ScreenStill

_MIDDLE = ((TOP + BOTTOM) // 2, POINTS // 2)
LONGEST = 200
"""Characters of an answer."""


_LEAST_OVERLAP = 1e-3


class SessionDialogue(QObject):
    """One session, from the shape to the listing.

    Signals:
        changed(): the screen is to be painted. handed(Job): the operator goes on with this job in the modern views.

    Attributes:
        screen: what is seen. ask: where the dialogue stands. given: the amounts, as answered or offered.
    """

    changed = Signal()
    handed = Signal(Job)

    def __init__(self, current: Callable[[], Job], parent: QObject | None = None) -> None:
        """Begin with the first question; `current` returns the job whose drawing and tools are on offer."""
        super().__init__(parent)
        self._current = current
        self.screen, self.worker = TerminalScreen(), Worker(self)
        self.playing, self.listing = StillPlayer(self.screen, self), ListingPlayer(self.screen, self)
        self.ask, self._asked = SessionQuestion.SHAPE, SessionQuestion.SHAPE
        self.draft = ShapeDraft()
        self.shape: EnteredShape | None = None
        self.paths: ShapePaths | None = None
        self.outline: ShapeOutline | None = None
        self.given = offered(current())
        self._connect()
        self.begin()

    def _connect(self) -> None:
        self.worker.failed.connect(self._on_failed)
        self.worker.progress.connect(lambda fraction, _: self._head(f"{round(100 * fraction)} %"))
        for clock in (self.playing, self.listing):
            clock.changed.connect(self.changed)
            clock.finished.connect(self._on_seen)

    def begin(self) -> None:
        """Ask for the shape, with an empty display."""
        self.given = offered(self._current())
        self.screen.talk.clear()
        self.screen.say("1 DRAWING OF THE JOB   2 SAMPLE, FIG. 2   3 DRAW")
        self._question(SessionQuestion.SHAPE)

    def type(self, text: str) -> None:
        """Take characters from the keyboard."""
        if self.ask not in BUSY:
            self.screen.typed = (self.screen.typed + text)[:LONGEST]
            self.changed.emit()

    def erase(self, everything: bool = False) -> None:
        """Take the last character back, or all."""
        self.screen.typed = "" if everything else self.screen.typed[:-1]
        self.changed.emit()

    def enter(self) -> None:
        """Take the answer; while something is shown, go to its end."""
        if self.ask in (SessionQuestion.PLAY, SessionQuestion.LIST):
            (self.playing if self.ask is SessionQuestion.PLAY else self.listing).skip()
            return
        if self.ask is SessionQuestion.WORK:
            return
        text = self.screen.typed.strip()
        try:
            self._answer(text)
        except InputError as error:
            self._echo(text)
            self._refuse(str(error), self.ask)

    def hold(self) -> None:
        """Hold what is shown, or go on."""
        if self.ask in (SessionQuestion.PLAY, SessionQuestion.LIST):
            (self.playing if self.ask is SessionQuestion.PLAY else self.listing).hold()

    def step(self, way: int) -> None:
        """Go one step on (+1) or back (-1) in what is shown, and hold it."""
        if self.ask is SessionQuestion.PLAY:
            self.playing.step(way)

    def rest(self) -> None:
        """Leave the dialogue for a while: what is computed is broken off, what is shown is held."""
        if self.ask is SessionQuestion.WORK:
            self.interrupt()
        elif (
            self.ask in (SessionQuestion.PLAY, SessionQuestion.LIST)
            and not (self.playing if self.ask is SessionQuestion.PLAY else self.listing).held
        ):
            self.hold()

    def interrupt(self) -> None:
        """Break off what goes on and ask again; every answer is kept."""
        if self.ask in BUSY:
            self.worker.cancel()
            self.playing.stop()
            self.listing.stop()
            self._refuse("? BREAK.", SessionQuestion.DONE if self.ask is SessionQuestion.LIST else self._asked)

    def finish(self) -> None:
        """End whatever runs, before the program ends."""
        self.playing.stop()
        self.listing.stop()
        self.worker.finish()

    def point(self, place: Place) -> None:
        """Put the cross hair on a point of the picture."""
        row, col = place
        self.screen.hair = (
            (min(max(row, TOP), BOTTOM - 1), min(max(col, 0), POINTS - 1)) if self.ask is SessionQuestion.DRAW else None
        )
        if self.ask is SessionQuestion.DRAW:
            x, y = self.draft.point(self.screen.hair or place).split(",")
            self._head(f"X {x} Y {y}")

    def put(self) -> None:
        """Write the place of the cross hair into the answer."""
        if self.ask is SessionQuestion.DRAW and self.screen.hair is not None:
            gap = "" if self.screen.typed.endswith(" ") or not self.screen.typed else " "
            self.type(f"{gap}{self.draft.point(self.screen.hair)} ")

    def _answer(self, text: str) -> None:
        word = text.upper()
        if word == "BACK" and self.ask in BACK:
            self._go_back(BACK[self.ask])
        elif word == "NEW":
            self.begin()
        else:
            answers: dict[SessionQuestion, Callable[[str], None]] = {
                SessionQuestion.SHAPE: self._choose,
                SessionQuestion.DRAW: self._draw,
                SessionQuestion.CONTOUR: self._take_contour,
                SessionQuestion.POCKET: self._take_pocket,
                SessionQuestion.OVERLAP: self._take_overlap,
                SessionQuestion.DONE: self._end,
            }
            answers[self.ask](text)

    def _choose(self, text: str) -> None:
        before = self._current()
        choice = text or ("1" if before.part.entities else "2")
        if choice == "1" and not before.part.entities:
            raise InputError("? Nothing is drawn in the job. Enter 2 or 3.")
        if choice not in ("1", "2", "3"):
            raise InputError("? Enter 1, 2 or 3.")
        self._echo(choice)
        if choice == "3":
            self._begin_draft()
            return
        self._work(
            lambda progress: shape_of(before if choice == "1" else sample_job(before, progress), progress),
            self._take_shape,
        )

    def _begin_draft(self) -> None:
        self.screen.say("LINE X,Y X,Y   CIRCLE X,Y R   ARC X,Y X,Y CENTRE X,Y")
        self.screen.say("RECT X,Y X,Y   POLYLINE X,Y ...   UNDO   CLEAR   END")
        self._question(SessionQuestion.DRAW)

    def _draw(self, text: str) -> None:
        if text.upper() == "END":
            if not self.draft.part.entities:
                raise InputError("? Nothing is drawn. Enter a line, a circle or an arc.")
            job = self.draft.job(self._current())
            self._echo(text)
            self._work(lambda progress: shape_of(job, progress), self._take_shape)
            return
        if text:
            reply = self.draft.run(text)
            self._echo(text)
            self.screen.say(f"  {reply}")
        self._question(SessionQuestion.DRAW)

    def _take_contour(self, text: str) -> None:
        shape = self._shape()
        contour = self._amount(text, self.given.contour, shape.pitch, shape.widest)
        self.given = given = replace(self.given, contour=contour)
        self._echo(f"{contour:g}")
        self._work(lambda progress: outline_of(shape, given, progress), self._take_outline)

    def _take_pocket(self, text: str) -> None:
        shape, before = self._shape(), self.given
        pocket = self._amount(text, before.pocket, shape.pitch, shape.widest)
        overlap = before.overlap if pocket == before.pocket else pocket
        self.given = replace(before, pocket=pocket, overlap=overlap)
        self._echo(f"{pocket:g}")
        if pocket < before.contour:
            self.screen.say("! Smaller than the contour tool. Enter BACK to change the amounts.")
        self._question(SessionQuestion.OVERLAP)

    def _take_overlap(self, text: str) -> None:
        shape = self._shape()
        most = 2 * self.given.pocket - shape.pitch
        overlap = self._amount(text, self.given.overlap, min(_LEAST_OVERLAP, most), most)
        self.given = given = replace(self.given, overlap=overlap)
        self._echo(f"{overlap:g}")
        if overlap < given.pocket:
            self.screen.say("! Less than the offset: metal may stay between the paths.")
        self._work(lambda progress: paths_of(shape, given, progress), self._take_paths)

    def _end(self, text: str) -> None:
        if text:
            raise InputError("? Enter return, back or new.")
        if self.paths is not None:
            self.handed.emit(self.paths.job)

    def _amount(self, text: str, usual: float, low: float, high: float) -> float:
        return amount(text or f"{usual:.17g}", low, high)

    def _shape(self) -> EnteredShape:
        assert self.shape is not None, "amounts are asked for when there is a shape"
        return self.shape

    def _work(self, function: Callable[[Progress], Answer], take: Callable[[Answer], None]) -> None:
        """Have something computed; the display stays, and the question is asked again where it fails."""
        self._asked = self.ask
        self.ask, self.screen.prompt, self.screen.typed, self.screen.hair = SessionQuestion.WORK, "", "", None
        self._head("WORKING")
        self.worker.start(function, 0, take)

    def _take_shape(self, shape: EnteredShape) -> None:
        self.shape = shape
        self._say(shape.notes)
        self._question(SessionQuestion.CONTOUR)

    def _take_outline(self, outline: ShapeOutline) -> None:
        self.outline = outline
        self._play(outline.stills)

    def _take_paths(self, paths: ShapePaths) -> None:
        self.paths = paths
        self._say(paths.notes)
        self._play(paths.stills)

    def _on_failed(self, answer: JobOutcome) -> None:
        """Ask again for what was wrong: of the pocket tool's amounts it can only be the offset."""
        self._refuse(
            answer.error or "", SessionQuestion.POCKET if self._asked is SessionQuestion.OVERLAP else self._asked
        )

    def _play(self, stills: tuple[ScreenStill, ...]) -> None:
        self.ask = SessionQuestion.PLAY
        self.playing.start(stills)

    def _on_seen(self) -> None:
        """Go on after what was shown."""
        if self.ask is SessionQuestion.PLAY and self._asked is SessionQuestion.CONTOUR:
            self._question(SessionQuestion.POCKET)
        elif self.ask is SessionQuestion.PLAY and self.paths is not None:
            self.ask = SessionQuestion.LIST
            self.listing.start(self.paths.listing)
        elif self.ask is SessionQuestion.LIST and self.paths is not None:
            self._question(SessionQuestion.DONE)

    def _go_back(self, ask: SessionQuestion) -> None:
        self._echo("BACK")
        if ask is SessionQuestion.SHAPE:
            self.begin()
        else:
            self._question(ask)

    def _question(self, ask: SessionQuestion) -> None:
        self.ask = ask
        self.screen.typed, self.screen.prompt = "", prompt(ask, self.given, bool(self._current().part.entities))
        self._show_ground(ask)
        if ask is SessionQuestion.DRAW:
            self.point(self.screen.hair or _MIDDLE)
        else:
            self.screen.hair = None
        self.changed.emit()

    def _show_ground(self, ask: SessionQuestion) -> None:
        """Show what a question is about."""
        screen = self.screen
        if ask is SessionQuestion.DONE:
            screen.head = ("END OF PROGRAM", counted(len(self.paths.listing if self.paths else ()), "block"))
            return
        screen.page = None
        still = self.shape.still if ask is SessionQuestion.CONTOUR and self.shape else None
        if ask in (SessionQuestion.POCKET, SessionQuestion.OVERLAP) and self.outline is not None:
            still = self.outline.stills[-1]
        if still is not None:
            screen.picture, screen.head = (
                still.picture,
                (f"{still.number} {still.name}", f"{self._shape().pitch:.3g} MM A POINT"),
            )
        else:
            screen.picture = self.draft.picture() if ask is SessionQuestion.DRAW else card()
            screen.head = ("DRAW THE SHAPE" if ask is SessionQuestion.DRAW else "TOOL PATH GENERATION", "1986")

    def _refuse(self, sentence: str, ask: SessionQuestion) -> None:
        """Say what is wrong and ask again, on an empty line."""
        self._say((sentence if sentence.startswith("?") else f"? {sentence}",))
        self._question(ask)

    def _say(self, sentences: tuple[str, ...]) -> None:
        for sentence in sentences:
            self.screen.say(sentence)

    def _echo(self, answer: str) -> None:
        self.screen.say(f"{self.screen.prompt} {answer}")

    def _head(self, right: str) -> None:
        self.screen.head = (self.screen.head[0], right)
        self.changed.emit()
