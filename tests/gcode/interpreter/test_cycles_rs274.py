"""Canned cycles do what LinuxCNC's interpreter prints, motion for motion, and are refused where it refuses them."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.gcode.interpreter.cycles import CYCLE_WORDS
from tests.examples import examples
from tests.gcode.interpreter.cycles_driver import Block, assert_same, assert_same_text, interpreted, program, read

PLANES = ("G17", "G18", "G19")
NORMAL = {"G17": "Z", "G18": "Y", "G19": "X"}


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    return st.integers(round(low * 20), round(high * 20)).map(lambda k: k / 20)


@st.composite
def drawn_blocks(draw: st.DrawFn, spindle: int) -> list[Block]:
    """Blocks of cycles in all planes and modes; most are right, some lack a word or have a wrong one."""
    taps = {1: "G74", -1: "G84"}
    codes, plane, blocks, code = [c for c in CYCLE_WORDS if c != taps[spindle]], "G17", [], ""
    for k in range(draw(st.integers(1, 5))):
        new_code = draw(st.sampled_from(codes)) if not k or draw(st.integers(0, 2)) == 0 else ""
        plane = draw(st.sampled_from(PLANES)) if draw(st.integers(0, 3)) == 0 else plane
        full = bool(new_code and new_code != code) or draw(st.booleans())
        code = new_code or code
        modes = (plane, draw(st.sampled_from(["G90", "G91"])), draw(st.sampled_from(["G98", "G99"])))
        blocks.append(Block(new_code, modes, draw(drawn_words(code, plane, full))))
    return blocks


@st.composite
def drawn_words(draw: st.DrawFn, code: str, plane: str, full: bool) -> dict[str, float]:
    """Words of one block; all of them where it is full, but for one in a while."""
    ranges = {
        "R": (-1, 4),
        "Q": (0.05, 3),
        "P": (0, 1),
        "I": (-1, 1),
        "J": (-1, 1),
        "K": (-3, 1),
        NORMAL[plane]: (-4, 0),
    }
    letters = [NORMAL[plane], *(letter for letter in CYCLE_WORDS[code] if letter != "L")]
    kept = letters if full and draw(st.integers(0, 15)) else [letter for letter in letters if draw(st.booleans())]
    words = {letter: draw(numbers(*ranges[letter])) for letter in kept}
    hole = [letter for letter in "XYZ" if letter != NORMAL[plane]]
    words |= {letter: draw(numbers(-9, 9)) for letter in hole if draw(st.booleans())}
    if not any(letter in words for letter in "XYZ"):
        words[hole[0]] = draw(numbers(-9, 9))
    if "L" in CYCLE_WORDS[code] and draw(st.integers(0, 3)) == 0:
        words["L"] = draw(st.integers(0, 4))
    return words


@settings(max_examples=examples(150), deadline=None)
@given(st.data(), st.sampled_from([1, -1]), st.sampled_from(["G20", "G21"]))
def test_any_cycles(data: st.DataObject, spindle: int, units: str) -> None:
    assert_same(data.draw(drawn_blocks(spindle)), spindle, units)


@pytest.mark.parametrize("units", ["G20", "G21"])
@pytest.mark.parametrize("code", ["G73", "G83"])
@pytest.mark.parametrize(
    ("r", "depth", "peck"), [(1, -3, 1), (1, -3, 0.1), (0.01, -0.2, 0.2), (0, -1, 0.3), (2, -0.5, 4), (1, 1, 1)]
)
def test_pecks(code: str, units: str, r: float, depth: float, peck: float) -> None:
    run = assert_same([Block(code, (), {"X": 4, "Z": depth, "R": r, "Q": peck})], units=units)
    assert run.refused is None
    assert len(run.motions) >= 3 + (2 if r != depth else 0) * (peck < r - depth)


def test_the_lift_of_a_peck_is_a_hundredth_of_an_inch_in_both_units() -> None:
    for code, up in (("G73", 0.254), ("G83", 0.254)):
        for units, unit in (("G21", 1.0), ("G20", 25.4)):
            run = assert_same([Block(code, (), {"X": 4, "Z": -3, "R": 0, "Q": 2})], units=units)
            heights = [end[2] * unit for _, _, end in run.motions]
            assert heights[-3] == pytest.approx(-2 * unit + up, abs=1e-3)


@pytest.mark.parametrize("code", CYCLE_WORDS)
@pytest.mark.parametrize("letter", "LPQIJK")
def test_the_table_of_words_is_linuxcnc_s(code: str, letter: str) -> None:
    good = {"R": 1.0, "P": 0.5, "Q": 1.0, "I": 0.1, "J": 0.1, "K": -1.0}
    words = {name: good[name] for name in CYCLE_WORDS[code] if name != "L"} | {letter: good.get(letter, 2.0)}
    block = Block(code, (), {"X": 1.0, "Z": -2.0, **words})
    run = interpreted(program([block], -1 if code == "G74" else 1))
    assert (run.refused is None) == (letter in CYCLE_WORDS[code])


FULL = {"X": 1.0, "Z": -3.0, "R": 1.0, "Q": 1.0, "P": 0.5, "I": 0.2, "J": 0.1, "K": -2.0}


def full(code: str, **changed: float) -> dict[str, float]:
    return {k: v for k, v in FULL.items() if k in "XZR" or k in CYCLE_WORDS[code]} | changed


@pytest.mark.parametrize("code", CYCLE_WORDS)
@pytest.mark.parametrize("spindle", [-1, 0, 1])
def test_what_the_spindle_must_do(code: str, spindle: int) -> None:
    assert_same([Block(code, (), full(code))], spindle)


@pytest.mark.parametrize("code", CYCLE_WORDS)
@pytest.mark.parametrize("missing", FULL)
def test_missing_words_are_refused(code: str, missing: str) -> None:
    words = {k: v for k, v in full(code).items() if k != missing}
    run = assert_same([Block(code, (), words)], -1 if code == "G74" else 1)
    assert (run.refused == 1) == (
        missing in full(code) and missing != "X" and (missing, code[1:]) not in {("P", "84"), ("P", "74")}
    )


@pytest.mark.parametrize(
    ("code", "wrong"),
    [
        ("G81", {"R": -4.0}),
        ("G81", {"L": 0.0}),
        ("G83", {"Q": 0.0}),
        ("G73", {"Q": 0.0}),
        ("G82", {"P": -1.0}),
        ("G83", {"Q": -1.0}),
    ],
)
def test_wrong_words_are_refused(code: str, wrong: dict[str, float]) -> None:
    assert assert_same([Block("G81", (), full("G81")), Block(code, (), full(code, **wrong))]).refused == 2


def test_the_run_of_another_plane_keeps_the_initial_height() -> None:
    blocks = [Block("G81", (), full("G81")), Block("G82", ("G18", "G91"), {"X": 1.0, "Y": -3.0, "R": 1.0, "P": 0.0})]
    run = assert_same(blocks)
    assert run.motions[-2][2][1] == 3.0 + 1.0 - 3.0


@pytest.mark.parametrize(
    "lines",
    [
        ["G81 X1 Z-3 R1", "G0 Z9", "G81 X2 Z-3 R1", "X3"],
        ["G81 X1 Z-3 R1", "G0 Z9", "G81 X2"],
        ["G81 X1 Z-3 R1", "G80", "X3"],
        ["G81 X1 Z-3 R1", "G4 P1", "F200", "X2", "M5", "X3"],
        ["G81"],
        ["G80 X1"],
        ["G81 X1 Z-3 R1", "G1 X4", "G98 X5"],
        ["G93 G81 X1 Z-3 R1 F2"],
        ["F0 G81 X1 Z-3 R1"],
        ["G53 G81 X1 Z-3 R1"],
        ["G81 X1 Z-3 R1", "G80", "G81 X2 Z-3 R1"],
        ["G84 G18 X1 Y-3 R1", "G91 X1 Z1 L3", "G0 X1 Z1"],
        ["G88 X1 Z-3 R1 P0", "G91 G1 X1", "G0 Z1"],
    ],
)
def test_cycles_among_other_words(lines: list[str]) -> None:
    assert_same_text(
        "\n".join(
            [program([]).rsplit("M2", 1)[0].strip(), *(f"N{k} {line}" for k, line in enumerate(lines, 1)), "M2\n"]
        )
    )


@pytest.mark.parametrize(("units", "other"), [("G21", "G20"), ("G20", "G21")])
def test_numbers_that_stay_are_those_written_over_a_change_of_units(units: str, other: str) -> None:
    lines = [
        f"{units} G17 G90 G98 F100 M3 S100",
        "N0 G0 X1 Y2 Z3",
        "N1 G83 X1 Z-.3 R1 Q.4",
        f"N2 {other} X2",
        f"N3 {units} X3",
        "M2",
        "",
    ]
    factor = 25.4 if other == "G20" else 1 / 25.4
    theirs, mine = interpreted("\n".join(lines)), read("\n".join(lines))
    meant = [[value * (factor if n == 2 else 1.0) for value in end] for n, _, end in theirs.motions]
    assert [end for _, _, end in mine.motions] == [pytest.approx(end, abs=2e-3) for end in meant]
