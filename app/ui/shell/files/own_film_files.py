"""The user's own file that a film of one of the texts is made of: what NC or Surfaces shows, and what
Cut was told of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ....core.errors import InputError
from ...views.cut.controller import CutController
from ...views.nc.controller import NcController
from ...views.surfaces.scene_document import SceneDocument

if TYPE_CHECKING:
    from ....exhibits.films.making import FilmSource


class OwnFilmFiles:
    """Finds the file that is open."""

    def __init__(self, nc: NcController, scene: SceneDocument, cut: CutController) -> None:
        self._nc, self._scene, self._cut = nc, scene, cut

    def of(self, letter: str) -> FilmSource | None:
        """Return the file that is open for a text: the scene for C, else the program; None where there is none."""
        from ....exhibits.films.making import FilmSource
        from ....usecases.examine import ExamineOptions

        if letter == "C":
            scene = self._scene
            folder = scene.path.parent if scene.path is not None else Path()
            return (
                FilmSource(scene.name, scene.text.encode(), lambda name: _read(folder / name)) if scene.open else None
            )
        shown = self._nc.shown
        if shown is None:
            return None
        source = shown.source
        reading = ExamineOptions(source.dialect, source.tools, units=source.units)
        if letter != "B":
            return FilmSource(source.name, source.bytes(), lambda name: _read(Path(name)), reading)
        known = self._cut.known_of(source)
        return FilmSource(
            source.name, source.bytes(), lambda name: _read(Path(name)), reading, known.tools, known.stock
        )


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror or error}; choose another file.") from error
