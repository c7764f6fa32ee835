"""The actions of menus and keys, for whoever answers some of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from PySide6.QtGui import QAction


class Commands(Protocol):
    """Gives each action by its name."""

    def __getitem__(self, name: str, /) -> QAction:
        """Return an action."""


def on_trigger(commands: Commands, name: str, act: Callable[[], object]) -> None:
    """Do something whenever an action is triggered."""
    commands[name].triggered.connect(lambda *_: act())
