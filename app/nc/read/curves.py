"""Splines as the control obeys them."""

from __future__ import annotations

from app.nc.read.block import Block
from app.nc.read.control import Control
from app.nc.read.fault import Fault


def move_along_curve(control: Control, block: Block) -> None:
    """Obey G5, G5.1, G5.2, G5.3 and G6.2."""
    raise Fault(f"{control.motion} is not followed.", letter="g")


def end_curve(control: Control, code: str) -> None:
    """Refuse a code within a spline that goes over several blocks."""
