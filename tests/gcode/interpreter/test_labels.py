"""LinuxCNC's own limits of lines and O words: what its interpreter refuses is refused at the same line, what it takes
is taken.
"""

import os
import re
import subprocess
from pathlib import Path

import pytest

from app.gcode.interpreter.reader import read_program
from tests.gcode.rs274_oracle import RS274, needs_rs274, own_home

OPENED = {
    "if": "o1 if [1]\nG0 X1\no1 endif\n",
    "if not": "o1 if [0]\nG0 X1\no1 endif\n",
    "else": "o1 if [0]\no1 else\nG0 X1\no1 endif\n",
    "while": "#1=0\no1 while [#1 lt 2]\n#1=[#1+1]\no1 endwhile\n",
    "while not": "o1 while [0]\n#1=[#1+1]\no1 endwhile\n",
    "repeat": "o1 repeat [2]\nG0 X1\no1 endrepeat\n",
    "sub": "o1 sub\nG0 X1\no1 endsub\n",
    "do": "#1=0\no1 do\n#1=[#1+1]\no1 while [#1 lt 2]\n",
}
PAIRS = {f"{a}, {b}": OPENED[a] + OPENED[b] + "M2\n" for a in OPENED for b in OPENED if "do" not in (a, b) or a == "if"}
IF, SUB = OPENED["if"], OPENED["sub"]
LONG = "(" + "a" * 251 + ")\n"


def calls(deep: int) -> str:
    """Subroutines that call one another so deep."""
    return (
        "".join(f"o{k} sub\no{k + 1} call\no{k} endsub\n" for k in range(1, deep))
        + f"o{deep} sub\nG0 X1\no{deep} endsub\no1 call\nM2\n"
    )


PLACES = {
    "an if that is done twice": f"o9 repeat [2]\n{IF}o9 endrepeat\nM2\n",
    "one label in two subroutines": f"o100 sub\n{IF}o100 endsub\no101 sub\n{IF}o101 endsub\no100 call\no101 call\nM2\n",
    "one label in a subroutine and beside it": f"o100 sub\n{IF}o100 endsub\no100 call\n{IF}M2\n",
    "twice in a subroutine": f"o100 sub\n{IF}{IF}o100 endsub\no100 call\nM2\n",
    "twice in a subroutine that is not called": f"o100 sub\n{IF}{IF}o100 endsub\nM2\n",
    "a name of all": "o<_a> if [1]\nG0 X1\no<_a> endif\no<_a> if [1]\nG0 X1\no<_a> endif\nM2\n",
    "twice in what is not done": f"o2 if [0]\n{IF}{IF}o2 endif\nM2\n",
    "once in what is not done": f"o2 if [0]\n{IF}o2 endif\n{IF}M2\n",
    "a subroutine in an if": f"o2 if [1]\n{SUB}o2 endif\no1 call\nM2\n",
    "a subroutine in a loop": f"o2 repeat [2]\n{SUB}o2 endrepeat\nM2\n",
    "a subroutine in an if not done": f"o2 if [0]\n{SUB}o2 endif\nM2\n",
    "one in another": f"o2 sub\n{SUB}o2 endsub\nM2\n",
    "behind its call": f"o1 call\n{SUB}M2\n",
    "twice": f"{SUB}{SUB}M2\n",
    "twice, called between": f"{SUB}o1 call\n{SUB}M2\n",
    "twice, one behind the end": f"{SUB}o1 call\nM2\n{SUB}",
    "behind the end": f"o1 call\nM2\n{SUB}",
    "loops across one another": "o1 repeat [2]\no2 if [1]\nG0 X1\no1 endrepeat\no2 endif\nM2\n",
    "endif alone": "o1 endif\nM2\n",
    "else alone": "o1 else\nM2\n",
    "endwhile alone": "o1 endwhile\nM2\n",
    "endsub alone": "o1 endsub\nM2\n",
    "break alone": "o1 break\nM2\n",
    "continue alone": "o1 continue\nM2\n",
    "return alone": "o1 return\nM2\n",
    "else of a while": "o1 while [0]\no1 else\nG0 X1\no1 endwhile\nM2\n",
    "calls 9 deep": calls(9),
    "calls 10 deep": calls(10),
    "a line of 252": "G0 X1\n(" + "a" * 250 + ")\nM2\n",
    "a line of 253": f"G0 X1\n{LONG}M2\n",
    "a long line": "G0 X1" + " " * 300 + "\nM2\n",
    "a long line in an if not done": f"o1 if [0]\n{LONG}o1 endif\nM2\n",
    "a long line in a subroutine": f"o1 sub\n{LONG}o1 endsub\nM2\n",
    "a long line behind the end": f"G0 X1\nM2\n{LONG}",
    "252 and two bytes of line end": "G21\r\n(" + "a" * 250 + ")\r\nM2\r\n",
    "251 and two": "G21\r\n(" + "a" * 249 + ")\r\nM2\r\n",
}
REFUSED = re.compile(r"^(\d+): |line:(\d+) ", re.MULTILINE)


@pytest.mark.parametrize("name", [*PAIRS, *PLACES])
def test_as_linuxcnc(name: str, tmp_path: Path) -> None:
    needs_rs274()
    text = (PAIRS | PLACES)[name]
    (tmp_path / "in.ngc").write_bytes(text.encode())
    (tmp_path / "tool.tbl").touch()
    command = [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc"]
    ran = subprocess.run(
        command, cwd=tmp_path, env=own_home(str(tmp_path)), capture_output=True, stdin=subprocess.DEVNULL, timeout=20
    )
    error = read_program(text.encode()).error
    assert (ran.returncode != 0) == (error is not None), (ran.stderr[-300:], error)
    line = REFUSED.search(os.fsdecode(ran.stderr)) if ran.returncode else None
    if line is not None and error is not None and "sub" not in name:
        assert error.line == int(line[1] or line[2]), (ran.stderr, error)


@pytest.mark.parametrize(
    ("name", "line", "cause"),
    [
        ("if, while", 5, "the label of what begins in line 1 already"),
        ("if, do", 7, "the label of what begins in line 1 already"),
        ("one in another", 1, "begins in line 2 within another"),
        ("twice", 4, "is in line 1 already"),
        ("behind its call", 2, "again"),
        ("else of a while", 2, "belongs to no if: line 1 has while"),
        ("endif alone", 1, "belongs to no if"),
        ("calls 10 deep", 26, "more than 9 deep"),
        ("a line of 253", 2, "longer than 252 characters"),
        ("a long line in an if not done", 2, "longer than 252 characters"),
        ("252 and two bytes of line end", 2, "longer than 251 characters"),
    ],
)
def test_the_cause_is_told(name: str, line: int, cause: str) -> None:
    error = read_program((PAIRS | PLACES)[name].encode()).error
    assert error is not None and error.line == line and cause in error.text
