"""A picture as a scanner would give it, drawn here."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

DARK_INK, PAPER = 40, 230
"""Grey of lines and of paper."""


def scan(path: Path) -> Path:
    """Write a frame with a ring in it, bars from the frame to the ring, which make T junctions, and a square; lines are
    2 px wide.
    """
    picture = np.full((240, 360), PAPER, np.uint8)
    cv2.rectangle(picture, (20, 20), (220, 220), DARK_INK, 2)
    cv2.circle(picture, (120, 120), 50, DARK_INK, 2)
    cv2.line(picture, (120, 20), (120, 70), DARK_INK, 2)
    cv2.line(picture, (120, 170), (120, 220), DARK_INK, 2)
    cv2.rectangle(picture, (260, 40), (340, 120), DARK_INK, 2)
    cv2.imwrite(str(path), picture)
    return path
