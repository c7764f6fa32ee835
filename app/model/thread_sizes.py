"""Threads that operations cut: what each is called, how wide it is, how far one turn goes, and how deep it is cut.

ISO 68-1 and 261 (M), ASME B1.1 (UNC, UNF; the same 60 degree form), ISO 228-1 (G; 55 degrees). H is the height of the
sharp triangle: P * sqrt(3) / 2, and 0.960491 P at 55 degrees. An ISO nut's core is D - 2 * 5/8 H, its bolt's d - 2 *
17/24 H (with the rounded root); a pipe thread is 2/3 H deep on both sides.
"""

from __future__ import annotations

import math
from enum import Enum

_INCH = 25.4
"""mm."""
_TRIANGLE = math.sqrt(3) / 2
"""Height of the triangle of 60 degrees that a thread is cut from, in pitches (ISO 68-1)."""
_WHITWORTH = 0.960491
"""Height of the triangle of 55 degrees, in pitches (ISO 228-1)."""

_UP = 0.004
"""mm; what is rounded to the hundredth is not rounded down."""


class ThreadForm(Enum):
    """The profile of a thread; the value says the angle between its flanks, degrees."""

    ISO = 60
    WHITWORTH = 55


class ThreadSize(Enum):
    """A thread by its name in drawings, to the right; operations say where one turns to the left.

    Attributes:
        major: diameter over the crests of the bolt, mm.
        pitch: how far one turn goes, mm.
    """

    major: float
    pitch: float

    def __new__(cls, word: str, major: float, pitch: float) -> ThreadSize:
        """Make a member whose value is its name in drawings."""
        made = object.__new__(cls)
        made._value_ = word
        made.major, made.pitch = major, pitch
        return made

    M1_6 = "M1.6", 1.6, 0.35
    M2 = "M2", 2.0, 0.4
    M2_5 = "M2.5", 2.5, 0.45
    M3 = "M3", 3.0, 0.5
    M4 = "M4", 4.0, 0.7
    M5 = "M5", 5.0, 0.8
    M6 = "M6", 6.0, 1.0
    M8 = "M8", 8.0, 1.25
    M10 = "M10", 10.0, 1.5
    M12 = "M12", 12.0, 1.75
    M14 = "M14", 14.0, 2.0
    M16 = "M16", 16.0, 2.0
    M18 = "M18", 18.0, 2.5
    M20 = "M20", 20.0, 2.5
    M24 = "M24", 24.0, 3.0
    M30 = "M30", 30.0, 3.5
    M36 = "M36", 36.0, 4.0
    M42 = "M42", 42.0, 4.5
    M48 = "M48", 48.0, 5.0
    M8X1 = "M8x1", 8.0, 1.0
    M10X1 = "M10x1", 10.0, 1.0
    M10X1_25 = "M10x1.25", 10.0, 1.25
    M12X1 = "M12x1", 12.0, 1.0
    M12X1_5 = "M12x1.5", 12.0, 1.5
    M14X1_5 = "M14x1.5", 14.0, 1.5
    M16X1_5 = "M16x1.5", 16.0, 1.5
    M18X1_5 = "M18x1.5", 18.0, 1.5
    M20X1_5 = "M20x1.5", 20.0, 1.5
    M24X2 = "M24x2", 24.0, 2.0
    M30X2 = "M30x2", 30.0, 2.0
    UNC_4 = "4-40 UNC", 0.112 * _INCH, _INCH / 40
    UNC_6 = "6-32 UNC", 0.138 * _INCH, _INCH / 32
    UNC_8 = "8-32 UNC", 0.164 * _INCH, _INCH / 32
    UNC_10 = "10-24 UNC", 0.190 * _INCH, _INCH / 24
    UNC_1_4 = "1/4-20 UNC", 0.250 * _INCH, _INCH / 20
    UNC_5_16 = "5/16-18 UNC", 0.3125 * _INCH, _INCH / 18
    UNC_3_8 = "3/8-16 UNC", 0.375 * _INCH, _INCH / 16
    UNC_7_16 = "7/16-14 UNC", 0.4375 * _INCH, _INCH / 14
    UNC_1_2 = "1/2-13 UNC", 0.500 * _INCH, _INCH / 13
    UNC_5_8 = "5/8-11 UNC", 0.625 * _INCH, _INCH / 11
    UNC_3_4 = "3/4-10 UNC", 0.750 * _INCH, _INCH / 10
    UNC_1 = "1-8 UNC", 1.000 * _INCH, _INCH / 8
    UNF_4 = "4-48 UNF", 0.112 * _INCH, _INCH / 48
    UNF_6 = "6-40 UNF", 0.138 * _INCH, _INCH / 40
    UNF_8 = "8-36 UNF", 0.164 * _INCH, _INCH / 36
    UNF_10 = "10-32 UNF", 0.190 * _INCH, _INCH / 32
    UNF_1_4 = "1/4-28 UNF", 0.250 * _INCH, _INCH / 28
    UNF_5_16 = "5/16-24 UNF", 0.3125 * _INCH, _INCH / 24
    UNF_3_8 = "3/8-24 UNF", 0.375 * _INCH, _INCH / 24
    UNF_7_16 = "7/16-20 UNF", 0.4375 * _INCH, _INCH / 20
    UNF_1_2 = "1/2-20 UNF", 0.500 * _INCH, _INCH / 20
    UNF_5_8 = "5/8-18 UNF", 0.625 * _INCH, _INCH / 18
    UNF_3_4 = "3/4-16 UNF", 0.750 * _INCH, _INCH / 16
    UNF_1 = "1-12 UNF", 1.000 * _INCH, _INCH / 12
    G1_8 = "G1/8", 9.728, _INCH / 28
    G1_4 = "G1/4", 13.157, _INCH / 19
    G3_8 = "G3/8", 16.662, _INCH / 19
    G1_2 = "G1/2", 20.955, _INCH / 14
    G3_4 = "G3/4", 26.441, _INCH / 14
    G1 = "G1", 33.249, _INCH / 11

    @property
    def form(self) -> ThreadForm:
        """The profile."""
        return ThreadForm.WHITWORTH if self.value.startswith("G") else ThreadForm.ISO

    @property
    def pitch_diameter(self) -> float:
        """Diameter at which teeth and gaps are equally wide, mm."""
        deep = 3 / 8 * _TRIANGLE if self.form is ThreadForm.ISO else 1 / 3 * _WHITWORTH
        return self.major - 2 * deep * self.pitch

    @property
    def nut_core(self) -> float:
        """Diameter within the crests of the nut, mm: of the hole before it is threaded."""
        deep = 5 / 8 * _TRIANGLE if self.form is ThreadForm.ISO else 2 / 3 * _WHITWORTH
        return self.major - 2 * deep * self.pitch

    @property
    def bolt_core(self) -> float:
        """Diameter at the roots of the bolt, mm."""
        deep = 17 / 24 * _TRIANGLE if self.form is ThreadForm.ISO else 2 / 3 * _WHITWORTH
        return self.major - 2 * deep * self.pitch

    @property
    def tap_drill(self) -> float:
        """Diameter of the drill before the tap, mm, to the tenth where that is no less than the core, else to the
        hundredth: a little more than the core, so that the tap turns.
        """
        wanted = max(self.major - self.pitch, self.nut_core)
        return next(size for size in (round(wanted, 1), round(wanted + _UP, 2)) if size >= self.nut_core)
