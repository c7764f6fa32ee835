"""Posts are data files; a wrong one is refused with its file, its key and what is expected there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from app.core.errors import InputError
from app.core.resources import resource
from app.gcode.interpreter.dialect import DIALECT_RULES, Dialect
from app.gcode.posts import ArcCentre, Coolant, load_post, post_names, post_titles, read_post
from app.model.part import Units

TEXT = resource("posts", "linuxcnc.toml").read_text("utf-8")


def variant(folder: Path, old: str, new: str) -> Path:
    """The LinuxCNC post with one line changed, as mill.toml."""
    assert old in TEXT
    path = folder / "mill.toml"
    path.write_text(TEXT.replace(old, new, 1), "utf-8")
    return path


def test_linuxcnc() -> None:
    post = load_post("linuxcnc")
    assert "linuxcnc" in post_names()
    assert (post.title, post.extension) == ("LinuxCNC", ".ngc")
    assert (post.digits(Units.MM).X, post.digits(Units.INCH).X) == (4, 5)
    assert post.arcs.centre is ArcCentre.INCREMENTAL and post.coolant.use is Coolant.NONE


def test_five_controls_come_with_the_program() -> None:
    assert post_titles() == {"fanuc": "Fanuc", "grbl": "grbl", "haas": "Haas", "linuxcnc": "LinuxCNC", "mach3": "Mach3"}
    assert {name: load_post(name).extension for name in post_names()} == {
        "fanuc": ".nc",
        "grbl": ".nc",
        "haas": ".nc",
        "linuxcnc": ".ngc",
        "mach3": ".tap",
    }
    assert all(load_post(name).dialect is Dialect(name) for name in post_names())


@pytest.mark.parametrize("name", post_names())
def test_posts_know_only_words_of_their_language(name: str) -> None:
    """No block of a post names a G word that the reader's table says the control lacks."""
    post, missing = load_post(name), DIALECT_RULES[Dialect(name)].missing
    blocks = [
        *post.program.start,
        *post.program.tool,
        *post.program.leave,
        *post.program.home,
        *post.program.end,
        post.blending.exact,
    ]
    blocks += [post.blending.blend, post.drilling.drill, post.drilling.peck, post.drilling.chip_break, post.nurbs.word]
    assert not missing & {word for block in blocks for word in re.findall(r"[GM][0-9.]+", block)}


def test_unknown_post_names_the_known_ones() -> None:
    with pytest.raises(InputError, match=r"no post 'fanuk'.*linuxcnc"):
        load_post("fanuk")


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('title = "LinuxCNC"\n', "", "mill.toml: title is missing; add a text"),
        ("[spindle]\ndwell_s = 2.0\n", "", "mill.toml: spindle is missing; add a table with dwell_s"),
        ("dwell_s = 2.0", "dwell_s = 2.0\nwarmup = 1", "mill.toml: spindle.warmup is not known; expected are dwell_s"),
        ("dwell_s = 2.0", "dwell_s = -1", "mill.toml: spindle.dwell_s is -1; expected is a number from 0 to 600"),
        ("dwell_s = 2.0", 'dwell_s = "2"', "mill.toml: spindle.dwell_s is '2'; expected is a number"),
        ("dwell_s = 2.0", "dwell_s = true", "mill.toml: spindle.dwell_s is True; expected is a number"),
        ("use = false", "use = 0", "mill.toml: numbers.use is 0; expected is true or false"),
        ("step = 10", "step = 1.5", "mill.toml: numbers.step is 1.5; expected is a whole number"),
        (
            'centre = "incremental"',
            'centre = "radius"',
            "mill.toml: arcs.centre is 'radius'; expected is 'incremental' or 'absolute'",
        ),
        ('end = ["M2"]', 'end = "M2"', "mill.toml: program.end is 'M2'; expected is a list of texts"),
        ('end = ["M2"]', 'end = ["M2 {tool}"]', "mill.toml: program.end: {tool} in 'M2 {tool}' is not known"),
        ('"T{tool} M6"', '"T{tool M6"', "mill.toml: program.tool: 'T{tool M6' has a brace without its partner"),
        ("G64 P{blend} Q0", "G64 P{p} Q0", "mill.toml: blending.blend: {p} in 'G64 P{p} Q0' is not known"),
        ('"X", "Y", "Z"', '"X", "Y", "Y"', "mill.toml: words.order has 'Y' twice; expected is each of"),
        ('"G2", "G3"]', '"G2"]', "mill.toml: words.motion has 3 texts"),
        ('"T{tool} M6"', '"T{tool:>4} M6"', "mill.toml: program.tool: 'T{tool:>4} M6' cannot be filled in"),
        ('"T{tool} M6"', '"T{tool[x]} M6"', "mill.toml: program.tool: {tool[x]} in 'T{tool[x]} M6' is not known"),
        (
            "home = []",
            'home = ["G0 Z{clearance}"]',
            "mill.toml: program.home: {clearance} in 'G0 Z{clearance}' is not known",
        ),
        ("number = 1", "number = 9001", "mill.toml: program.number is 9001; expected is a number from 1 to 7999"),
        ('form = "bezier"', 'form = "none"', "mill.toml: nurbs.word is 'G5.2' for the form 'none'"),
        (
            '"T{tool} M6"',
            '"T{tool} M6 (Fräser)"',
            "mill.toml: program.tool has 'T{tool} M6 (Fräser)'; programs are lines of ASCII",
        ),
        ('end = ["M2"]', 'end = ["M2\\nM30"]', "mill.toml: program.end has 'M2\\nM30'; programs are lines of ASCII"),
        (
            'dialect = "linuxcnc"',
            'dialect = "okuma"',
            "mill.toml: dialect is 'okuma'; expected is 'linuxcnc', 'grbl'",
        ),
        ("X = 4", "X = 9", "mill.toml: decimals.mm.X is 9; expected is a number from 0 to 6"),
        ("I = 4", "I = 3", "mill.toml: decimals.mm must be alike"),
        (
            "Z = 4",
            "Z = 2",
            "mill.toml: decimals.mm must be alike for X and Y, and for I and J, and I and Z not less than X",
        ),
        ('title = "LinuxCNC"', "title = ", "mill.toml: this is no TOML file"),
    ],
)
def test_wrong_posts_say_what_is_wrong(tmp_path: Path, old: str, new: str, sentence: str) -> None:
    file, said = sentence.split(": ", 1)
    with pytest.raises(InputError, match=rf"^{re.escape(file)}(:\d+)?: {re.escape(said)}"):
        read_post(variant(tmp_path, old, new))


def test_the_line_is_told(tmp_path: Path) -> None:
    line = TEXT.splitlines().index("dwell_s = 2.0") + 1
    with pytest.raises(InputError, match=rf"^mill.toml:{line}: spindle.dwell_s"):
        read_post(variant(tmp_path, "dwell_s = 2.0", "dwell_s = -1"))


def test_whole_numbers_will_do_where_decimals_may_be(tmp_path: Path) -> None:
    assert read_post(variant(tmp_path, "dwell_s = 2.0", "dwell_s = 3")).spindle.dwell_s == 3
