"""Draws the figures of the five texts anew: `python -m tests.exhibits.make_figures`, into resources/docs/figures."""

from __future__ import annotations

from app.core.resources import resource
from app.exhibits.figure_eleven import FigureOptions, figure_eleven
from tests.exhibits.redrawn import redrawn


def main() -> None:
    folder = resource("docs") / "figures"
    folder.mkdir(exist_ok=True)
    for name, data in redrawn(figure_eleven(FigureOptions(("A", "B"), 1024, 1))).items():
        (folder / f"{name}.png").write_bytes(data)


if __name__ == "__main__":
    main()
