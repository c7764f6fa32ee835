"""Languages of other controls and machines, which are not read: named where a program turns out to be in one of them.

A name says more than the first word that is not understood. Nothing is decided by it: it is looked for only where the
reading has ended with an error.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from .program import ProgramProblem, Severity

_LOOKED_AT = 50_000
"""Bytes from the beginning."""

_POST_IT = "let your CAM program post it for LinuxCNC, grbl, Mach3, Haas or Fanuc"


@dataclass(frozen=True, slots=True)
class _Language:
    """Attributes: title: how its users call it. telling: what no program of a control that is read holds outside its
    comments. remedy: what to do instead.
    """

    title: str
    telling: str
    remedy: str = _POST_IT


_REMARK = r"(?<=\()[^()\n]*(?=\))"
"""What CAM programs write in brackets speaks of tools (CR=0.), times and other controls."""


_LANGUAGES = (
    _Language(
        "a program in Heidenhain's plain language",
        r"^[ \t]*(?:\d+\s+)?(?:BEGIN\s+PGM|TOOL\s+CALL|BLK\s+FORM)\b",
    ),
    _Language(
        "a Heidenhain program in DIN/ISO",
        r"^[ \t]*%[^\n%]{1,60}\sG7[01]\s*\*?\s*$|^[ \t]*(?:N\d+\s*)?G30\s+G17\s+X|^[ \t]*N\d+\s[^\n*;]*\*\s*$",
    ),
    _Language("an Eding CNC program with its own subroutines", r"^[ \t]*(?:GOSUB|ENDSUB)\b"),
    _Language(
        "a Siemens Sinumerik program",
        (
            r"^[ \t]*%_N_|\bG(?:710|700|641|642)\b|\bCYCLE\d+\s*\(|\bPOCKET\d\s*\(|\bWORKPIECE\s*\(|\bCR\s*="
            r"|[A-Z]\d?\s*=\s*(?:AC|IC)\s*\("
            r"|\bT\d*\s*=\s*\""
            r"|\b(?:RNDM?|CHF|CHR|GOTO[BF])\b|\bG500\b|^[^;#\n]*\b[XYZ]\s*=\s*[-+\d(]"
            r"|^[ \t]*R\d+\s*=|^[ \t]*(?:N\d+\s*)?(?:A?TRANS|A?ROT|MSG|SUPA)\b"
        ),
    ),
    _Language(
        "an Okuma OSP program",
        r"^[ \t]*\$[^\n$]{1,40}%|^[ \t]*(?:N\d+\s*)?CALL\s+O\w+|\bVC\d+\s*=|\bG15\s*H\d",
    ),
    _Language(
        "cutter location data (APT)",
        r"^[ \t]*(?:GOTO|FEDRAT|LOADTL|TLDATA)\s*/",
    ),
    _Language(
        "a plot file (HP-GL)",
        r"^[ \t]*(?:IN|SP\d+|PU|PD)\s*;|;\s*P[UD]-?\d",
        "save it with the ending .plt and open it as a drawing",
    ),
    _Language(
        "a program for a 3D printer",
        r"^[ \t]*M(?:8[23]\b|(?:104|109|140|190)\s*[SR]\d)|^[ \t]*(?:N\d+\s*)?G[01]\b[^;(\n]*\bE-?[\d.]",
        "a mill has no extruder: open the solid itself, as STL, and make its paths here",
    ),
    _Language(
        "a program for Marlin, Smoothieware or Klipper",
        r"^[ \t]*(?:M11[78]\s+[A-Z]{2}|M300\s*S|[A-Z]{2,}_[A-Z_]+(?:\s+\w+=|\s*$))",
    ),
    _Language(
        "a ShopBot program",
        r"^[ \t]*(?:[MJ][2-5XYZ]|[MJV]S|TR|C6|C7|C9)\s*,\s*[-.\d]",
    ),
    _Language(
        "a Gerber drawing of a circuit board",
        r"^[ \t]*(?:%(?:FS[LT]|MO(?:MM|IN)\*|ADD\d)|G04[^\n]*\*\s*$)",
        "save its outline as DXF or SVG and open it as a drawing",
    ),
    _Language(
        "a list of a circuit board's holes (Excellon)",
        r"^[ \t]*(?:(?:METRIC|INCH)(?:,[TL]Z\b|\s*$)|FMAT,\d|T\d+C[\d.]+\s*$)",
        "save the holes as DXF and open it as a drawing",
    ),
)
"""In the order in which they are asked: the surest words first."""


def foreign_language(data: bytes) -> ProgramProblem | None:
    """Return the language that a program is in, with the line that tells; None where it is in none that is known.

    Args:
        data: the file's bytes.
    """
    text = re.sub(_REMARK, "", data[:_LOOKED_AT].decode("latin-1"))
    for language in _LANGUAGES:
        found = re.search(language.telling, text, re.IGNORECASE | re.MULTILINE)
        if found is not None:
            word = " ".join(found[0].split())
            line = text.count("\n", 0, found.end() - 1) + 1
            says = f"this looks like {language.title}, which is not read; {language.remedy}."
            return ProgramProblem(line, 0, word, says, Severity.WARNING)
    return None
