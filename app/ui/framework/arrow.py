"""The arrow of drop-down fields: style sheets take pictures only from files, so it is drawn into a temporary one."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from functools import cache
from pathlib import Path

from ...core.atomic import waiting_prefix
from .icons import pixmap
from .theme import Theme


@cache
def _folder() -> Path:
    folder = Path(tempfile.mkdtemp(prefix=waiting_prefix("hitofude"), suffix=".part"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def arrow_picture(theme: Theme) -> str:
    """Return the path of the arrow in the theme's muted colour, with forward slashes."""
    path = _folder() / f"arrow-{theme.name}.png"
    if not path.exists():
        pixmap("down", theme.muted, 2).save(str(path))
    return path.as_posix()
