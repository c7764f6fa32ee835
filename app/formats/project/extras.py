"""What lies beside the drawing in a project file: the picture that is traced, and the text of its editor."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.toml_tables import spelled
from ...model.underlay import Underlay
from ..job.tables import JobTable, JobText, read_angle, read_flag, read_number, read_points, read_text, read_texts
from ..job.write import angle_said

MOST_TEXT = 2 * 2**20
"""Letters of the editor's text as the file spells it; a longer one is left out, and has files of its own."""


@dataclass(frozen=True, slots=True)
class ProjectExtras:
    """What is no part of the drawing and yet belongs to it.

    Attributes:
        underlay: the picture that is traced; None where there is none.
        text: what stands in the editor of the shape language. replaces: running it replaces the drawing.
    """

    underlay: Underlay | None = None
    text: str = ""
    replaces: bool = False

    def from_folder(self, folder: Path) -> ProjectExtras:
        """Return it with the picture's path as it is seen from elsewhere, where it is told from this folder."""
        return self._with_path(str(Path(folder.absolute(), self.underlay.path))) if self.underlay is not None else self

    def in_folder(self, folder: Path) -> ProjectExtras:
        """Return it with the picture's path told from this folder, where the picture lies in that."""
        if self.underlay is None or not Path(self.underlay.path).is_relative_to(folder.absolute()):
            return self
        return self._with_path(Path(self.underlay.path).relative_to(folder.absolute()).as_posix())

    def _with_path(self, path: str) -> ProjectExtras:
        assert self.underlay is not None
        return replace(self, underlay=replace(self.underlay, path=path))


NOTHING_BESIDE = ProjectExtras()


def beside_lines(beside: ProjectExtras) -> Iterator[str]:
    """Yield the tables of a project file."""
    if (under := beside.underlay) is not None:
        yield from (
            "",
            "[underlay]",
            f"path = {spelled(under.path)}",
            f"origin = {spelled(under.origin)}",
            f"mm_per_px = {spelled(under.mm_per_px)}",
            f"angle = {spelled(angle_said(under.angle))}",
            f"opacity = {spelled(under.opacity)}",
        )
    lines = [f"    {spelled(line)}," for line in beside.text.split("\n")] if beside.text.strip() else []
    if lines and sum(map(len, lines)) <= MOST_TEXT:
        yield from ("", "[text]", f"replaces = {spelled(beside.replaces)}", "lines = [", *lines, "]")


def read_beside(lines: JobText, tables: Mapping[str, dict[str, Any]]) -> ProjectExtras:
    """Return what `beside_lines` has written.

    Args:
        lines: the file, for errors.
        tables: "underlay" and "text", by their names; an empty one is one that is not there.

    Raises:
        InputError: a value is missing, unknown or of another kind, with its line.
    """
    table = JobTable(lines, "text", 0, dict(tables["text"]))
    table.take("replaces", read_flag)
    table.take("lines", read_texts)
    table.done("replaces, lines")
    return ProjectExtras(
        _underlay(lines, tables["underlay"]),
        "\n".join(table.taken.get("lines", ())),
        table.taken.get("replaces", False),
    )


def _underlay(lines: JobText, values: dict[str, Any]) -> Underlay | None:
    if not values:
        return None
    table = JobTable(lines, "underlay", 0, dict(values))
    table.take("path", read_text)
    table.take("origin", lambda value: read_points([value])[0])
    table.take("mm_per_px", read_number)
    table.take("angle", read_angle)
    table.take("opacity", read_number)
    table.done("path, origin, mm_per_px, angle, opacity")
    if not table.taken.get("path"):
        raise InputError(f"{lines.name}:{lines.line('underlay', 0, '')}: [underlay] names no picture; give its path.")
    return lines.built("underlay", 0, lambda: Underlay(**table.taken))
