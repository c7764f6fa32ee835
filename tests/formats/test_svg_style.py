"""What style sheets of an SVG say: variables, what is important, places and sizes."""

import time

import pytest

from app.formats.readers import read_drawing
from app.model.curves import Circle, Curve
from app.model.read_options import DrawingOptions

PAGE = 'width="100mm" height="50mm" viewBox="0 0 100 50" xmlns="http://www.w3.org/2000/svg"'
RIM = '<circle cx="40" cy="25" r="5"/>'


def curves(body: str) -> list[Curve]:
    data = f"<svg {PAGE}>{body}</svg>".encode()
    return [each.curve for each in read_drawing("a.svg", data, None, (), DrawingOptions()).part.entities]


@pytest.mark.parametrize(
    "body",
    [
        '<style>:root{--seen:none} .a{display:var(--seen)}</style><rect class="a" width="9" height="9"/>',
        '<g style="--seen:none"><rect style="display:var( --seen )" width="9" height="9"/></g>',
        '<rect style="display:var(--seen, none)" width="9" height="9"/>',
        '<g style="--a:var(--b);--b:none"><rect style="display:var(--a)" width="9" height="9"/></g>',
        '<g style="--a:no;--b:ne"><rect style="--c:none;display:var(--c)" width="9" height="9"/></g>',
        '<style>rect{display:none !important}</style><rect style="display:inline" width="9" height="9"/>',
        '<style>.a{display:none!important} rect.a{display:inline}</style><rect class="a" width="9" height="9"/>',
        '<style>g > .a{display:none}</style><g><rect class="a" width="9" height="9"/></g>',
        '<style>#b .a , p{display:none}</style><g id="b"><g><rect class="a" width="9" height="9"/></g></g>',
        '<style>g>g rect.a.b{display:none}</style><g><g><a><rect class="b a" width="9" height="9"/></a></g></g>',
        '<style>[data-x="1"]{display:none} rect{display:inline}</style><rect data-x="1" width="9" height="9"/>',
        '<style>.b{display:none} .a{display:inline}</style><style>.b{display:none}</style><rect class="b a" width="9" '
        'height="9"/>',
        '<style>#c{display:none} g rect.a{display:inline}</style><g><rect id="c" class="a" width="9" height="9"/></g>',
        '<g opacity="0"><rect width="9" height="9"/></g>',
        '<rect style="fill-opacity:0.0" width="9" height="9"/>',
        '<g fill="none" stroke="red" stroke-opacity="0%"><rect width="9" height="9"/></g>',
        '<switch><g systemLanguage="ja"><rect width="9" height="9"/></g><g/></switch>',
        '<style>@import url("a.css?b;c"); rect{display:none}</style><rect width="9" height="9"/>',
        '<style>@import url(a.css?b;c) screen; rect{display:none}</style><rect width="9" height="9"/>',
        '<rect style="display:none ! important" width="9" height="9"/>',
        '<style>rect{display:none !IMPORTANT}</style><rect style="display:inline" width="9" height="9"/>',
        '<rect style="/* outline only */fill:none;/* no pen: */stroke:none" width="9" height="9"/>',
        '<style type="text/x-other">rect{fill:red}</style><rect style="fill:none" width="9" height="9"/>',
        '<style>@charset "UTF-8"; rect{display:none}</style><rect width="9" height="9"/>',
        '<style>@font-face{src:url("a;b{c")} rect{display:none}</style><rect width="9" height="9"/>',
        '<style>@supports (display:grid){@layer a{g{fill:red} rect{display:none}}}</style><rect width="9" height="9"/>',
        '<style>@media screen, print{rect{display:none}}</style><rect width="9" height="9"/>',
        '<style media="screen">rect{display:none}</style><rect width="9" height="9"/>',
        '<rect fill="transparent" width="9" height="9"/>',
        '<rect fill="rgba(1, 2, 3, 0)" stroke="#12340000" width="9" height="9"/>',
        '<rect fill="hsl(9 9% 9% / 0%)" stroke="#1230" width="9" height="9"/>',
        '<g color="transparent"><rect fill="currentColor" width="9" height="9"/></g>',
    ],
)
def test_what_a_variable_or_an_important_rule_hides_is_not_read(body: str) -> None:
    assert curves(body + RIM) == [Circle((40, 25), 5)]


@pytest.mark.parametrize(
    "body",
    [
        '<style>rect:not(.a):not([id]){display:none}</style><rect class="b" width="9" height="9"/>',
        '<style>[id^="ab"]{display:none}</style><rect id="abc" width="9" height="9"/>',
        '<style>[id$=bc]{display:none}</style><rect id="abc" width="9" height="9"/>',
        '<style>[id*="b"]{display:none}</style><rect id="abc" width="9" height="9"/>',
        '<style>[class~="x"]{display:none}</style><rect class="z x" width="9" height="9"/>',
        '<style>[id|="a"]{display:none}</style><rect id="a-b" width="9" height="9"/>',
        '<rect style="DISPLAY:None" width="9" height="9"/>',
    ],
)
def test_what_closer_selectors_hide_is_not_read(body: str) -> None:
    assert curves(body + RIM) == curves(RIM)


@pytest.mark.parametrize("value", ["var(--not-set)", "var(--a)", "var(", "none;display:inline"])
def test_a_variable_without_a_value_says_nothing(value: str) -> None:
    assert len(curves(f'<g style="--a:var(--a)"><rect style="display:{value}" width="9" height="9"/></g>')) == 4


def test_variables_that_unfold_to_much_are_nothing_at_once() -> None:
    """Ten levels of ten copies each would be 10,000,000,000 letters."""
    unfolded = "".join(f"--v{k}:{f'var(--v{k + 1})' * 10};" for k in range(12))
    begun = time.process_time()
    assert (
        len(curves(f'<g style="{unfolded}--v12:none"><rect style="display:var(--v0)" width="9" height="9"/></g>')) == 4
    )
    assert time.process_time() - begun < 2


@pytest.mark.parametrize(
    "body",
    [
        "<style>circle{cx:40px;cy:25px;r:5px}</style><circle/>",
        '<circle cx="1" r="5" style="cx:40px;cy:25px"/>',
        '<g style="--r:5"><circle cx="40" cy="25" style="r:var(--r)"/></g>',
    ],
)
def test_places_and_sizes_may_stand_in_a_style(body: str) -> None:
    assert curves(body) == [Circle((40, 25), 5)]


@pytest.mark.parametrize(
    "body",
    [
        '<style>g > .a{display:none}</style><g><a><rect class="a" width="9" height="9"/></a></g>',
        '<style>.a.b{display:none} rect:hover{display:none}</style><rect class="a" width="9" height="9"/>',
        '<style>.a{display:none} .b{display:inline}</style><rect class="b a" width="9" height="9"/>',
        '<rect style="fill-opacity:0" stroke="red" width="9" height="9"/>',
        '<switch><g systemLanguage="ja"><rect width="9" height="9"/></g></switch>',
        '<style>@media print{g{fill:red} rect{display:none}}</style><rect width="9" height="9"/>',
        '<style media="print">rect{display:none}</style><rect width="9" height="9"/>',
        '<style>@media (prefers-color-scheme: dark){rect{fill:none}}</style><rect width="9" height="9"/>',
        '<style>@keyframes a{from{opacity:0} to{opacity:1}}</style><rect width="9" height="9"/>',
        '<style>rect:not(.a){display:none}</style><rect class="a" width="9" height="9"/>',
        '<style>[id^="b"],[id$="b"],[id*="bb"],[class~="x"],[id|="a"]{display:none}</style>'
        '<rect id="abc" class="xy z" width="9" height="9"/>',
        '<rect fill="rgb(0,0,0)" width="9" height="9"/>',
        '<g visibility="hidden"><rect visibility="initial" width="9" height="9"/></g>',
        '<rect visibility="no such word" width="9" height="9"/>',
        '<rect fill="rgba(0,0,0,0.5)" width="9" height="9"/>',
        '<rect fill="#1230" stroke="#000" width="9" height="9"/>',
    ],
)
def test_what_no_rule_hides_is_read(body: str) -> None:
    assert len(curves(body)) == 4


def test_rules_that_cannot_be_followed_are_told() -> None:
    styles = "<style>circle + rect, rect:nth-child(2){display:none} text:first-child{font-size:3px}</style>"
    data = f"<svg {PAGE}>{styles}{RIM}</svg>".encode()
    (found,) = read_drawing("a.svg", data, None, (), DrawingOptions()).findings
    assert found.counts and found.text == (
        "2 rules of the style sheet cannot be followed, the first for circle + rect; check that nothing hidden is read."
    )


def test_a_style_sheet_in_another_file_is_told() -> None:
    data = f'<?xml version="1.0"?>\n<?xml-stylesheet href="a.css"?>\n<svg {PAGE}>{RIM}</svg>'.encode()
    (found,) = read_drawing("a.svg", data).findings
    assert found.counts and 'xml-stylesheet href="a.css"' in found.text


def test_a_style_sheet_in_another_file_that_brings_letters_alone_is_not_told() -> None:
    address = 'href="https://fonts.googleapis.com/css2?family=Roboto" type="text/css"'
    data = f'<?xml version="1.0"?>\n<?xml-stylesheet {address}?>\n<svg {PAGE}>{RIM}</svg>'.encode()
    assert not read_drawing("a.svg", data).findings


@pytest.mark.parametrize(
    ("sheet", "told"),
    [
        ('@import url("a.css");', True),
        ("@import 'a.css' screen;", True),
        ("@import url(a.css) print;", False),
        ("@import url(a.css) print, speech;", False),
        ("@import url(a.css) print, screen;", True),
        ('@import "my-fonts/../hide.css";', True),
        ("@import url(../css/webfont.min.css?v=2);", False),
        ("/* @import 'a.css'; */", False),
        ("@import url('https://fonts.example/css?family=A');", False),
    ],
)
def test_a_style_sheet_that_is_imported_is_told(sheet: str, told: bool) -> None:
    found = read_drawing("a.svg", f"<svg {PAGE}><style>{sheet}</style>{RIM}</svg>".encode()).findings
    assert [each.counts and "the first for @import" in each.text for each in found] == [True] * told


def test_a_rule_that_only_paints_does_not_count() -> None:
    data = f"<svg {PAGE}><style>rect:nth-child(2){{fill:red}}</style>{RIM}</svg>".encode()
    (found,) = read_drawing("a.svg", data).findings
    assert not found.counts and "rect:nth-child(2)" in found.text


def test_a_rule_for_some_windows_alone_is_told() -> None:
    (found,) = read_drawing(
        "a.svg", f"<svg {PAGE}><style>@media (width>9px){{.a,.b{{display:none}}}}</style>{RIM}</svg>".encode()
    ).findings
    assert found.text.startswith("1 rule of the style sheet cannot be followed, the first for @media (width>9px);")


def test_a_selector_of_many_elements_ends_soon() -> None:
    body = "<g>" * 90 + '<rect width="9" height="9"/>' * 50 + "</g>" * 90
    begun = time.process_time()
    assert len(curves(f"<style>{'g ' * 19}circle, {'g ' * 18}b rect{{display:none}}</style>{body}")) == 200
    assert time.process_time() - begun < 2
