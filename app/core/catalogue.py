"""What the program says in another language: a catalogue from English in `resources/translations`: of each language a
file, and a folder with the errors of each room, and what paper says.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

from .resources import resource

LANGUAGES = ("en", "ja")
"""Codes of those that the program speaks; it is written in the first."""

_HOLE = re.compile(r"\{(n?)\}")
_ANYTHING, _NUMBER = "(.+)", "([-+.,\u2009\u2212\\d]+(?:e[-+]\\d+)?)"
_PERHAPS, _SIDE_BY_SIDE = "(.*)", re.compile(r"(?:\(\.\+\)){2,}")
_REMEMBERED = 4096
"""Sentences whose translation is kept: more than a window shows."""
_MNEMONIC = re.compile(r"&(\w)")
_KEY_TIP = re.compile(r"(.+) (\([^()]+\))")
_BETWEEN_SENTENCES = re.compile(r"(?<=[.?!]) (?=[A-Z])")
_IN_A_LIST = re.compile(r"(?:, | (?:or|and) )(?![^()]*\))")
"""Between names; what stands in brackets behind one is a part of it."""
_AS_TYPED = re.compile(r"""'[^']*'|"[^"]*"|[.#-]\S+|[A-Z]{1,2}\d*|[-+.\d]+|\d+ [A-Z][A-Z\d_]+""")
"""Of a list: what is the same in every language: what is quoted, suffixes, options, words of programs, numbers, and
counted entities of a DXF.
"""
_BEHIND_BRACKETS = "), "
"""Where it stands, an entry for the last name of a list would swallow those before."""
_LETTER = re.compile(r"[A-Za-z]")
_COLON = re.compile(": ")
_TOOL = re.compile(r"(?<![A-Za-z])T$")
"""What stands before number and name of a tool."""
_CHANGED = re.compile(r"\bChange $")
"""What stands before the name of a field, which is written small there."""
_NUMBERED = re.compile(r"(T\d+ +)(\S.*)")
"""A tool as lists have it: its number, and its name."""
_AREA = re.compile(r"\bmm2\b")
_TYPED, _OFFERED = re.compile(r"(?:one of|expected|expected are) $"), re.compile(r"(?:choose|try|use|write) $")
"""What stands before words to choose one of, which have to be typed as they are; the second, where it is a list."""


@dataclass(frozen=True, slots=True)
class _Pattern:
    """An entry with holes: its longest piece, which is quickly looked for, the expression that finds its texts, and the
    translation as `str.format` fills it.
    """

    longest: str
    form: str
    other: str


class Catalogue:
    """English texts and what they are in another language.

    An entry stands for the text in a menu (`&Open…`), in a tip (`Open (Ctrl+O)`) and on a button alike: the letter to
    press, dots, blanks at the ends and keys are put back round it. `{}` in an entry stands for anything, side by side
    also for nothing, `{n}` for a number; what it stood for is looked up too. In the translation they may be numbered,
    `{1} {0}`, to stand in another order, and it may be a list of names, each of them an entry, whose commas, "or" and
    "and" are the language's. Of several sentences
    each may be an entry, and a sentence may stand behind a place, as in `part.dxf:7: …`. Of several entries that would
    do, that with the most letters of its own is taken; last comes what has no word of its own, such as `{}: {}`.
    """

    def __init__(self, entries: dict[str, str], lists: Mapping[str, str] | None = None) -> None:
        self._lists = lists or {}
        plain = {_as_written(text): other for text, other in entries.items()}
        self._entries = {text: other for text, other in plain.items() if not _HOLE.search(text)}
        holed = {text: other for text, other in plain.items() if _HOLE.search(text)}
        most_said_first = sorted(holed, key=_letters, reverse=True)
        self._patterns = [_pattern(text, holed[text]) for text in most_said_first if _letters(text)]
        self._joints = [_pattern(text, holed[text]) for text in most_said_first if not _letters(text)]
        self.look_up = lru_cache(_REMEMBERED)(self._look_up)

    def _look_up(self, text: str) -> str | None:
        """Return a text in this language, or None where the catalogue lacks it; areas are found as mm2 and as mm²."""
        found = self._found(_as_written(text))
        return found if found is None or "mm²" not in text else _AREA.sub("mm²", found)

    def _found(self, text: str) -> str | None:
        if text in self._entries:
            return self._entries[text]
        core = text.strip()
        if not core:
            return None
        front, tab, hint = core.partition("\t")
        dots = "…" if front.endswith("…") else ""
        found = self._core(front.removesuffix("…"), joints=not dots)
        if found is None and dots:  # of a sentence that shows what to add
            found, dots = self._core(front), ""
        if found is None:
            return None
        lead, trail = text[: len(text) - len(text.lstrip())], text[len(text.rstrip()) :]
        return f"{lead}{found}{dots}{tab}{hint}{trail}"

    def joined(self, names: Sequence[str]) -> str:
        """Return a list of names, with this language's commas between those that are in it."""
        return self._joined(names, [", "] * (len(names) - 1))

    def _core(self, text: str, joints: bool = True) -> str | None:
        letter = _MNEMONIC.search(text)
        words = text.replace("&", "")
        if words in self._entries:
            return self._entries[words] + (f"(&{letter.group(1).upper()})" if letter else "")
        with_key = _KEY_TIP.fullmatch(words)
        if with_key and with_key.group(1) in self._entries:
            return f"{self._entries[with_key.group(1)]} {with_key.group(2)}"
        return (
            self._sentence(words)
            or self._placed(words)
            or self._numbered(words)
            or self._matched(words, self._joints if joints else ())
        )

    def _sentence(self, words: str) -> str | None:
        """Return what is an entry, or several lines or sentences that are; no entry swallows a sentence that is one."""
        return (
            self._entries.get(words)
            or self._matched(words, self._patterns, within_sentences=True)
            or self._sentences(words)
            or self._matched(words, self._patterns)
        )

    def _placed(self, words: str) -> str | None:
        """Return a sentence behind a place, its file and line or whatever a colon parts from it."""
        for colon in _COLON.finditer(words):
            found = self._sentence(words[colon.end() :])
            if found is not None:
                place = words[: colon.start()]
                return f"{self.look_up(place) or place}: {found}"
        return None

    def _numbered(self, words: str) -> str | None:
        """Return a tool by number and name, where the name is an entry."""
        tool = _NUMBERED.fullmatch(words)
        name = self.look_up(tool[2]) if tool is not None else None
        return f"{tool[1]}{name}" if tool is not None and name is not None else None

    def _matched(self, words: str, patterns: Sequence[_Pattern], within_sentences: bool = False) -> str | None:
        """Return what the first entry with holes makes of a text.

        Args:
            within_sentences: no hole stands for the end of one sentence and the beginning of the next.
        """
        for pattern in patterns:
            match = _finder(pattern.form).fullmatch(words) if pattern.longest in words else None
            if match and not (within_sentences and any(map(_BETWEEN_SENTENCES.search, match.groups()))):
                holes = range(1, match.re.groups + 1)
                return pattern.other.format(*(self._filling(words[: match.start(k)], match[k]) for k in holes))
        return None

    def _filling(self, before: str, part: str) -> str:
        """Return what stands for what a hole stood for; the names of a list are written small in English.

        Args:
            before: the text as far as the hole.
        """
        if _TOOL.search(before) and (tool := self.look_up(f"T{part}")) is not None:
            return tool.removeprefix("T")
        names, joints = _IN_A_LIST.split(part), _IN_A_LIST.findall(part)
        plain = not any(" " in name for name in names)
        if _TYPED.search(before) or (_OFFERED.search(before) and joints and plain):
            return self._joined(names, joints)
        small = _CHANGED.search(before) is not None
        whole = self.look_up(part) or (self.look_up(part[:1].upper() + part[1:]) if small else None)
        if whole is not None and _BEHIND_BRACKETS not in part:
            return whole
        if not joints or before.endswith(("'", '"')):  # a name that somebody gave
            return part
        known = [self.look_up(name) or self.look_up(name.capitalize()) for name in names]
        told = [other or (name if _AS_TYPED.fullmatch(name) else "") for name, other in zip(names, known, strict=True)]
        only_typed = not any(known) and not {*joints} - {", "}
        return whole or part if only_typed or not all(told) else self._joined(told, joints)

    def _joined(self, names: Sequence[str], joints: Sequence[str]) -> str:
        """Return a list with this language's joints; words of English stand apart from these."""
        text = names[0]
        for joint, name in zip(joints, names[1:], strict=True):
            word, comma = self._lists.get(joint.strip(), joint.strip()), joint == ", "
            english = text[-1:].isascii() and name[:1].isascii()
            text += (joint if comma else f" {word} ") + name if english else word + name
        return text

    def _sentences(self, words: str) -> str | None:
        """Return several lines, or sentences one behind the other, if each of them is known."""
        lines = words.split("\n")
        parts, between = (lines, "\n") if len(lines) > 1 else (_BETWEEN_SENTENCES.split(words), "")
        if len(parts) == 1:
            return None
        found = [self.look_up(part) or (None if _LETTER.search(part) else part) for part in parts]
        return between.join(part for part in found if part is not None) if None not in found else None


def _as_written(text: str) -> str:
    """Return a text with units of area as files and engines write them."""
    return text.replace("mm²", "mm2")


def _letters(text: str) -> int:
    """Return how many letters of its own an entry has."""
    return len(_LETTER.findall(_HOLE.sub("", text)))


def _pattern(text: str, other: str) -> _Pattern:
    """Return what finds the texts that an entry with holes stands for."""
    words = _HOLE.split(text)
    form = "".join((_NUMBER if word else _ANYTHING) if at % 2 else re.escape(word) for at, word in enumerate(words))
    form = _SIDE_BY_SIDE.sub(lambda found: found[0].replace(_ANYTHING, _PERHAPS), form)
    return _Pattern(max(words[::2], key=len), form, _HOLE.sub("{}", other))


@cache
def _finder(form: str) -> re.Pattern[str]:
    """Return an expression, compiled when a text may be one of its own: few of all ever are in a run."""
    return re.compile(form, re.S)


@cache
def catalogue(code: str) -> Catalogue:
    """Return the catalogue of a language by its code, such as "ja"; "en" has none, and needs none."""
    if code == "en":
        return Catalogue({})
    entries: dict[str, str] = {}
    lists: dict[str, str] = {}
    for path in catalogue_files(code):
        tables = tomllib.loads(path.read_text("utf-8"))
        entries |= tables["words"]
        lists |= tables.get("lists", {})
    return Catalogue(entries, lists)


def catalogue_files(code: str) -> tuple[Path, ...]:
    """Return the files of a language: what the window says, then the errors of each room."""
    return resource("translations", f"{code}.toml"), *sorted(resource("translations", code).glob("*.toml"))
