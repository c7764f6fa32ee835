"""The language that the window speaks, and its words in it."""

from __future__ import annotations

from ...core.catalogue import catalogue


class _ActiveLanguage:
    """The language that the window speaks."""

    code = "en"


def set_language(code: str) -> None:
    """Use another language from now on."""
    catalogue(code)
    _ActiveLanguage.code = code


def active_language() -> str:
    """Return the code of the language that the window speaks."""
    return _ActiveLanguage.code


def tr(text: str) -> str:
    """Return a text in the language that the window speaks; what the catalogue lacks stays English."""
    return catalogue(_ActiveLanguage.code).look_up(text) or text
