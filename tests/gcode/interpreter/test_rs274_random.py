"""Random programs that keep to the language: every motion is that of LinuxCNC's own interpreter."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.examples import examples
from tests.gcode.interpreter.rs274_motions import OPTIONS, assert_same, read_program, rs274

lengths = st.decimals(-40, 40, places=2).map(str)
planes = {"G17": ("X", "Y", "I", "J"), "G18": ("Z", "X", "K", "I"), "G19": ("Y", "Z", "J", "K")}
LOOP = "#1=0\no{0} while [#1 lt {1}]\nG1 X[#1*1.5] Y[sin[#1*10]]\n#1=[#1+1]\no{0} endwhile"


@st.composite
def axes(draw: st.DrawFn, least: int = 1) -> str:
    letters = draw(st.permutations("XYZ"))[: draw(st.integers(least, 3))]
    return " ".join(letter + draw(lengths) for letter in letters)


@st.composite
def arcs(draw: st.DrawFn) -> str:
    """Half a circle and a full one, from wherever the tool is, in words that cannot contradict one another; back to
    G90.
    """
    plane = draw(st.sampled_from(sorted(planes)))
    first, second, i, j = planes[plane]
    radius, turns = draw(st.decimals(1, 30, places=2)), draw(st.sampled_from(["", "", " P2"]))
    word = draw(st.sampled_from(["G2", "G3"]))
    ends = f"{first}{2 * radius} {i}{radius}", f"{second}{-2 * radius} R{radius}", f"{second}{2 * radius} {j}{radius}"
    half = draw(st.sampled_from(ends))
    return f"{plane} G91 {word} {half}{turns}\n{word} {i}{radius} {j}{radius / 2}\nG90 G17"


@st.composite
def holes(draw: st.DrawFn) -> str:
    """A cycle at two places, above what is drilled."""
    cycle = draw(st.sampled_from(["G81", "G82 P0.1", "G83 Q2.5", "G73 Q2.5", "G85", "G89 P0.1"]))
    level = draw(st.sampled_from(["G98 ", "G99 ", ""]))
    repeats = draw(st.sampled_from(["", " L2"]))
    return f"G0 Z50\n{level}{cycle} {draw(axes(3))} R45{repeats}\nX{draw(lengths)}\nG80"


offsets = st.one_of(
    st.builds("G10 L2 P{} {}".format, st.integers(1, 9), axes()),
    st.builds("G10 L20 P{} {}".format, st.integers(1, 9), axes()),
    st.builds(
        "{}".format,
        st.sampled_from(["G54", "G55", "G56", "G59.1", "G59.3", "G92.1", "G92.2", "G92.3", "G49", "G28", "G30"]),
    ),
    st.builds("G92 {}".format, axes()),
    st.builds("G52 {}".format, axes()),
    st.builds("G28 {}".format, axes()),
    st.sampled_from(["G43 H1", "G43 H2", "G0 Z7\nT3 M6", "G43.1 Z5", "G28.1", "G30.1"]),
)
"""Before a tool change Z moves: the interpreter without a machine asks itself where it is then, and forgets a new
length offset.
"""

moves = st.one_of(
    st.builds("G0 {}".format, axes()),
    st.builds("G1 {}".format, axes()),
    axes().map("G1 {}".format),
    st.builds("G91 G1 {}\nG90".format, axes()),
    st.builds("G53 G0 {}".format, axes()),
)
flow = st.one_of(
    st.builds("#1={}\n#2=[#1*2-1]\nG1 X#1 Y[#2/3] Z[abs[#1]]".format, lengths),
    st.builds(LOOP.format, st.uuids().map(lambda unique: unique.int % 10**6), st.integers(0, 4)),
)
others = st.sampled_from(
    [
        "G20",
        "G21",
        "G61",
        "G64 P0.01",
        "G4 P0.1",
        "S100 M3",
        "M5",
        "F50",
        "G94 F60",
        "(text)",
        "",
        "G0",
        "/G0 X1",
        "N5 G1 Y1",
    ]
)
turned = st.sampled_from(
    [
        "G10 L2 P1 R30",
        "G10 L2 P2 R-15",
        "G54",
        "G55",
        "G10 L2 P1 R0",
        "G10 L2 P1 X5",
        "G53 G0 X1",
        "G2 X20 R30",
        "G3 I4 J-2",
    ]
)
programs = st.lists(st.one_of(moves, moves, arcs(), holes(), offsets, flow, others), min_size=1, max_size=12).map(
    lambda lines: "\n".join(["G21 F100 G0 X1 Y2 Z3", *lines, "M2\n"])
)


def assert_as_linuxcnc(text: str) -> None:
    """Whatever it does, up to where it refuses, we do; and what it refuses, we may refuse or not."""
    printed, complaint = rs274(text.encode())
    program = read_program(text.encode(), OPTIONS)
    if not complaint:
        assert program.error is None, program.error
        assert_same(program, printed)


turning = st.lists(st.one_of(moves, turned, flow, others), min_size=1, max_size=12).map(
    lambda lines: "\n".join(["G21 F100 G0 X1 Y2 Z3", *lines, "M2\n"])
)
"""Work offsets that are turned: without G92, whose part in a turn LinuxCNC forgets, and without upright arcs."""


@settings(max_examples=examples(40), deadline=None, suppress_health_check=list(HealthCheck))
@given(st.one_of(programs, turning))
def test_random_programs(text: str) -> None:
    assert_as_linuxcnc(text)


@pytest.mark.exhaustive
@settings(max_examples=examples(3000), deadline=None, suppress_health_check=list(HealthCheck))
@given(st.one_of(programs, turning))
def test_many_random_programs(text: str) -> None:
    assert_as_linuxcnc(text)
