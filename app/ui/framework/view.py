"""The views of the window, on the way from drawing to machine: a registry that anybody may add to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Protocol

from PySide6.QtWidgets import QWidget

from .controller import Controller
from .missing import NOTHING, MissingHint
from .workspace import Workspace


class Zoomable(Protocol):
    """What the keys and the menu View zoom and fit."""

    def fit(self) -> None:
        """Show everything."""

    def zoom_by(self, factor: float) -> None:
        """Zoom about the middle."""


def _nothing() -> MissingHint:
    return NOTHING


def _no_words() -> str:
    return ""


def _no_side() -> QWidget | None:
    return None


@dataclass(frozen=True, eq=False)
class ViewPage:
    """What a view puts into the window.

    Attributes:
        widget: in the middle; the keys go to it. viewport: what zooms and fits.
        prompt: what the command line says. missing: what is said in its place while it has nothing to show.
        summary: what the status bar says when nothing else is to be said, or "".
        side: what stands at the right now; None = nothing.
        controller: told whether the view is at the front; None = there is none, or somebody else tells it.
    """

    widget: QWidget
    viewport: Zoomable
    prompt: Callable[[], str] = _no_words
    missing: Callable[[], MissingHint] = _nothing
    summary: Callable[[], str] = _no_words
    side: Callable[[], QWidget | None] = _no_side
    controller: Controller | None = None


@dataclass(frozen=True, eq=False)
class View:
    """A view: its name, and how its page is made.

    Attributes:
        value: the name of its action. text: in the menu View. key: its shortcut, or "".
        make: makes its page in a new window; None = the window makes it itself.
    """

    value: str
    text: str
    key: str = ""
    make: Callable[[Workspace], ViewPage] | None = None

    DRAW: ClassVar[View]
    STAGES: ClassVar[View]
    PATHS: ClassVar[View]
    CUT: ClassVar[View]
    CURVES: ClassVar[View]
    SURFACES: ClassVar[View]
    NC: ClassVar[View]


_VIEWS: list[View] = []


def register(view: View) -> View:
    """Add a view behind the others; windows that are made afterwards have it.

    Raises:
        ValueError: there is one of that name.
    """
    if any(each.value == view.value for each in _VIEWS):
        raise ValueError(f"there is a view {view.value} already; give this one another name")
    _VIEWS.append(view)
    return view


def unregister(view: View) -> None:
    """Take a view away again; windows that there are keep it."""
    _VIEWS.remove(view)


def views() -> tuple[View, ...]:
    """Return all views in their order."""
    return tuple(_VIEWS)


View.DRAW = register(View("view_draw", "&Draw", "Ctrl+1"))
View.STAGES = register(View("view_stages", "St&ages", "Ctrl+2"))
View.PATHS = register(View("view_paths", "&Paths", "Ctrl+3"))
View.CUT = register(View("view_cut", "C&ut", "Ctrl+4"))
View.CURVES = register(View("view_curves", "Cur&ves", "Ctrl+5"))
View.SURFACES = register(View("view_surfaces", "Sur&faces", "Ctrl+6"))
View.NC = register(View("view_nc", "&NC", "Ctrl+7"))
