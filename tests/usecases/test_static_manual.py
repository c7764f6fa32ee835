"""The manual as a site: every link leads somewhere, every page is found by what stands on it, in both languages."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest
from markdown_it import MarkdownIt

from app.cli.main import main
from app.usecases.manual.pages import GROUPS, LANGUAGES
from app.usecases.manual.site import linked, static_manual
from tests.ui.manual_tour import OPERATION_PAGES

DOCS = Path(__file__).resolve().parents[2] / "resources/docs"


class Page(HTMLParser):
    """What a page refers to, the anchors on it, and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.refers: list[str] = []
        self.anchors: set[str] = set()
        self.words: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.refers += [value for name, value in attrs if name in ("href", "src") and value]
        self.anchors |= {value for name, value in attrs if name == "id" and value}

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def contents(folder: Path) -> dict[str, bytes]:
    """The files of a folder and of those in it, by their path from there."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def site() -> dict[str, bytes]:
    return static_manual(contents(DOCS))


@pytest.fixture(scope="module")
def pages(site: dict[str, bytes]) -> dict[str, Page]:
    return {name: Page(data.decode()) for name, data in site.items() if name.endswith(".html")}


def sections(site: dict[str, bytes], name: str) -> list[list[str]]:
    rows: list[list[str]] = json.loads(site[name].decode().partition("\n")[0].removeprefix("const sections = ")[:-1])
    return rows


def broken(refers: list[str], site: dict[str, bytes], pages: dict[str, Page], on: str) -> list[str]:
    found = []
    for href in refers:
        target, _, anchor = unquote(href).partition("#")
        if href.startswith(("https://", "http://", "mailto:")):
            continue
        if (target or on) not in site or (anchor and anchor not in pages[target or on].anchors):
            found.append(f"{on}: {href}")
    return found


def test_every_link_leads_somewhere(site: dict[str, bytes], pages: dict[str, Page]) -> None:
    assert not [each for name, page in pages.items() for each in broken(page.refers, site, pages, name)]


def test_the_index_says_a_sentence_about_every_page(site: dict[str, bytes]) -> None:
    """Of its text, where a page begins with a picture too; its name is its first heading."""
    for language in LANGUAGES:
        index = site[f"index{language.ending}.html"].decode()
        said = re.findall(r"</a><p>(.*?)</p>", index)
        assert len(said) > 40 and all(said)
        assert [index.find(f">{group.titles[language.code]}</h2>") > 0 for group in GROUPS] == [True] * len(GROUPS)
    assert '">Parameters</a>' in site["index.html"].decode() and '">パラメータ</a>' in site["index_ja.html"].decode()


def test_what_the_search_finds_is_there(site: dict[str, bytes], pages: dict[str, Page]) -> None:
    for name in ("search.js", "search_ja.js"):
        rows = sections(site, name)
        assert len(rows) > 40 and not broken([row[0] for row in rows], site, pages, "index.html")
        every = {row[0].partition("#")[0] for row in rows}
        assert every == {each for each in pages if each.endswith("_ja.html") == (name == "search_ja.js")} - {
            "index.html",
            "index_ja.html",
        }


def test_a_broken_link_would_be_told() -> None:
    site = static_manual({"a.md": b"# A\n[x](b.md) [y](#nowhere) ![z](no.png)\n"})
    pages = {name: Page(data.decode()) for name, data in site.items() if name.endswith(".html")}
    assert broken(pages["a.html"].refers, site, pages, "a.html") == [
        "a.html: b.html",
        "a.html: #nowhere",
        "a.html: no.png",
    ]


def test_both_languages_have_every_page(site: dict[str, bytes], pages: dict[str, Page]) -> None:
    english = {path.stem for path in DOCS.glob("*.md") if not path.stem.endswith("_ja")}
    for language in LANGUAGES:
        assert {f"{name}{language.ending}.html" for name in (*english, "index")} <= set(pages)
    assert b'<main lang="ja">' in site["texts_ja.html"] and b'<main lang="en">' in site["changelog_ja.html"]
    assert "texts.html" in pages["texts_ja.html"].refers and "texts_ja.html" in pages["texts.html"].refers


def test_every_page_that_a_user_reads_is_written_in_both_languages() -> None:
    pages = {path.stem for path in DOCS.glob("*.md")}
    english = {name for name in pages if not name.endswith("_ja")}
    assert {name for name in english - {"architecture", "changelog"} if f"{name}_ja" not in pages} == set()
    assert {base for group in GROUPS for base in group.bases} >= english


def pictures_of(page: Path) -> list[str]:
    return re.findall(r"!\[[^]]+\]\(([^)]+)\)", page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", sorted(DOCS.glob("*_ja.md")), ids=lambda page: page.stem)
def test_both_languages_of_a_page_show_the_same(page: Path) -> None:
    """The same pictures, in the same order, those of the window in its language; no command that the English page does
    not have.
    """
    english = page.with_name(page.name.replace("_ja", ""))
    assert pictures_of(page) == [re.sub("^pictures/", "pictures/ja/", each) for each in pictures_of(english)]
    assert command_lines(page) <= command_lines(english)


def command_lines(page: Path) -> set[str]:
    lines = page.read_text(encoding="utf-8").splitlines()
    return {line.partition("  #")[0].strip() for line in lines if line.startswith("    ./hitofude ")}


def test_every_operation_s_page_and_every_tutorial_has_a_picture_of_the_window() -> None:
    tutorials = ("first_part", "sign", "mould", "foreign_program", "lesson")
    operations = [each[0] for each in OPERATION_PAGES]
    shown = {name: pictures_of(DOCS / f"{name}.md") for name in (*tutorials, *operations, "lettering")}
    assert all(any(each.startswith("pictures/") for each in found) for found in shown.values()), shown
    pictures = DOCS / "pictures"
    taken = {f"pictures/{path.name}" for path in pictures.glob("*.png")}
    assert taken == {each for found in shown.values() for each in found}
    assert {path.name for path in pictures.glob("*.png")} == {path.name for path in (pictures / "ja").glob("*.png")}


@pytest.mark.parametrize(
    "page", [DOCS.parents[1] / "README.md", *sorted(DOCS.rglob("*.md"))], ids=lambda page: page.stem
)
def test_what_is_to_be_typed_is_set_apart(page: Path) -> None:
    """Behind a list four spaces make a paragraph of its last item: the commands of the README ran into one another."""
    text = page.read_text(encoding="utf-8")
    blocks = (each.map for each in MarkdownIt("commonmark").parse(text) if each.type in ("code_block", "fence"))
    code = {number for lines in blocks if lines for number in range(*lines)}
    typed = {
        number for number, line in enumerate(text.splitlines()) if line.startswith(("    ./hitofude", "./hitofude"))
    }
    assert typed <= code


def test_the_pictures_are_small() -> None:
    sizes = {path.name: path.stat().st_size for path in DOCS.rglob("*.png")}
    assert sum(sizes.values()) < 4_000_000 and max(sizes.values()) < 400_000


def test_headings_of_one_name_have_anchors_of_their_own() -> None:
    site = static_manual({"a.md": b"# A\n## `Two` words!\n## Two words\n[x](a.md#two-words-2)\n"})
    page = Page(site["a.html"].decode())
    assert {"a", "two-words", "two-words-2"} <= page.anchors and "a.html#two-words-2" in page.refers


def test_links_lead_to_pages_of_the_language() -> None:
    english, japanese = LANGUAGES
    assert linked("posts.md#post", english) == "posts.html#post"
    assert linked("posts.md", japanese) == "posts_ja.html"
    assert linked("texts_ja.md", english) == "texts_ja.html"
    assert linked("../../README.md", japanese) == "index_ja.html"
    assert linked("https://a.example/b.md", english) == "https://a.example/b.md"


def test_the_search_finds_sections_by_their_words(site: dict[str, bytes]) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("there is no node here to run the page's script with")
    stub = """
    const element = () => ({addEventListener() {}, replaceChildren(...a) { this.items = a; },
      append(...a) { this.a = a; }, form: {addEventListener() {}}, value: "", hidden: true});
    const elements = {search: element(), found: element()};
    const document = {getElementById: id => elements[id], createElement: element, addEventListener() {}};
    """
    ask = """
    for (const words of ["scallop ridge", "GRBL tool", "zzzz"]) {
      field.value = words; found.items = []; show();
      console.log(found.items.length, found.items.length ? found.items[0].a[0].href : found.textContent);
    }
    """
    script = stub + site["search.js"].decode() + ask
    done = subprocess.run([node, "-"], input=script, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == 3 and lines[2] == "0 Nothing found"
    for line in lines[:2]:
        count, href = line.split()
        assert int(count) >= 1 and href in {row[0] for row in sections(site, "search.js")}


def test_the_command_writes_it(tmp_path: Path, site: dict[str, bytes], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["manual", "-o", str(tmp_path / "site")]) == 0
    assert contents(tmp_path / "site") == site
    assert main(["manual", "-o", str(tmp_path / "no" / "site")]) == 2
    assert "there is no folder" in capsys.readouterr().err
