"""Texts of NC programs for hypothesis: made by a grammar, and real ones with bytes changed."""

from hypothesis import strategies as st

from tests.conftest import ROOT
from tests.gcode.interpreter.rs274_programs import PROGRAMS

SEEDS = [text.encode() for text in PROGRAMS.values()] + [
    b"".join(path.read_bytes().splitlines(keepends=True)[:60])
    for folder in ("tests/data/nc", "tests/gcode/golden", "../shared/data/nc")
    for path in sorted((ROOT / folder).glob("*"))
]

numbers = st.one_of(
    st.integers(-20, 20).map(str),
    st.decimals(-50, 50, places=3).map(str),
    st.sampled_from(
        [
            "0",
            "-0",
            ".5",
            "5.",
            "-.25",
            "+1",
            "0.0001",
            "1e3",
            "99999999",
            "-",
            ".",
            "",
            "1.2.3",
            "9999999999999999",
            "1 2",
            "- 3",
        ]
    ),
)
names = st.sampled_from(["1", "2", "#1", "[1+1]", "<a>", "<_b>", "5400", "5061", "100", "99999", "0", "-1", "1.5"])
OPERATORS = "mod and or xor eq ne lt gt le ge"
operators = st.sampled_from([*"+-*/^", "**", "", *(f" {name} " for name in OPERATORS.split())])
FUNCTIONS = "sin cos tan asin acos sqrt abs ln exp round fix fup exists atan foo"
functions = st.sampled_from(FUNCTIONS.split())


def _composed(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.builds("[{}{}{}]".format, inner, operators, inner),
        st.builds("{}[{}]".format, functions, inner),
        st.builds("atan[{}]/[{}]".format, inner, inner),
        st.builds("#{}".format, inner),
        st.builds("-{}".format, inner),
    )


values = st.recursive(st.one_of(numbers, numbers, names.map("#{}".format)), _composed, max_leaves=6)
CODES = """
    G0 G1 G2 G3 G4 G5 G5.1 G5.2 G5.3 G6.2 G17 G18 G19 G20 G21 G28 G30 G28.1 G30.1 G33 G38.2 G40 G41 G42 G43 G43.1 G49
    G52 G53 G54 G55 G59.3 G54.1 G61 G64 G65 G73 G80 G81 G82 G83 G84 G85 G86 G87 G88 G89 G90 G91 G90.1 G91.1 G92 G92.1
    G92.2 G92.3 G93 G94 G95 G96 G97 G98 G99 M0 M1 M2 M3 M4 M5 M6 M7 M8 M9 M19 M30 M48 M61 M98 M99 M100 g01 G99.9 G M
"""
codes = st.sampled_from(["G10 L2", "G10 L20", "G10 L1", *CODES.split()])
words = st.one_of(
    codes,
    st.builds("{}{}".format, st.sampled_from("XYZIJKRFXYZIJKRFABCDEHLNPQSTUVWxyzf"), numbers),
    st.builds("{}{}".format, st.sampled_from("XYZIJKRPQLF"), values),
    st.builds("#{}={}".format, names, values),
)
comments = st.sampled_from(
    [*[""] * 4, "(text)", "(tool radius 3)", ";end", "(open", "(a(b))", "(MSG,hi)", "(T1 D=6)", *"%/é\x00"]
)
flow = st.builds(
    "o{} {} {}".format,
    st.sampled_from(["1", "2", "3", "<a>", "#1", "[1+1]", ""]),
    st.sampled_from(
        [
            "sub",
            "endsub",
            "call",
            "return",
            "while",
            "endwhile",
            "do",
            "if",
            "elseif",
            "else",
            "endif",
            "repeat",
            "endrepeat",
            "break",
            "continue",
            "",
            "goto",
        ]
    ),
    st.one_of(st.just(""), st.builds("[{}]".format, values)),
)
macros = st.one_of(
    st.builds("GOTO {}".format, numbers),
    st.builds("IF [{}] GOTO {}".format, values, numbers),
    st.builds("IF [{}] THEN #1={}".format, values, values),
    st.builds("WHILE [{}] DO {}".format, values, st.integers(1, 3)),
    st.builds("END {}".format, st.integers(1, 3)),
    st.builds("M98 P{} L{}".format, numbers, numbers),
    st.builds("O{}".format, st.integers(1, 4)),
)
blocks = st.builds(
    "{}{}{}".format, st.sampled_from(["", "", "N10 ", "/", "N5"]), st.lists(words, max_size=5).map(" ".join), comments
)
lines = st.one_of(blocks, blocks, blocks, flow, macros)
grammatical = st.lists(lines, max_size=25).map("\n".join)
"""A program that looks like one."""


@st.composite
def damaged(draw: st.DrawFn) -> bytes:
    """A real program with some of its bytes changed, taken away, doubled, or swapped with those of another."""
    text = bytearray(draw(st.sampled_from(SEEDS)))
    for _ in range(draw(st.integers(1, 8))):
        at = draw(st.integers(0, len(text)))
        until = min(len(text), at + draw(st.integers(0, 12)))
        other = draw(st.sampled_from(SEEDS))
        begin = draw(st.integers(0, len(other)))
        text[at:until] = draw(
            st.one_of(
                st.binary(max_size=4),
                st.just(b""),
                st.just(bytes(text[at:until]) * 2),
                st.just(other[begin : begin + 40]),
                st.sampled_from(
                    [
                        b"[",
                        b"]",
                        b"#",
                        b"\n",
                        b"(",
                        b"-",
                        b"%",
                        b"\r",
                        b"999999999",
                        b"L9999",
                        b"o1 call\n",
                        b"o1 while [1]\n",
                    ]
                ),
            )
        )
    return bytes(text)
