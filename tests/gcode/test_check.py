"""The check of what was written: what is right passes, and every change of a text that changes its motion is caught."""

from __future__ import annotations

import math
import re
import time
from dataclasses import replace
from itertools import zip_longest

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import HitofudeError
from app.gcode.checks.check import Check, CheckReference, check
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import NcProgram
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import Coolant, Post, load_post, post_names
from app.gcode.writer.write import NcFile, write_files, writing_tolerance
from app.model.job import OriginXY, OriginZ
from app.model.motion_path import arc_paths
from app.model.moves import Program
from app.model.part import Units
from tests.examples import examples
from tests.gcode.programs import Path, job, two_tools
from tests.gcode.test_drilling import Holes

POSTS = pytest.mark.parametrize("name", post_names())


class Written:
    """A program as files, and what it was written from."""

    def __init__(self, post: Post, program: Program | None = None, **changes: object) -> None:
        self.program, self.job, self.post = program or two_tools().program(), job(**changes), post
        self.meant = CheckReference(self.program, self.job, post)
        self.files = write_files(self.program, self.job, post)

    def check(self, file: NcFile, text: str | None = None) -> Check:
        return check((file.nc.text if text is None else text).encode("latin-1"), file, self.meant)


LINUXCNC = Written(load_post("linuxcnc"))


def problems(text: str, written: Written = LINUXCNC, file: int = 0) -> list[tuple[int, str]]:
    return [(problem.line, problem.text) for problem in written.check(written.files[file], text).problems]


@POSTS
@pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])
@pytest.mark.parametrize("exact", [False, True], ids=["blend", "exact"])
def test_what_every_post_writes_is_what_was_meant(name: str, units: Units, exact: bool) -> None:
    post = load_post(name)
    if exact and not post.blending.exact:
        pytest.skip("this post refuses an exact path")
    written = Written(post, out_units=units, exact_path=exact, origin_xy=OriginXY.CENTRE, origin_z=OriginZ.BOTTOM)
    covered = []
    for file in written.files:
        found = written.check(file)
        assert found.problems == ()
        assert 0 <= found.largest_distance_mm <= found.tolerance_mm == writing_tolerance(written.job, post)
        covered += sorted(set(found.move.tolist()))
    assert covered == list(range(len(written.program.moves)))


@POSTS
def test_canned_cycles_are_the_moves_that_they_stand_for(name: str) -> None:
    path = Holes().rapid(0, 0, 5)
    for x in (0, 10, 20):
        path.drilled(x, 5, -3.0)  # type: ignore[attr-defined]
    path.pecked(5, 9, -4.0, 1.5).chipped(9, 9, -4.0, 1.5).line(9, 9, 5)
    written = Written(load_post(name), path.program())
    (file,) = written.files
    found = written.check(file)
    assert found.problems == ()
    assert set(found.move.tolist()) >= set(range(1, len(written.program.moves) - 1))
    if "G81" in file.nc.text:
        (line,) = [k for k, text in enumerate(file.nc.text.splitlines(), 1) if "X10." in text]
        deeper = file.nc.text.replace("Z-3.", "Z-3.5")
        assert problems(deeper, written)
        assert problems("\n".join(text for k, text in enumerate(file.nc.text.splitlines(), 1) if k != line), written)


@pytest.mark.parametrize("coolant", list(Coolant))
def test_coolant_is_looked_at(coolant: Coolant) -> None:
    post = load_post("linuxcnc")
    written = Written(replace(post, coolant=replace(post.coolant, use=coolant)))
    (file,) = written.files
    assert written.check(file).problems == ()
    if coolant is not Coolant.NONE:
        word = post.coolant.flood if coolant is Coolant.FLOOD else post.coolant.mist
        assert "coolant" in problems(file.nc.text.replace(word, "M9"), written)[0][1]


TEXT = LINUXCNC.files[0].nc.text


def line_of(text: str) -> int:
    return next(k for k, line in enumerate(TEXT.splitlines(), 1) if text in line)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("X30.0000 F600", "X30.0010 F600", "the written path is 0.0010 mm from the move to X30.0000 Y10.0000"),
        ("X30.0000", "X-30.0000", "from the move to X30.0000"),
        ("X30.0000", "X3.0000", "from the move to X30.0000"),
        ("Z-1.0000", "Z1.0000", "the written path is 2.0000 mm"),
        ("G3 X35.0000", "G2 X35.0000", "this is G2 where G3 was meant"),
        ("F450", "F4500", "the feed is 4500 mm/min where 450 was meant"),
        ("S18000 M3", "S18000", "the spindle does not turn clockwise"),
        ("S18000 M3", "S18000 M4", "the spindle does not turn clockwise"),
        ("S18000", "S1800", "the spindle speed is S1800 where S18000 was meant"),
        ("T2 M6", "T1 M6", "T1 is in the spindle where T2 was meant"),
        ("T2 M6", "T3 M6", "tool 3 is not in the tool table"),
        ("T2 M6\n", "", "T1 is in the spindle where T2 was meant"),
        ("G43\n", "", "the tool length is H0 where H1 was meant"),
        ("G54\n", "G55\n", "the work offset is G55"),
        ("G91.1\n", "G90.1\n", "the arc does not end on its circle"),
        ("G17 G21", "G17 G20", "from the move to"),
        ("G90 G94", "G91 G94", "the arc does not end on its circle"),
        ("G90 G94", "G90 G93", "needs a feed rate"),
        ("G64 P0.0100 Q0", "G64 P0.1 Q0", "the control may leave the path by 0.1 mm"),
        ("G64 P0.0100 Q0", "G64 P0.0100 Q0.2", "the control may leave the path by 0.2 mm"),
        ("G64 P0.0100 Q0", "G64", "the control may leave the path by inf mm"),
        ("G4 P2\n", "", "the spindle has 0 s to reach its speed, not 2"),
        ("M2\n", "", "the program has no end"),
        ("M2\n", "M2\nG0 X0\n", ""),
        ("M5\nM2", "M5\nG0 Z-3\nM2", "belongs to no move of the path and is no lift"),
        ("M5\nM2", "M5\nM1\nM2", "there is a optional stop here"),
        ("G54\n", "G54\nG10 L2 P1 X1\n", "the work offset is G54, shifted by (1.0, 0.0, 0.0)"),
        ("G54\n", "G54\nG52 Y-2\n", "the work offset is G54, shifted by (0.0, -2.0, 0.0)"),
        ("G54\n", "G54\nG41 D1\n", "G41 needs the diameter"),
        ("G54\n", "G54\n?\n", ""),
    ],
)
def test_a_change_is_told_with_its_line(old: str, new: str, words: str) -> None:
    assert old in TEXT
    found = problems(TEXT.replace(old, new, 1))
    if new == "M2\nG0 X0\n":
        assert found == []  # no control reads behind the end
        return
    assert found
    assert any(words in text for _, text in found), found


def test_the_first_difference_is_refused_with_its_line() -> None:
    (file,) = LINUXCNC.files
    changed = LINUXCNC.check(file, TEXT.replace("X30.0000", "X30.1000", 1))
    with pytest.raises(
        HitofudeError, match=rf"^part\.ngc:{line_of('X30.0000')}: the written path is 0\.1000 mm .* it is not kept"
    ):
        changed.require("part.ngc")
    LINUXCNC.check(file).require("part.ngc")


def test_a_missing_point_on_a_fanuc_is_a_thousandth() -> None:
    written = Written(load_post("fanuc"))
    (file,) = written.files
    assert "X30." in file.nc.text
    found = problems(re.sub(r"X30\.(?!\d)", "X30", file.nc.text, count=1), written)
    assert any("the written path is 29.9700 mm" in text for _, text in found)


def test_home_goes_up_and_nowhere_else() -> None:
    for name, old, new in (
        ("fanuc", "G91 G28 Z0.", "G91 G28 Z-9."),
        ("fanuc", "G91 G28 Z0.\nG90\n(T2", "G91 G28 X0. Z0.\nG90\n(T2"),
        ("haas", "G53 G0 Z0.", "G53 G0 Z-1."),
    ):
        written = Written(load_post(name))
        (file,) = written.files
        assert old in file.nc.text
        assert any("no lift" in text for _, text in problems(file.nc.text.replace(old, new, 1), written)), new


def test_a_tool_that_does_not_go_to_clearance_is_told() -> None:
    lines = TEXT.splitlines()
    second = line_of("T2 M6") - 1
    lift = lines.index("G0 Z5.0000", second)
    found = problems("\n".join([*lines[:lift], "", f"G0 {lines[lift + 1]}", *lines[lift + 2 :]]) + "\n")
    assert any("T2 does not go to clearance height" in text for _, text in found)


def test_a_tool_whose_length_is_taken_and_not_gone_to_is_told() -> None:
    written = Written(load_post("fanuc"))
    (file,) = written.files
    assert "G43 H2 Z5." in file.nc.text
    assert any(
        "does not go to clearance" in text
        for _, text in problems(file.nc.text.replace("G43 H2 Z5.", "G43 H2"), written)
    )
    second = TEXT.index("T2 M6")
    bare = TEXT[:second] + TEXT[second:].replace("G0 Z5.0000", "G0", 1)  # stays where the other tool was lifted to
    assert any("does not go to clearance" in text for _, text in problems(bare))
    swapped = file.nc.text.replace("H1", "H9").replace("H2", "H1").replace("H9", "H2")
    assert any("the tool length is H2 where H1 was meant" in text for _, text in problems(swapped, written))


def points(read: NcProgram) -> list[tuple[object, ...]]:
    """Everything that a program does on the machine, to 1e-9 mm, for two texts to be compared."""
    motions = read.motions
    moving = ~(np.all(motions.start == motions.end, axis=1) & (motions.kind < 2))
    paths = arc_paths(motions)
    arcs = dict(zip(paths.rows.tolist(), paths.points(np.array([0.3]))[:, 0].round(9).tolist(), strict=True))
    told = []
    for row in np.flatnonzero(moving).tolist():
        state = read.states[motions.state[row]]
        told.append(
            (
                motions.end[row].round(9).tolist(),
                int(motions.kind[row]),
                arcs.get(row),
                float(motions.feed[row]),
                state.tool,
                state.length_offset,
                state.spindle,
                state.speed,
                state.flood,
                state.mist,
            )
        )
    return told


def same_motion(text: str, changed: str, post: Post) -> bool:
    """Whether a changed text does what the text does; one that is refused does not."""
    first, second = (
        read_program(each.encode("latin-1"), ReadOptions(dialect=post.dialect)) for each in (text, changed)
    )
    return not second.problems and points(first) == points(second)


def nearly_same_motion(text: str, changed: str, written: Written) -> bool:
    """Whether a changed text differs by less than the rounding that the check allows, and in nothing else."""
    options = ReadOptions(dialect=written.post.dialect)
    first, second = (read_program(each.encode("latin-1"), options) for each in (text, changed))
    if (
        second.problems
        or len(first.motions) != len(second.motions)
        or not np.array_equal(first.motions.kind, second.motions.kind)
    ):
        return False
    gap = max(
        float(np.max(np.abs(getattr(first.motions, end) - getattr(second.motions, end)))) for end in ("start", "end")
    )
    middle = [arc_paths(read.motions).points(np.linspace(0, 1, 9)) for read in (first, second)]
    step = 2.1 * writing_tolerance(written.job, written.post)
    inside = float(np.max(np.abs(middle[0] - middle[1]), initial=0.0))
    feed = float(np.nanmax(np.abs(first.motions.feed - second.motions.feed)))
    return max(gap, inside) <= step and feed <= 0.1 * written.job.out_units.value


ALPHABET = "0123456789.-XYZGMFSTIJNAHP/#( \n"
CASES = {
    name: Written(load_post(name), **({"out_units": Units.INCH} if name == "haas" else {})) for name in post_names()
}  # type: ignore[arg-type]


@st.composite
def mutations(draw: st.DrawFn) -> tuple[str, int, str]:
    """A post, the number of a file, and its text with one change."""
    name = draw(st.sampled_from(sorted(CASES)))
    number = draw(st.integers(0, len(CASES[name].files) - 1))
    lines = CASES[name].files[number].nc.text.splitlines(keepends=True)
    code = [k for k, line in enumerate(lines) if not line.startswith("(")]
    at = draw(st.sampled_from(code))
    line = lines[at]
    place = draw(st.integers(0, len(line) - 1))
    kind = draw(
        st.sampled_from(["digit", "digit", "digit", "replace", "insert", "delete", "drop", "double", "swap", "sign"])
    )
    if kind == "drop":
        lines[at] = ""
    elif kind == "double":
        lines[at] = line * 2
    elif kind == "swap":
        other = draw(st.sampled_from(code))
        lines[at], lines[other] = lines[other], line
    elif kind == "sign":
        numbers = [match.start() for match in re.finditer(r"(?<=[A-Z])-?\d", line)]
        place = draw(st.sampled_from(numbers)) if numbers else 0
        lines[at] = line[:place] + line[place + 1 :] if line[place] == "-" else line[:place] + "-" + line[place:]
    elif kind == "digit":
        digits = [match.start() for match in re.finditer(r"\d", line)]
        place = draw(st.sampled_from(digits)) if digits else place
        lines[at] = line[:place] + draw(st.sampled_from("0123456789")) + line[place + 1 :]
    else:
        new = "" if kind == "delete" else draw(st.sampled_from(ALPHABET))
        lines[at] = line[:place] + new + line[place + (kind != "insert") :]
    return name, number, "".join(lines)


@settings(max_examples=examples(600), deadline=None)
@given(mutations())
def test_every_single_change_is_caught_or_changes_nothing(mutation: tuple[str, int, str]) -> None:
    name, number, changed = mutation
    written = CASES[name]
    file = written.files[number]
    if written.check(file, changed).problems:
        return
    harmless = same_motion(file.nc.text, changed, written.post) or nearly_same_motion(file.nc.text, changed, written)
    assert harmless, [(a, b) for a, b in zip_longest(file.nc.text.splitlines(), changed.splitlines()) if a != b][:3]


@pytest.mark.exhaustive
def test_checking_fifty_thousand_moves_takes_well_under_a_second() -> None:
    path = Path().into_work(20.0, 0.0)
    for turn in np.linspace(0, 2 * math.pi * 500, 50_001)[1:].tolist():
        before = path.rows[-1][0]
        end = (20 * math.cos(turn), 20 * math.sin(turn), -1.0)
        if len(path.rows) % 2:
            path.line(*end)
        else:
            path.arc(end, ((before[0] + end[0]) / 2, (before[1] + end[1]) / 2))  # type: ignore[index]
    path.out_of_work()
    written = Written(load_post("linuxcnc"), path.program())
    (file,) = written.files
    written.check(file)
    took = []
    for _ in range(3):
        start = time.process_time()
        found = written.check(file)
        took.append(time.process_time() - start)
    assert found.problems == ()
    assert len(found.program.motions) >= 50_000
    assert min(took) < 1.0


HOPELESS = (
    "",
    "%\n",
    "M2\n",
    "G0 X1 Y1 Z5\nM2\n",
    "\x00\xff",
    "(" * 500,
    "G81 X1\n" * 50,
    "o1 call\n",
    TEXT[: len(TEXT) // 2],
    TEXT[9:] + TEXT,
)


@pytest.mark.parametrize("text", HOPELESS, ids=range(len(HOPELESS)))
@POSTS
def test_any_text_gets_an_answer(text: str, name: str) -> None:
    for file in CASES[name].files:
        found = CASES[name].check(file, text)
        assert found.problems
        assert found.largest_distance_mm > 0
