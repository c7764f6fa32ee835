"""The kinds of operation that come with the program: importing this registers them."""

from __future__ import annotations

from . import adaptive, contour, drill, pocket, rest, vcarve

__all__ = ["adaptive", "contour", "drill", "pocket", "rest", "vcarve"]
