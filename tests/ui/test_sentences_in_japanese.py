"""Whatever the program can say to the window, it can say in Japanese: read out of the source, and from declarations."""

from __future__ import annotations

import re

import pytest

from app.core.catalogue import Catalogue, catalogue
from app.core.errors import HitofudeError
from app.core.resources import resource
from app.core.toml_tables import EXPECTED
from app.drafting.expressions.values import kind_of
from app.formats.readers import read_drawing
from app.formats.scene.toml import read_scene
from app.model.fields import Unit, declared_of
from app.model.finding import FindingKind
from app.model.operation_kinds import OPERATION_KINDS, parameters
from app.model.tool import Tool
from app.ui.panels.parameter_fields import sentence, spec_of
from app.usecases.examine import ExamineOptions, examine
from app.usecases.manual.parameter_table import parameter_table
from tests.ui.errors import errors_of, errors_of_the_program
from tests.ui.sentences import HOLE, Sentence, said_in, sentences, written_in

JAPANESE = catalogue("ja")
FILLERS = ("7", "Xyz")
ENGLISH = re.compile(r"[a-z]{3,} [a-z]{2,}|^[A-Z][a-z]{3,}$")
NUMBERS = (Unit.LENGTH, Unit.ANGLE, Unit.SHARE, Unit.COUNT, Unit.TIME)
KEPT = re.compile(r"--[\w-]+( \w+)?|\((Page|Ctrl|Shift)[^)]*\)|`[^`]+`")
"""Options, keys and lines to type, which stand in Japanese sentences as they are."""
WORDS = re.compile("[A-Za-z]{2,}")
OF_BOTH = {"mm", "px", "kB", "rpm", "NC", "rrggbb", "Home", "Draw", "in", "Space", "Left", "Right", "End", "Shift"}
OF_BOTH |= {"Page", "up", "down"}
"""Units, marks and keys: what says nothing else is the same in both languages."""


def in_japanese(text: str, words: Catalogue = JAPANESE) -> bool:
    """Whether a sentence is known as a whole, with numbers or with words in its holes, and no English is left of it."""
    for filler in FILLERS:
        found = words.look_up(text.replace(HOLE, filler))
        if found and not ENGLISH.search(KEPT.sub("", found.replace(filler, ""))):
            return True
    return False


def missing(said: tuple[Sentence, ...]) -> list[str]:
    return [
        f"{each.place}: {each.text.replace(HOLE, '{}')}"
        for each in said
        if set(WORDS.findall(each.text)) - OF_BOTH and not in_japanese(each.text)
    ]


def test_every_sentence_has_a_japanese_one() -> None:
    said = sentences()
    assert len(said) > 600
    assert missing(said) == []


def test_every_error_has_a_japanese_one() -> None:
    raised = errors_of_the_program()
    assert len(raised) > 900
    assert missing(raised) == []


def test_what_errors_quote_is_japanese_too() -> None:
    words = [*EXPECTED.values(), *(kind_of(value) for value in (1.0, (1.0, 2.0)))]
    words += [name.replace("_", " ") for name in declared_of(Tool) if "_" in name]
    assert [each for each in words if not in_japanese(each)] == []


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.dxf", "hello", "a.dxf: DXF ファイルではなく、"),
        ("a.draw", "line 0,0 0,0", "a.draw:1: 1 桁目: 点 2 は点 1, (0.000, 0.000) と同じです。"),
        ("a.svg", "<svg", "a.svg:1: XML が壊れています (列 1: "),
        ("a.hito", "format = 1", 'a.hito: format = "hitofude" がないため、Hitofude のプロジェクトではありません。'),
        ("s.toml", "[[tool]]\nnumber = 1\n", "s.toml:1: diameter がこの [[tool]] にありません。diameter = … を"),
        ("s.toml", "foo = 1", "s.toml:1: foo は使えません。使えるのは name, stock, surface, passes です。"),
        ("p.ngc", "G1 X3 Q2 F100\nM30", "p.ngc:1:7: Q2: このブロックのどのコードもこのワードを使いません。"),
        ("a.draw", "lime 0,0 1,1", "a.draw:1: 1 桁目: 'lime' というコマンドはありません。近いもの: line または spline"),
        ("s.toml", 'units = "ft"', "s.toml:1: units が 'ft' です。mm または in を使ってください"),
        ("p.ngc", "#1=", "p.ngc:1:4: 数、#、[、関数のどれかが要ります (行末 があります)。"),
    ],
)
def test_errors_are_put_together_in_japanese(name: str, text: str, told: str) -> None:
    """As they reach the window: with the place before, parts put together by helpers, and words to type as they are."""
    assert (JAPANESE.look_up(_error_of(name, text.encode())) or "").startswith(told)


def _error_of(name: str, data: bytes) -> str:
    """Return the first thing that is wrong in a file, as the program says it."""
    try:
        if name.endswith(".ngc"):
            return examine(name, data, ExamineOptions()).problems[0].message(name)
        read_scene(name, data) if name.endswith(".toml") else read_drawing(name, data)
    except HitofudeError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("kind", FindingKind, ids=lambda kind: kind.value)
def test_every_kind_of_finding_has_japanese_words(kind: FindingKind) -> None:
    assert in_japanese(kind.words) or in_japanese(sentence(kind.words))


def test_every_parameter_is_explained_in_japanese() -> None:
    declared = [placed.parameter for placed, _ in parameters().values()]
    declared += [placed.parameter for placed in declared_of(Tool).values()]
    lacking = set()
    for each in declared:
        tip = spec_of(each).tip if each.unit in NUMBERS else ""
        said = [each.label, each.short or each.label, f"{sentence(each.help)}.", *each.choices]
        lacking |= {words for words in (*said, tip) if words and not in_japanese(words)}
    assert sorted(lacking) == []


def test_the_japanese_table_of_parameters_is_that_of_the_declarations() -> None:
    made = parameter_table(lambda words: JAPANESE.look_up(words) or words)
    page = resource("docs", "parameters_ja.md")
    assert page.read_text("utf-8") == made, "write it anew: usecases.manual.parameter_table.parameter_table(tr)"
    assert not re.search(r"\| [A-Z]?[a-z]{3,} [a-z]{2,} [a-z]", made)


def test_every_operation_has_a_japanese_name() -> None:
    assert [word for word in OPERATION_KINDS if not in_japanese(f"Add {word}")] == []


def test_what_is_said_is_found_in_a_source() -> None:
    source = (
        "def f(n, where):\n"
        '    more = "" if n == 1 else f" and {n} more"\n'
        '    text = f"A hole at {where:.3f}{more} is missing."\n'
        "    return Finding(KIND, text)\n"
        "def g(self):\n"
        '    self.notice.ask("Save it?" if self.new else "Keep it?")\n'
        '    self.said.emit("Done with it.")\n'
        '    self.done.emit("unheard")\n'
    )
    assert {each.text for each in said_in(source, "x.py")} == {
        f"A hole at {HOLE} is missing.",
        f"A hole at {HOLE} and {HOLE} more is missing.",
        "Save it?",
        "Keep it?",
        "Done with it.",
    }
    written = 'NOTE = "The scan begins here."\nraise InputError("This is an error.")\ndef f():\n    """Say it now."""\n'
    assert [each.text for each in written_in(written, "x.py")] == ["The scan begins here."]


def test_what_can_go_wrong_is_found_in_a_source() -> None:
    source = (
        'MEND = "mend the line"\n'
        "class WrongError(InputError):\n    pass\n"
        "class Other(ValueError):\n    pass\n"
        "def f(n, table):\n"
        "    if n > 3:\n"
        "        raise WrongError(f'A hole is {n} mm; {MEND}')\n"
        "    if n > 2:\n"
        "        raise table.error('depth', f'is {n}; use less')\n"
        "    if n > 1:\n"
        "        raise ValueError('never shown')\n"
        "    if n > 0:\n"
        "        raise Other('nor is this one')\n"
        "    return GeometryError('Nothing is left of it.')\n"
    )
    base = "class InputError(HitofudeError):\n    pass\nclass GeometryError(HitofudeError):\n    pass\n"
    said = errors_of({"core/errors.py": base, "x.py": source})
    assert {each.text for each in said} >= {
        f"A hole is {HOLE} mm; mend the line",
        f"{HOLE} is {HOLE}; use less",
        "Nothing is left of it.",
    }
    assert "never shown" not in {each.text for each in said}


def test_a_sentence_that_is_half_english_counts_as_missing() -> None:
    words = Catalogue({"{}: {}": "{}: {}", "Found": "発見", "A gap at {}": "すき間 {}", "{} at {}": "{} ({})"})
    assert not in_japanese("Found: nothing of the kind", words)
    assert not in_japanese(f"the gap at {HOLE}", words)
    assert in_japanese(f"A gap at {HOLE}", words)
