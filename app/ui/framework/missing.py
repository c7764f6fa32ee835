"""What a view says in place of a picture."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MissingHint:
    """What a view lacks: a sentence, and the button (with the name of its action) that makes it."""

    sentence: str = ""
    button: str = ""
    action: str = "open"


NOTHING = MissingHint()


def failed_hint(error: str, again: bool, action: str) -> MissingHint:
    """Return why something is not there, with the button that computes it again where that may help."""
    return MissingHint(error, "Compute again", action) if again else MissingHint(error)
