"""The picture of part and paths as a file, by its suffix."""

from __future__ import annotations

from .picture import PathPicture
from .picture_svg import svg


def plot(picture: PathPicture, suffix: str) -> bytes:
    """Return the picture as a file's bytes; `suffix` is .svg or .png."""
    if suffix == ".svg":
        return svg(picture).encode()
    from .picture_png import png

    return png(picture)
