"""The user's settings as they are now, and their keeping from one run to the next."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from ...core.errors import HitofudeError
from ...core.settings import Settings, save_settings


class Preferences(QObject):
    """Holds the settings for everybody who reads or changes one.

    Signals:
        saving(): they are about to be written; whoever keeps something in them brings it up to date.

    Attributes:
        settings: as they are now.
    """

    saving = Signal()

    def __init__(self, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.settings = settings

    @property
    def last_folder(self) -> Path:
        """The folder in which a file is written that nobody has named yet."""
        return Path(self.settings.last_folder or Path.home())

    def add_recent(self, path: Path) -> None:
        """Put a file at the head of those that were opened lately, at once: whoever is killed offers it next time."""
        self.keep(self.settings.with_recent_file(path))

    def keep(self, settings: Settings) -> None:
        """Take other settings over and save them."""
        self.settings = settings
        self.save()

    def save(self) -> None:
        """Save them; a folder that cannot be written is no reason to bother anybody."""
        self.saving.emit()
        with suppress(HitofudeError):
            save_settings(self.settings)
