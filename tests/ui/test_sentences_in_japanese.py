"""Whatever the program can say to the window, it can say in Japanese: read out of the source, and from declarations."""

from __future__ import annotations

import re

import pytest

from app.core.resources import resource
from app.model.fields import Unit, declared_of
from app.model.finding import FindingKind
from app.model.operation_kinds import OPERATION_KINDS, parameters
from app.model.tool import Tool
from app.ui.framework.catalogue import Catalogue, catalogue
from app.ui.panels.parameter_fields import sentence, spec_of
from app.usecases.manual.parameter_table import parameter_table
from tests.ui.sentences import HOLE, Sentence, said_in, sentences, written_in

JAPANESE = catalogue("ja")
FILLERS = ("7", "Xyz")
ENGLISH = re.compile(r"[a-z]{3,} [a-z]{2,}|^[A-Z][a-z]{3,}$")
NUMBERS = (Unit.LENGTH, Unit.ANGLE, Unit.SHARE, Unit.COUNT, Unit.TIME)
KEPT = re.compile(r"--[\w-]+( \w+)?|\((Page|Ctrl|Shift)[^)]*\)")
"""Options and keys, which stand in Japanese sentences as they are."""
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


def test_a_sentence_that_is_half_english_counts_as_missing() -> None:
    words = Catalogue({"{}: {}": "{}: {}", "Found": "発見", "A gap at {}": "すき間 {}", "{} at {}": "{} ({})"})
    assert not in_japanese("Found: nothing of the kind", words)
    assert not in_japanese(f"the gap at {HOLE}", words)
    assert in_japanese(f"A gap at {HOLE}", words)
