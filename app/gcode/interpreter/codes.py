"""G and M codes by modal group, and the words that each takes."""

from __future__ import annotations

from enum import StrEnum

from .cycles import CYCLE_WORDS

AXES = "xyz"
ROTARY = "abcuvw"


class ModalGroup(StrEnum):
    """Codes of one group exclude one another in a block; the value says what they are about."""

    ONCE = "what is done once"
    MOTION = "motion"
    PLANE = "plane"
    DISTANCE = "distance mode"
    ARC_DISTANCE = "arc distance mode"
    FEED = "feed mode"
    UNITS = "units"
    RADIUS = "cutter compensation"
    LENGTH = "tool length"
    RETURN = "return level of cycles"
    OFFSET = "work offset"
    PATH = "path control"
    SPINDLE_MODE = "spindle mode"
    LATHE = "lathe mode"
    POLAR = "polar coordinates"
    SCALING = "scaling"
    MIRRORING = "mirroring"
    TURNING = "rotation"
    SMOOTHING = "smoothing"
    STOP = "stopping"
    TOOL = "tool change"
    SPINDLE = "spindle"
    COOLANT = "coolant"
    OVERRIDE = "overrides"
    PINS = "input and output"
    CALL = "calls"
    STATE = "saved state"


def _codes(text: str) -> tuple[str, ...]:
    return tuple(text.split())


_G: dict[ModalGroup, tuple[str, ...]] = {
    ModalGroup.ONCE: _codes("G4 G9 G10 G28 G28.1 G30 G30.1 G52 G53 G65 G92 G92.1 G92.2 G92.3"),
    ModalGroup.MOTION: _codes(
        "G0 G1 G2 G3 G5 G5.1 G5.2 G5.3 G6.2 G33 G33.1 G38.2 G38.3 G38.4 G38.5 G73 G74 G80 G81 G82 G83 G84 G85 G86 G87 "
        "G88 G89"
    ),
    ModalGroup.PLANE: _codes("G17 G18 G19"),
    ModalGroup.DISTANCE: _codes("G90 G91"),
    ModalGroup.ARC_DISTANCE: _codes("G90.1 G91.1"),
    ModalGroup.FEED: _codes("G93 G94 G95"),
    ModalGroup.UNITS: _codes("G20 G21"),
    ModalGroup.RADIUS: _codes("G40 G41 G41.1 G42 G42.1"),
    ModalGroup.LENGTH: _codes("G43 G43.1 G43.2 G44 G49"),
    ModalGroup.RETURN: _codes("G98 G99"),
    ModalGroup.OFFSET: _codes("G54 G54.1 G55 G56 G57 G58 G59 G59.1 G59.2 G59.3"),
    ModalGroup.PATH: _codes("G61 G61.1 G64"),
    ModalGroup.SPINDLE_MODE: _codes("G96 G97"),
    ModalGroup.LATHE: _codes("G7 G8"),
    ModalGroup.POLAR: _codes("G15 G16"),
    ModalGroup.SCALING: _codes("G50 G51"),
    ModalGroup.MIRRORING: _codes("G50.1 G51.1"),
    ModalGroup.TURNING: _codes("G68 G69"),
    ModalGroup.SMOOTHING: _codes("G187"),
}
_M: dict[ModalGroup, tuple[str, ...]] = {
    ModalGroup.STOP: _codes("M0 M1 M2 M30 M60"),
    ModalGroup.TOOL: _codes("M6 M61"),
    ModalGroup.SPINDLE: _codes("M3 M4 M5 M19"),
    ModalGroup.COOLANT: _codes("M7 M8 M9"),
    ModalGroup.OVERRIDE: _codes("M48 M49 M50 M51 M52 M53"),
    ModalGroup.PINS: _codes("M62 M63 M64 M65 M66 M67 M68"),
    ModalGroup.CALL: _codes("M97 M98 M99"),
    ModalGroup.STATE: _codes("M70 M71 M72 M73"),
}
GROUP_OF: dict[str, ModalGroup] = {
    code: group for table in (_G, _M) for group, codes in table.items() for code in codes
}

CYCLES = frozenset(CYCLE_WORDS)
WITHOUT_AXES = frozenset({"G4", "G9", "G28.1", "G30.1", "G53", "G92.1", "G92.2", "G92.3"})
"""Codes done once that leave the axis words of their block to its motion."""

TAKES: dict[str, str] = {code: letters.lower() for code, letters in CYCLE_WORDS.items()} | {
    "G2": "ijkrp",
    "G3": "ijkrp",
    "G4": "pxu",
    "G5": "ijpq",
    "G5.1": "ijpq",
    "G5.2": "pl",
    "G6.2": "pkr",
    "G10": "lprijq",
    "G30": "p",
    "G33": "k",
    "G33.1": "ki",
    "G41": "d",
    "G42": "d",
    "G41.1": "dl",
    "G42.1": "dl",
    "G43": "h",
    "G43.1": "",
    "G43.2": "h",
    "G44": "h",
    "G51": "ijkp",
    "G54.1": "p",
    "G64": "pqr",
    "G65": "abcdefhijklmqrstuvwxyzp",
    "G68": "abr",
    "G96": "d",
    "G187": "pe",
    "M19": "rpq",
    "M3": "$",
    "M50": "p",
    "M51": "p",
    "M52": "p",
    "M53": "p",
    "M61": "q",
    "M62": "p",
    "M63": "p",
    "M64": "p",
    "M65": "p",
    "M66": "pelq",
    "M67": "eq",
    "M68": "eq",
    "M97": "pl",
    "M98": "pl",
    "M99": "p",
}
"""Which words beside axes, F, S and T a code takes; codes that are not named take none."""
