"""The check of blocks that are no moves: what the reader passes over or obeys without a motion is the post's, in its
order.
"""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.checks import blocks as check_blocks
from app.gcode.posts import Coolant, load_post, post_names
from tests.examples import examples
from tests.gcode.programs import Path
from tests.gcode.test_check import Written, problems


def texts(text: str, written: Written) -> str:
    return " | ".join(found for _, found in problems(text, written))


def of(name: str, **blocks: tuple[str, ...]) -> Written:
    """What a post writes whose blocks are changed."""
    post = load_post(name)
    return Written(replace(post, program=replace(post.program, **blocks)))  # type: ignore[arg-type]


@pytest.mark.parametrize("name", post_names())
def test_a_block_that_is_left_out_put_in_or_slashed_is_told_wherever_it_is(name: str) -> None:
    post = load_post(name)
    written = Written(replace(post, coolant=replace(post.coolant, use=Coolant.FLOOD)))
    for number, file in enumerate(written.files):
        lines = file.nc.text.splitlines()
        blocks = [
            k
            for k, line in enumerate(lines)
            if re.match(r"[GMTSO%]", line) and not re.fullmatch(r"G[0-3]( [XYZIJF][-.\d]+)+", line)
        ]
        assert sum("M9" in lines[k] for k in blocks) == sum("M5" in lines[k] for k in blocks) >= 1
        for k in blocks:
            for new in ("", f"({lines[k]})", f"/{lines[k]}", f"{lines[k]} A90"):
                changed = "\n".join([*lines[:k], new, *lines[k + 1 :]]) + "\n"
                assert problems(changed, written, number), (lines[k], new)


@pytest.mark.parametrize(
    "line",
    [
        "G10 L2 P2 X1",
        "G10 L1 P1 Z1",
        "G28.1",
        "G30.1",
        "#5221=1",
        "#1=1",
        "M64 P0",
        "M66 P0 L0",
        "M50 P0",
        "M49",
        "M48",
        "G92.1",
        "G92 X1",
        "G52 X1",
        "M4",
        "M8",
        "M7",
        "N5",
        "T5",
        "A90",
        "G0 A90",
        "G0 B1 C1",
        "G1 U1",
        "/G0 X1",
        "/M0",
        "G61.1",
        "G64",
        "G187 E9",
        "M19",
        "M3",
        "M98 P1",
        "M60",
        "M6",
        "G4 P1",
        "S9",
        "F9",
        "H1",
    ],
)
@pytest.mark.parametrize("name", ["linuxcnc", "haas", "grbl"])
def test_a_block_that_the_post_does_not_say_is_told(line: str, name: str) -> None:
    written = Written(load_post(name))
    (file, *_) = written.files
    assert "\nM5\n" in file.nc.text
    places = ("\nM5\n", "\nG54\n", "\nX30")
    for place in places:
        changed = file.nc.text.replace(place, f"\n{line}{place}", 1)
        if line in ("N5", "F9"):
            continue
        assert problems(changed, written), (line, place)
    instead = file.nc.text.replace("\nM5\n", f"\n{line}\n", 1)
    assert problems(instead, written)


@pytest.mark.parametrize("new", ["G187 E0.1", "G187", "G187 P1", "(G187 E0.010)", "G187 E0.010 P3"])
def test_haas_blending_is_looked_at(new: str) -> None:
    written = Written(load_post("haas"))
    text = written.files[0].nc.text
    assert "G187 E0.010" in texts(text.replace("G187 E0.010", new), written)


def test_a_spindle_that_starts_before_the_change_is_told() -> None:
    written = Written(load_post("linuxcnc"))
    text = written.files[0].nc.text
    assert problems(text.replace("T2 M6\n", "M3\nT2 M6\n"), written)
    assert problems(text.replace("T2 M6", "T2 M6 M3"), written)
    found = of("linuxcnc", tool=("M3", "T{tool} M6", "G43", "S{speed} M3", "G4 P{dwell_s}"))
    assert "the spindle turns while the tool is changed; write M5 before." in texts(found.files[0].nc.text, found)


@pytest.mark.parametrize(
    ("blocks", "words"),
    [
        ({"leave": ()}, "the spindle turns while the tool is changed; write M5 before."),
        ({"leave": ("M9",), "end": ("M30",)}, "the spindle turns at the end of the program; write M5 before."),
        ({"end": ("M8", "M2")}, "the coolant flows at the end of the program; write M9 before."),
        (
            {"end": ("G10 L2 P1 X5", "M2")},
            "G10 sets something that the path does not know or that stays in the machine",
        ),
        ({"end": ("G28.1", "M2")}, "G28.1 sets something"),
        ({"end": ("M64 P0", "M2")}, "M64 sets something"),
        ({"end": ("M50 P0", "M2")}, "M50 sets something"),
        ({"end": ("M49", "M2")}, "M49 sets something"),
        ({"end": ("G92.1", "M2")}, "G92.1 sets something"),
        ({"end": ("#5221=0", "M2")}, "plain blocks of letters and numbers alone"),
        ({"end": ("/M8", "M9", "M2")}, "plain blocks of letters and numbers alone"),
        ({"end": ("G0 A0", "M2")}, "A0 moves an axis that no path is checked for"),
    ],
)
def test_what_a_post_must_not_write_is_told(blocks: dict[str, tuple[str, ...]], words: str) -> None:
    written = of("linuxcnc", **blocks)
    assert words in texts(written.files[0].nc.text, written)


def test_blocks_of_ones_own_are_taken_as_they_are_spelled() -> None:
    written = of(
        "fanuc",
        tool=("T{tool} M06", "G00 G43 Z{clearance} H{tool}", "S{speed} M03", "G04 P{dwell_ms}", "{preselect}"),
        start=("(SHOP RULES)", "G17 {units} G90 G94 G40 G49 G80 G69 G15", "G54", "G64"),
        end=("M01", "M30", "%"),
    )
    (file,) = written.files
    assert written.check(file).problems == ()
    assert written.check(file, file.nc.text.replace("M06", "M6").replace("(SHOP RULES)", "(OTHERS)")).problems == ()
    assert problems(file.nc.text.replace("P2000", "P2000."), written)


def test_a_work_offset_beyond_the_ninth_is_taken() -> None:
    written = of("haas", start=("G17 {units} G90 G94 G40 G49 G80", "G54.1 P3", "{blending}"))
    (file,) = written.files
    assert written.check(file).problems == ()
    assert "the work offset is G54.1 P4" in texts(file.nc.text.replace("G54.1 P3", "G54.1 P4"), written)


def test_line_numbers_are_no_blocks() -> None:
    post = load_post("haas")
    written = Written(replace(post, numbers=replace(post.numbers, use=True)))
    (file,) = written.files
    assert "\nN10 G17" in file.nc.text
    assert written.check(file).problems == ()
    assert problems(re.sub(r"(N\d+) M5\n", r"\1\n", file.nc.text, count=1), written)


@pytest.mark.parametrize("letter", ["X", "Y"])
def test_a_tool_says_where_it_goes_first_even_where_the_one_before_was(letter: str) -> None:
    path = Path().into_work(10.0, 12.0).line(14.0, 12.0, -1.0).line(10.0, 12.0, -1.0).out_of_work()
    path.tool, path.operation = 2, 1
    path.into_work(10.0, 12.0).line(14.0, 12.0, -1.0).out_of_work()
    written = Written(load_post("linuxcnc"), path.program())
    (file,) = written.files
    before, last = file.nc.text.rsplit("X10.0000 Y12.0000", 1)
    assert written.check(file).problems == ()
    word = {"X": "Y12.0000", "Y": "X10.0000"}[letter]
    assert f"does not say {letter}" in texts(f"{before}{word}{last}", written)


def test_a_tool_that_is_changed_in_the_work_is_told() -> None:
    path = Path().into_work(10.0, 12.0).line(14.0, 12.0, -1.0)
    path.tool, path.operation = 2, 1
    path.into_work(10.0, 12.0).line(14.0, 12.0, -1.0).out_of_work()
    written = Written(load_post("linuxcnc"), path.program())
    (file,) = written.files
    assert written.check(file).problems == ()
    assert "is not lifted to clearance" in texts(file.nc.text.replace("G0 Z5.0000\nM5\n", "\nM5\n", 1), written)


pieces = st.sampled_from(
    [
        "G",
        "g",
        "X",
        "y",
        "N10",
        "0",
        "00",
        "1",
        "81",
        "98",
        "2.",
        ".5",
        "-",
        "+",
        ".",
        " ",
        "\t",
        "\r",
        "M5",
        "(",
        "é",
        "\n",
    ]
)


@settings(max_examples=examples(300), deadline=None)
@given(text=st.lists(pieces, max_size=30).map("".join), name=st.sampled_from(post_names()))
def test_lines_that_are_passed_over_at_once_only_move(text: str, name: str) -> None:
    """By the pattern that looks at one line after the other; of spaces beyond ASCII the other way round is not
    promised.
    """
    post = load_post(name)
    plain = check_blocks._moves_alone(post)
    slow = [number for number, line in enumerate(text.split("\n"), start=1) if plain.fullmatch(line) is None]
    assert check_blocks._lines_with_more(text, post).tolist() == slow


def test_a_post_without_g_words_of_motion_has_lines_that_only_move() -> None:
    post = load_post("grbl")
    bare = replace(post, words=replace(post.words, motion=("", "", "", "")))
    assert check_blocks._lines_with_more("X1 Y2\nG1 X1\n", bare).tolist() == [2]


@pytest.mark.parametrize(
    ("line", "moves"),
    [
        ("", True),
        ("N10 G1 X1.5 Y-.5 Z+2. F100", True),
        ("g00x1i0j2r3q4", True),
        ("G0", True),
        ("G83 X1", True),
        ("G098", True),
        ("X1.2.3", False),
        ("X", False),
        ("X-", False),
        ("X.", False),
        ("X 1", False),
        ("X--1", False),
        ("G1.", False),
        ("G10", False),
        ("G", False),
        ("G 1", False),
        ("G01.5", False),
        ("G8", False),
        ("M5", False),
        ("X1 (far)", False),
        ("A1", False),
        ("1", False),
    ],
)
def test_which_lines_only_move(line: str, moves: bool) -> None:
    """The one line among others that move, and it alone."""
    post = load_post("linuxcnc")
    assert check_blocks._lines_with_more(f"X1\n{line}\nX2", post).tolist() == ([] if moves else [2])
    assert (check_blocks._moves_alone(post).fullmatch(line) is not None) == moves
