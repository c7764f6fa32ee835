"""The manual as a folder of pages for browsers, with a search that needs no server, in all languages that it has."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import groupby, pairwise
from pathlib import PurePosixPath

from markdown_it import MarkdownIt
from markdown_it.token import Token

from ...core.resources import resource
from .pages import LANGUAGES, ManualLanguage, PageGroup, base_of, group_of, language_of, rank, shown_in


@dataclass(frozen=True)
class ManualSection:
    """A part of a page under one heading: what the search looks through.

    Attributes:
        href: where it stands. page: title of its page. title: its heading.
        text: all of it, without marks.
    """

    href: str
    page: str
    title: str
    text: str


@dataclass(frozen=True)
class ManualPage:
    """A page, read.

    Attributes:
        name: of its file, without a suffix. tokens: of its Markdown, each heading with an anchor.
    """

    name: str
    title: str
    tokens: Sequence[Token]

    @property
    def language(self) -> ManualLanguage:
        """That it is written in."""
        return language_of(self.name)

    @property
    def base(self) -> str:
        """Its name without what tells the language."""
        return base_of(self.name)


def static_manual(files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files of the site by their names.

    Args:
        files: Markdown pages and pictures of the manual, by name.
    """
    parser = MarkdownIt("commonmark").enable("table")
    pages = [
        _read(parser, PurePosixPath(name).stem, data.decode("utf-8"))
        for name, data in files.items()
        if name.endswith(".md")
    ]
    pages.sort(key=lambda page: rank(page.base))
    site = {name: data for name, data in files.items() if not name.endswith(".md")}
    for language in LANGUAGES:
        shown = _shown(pages, language)
        for page in shown:
            site[f"{page.base}{language.ending}.html"] = _page_html(parser, page, shown, language)
        site[f"index{language.ending}.html"] = _index_html(shown, language)
        sections = [section for page in shown for section in _sections(page, language)]
        site[f"search{language.ending}.js"] = _search_js(sections, language)
    return site | {"manual.css": resource("web", "manual.css").read_bytes()}


def _shown(pages: Sequence[ManualPage], language: ManualLanguage) -> list[ManualPage]:
    """Return each page in a language, or in English where it is not written in that."""
    by_name = {page.name: page for page in pages}
    return [by_name[name] for name in shown_in(language, by_name)]


def _read(parser: MarkdownIt, name: str, text: str) -> ManualPage:
    """Return a page whose headings have anchors, none twice, as the pages' own links name them."""
    tokens, taken = parser.parse(text), set[str]()
    title = name
    for token, inline in pairwise(tokens):
        if token.type == "heading_open":
            words = _plain(inline)
            if token.tag == "h1" and title == name:
                title = words
            anchor = _slug(words)
            number = 1
            while (unique := anchor if number == 1 else f"{anchor}-{number}") in taken:
                number += 1
            taken.add(unique)
            token.attrSet("id", unique)
    return ManualPage(name, title, tokens)


def _slug(words: str) -> str:
    """Return an anchor as the usual hosts of Markdown make it: letters, figures and dashes."""
    return re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", words.lower()).strip())


def _plain(inline: Token) -> str:
    """Return the text of a line without its marks."""
    words = (
        each.content if each.type in ("text", "code_inline") else " " * ("break" in each.type)
        for each in inline.children or ()
    )
    return "".join(words).strip()


def _page_html(parser: MarkdownIt, page: ManualPage, shown: Sequence[ManualPage], language: ManualLanguage) -> bytes:
    for token in page.tokens:
        for child in token.children or ():
            if child.type == "link_open":
                child.attrSet("href", linked(str(child.attrGet("href")), language))
    body = parser.renderer.render(list(page.tokens), parser.options, {})
    body = re.sub(r"<table>.*?</table>", lambda match: f'<div class="wide">{match[0]}</div>', body, flags=re.DOTALL)
    return _html(_Body(page.title, body, page.base, page.language.code), shown, language)


def linked(href: str, language: ManualLanguage) -> str:
    """Return where a link of a page leads on the site: to a page of a language, or to the index."""
    target, mark, anchor = href.partition("#")
    if ":" in href or not target:
        return href
    path = PurePosixPath(target)
    if path.name == "README.md":
        return f"index{language.ending}.html"
    if path.suffix != ".md":
        return path.name
    written = language_of(path.stem)
    ending = language.ending if written is LANGUAGES[0] else written.ending
    return f"{base_of(path.stem)}{ending}.html{mark}{anchor}"


def _index_html(shown: Sequence[ManualPage], language: ManualLanguage) -> bytes:
    groups = "".join(
        f'<h2>{escape(group.titles[language.code])}</h2><ul class="index">'
        + "".join(f"<li>{_link(page, language)}<p>{escape(_first(page))}</p></li>" for page in pages)
        + "</ul>"
        for group, pages in _grouped(shown)
    )
    body = f"<h1>{language.title}</h1>{groups}"
    return _html(_Body(language.title, body, "index", language.code), shown, language)


def _link(page: ManualPage, language: ManualLanguage, current: str = "") -> str:
    """Return a link to a page, marked where it is the page that it stands on."""
    mark = " aria-current=page" if page.base == current else ""
    return f'<a href="{page.base}{language.ending}.html"{mark}>{escape(page.title)}</a>'


def _grouped(shown: Sequence[ManualPage]) -> Iterator[tuple[PageGroup, list[ManualPage]]]:
    """Yield the groups with their pages, from pages in the manual's order."""
    for group, pages in groupby(shown, key=lambda page: group_of(page.base)):
        yield group, list(pages)


def _first(page: ManualPage) -> str:
    """Return the first sentence of a page that says something; a picture at its head says nothing."""
    paragraphs = (_plain(inline) for token, inline in pairwise(page.tokens) if token.type == "paragraph_open")
    words = next(filter(None, paragraphs), "")
    return re.split(r"(?<=[.。])\s?", words, maxsplit=1)[0]


@dataclass(frozen=True)
class _Body:
    """What stands on a page of the site: its title, its HTML, its name without a language, the language of its text."""

    title: str
    html: str
    base: str
    written: str


def _html(body: _Body, shown: Sequence[ManualPage], language: ManualLanguage) -> bytes:
    links = "".join(
        f"<li><b>{escape(group.titles[language.code])}</b><ul>"
        + "".join(f"<li>{_link(page, language, body.base)}</li>" for page in pages)
        + "</ul></li>"
        for group, pages in _grouped(shown)
    )
    others = " ".join(
        f'<a href="{body.base}{each.ending}.html" lang="{each.code}">{each.name}</a>'
        for each in LANGUAGES
        if each is not language
    )
    whole = _PAGE.format(
        code=language.code,
        written=body.written,
        title=escape(body.title),
        site=language.title,
        index=f"index{language.ending}.html",
        search=language.search,
        script=f"search{language.ending}.js",
        pages=language.pages,
        links=links,
        others=others,
        body=body.html,
    )
    return whole.encode()


def _sections(page: ManualPage, language: ManualLanguage) -> Iterator[ManualSection]:
    """Yield what stands under each heading of a page."""
    href, title, words = f"{page.base}{language.ending}.html", page.title, list[str]()
    anchor, heading = "", False
    for token in page.tokens:
        if token.type == "heading_open":
            if words:
                yield ManualSection(f"{href}{anchor}", page.title, title, " ".join(words))
            anchor, words, heading = f"#{token.attrGet('id')}", [], True
        elif token.type == "inline":
            if heading:
                title = _plain(token)
            words.append(_plain(token))
            heading = False
        elif token.type in ("fence", "code_block"):
            words.append(token.content)
    if words:
        yield ManualSection(f"{href}{anchor}", page.title, title, " ".join(words))


def _search_js(sections: Sequence[ManualSection], language: ManualLanguage) -> bytes:
    rows = [[each.href, each.page, each.title, " ".join(each.text.split())] for each in sections]
    told = json.dumps(rows, ensure_ascii=False, separators=(",", ":"))
    nothing = json.dumps(language.nothing, ensure_ascii=False)
    head = f"const sections = {told};\nconst nothing = {nothing};\n"
    return head.encode() + resource("web", "manual.js").read_bytes()


_PAGE = """\
<!DOCTYPE html>
<html lang="{code}">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<link rel="stylesheet" href="manual.css">
</head>
<body>
<header>
<a class="site" href="{index}">{site}</a>
<form role="search"><input type="search" id="search" placeholder="{search}" aria-label="{search}" autocomplete="off">
<ol id="found" hidden></ol></form>
<span class="languages">{others}</span>
</header>
<nav aria-label="{pages}"><ul>{links}</ul></nav>
<main lang="{written}">
{body}
</main>
<script src="{script}"></script>
</body>
</html>
"""
