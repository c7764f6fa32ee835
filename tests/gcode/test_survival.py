"""Each sentence of "NC that machines survive", for every post in both units."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from itertools import pairwise

import pytest

from app.gcode.posts import Coolant, Post, load_post, post_names
from app.gcode.writer.write import blend_mm, write_files, writing_tolerance
from app.model.job import OriginXY
from app.model.part import Part, Units
from tests.gcode.programs import Path, job, two_tools

POSTS = pytest.mark.parametrize("name", post_names())
UNITS = pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])
CHANGES = tuple(name for name in post_names() if not load_post(name).file_per_tool)
DECIMALS = {"fanuc": (3, 4), "haas": (3, 4)}
KNOW_G91_1 = ("grbl", "linuxcnc", "mach3")
DOTTED = ("fanuc", "haas")


def texts(name: str, units: Units = Units.MM, path: Path | None = None, **changes: object) -> list[list[str]]:
    """Blocks of each file, without comments."""
    files = write_files((path or two_tools()).program(), job(out_units=units, **changes), post(name))
    return [[line for line in file.nc.text.splitlines() if line[0] != "("] for file in files]


def post(name: str, coolant: Coolant = Coolant.NONE) -> Post:
    found = load_post(name)
    return replace(found, coolant=replace(found.coolant, use=coolant))


def words(block: str) -> dict[str, str]:
    """Axis and value words of a block; G and M words are left to `in`."""
    return dict(re.findall(r"([A-FH-LN-Z])(-?[\d.]+)", block))


def sections(blocks: list[str]) -> list[list[str]]:
    """What is done with each tool: from the change, or from the spindle's start where there is none, to the next."""
    changes, spindle = ([k for k, block in enumerate(blocks) if word in block.split()] for word in ("M6", "M3"))
    starts = changes or spindle
    return [blocks[a:b] for a, b in pairwise([*starts, len(blocks)])]


def place(blocks: list[str], wanted: str) -> int:
    """Index of the first block that holds a word."""
    return next(k for k, block in enumerate(blocks) if wanted in block.split())


@POSTS
@UNITS
def test_each_tool_begins_in_the_order_that_is_safe(name: str, units: Units) -> None:
    """Change, length, spindle, time to spin up, coolant, up to clearance; only then X and Y."""
    flood = post(name, Coolant.FLOOD)
    files = write_files(two_tools().program(), job(out_units=units), flood)
    found = [
        section
        for file in files
        for section in sections([line for line in file.nc.text.splitlines() if line[0] != "("])
    ]
    assert len(found) == 2
    for number, section in enumerate(found, start=1):
        level = next(k for k, block in enumerate(section) if {"X", "Y"} & words(block).keys())
        order = [place(section, word) for word in ("M3", "G4", "M8")]
        assert order == sorted(order) and order[-1] < level
        clearance = [k for k in range(level) if "Z" in words(section[k])]
        assert clearance and all("G0" in section[k].split() for k in clearance)
        assert all(float(words(section[k])["Z"]) * units.value == pytest.approx(5.0, abs=2e-3) for k in clearance)
        assert f"S{12000 if number == 1 else 18000} M3" in section
        if name in CHANGES:
            assert section[0] == f"T{number} M6"
            length = place(section, "G43")
            assert 0 < length < order[0]
            assert words(section[length]).get("H", "") == ("" if name == "linuxcnc" else str(number))


@pytest.mark.parametrize("name", [name for name in CHANGES if name != "linuxcnc"])
def test_length_and_clearance_share_a_block(name: str) -> None:
    """Fanuc may move Z by the offset where G43 stands alone."""
    (blocks,) = texts(name)
    alone = [block for block in blocks if "G43" in block.split()]
    assert len(alone) == 2 and all("Z" in words(block) and "G0" in block.split() for block in alone)


@POSTS
@UNITS
def test_before_a_change_the_tool_is_at_clearance_and_the_spindle_off(name: str, units: Units) -> None:
    """At the end of a program too; and what brings it home moves along Z alone, behind that."""
    for blocks in texts(name, units):
        stops = [k for k, block in enumerate(blocks) if block == "M5"]
        assert len(stops) == len(sections(blocks))
        for k in stops:
            assert "Z" in words(blocks[k - 1]) and not {"X", "Y"} & words(blocks[k - 1]).keys()
            assert blocks[k - 1].startswith("G0 ") and float(words(blocks[k - 1])["Z"]) * units.value == pytest.approx(
                5.0, abs=2e-3
            )
        for before, change in pairwise(sections(blocks)):
            assert (
                not any({"X", "Y", "I"} & words(block).keys() for block in before[place(before, "M5") :])
                and "M6" in change[0]
            )


@POSTS
def test_coolant_is_off_before_the_change(name: str) -> None:
    for file in write_files(two_tools().program(), job(), post(name, Coolant.FLOOD)):
        blocks = [line for line in file.nc.text.splitlines() if line[0] != "("]
        for section in sections(blocks):
            assert place(section, "M8") < place(section, "M9") < place(section, "M5") and section.count("M8") == 1


@POSTS
@UNITS
def test_the_start_is_safe(name: str, units: Units) -> None:
    for blocks in texts(name, units):
        start = blocks[: next(k for k, block in enumerate(blocks) if re.search(r"\bM[36]\b", block))]
        told = set(" ".join(start).split())
        assert {"G17", "G20" if units is Units.INCH else "G21", "G90", "G94", "G40", "G49", "G80", "G54"} <= told
        assert ("G91.1" in told) is (name in KNOW_G91_1)
        assert "G91" not in told or start.index("G90") > place(start, "G91"), "increments end before anything else"


@POSTS
@UNITS
def test_decimals_and_points(name: str, units: Units) -> None:
    """Every axis word has a point; no more digits behind it than the control takes; F has one where whole numbers count
    less.
    """
    most = DECIMALS.get(name, (4, 5))[units is Units.INCH]
    for blocks in texts(name, units, origin_xy=OriginXY.CENTRE):
        for block in blocks:
            for letter, number in words(block).items():
                if letter in "XYZIJKR":
                    assert "." in number and len(number.split(".")[1]) <= most, block
                if letter == "F" and name in DOTTED:
                    assert "." in number, block


@POSTS
@UNITS
def test_arcs_are_what_the_control_takes(name: str, units: Units) -> None:
    """The two radii agree, no arc ends where it starts, none is a point: also after rounding to few digits."""
    path = Path().into_work(1.23456, -6.54321)
    x, y = 1.23456, -6.54321
    for k in range(60):
        radius, angle = 0.003 * 1.22**k, 2.4 * k
        cx, cy = x - radius * math.cos(angle), y - radius * math.sin(angle)
        sweep = (0.02, 1.0, 3.1, 6.2, math.tau)[k % 5]
        end = (
            (x, y)
            if sweep == math.tau
            else (cx + radius * math.cos(angle + sweep), cy + radius * math.sin(angle + sweep))
        )
        path.arc((*end, -1.0), (cx, cy))
        x, y = end
    rules, count = load_post(name).arcs, 0
    for blocks in texts(name, units, path.out_of_work()):
        at = {"X": math.nan, "Y": math.nan}
        for block in blocks:
            found = words(block)
            if "I" in found:
                start, end = complex(at["X"], at["Y"]), complex(float(found["X"]), float(found["Y"]))
                centre = start + complex(float(found["I"]), float(found["J"]))
                first, last = abs(start - centre) * units.value, abs(end - centre) * units.value
                count += 1
                assert start != end and min(first, last) >= rules.smallest_radius_mm - 1e-12
                assert (
                    abs(first - last) <= rules.radius_mismatch_mm + 1e-12
                    and max(first, last) <= rules.largest_radius_mm
                )
            at |= {letter: float(found[letter]) for letter in "XY" if letter in found}
    assert count > 60


@POSTS
def test_blending_is_told_and_never_more_than_stated(name: str) -> None:
    found = load_post(name)
    for units in (Units.MM, Units.INCH):
        task = job(out_units=units)
        for file in write_files(two_tools().program(), task, found):
            word = re.search(r"^(?:G64 P|G187 E)([\d.]+)", file.nc.text, re.M)
            amount = blend_mm(task, found)
            assert amount <= found.blending.tolerance_mm
            assert word is not None or amount == found.blending.tolerance_mm
            assert word is None or float(word[1]) * units.value == pytest.approx(amount, abs=1e-9)
            assert (word is not None) is ("{blend}" in found.blending.blend)
            assert ("may blend" in file.nc.text.lower()) is (amount > 0)
    for blocks in texts(name, exact_path=True):
        assert "G61" in blocks and not any(block.startswith(("G64", "G187")) for block in blocks)


@POSTS
def test_tapes_begin_and_end_as_the_control_wants(name: str) -> None:
    for file in write_files(two_tools().program(), job(part=Part(name="bracket 1234")), load_post(name)):
        lines = file.nc.text.splitlines()
        if name in DOTTED:
            assert (
                lines[0] == lines[-1] == "%"
                and lines[1] == {"fanuc": "O1234", "haas": "O01234"}[name]
                and lines[-2] == "M30"
            )
        else:
            assert "%" not in lines and lines[-1] == ("M2" if name == "linuxcnc" else "M30")
            assert not any(line.startswith("O") for line in lines)


@POSTS
def test_comments_hold_only_what_the_control_takes(name: str) -> None:
    part = Part(name='Gehäuse; (links) 50% "neu" {1} [2] a\'b')
    for file in write_files(two_tools().program(), job(part=part, layer_names=("a;b", "Ä" * 200)), load_post(name)):
        comments = [line for line in file.nc.text.splitlines() if line[0] == "("]
        assert all(re.fullmatch(r"\([A-Za-z0-9 .,:;+\-/=_]*\)", line) for line in comments)
        assert max(map(len, comments)) <= load_post(name).comments.width + 2
        if name in DOTTED:
            assert not any(re.search(r"[a-z;]", line) for line in comments)
        if name == "grbl":
            assert ";" not in file.nc.text


@POSTS
def test_home_is_gone_to_only_behind_clearance_and_spindle_stop(name: str) -> None:
    """Controls with a magazine leave Z at home for the change and for the operator; along Z alone, in machine
    coordinates.
    """
    for file in write_files(two_tools().program(), job(), load_post(name)):
        lines = file.nc.text.splitlines()
        home = [lines[line - 1] for line in file.nc.home_lines]
        assert home == {"fanuc": ["G91 G28 Z0.", "G90"] * 3, "haas": ["G53 G0 Z0."] * 3}.get(name, [])
        before = [lines[line - 2] for line in file.nc.home_lines if lines[line - 1] != "G90"]
        assert before[1:] == ["M5"] * (len(before) - 1)


def test_writing_tolerance_at_three_decimals() -> None:
    assert writing_tolerance(job(), load_post("fanuc")) == pytest.approx(1e-3)
    assert writing_tolerance(job(out_units=Units.INCH), load_post("haas")) == pytest.approx(2.54e-3)
