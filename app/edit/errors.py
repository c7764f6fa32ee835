"""What is said when a line of the drawing language cannot be read."""

from __future__ import annotations

from app.errors import InputError


class CommandError(InputError):
    """A line of the drawing language is wrong at one place.

    Attributes:
        reason: what was found, what was expected, what to do; a sentence.
        column: 1-based column in the line where reading stopped.
    """

    def __init__(self, reason: str, column: int = 1) -> None:
        """Say what is wrong and in which column."""
        super().__init__(f"Column {column}: {reason}")
        self.reason = reason
        self.column = column
