"""Packed data in a PDF."""

from __future__ import annotations

import zlib


def stream(data: bytes, told: str = "") -> bytes:
    """Return packed data as an object of a PDF.

    Args:
        told: further entries of its dictionary, each with a blank behind it.
    """
    packed = zlib.compress(data, 9)
    return f"<< {told}/Length {len(packed)} /Filter /FlateDecode >>\nstream\n".encode() + packed + b"\nendstream"
