"""Where the data files are, in a source tree and in an installed wheel."""

from __future__ import annotations

from pathlib import Path

PACKAGE = __name__.partition(".")[0]
"""What the whole program is called as a package: `app` in the tree, `hitofude` where it is installed."""

_FOLDER = Path(__file__).resolve().parents[1]


def resource(*parts: str) -> Path:
    """Return the path of a file or folder below `resources/`.

    Raises:
        FileNotFoundError: there is no such resource in this installation.
    """
    for root in (_FOLDER / "resources", _FOLDER.parent / "resources"):
        path = root.joinpath(*parts)
        if path.exists():
            return path
    raise FileNotFoundError(f"resource {'/'.join(parts)} is not part of this installation; reinstall Hitofude")
