"""Which key does what: the keys of the table, and what the user made of them."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtGui import QKeySequence

from ...framework.preferences import Preferences
from .actions import Actions


class Shortcuts:
    """The window's keys; what differs from the table is remembered."""

    def __init__(self, actions: Actions, preferences: Preferences) -> None:
        self._actions, self._preferences = actions, preferences
        kept = {name: key for name, key in _pairs(preferences.settings.shortcuts).items() if name in actions.specs}
        for name in kept:  # two of them may have changed their keys for one another's
            self._actions.set_key(name, "")
        for name, key in kept.items():
            self._give(name, key)

    def owner(self, key: str, but: str = "") -> str | None:
        """Return the name of the action that has a key, other than `but`."""
        wanted = QKeySequence(key)
        if wanted.isEmpty():
            return None
        return next(
            (name for name, action in self._actions.by_name.items() if name != but and wanted in action.shortcuts()),
            None,
        )

    def change(self, name: str, key: str) -> None:
        """Give an action its keys, "" = none; whoever had one of them loses that one."""
        self._give(name, key)
        self._keep()

    def _give(self, name: str, key: str) -> None:
        for given in QKeySequence.listFromString(key):
            other = self.owner(given.toString(), but=name)
            if other is not None:
                left = [kept for kept in self._actions[other].shortcuts() if kept != given]
                self._actions.set_key(other, QKeySequence.listToString(left))
        self._actions.set_key(name, key)

    def reset(self, name: str) -> None:
        """Give an action its key of the table again."""
        self.change(name, self._actions.specs[name].key)

    def reset_all(self) -> None:
        """Give every action its key of the table again."""
        for name, spec in self._actions.specs.items():
            self._actions.set_key(name, spec.key)
        self._keep()

    def is_own(self, name: str) -> bool:
        """Whether the user chose this key."""
        return name in changed_keys(self._actions)

    def _keep(self) -> None:
        pairs = tuple(f"{name}={key}" for name, key in changed_keys(self._actions).items())
        self._preferences.keep(replace(self._preferences.settings, shortcuts=pairs))


def changed_keys(actions: Actions) -> dict[str, str]:
    """Return the keys that are not those of the table, by action."""
    return {
        name: actions.key(name)
        for name, spec in actions.specs.items()
        if QKeySequence.listFromString(spec.key) != actions[name].shortcuts()
    }


def _pairs(kept: tuple[str, ...]) -> dict[str, str]:
    return {name: key for name, sign, key in (pair.partition("=") for pair in kept) if sign}
