"""What the program works on, without any window: everything that more than one view needs."""

from __future__ import annotations

from dataclasses import dataclass

from ...drafting.document import Document
from .activity import Activity
from .computation import Computation
from .log import Log
from .notice import Notice
from .preferences import Preferences


@dataclass(frozen=True, eq=False)
class Workspace:
    """The state that controllers share; they tell the window what they did by their signals.

    Attributes:
        document: the drawing and its job. computation: the job's program, and whether it is up to date.
        activity: what runs in the background. preferences: the user's settings.
        log: of what was done. notice: asks a question above the view.
    """

    document: Document
    computation: Computation
    activity: Activity
    preferences: Preferences
    log: Log
    notice: Notice
