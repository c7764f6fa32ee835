"""The window's words in the user's language: a catalogue from English, one file a language in `resources/translations`."""

from __future__ import annotations

import re
import tomllib
from functools import cache

from app.resources import resource

_HOLE = re.compile(r"\{\}")
_MNEMONIC = re.compile(r"&(\w)")
_KEY_TIP = re.compile(r"(.+) (\([^()]+\))")


class Catalogue:
    """English texts and what they are in another language.

    An entry stands for the text in a menu (`&Open…`), in a tip (`Open (Ctrl+O)`) and on a button alike: the letter to press,
    dots, blanks at the ends and keys are put back round it. `{}` in an entry stands for anything; what it stood for is
    looked up too.
    """

    def __init__(self, entries: dict[str, str]) -> None:
        self._entries = {text: other for text, other in entries.items() if "{}" not in text}
        self._patterns = [(re.compile("(.+)".join(map(re.escape, _HOLE.split(text))), re.S), other)
                          for text, other in entries.items() if "{}" in text]

    def look_up(self, text: str) -> str | None:
        """Return a text in this language, or None when it is not in the catalogue."""
        if text in self._entries:
            return self._entries[text]
        core = text.strip()
        if not core:
            return None
        front, tab, hint = core.partition("\t")
        dots = "…" if front.endswith("…") else ""
        found = self._core(front.removesuffix("…"))
        if found is None:
            return None
        lead, trail = text[: len(text) - len(text.lstrip())], text[len(text.rstrip()):]
        return f"{lead}{found}{dots}{tab}{hint}{trail}"

    def _core(self, text: str) -> str | None:
        letter = _MNEMONIC.search(text)
        words = text.replace("&", "")
        if words in self._entries:
            return self._entries[words] + (f"(&{letter.group(1).upper()})" if letter else "")
        with_key = _KEY_TIP.fullmatch(words)
        if with_key and with_key.group(1) in self._entries:
            return f"{self._entries[with_key.group(1)]} {with_key.group(2)}"
        for pattern, other in self._patterns:
            match = pattern.fullmatch(words)
            if match:
                return other.format(*(self._entries.get(part, part) for part in match.groups()))
        return None


@cache
def catalogue(code: str) -> Catalogue:
    """Return the catalogue of a language by its code, such as "ja"; "en" has none, and needs none."""
    if code == "en":
        return Catalogue({})
    return Catalogue(tomllib.loads(resource("translations", f"{code}.toml").read_text("utf-8"))["words"])


class _Spoken:
    """The language that the window speaks."""

    code = "en"


def speak(code: str) -> None:
    """Use another language from now on."""
    catalogue(code)
    _Spoken.code = code


def spoken() -> str:
    """Return the code of the language that the window speaks."""
    return _Spoken.code


def tr(text: str) -> str:
    """Return a text in the language that the window speaks; what the catalogue lacks stays English."""
    return catalogue(_Spoken.code).look_up(text) or text
