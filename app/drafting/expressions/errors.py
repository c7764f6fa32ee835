"""What is said when a line of the drawing language cannot be read."""

from __future__ import annotations

from ...core.errors import HitofudeError, InputError


class CommandError(InputError):
    """A text of the drawing language is wrong at one place.

    Attributes:
        reason: what was found, what was expected, what to do; a sentence.
        column, line: 1-based, where reading stopped.
    """

    def __init__(self, reason: str, column: int = 1, line: int = 1) -> None:
        """Say what is wrong and where."""
        super().__init__(f"{f'Line {line}, column' if line > 1 else 'Column'} {column}: {reason}")
        self.reason = reason
        self.column = column
        self.line = line


def reason_of(error: HitofudeError) -> str:
    """Return what is wrong without its line and column, for whoever has typed none."""
    return error.reason if isinstance(error, CommandError) else str(error)
