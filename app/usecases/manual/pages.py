"""The pages of the manual: their order and their languages, for the window's Help and for the pages of browsers alike.

A page is a file NAME.md in English, and NAME_ja.md the same in Japanese; what is not written in a language is shown in
English in its place.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class PageGroup:
    """Pages that stand together under a heading of their own.

    Attributes:
        titles: the heading, by the language's code. bases: names of the pages, in their order.
    """

    titles: Mapping[str, str]
    bases: tuple[str, ...]


TUTORIALS = PageGroup(
    {"en": "Tutorials", "ja": "チュートリアル"}, ("first_part", "sign", "mould", "foreign_program", "lesson")
)
WORK = PageGroup(
    {"en": "How to work", "ja": "使い方"}, ("manual", "language", "layers", "feeds", "project", "posts", "scene")
)
PATHS = PageGroup(
    {"en": "Areas and contours", "ja": "領域と輪郭の加工"},
    (
        "pocket",
        "contour",
        "adaptive",
        "slots",
        "open_edges",
        "face",
        "chamfer",
        "engrave",
        "lettering",
        "vcarve",
        "inlay",
        "wear",
    ),
)
HOLES = PageGroup(
    {"en": "Holes", "ja": "穴の加工"},
    ("holes", "drill", "spot", "ream", "tap", "countersink", "bore", "counterbore", "thread"),
)
REFERENCE = PageGroup({"en": "Reference", "ja": "リファレンス"}, ("parameters", "texts", "python"))
INSIDE = PageGroup({"en": "The program itself", "ja": "プログラムの中"}, ("architecture", "changelog"))
"""What is for those who change the program, and what changed; pages that no group names stand here too, by name."""

GROUPS = (TUTORIALS, WORK, PATHS, HOLES, REFERENCE, INSIDE)
"""Of the manual, in its order: the tutorials, how to work, the operations, what is looked up."""


@dataclass(frozen=True)
class ManualLanguage:
    """What a manual says itself in a language.

    Attributes:
        code: of HTML, and behind the names of its pages: NAME_ja.md; "en" is behind none.
        name: of the language, in itself.
    """

    code: str
    name: str
    title: str
    search: str
    nothing: str
    pages: str

    @property
    def ending(self) -> str:
        """What the names of its pages end in."""
        return "" if self.code == "en" else f"_{self.code}"


LANGUAGES = (
    ManualLanguage("en", "English", "Hitofude manual", "Search the manual", "Nothing found", "Pages"),
    ManualLanguage("ja", "日本語", "Hitofude マニュアル", "マニュアルを検索", "見つかりません", "ページ"),
)


def language_of(name: str) -> ManualLanguage:
    """Return the language that a page is written in, by the name of its file without a suffix."""
    return next((each for each in LANGUAGES[1:] if name.endswith(each.ending)), LANGUAGES[0])


def base_of(name: str) -> str:
    """Return a page's name without what tells the language."""
    return name.removesuffix(language_of(name).ending)


def group_of(base: str) -> PageGroup:
    """Return the group that a page stands in, by its name without a language."""
    return next((group for group in GROUPS if base in group.bases), INSIDE)


def rank(base: str) -> tuple[int, int, str]:
    """Return what sorts pages into their order, by their names without a language."""
    group = group_of(base)
    within = group.bases.index(base) if base in group.bases else len(group.bases)
    return GROUPS.index(group), within, base


def shown_in(language: ManualLanguage, names: Iterable[str]) -> list[str]:
    """Return the names of the files to show in a language, in the manual's order.

    Args:
        language: that is read. names: of all files, without suffixes.
    """
    known = set(names)
    bases = sorted((name for name in known if language_of(name) is LANGUAGES[0]), key=rank)
    return [own if (own := f"{base}{language.ending}") in known else base for base in bases]
