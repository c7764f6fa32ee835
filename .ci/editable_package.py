"""What an editable installation is called: `hitofude`, as an installed wheel is, though the tree's folder is `app`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

DOOR = '''"""Hitofude as its source tree has it."""

__path__ = [{folder!r}]
__file__ = {file!r}
with open(__file__, encoding="utf-8") as _source:
    exec(compile(_source.read(), __file__, "exec"))
del _source
'''
"""A package whose modules are the tree's; its own resources it finds beside them."""


class EditableDoor(BuildHookInterface):
    """Puts a package `hitofude` in place of the folder of resources, which an installed tree finds beside its `app`."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write the package's one file for an editable installation; a wheel has the tree itself."""
        if version == "editable":
            door = self._door()
            door.parent.mkdir(parents=True, exist_ok=True)
            door.write_text(door_text(Path(self.root)), encoding="utf-8")
            build_data["force_include_editable"] = {str(door): "hitofude/__init__.py"}

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Take it away again once it is in the archive."""
        self._door().unlink(missing_ok=True)

    def _door(self) -> Path:
        return Path(self.directory) / "hitofude_door.py"


def door_text(root: Path) -> str:
    """Return the file of the package that leads to a tree.

    Args:
        root: of the tree.
    """
    folder = root / "app"
    return DOOR.format(folder=str(folder), file=str(folder / "__init__.py"))
