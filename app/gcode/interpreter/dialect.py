"""In what the controls' languages differ, as far as reading goes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

MANY = 1_000_000_000
"""More than `ReadLimits` allow."""


class Dialect(Enum):
    """The control's language."""

    LINUXCNC = "linuxcnc"
    GRBL = "grbl"
    FANUC = "fanuc"
    HAAS = "haas"
    MACH3 = "mach3"


@dataclass(frozen=True, slots=True)
class DialectRules:
    """What a dialect does its own way.

    Attributes:
        title: the control's name for people.
        ngc_flow: O words with sub, if, while, repeat; named parameters.
        fanuc_flow: O words are program numbers; IF [...] GOTO n, WHILE [...] DO m, M98 P calls.
        least_mm, least_inch: what a length without a decimal point counts in; 1 = the unit itself.
        dwell_unit_s: what P of G4 counts in, s, where it has no decimal point. dwell_unit_with_point_s: where it has
            one.
        length_from_tool: G43 without H takes the length of the tool in the spindle.
        tool_changes: M6 is known. stops_at_change: it leaves the spindle at rest; not where that is left to a macro.
        splines: "G5" (LinuxCNC), "G6.2" (Fanuc) or "".
        calls: how deep subroutines may call one another.
        longest_line: bytes of a line, its end not counted where that is one byte.
        longest_code: characters of a line without its blanks and comments.
        parameters: the largest number of a parameter.
        repeats_by_k: K of a canned cycle says how often it is done, as L does.
        macro_b: it has Fanuc's macro B: operators of its own, and a parameter that nobody has set is vacant and not 0.
        rapids_bend: it may be set to move each axis of a rapid at its own rate.
        missing: G words that other dialects have and this one refuses.
    """

    title: str
    ngc_flow: bool = True
    fanuc_flow: bool = False
    least_mm: float = 1.0
    least_inch: float = 1.0
    dwell_unit_s: float = 1.0
    dwell_unit_with_point_s: float = 1.0
    length_from_tool: bool = True
    tool_changes: bool = True
    stops_at_change: bool = True
    splines: str = "G5"
    calls: int = MANY
    longest_line: int = MANY
    longest_code: int = MANY
    parameters: int = 99_999
    repeats_by_k: bool = False
    macro_b: bool = False
    rapids_bend: bool = False
    missing: frozenset[str] = frozenset()


_GRBL_LACKS = frozenset(
    {
        "G5",
        "G5.1",
        "G5.2",
        "G5.3",
        "G6.2",
        "G7",
        "G8",
        "G9",
        "G15",
        "G16",
        "G33",
        "G33.1",
        "G41",
        "G41.1",
        "G42",
        "G42.1",
        "G43",
        "G43.2",
        "G44",
        "G50",
        "G50.1",
        "G51",
        "G51.1",
        "G52",
        "G54.1",
        "G59.1",
        "G59.2",
        "G59.3",
        "G61.1",
        "G64",
        "G65",
        "G68",
        "G69",
        "G73",
        "G74",
        "G81",
        "G82",
        "G83",
        "G84",
        "G85",
        "G86",
        "G87",
        "G88",
        "G89",
        "G90.1",
        "G92.2",
        "G92.3",
        "G95",
        "G96",
        "G97",
        "G98",
        "G99",
        "G187",
        "M6",
        "M19",
        *(f"M{number}" for number in (*range(48, 54), *range(60, 69), *range(70, 74))),
        "M97",
        "M98",
        "M99",
    }
)

_LINUXCNC_LACKS = frozenset(
    {
        "G6.2",
        "G9",
        "G15",
        "G16",
        "G44",
        "G50",
        "G50.1",
        "G51",
        "G51.1",
        "G54.1",
        "G65",
        "G68",
        "G69",
        "G187",
        "M97",
    }
)

_MACRO_B_LACKS = frozenset(
    {
        "G5.2",
        "G5.3",
        "G28.1",
        "G33.1",
        "G38.2",
        "G38.3",
        "G38.4",
        "G38.5",
        "G43.2",
        "G59.1",
        "G59.2",
        "G59.3",
        "G90.1",
        "G91.1",
        "G92.2",
        "G92.3",
    }
)
"""What LinuxCNC and its kin alone have; Fanuc and Haas stop with an alarm."""

DIALECT_RULES: dict[Dialect, DialectRules] = {
    Dialect.LINUXCNC: DialectRules("LinuxCNC", calls=9, longest_line=252, parameters=5601, missing=_LINUXCNC_LACKS),
    Dialect.GRBL: DialectRules(
        "grbl", ngc_flow=False, tool_changes=False, splines="", longest_code=79, missing=_GRBL_LACKS
    ),
    Dialect.FANUC: DialectRules(
        "Fanuc",
        ngc_flow=False,
        fanuc_flow=True,
        least_mm=0.001,
        least_inch=0.0001,
        dwell_unit_s=0.001,
        length_from_tool=False,
        splines="G6.2",
        repeats_by_k=True,
        macro_b=True,
        rapids_bend=True,
        missing=_MACRO_B_LACKS | {"G187"},
    ),
    Dialect.HAAS: DialectRules(
        "Haas",
        ngc_flow=False,
        fanuc_flow=True,
        least_mm=0.001,
        least_inch=0.0001,
        dwell_unit_s=0.001,
        length_from_tool=False,
        splines="",
        macro_b=True,
        rapids_bend=True,
        missing=_MACRO_B_LACKS | {"G30.1", "G41.1", "G42.1", "G43.1"},
    ),
    Dialect.MACH3: DialectRules(
        "Mach3",
        ngc_flow=False,
        fanuc_flow=True,
        length_from_tool=False,
        splines="",
        stops_at_change=False,
        missing=frozenset({"G51.1", "G187"}),
    ),
}
