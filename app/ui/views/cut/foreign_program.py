"""Cuts any NC program for the Cut view: what it tells of tools and stock, what the user says, and what has to be asked.
No Qt.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ....core.errors import InputError
from ....core.options import without_options
from ....core.progress import Progress
from ....model.finding import Finding, FindingKind
from ....model.stock_box import StockBox
from ....model.tool import Tool
from ....model.tool_kind import ToolKind
from ..nc.program_reader import ProgramSource
from .cell_colours import CutColourBy
from .shown_cut import ProgramFile, ShownCut, shown_cut
from .user_setup import Box, UserSetup

if TYPE_CHECKING:
    from ....gcode.interpreter.dialect import Dialect
    from ....usecases.cutting.ready_setup import ReadySetup
    from ....usecases.examine import ExaminedProgram
    from ....verify.parts import Part

GUESSED = "nobody"
"""Who tells of a tool that is only a guess."""

BELOW, LEAST_BELOW = 0.15, 1.0
"""How far an assumed stock goes on below the deepest cut: share of its height, and mm."""

_PUBLISHED = Finding(
    FindingKind.ASSUMED,
    "What is left is drawn by facets of two cells in the depth buffer, the method of 1999; while it plays, and for "
    "every verdict, the engine of record cuts.",
    counts=False,
)

DIAMETER = 6.0
"""mm; what a tool is guessed to be that nobody knows."""


@dataclass(frozen=True, eq=False)
class ForeignProgram:
    """A program to be cut.

    Attributes:
        source, dialect: what it is and how it is read. given: what was said of it.
        likely: tools of the open job, by T number: the first guess where nobody tells.
        part: of the open job, with which the program may be compared; None = there is none.
        scene: makes what a scene's program is to come to, with which it is compared; None = it is no scene's.
    """

    source: ProgramSource
    dialect: Dialect
    given: UserSetup = field(default_factory=UserSetup)
    likely: Mapping[int, Tool] = field(default_factory=dict)
    part: Part | None = None
    scene: Callable[[], Part] | None = None


@dataclass(frozen=True, eq=False)
class MissingSetup:
    """What is to be said before a program can be cut, or cut otherwise.

    Attributes:
        reason: why, a sentence. foreign: the program. given: what is known and guessed so far.
    """

    reason: str
    foreign: ForeignProgram
    given: UserSetup


def foreign_shown(foreign: ForeignProgram, colour: CutColourBy, progress: Progress) -> ShownCut | MissingSetup:
    """Cut a program and prepare it for the view; or return what nobody tells.

    Args:
        foreign: the program. colour: what the colours tell at first.
        progress: of all of it.

    Raises:
        HitofudeError: it has an error, or cuts nothing.
        Cancelled: the job was asked to stop.
    """
    from ....usecases.cutting.cut import CutOptions, Engine, cut  # imports the engine: never on the window's thread
    from ....usecases.examine import ExamineOptions, examine

    data = foreign.source.bytes()
    examined = examine(
        foreign.source.name,
        data,
        ExamineOptions(foreign.dialect, foreign.source.tools, units=foreign.source.units),
        progress.part(0.0, 0.3),
    )
    try:
        ready, reason = _ready(examined, foreign)
    except InputError as error:
        raise InputError(without_options(str(error))) from error
    if reason:
        return MissingSetup(reason, foreign, user_setup_of(ready, foreign.given))
    setup = replace(
        ready.setup,
        part=foreign.scene() if foreign.scene is not None else foreign.part if foreign.given.compare else None,
    )
    published = foreign.given.published
    how = CutOptions(engine=Engine.PATENT if published else Engine.AUTO)
    result = cut(setup, how, progress.part(0.3, 0.9))
    shown = shown_cut(result, (ProgramFile(foreign.source.name, data),), colour, progress.part(0.9, 1.0))
    assumed = (*(_plain(each) for each in ready.findings), *((_PUBLISHED,) if published else ()))
    return replace(shown, given=user_setup_of(ready, foreign.given), assumed=assumed)


def user_setup_of(ready: ReadySetup, given: UserSetup) -> UserSetup:
    """Return tools and stock as they are taken, for the form; the rest as it was given."""
    tools = {number: known.tool for number, known in ready.tools.items()}
    return replace(given, tools=tools, stock=_corners(ready))


def _corners(ready: ReadySetup) -> Box:
    """Return the corners of the stock, mm; the form and comments tell of boxes alone."""
    box: StockBox = ready.stock.stock.solid  # type: ignore[attr-defined]
    return box.x0, box.y0, box.z0, box.x1, box.y1, box.z1


def _ready(examined: ExaminedProgram, foreign: ForeignProgram) -> tuple[ReadySetup, str]:
    """Return the setup, and why somebody should look at it first, or ""."""
    noted = {note.number: note for note in examined.program.tools}
    used = {state.tool for state in examined.program.states}
    guesses = {number: _guess(number, foreign) for number in used}
    try:
        ready = _with(examined, foreign, {number: tool for number, tool in guesses.items() if number not in noted})
    except InputError as error:
        if examined.program.error is not None or not noted:
            raise
        rough = {
            number: replace(guesses.get(number, _guess(number, foreign)), diameter=note.diameter)
            for number, note in noted.items()
        }
        return _with(examined, foreign, guesses | rough), f"{without_options(str(error))} Say what it is."
    unknown = [number for number, known in ready.tools.items() if known.source == GUESSED]
    if not unknown:
        return ready, ""
    names = ", ".join(f"T{number}" for number in unknown)
    verb, them = ("cuts", "it is") if len(unknown) == 1 else ("cut", "they are")
    return ready, f"{names} {verb}, and {examined.name} does not tell what {them}. Say it here, then press Cut."


def _with(examined: ExaminedProgram, foreign: ForeignProgram, guesses: Mapping[int, Tool]) -> ReadySetup:
    from ....usecases.cutting.ready_setup import SetupRequest, setup_of
    from ....usecases.cutting.setup_stock import box_stock
    from ....usecases.cutting.setup_tools import ToolSource

    told = (ToolSource("the form", foreign.given.tools), ToolSource(GUESSED, guesses))
    stock = box_stock(foreign.given.stock) if foreign.given.stock is not None else None
    ready = setup_of((examined,), SetupRequest(told, stock=stock))
    return _on_a_table(ready) if stock is None and examined.program.stock is None else ready


def _on_a_table(ready: ReadySetup) -> ReadySetup:
    """Return a setup whose stock, assumed round the cuts, goes on below the deepest of them, so that their floor can be
    seen.
    """
    from ....usecases.cutting.setup_stock import KnownStock, box_stock

    x0, y0, z0, x1, y1, z1 = _corners(ready)
    z0 -= max(LEAST_BELOW, BELOW * (z1 - z0))
    text = (
        f"The program does not tell the stock; it is taken to be X {x0:.3f} to {x1:.3f}, Y {y0:.3f} to {y1:.3f}, "
        f"Z {z0:.3f} to {z1:.3f}: round the cuts and some way below them. Tools and stock… gives another."
    )
    assumed = Finding(FindingKind.ASSUMED, text, counts=False)
    stock = KnownStock(box_stock((x0, y0, z0, x1, y1, z1)), ready.stock.source, assumed)
    findings = (*(each for each in ready.findings if each is not ready.stock.assumed), assumed)
    return replace(ready, setup=replace(ready.setup, stock=stock.stock), stock=stock, findings=findings)


def _guess(number: int, foreign: ForeignProgram) -> Tool:
    return foreign.likely.get(number) or Tool(max(number, 1), DIAMETER, ToolKind.FLAT)


def _plain(finding: Finding) -> Finding:
    return replace(finding, text=without_options(finding.text))
