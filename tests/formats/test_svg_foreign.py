"""SVG as other programs and people write it: encodings of several bytes, prefixes that nobody declared, names of layers
that were encoded, pages that a style sheet sizes.
"""

from typing import Any

import pytest

from app.core.errors import InputError
from app.formats.drawing_account import size_of
from app.formats.readers import read_drawing
from app.formats.svg.svg import read_svg
from app.model.read_options import DrawingOptions

NS = 'xmlns="http://www.w3.org/2000/svg"'
RECT = '<rect width="5" height="4"/>'
PAGE = 'width="10mm" height="10mm" viewBox="0 0 10 10"'
READABLE = {
    "blanks first": f'\n \n<?xml version="1.0"?><svg {NS} {PAGE}>{RECT}</svg>'.encode(),
    "shift_jis": f'<?xml version="1.0" encoding="Shift_JIS"?><svg {NS} {PAGE}><title>①線</title>{RECT}</svg>'.encode(
        "cp932"
    ),
    "euc-jp": f'<?xml version="1.0" encoding="EUC-JP"?><svg {NS} {PAGE}><title>線</title>{RECT}</svg>'.encode("euc_jp"),
    "gbk": f"<?xml version=\"1.0\" encoding='GBK'?><svg {NS} {PAGE}><title>线</title>{RECT}</svg>".encode("gbk"),
    "undeclared link": f'<svg {NS} {PAGE}><defs><g id="a">{RECT}</g></defs><use xlink:href="#a"/></svg>'.encode(),
    "undeclared root": f'<svg:svg {PAGE}><svg:rect width="5" height="4"/></svg:svg>'.encode(),
    "undeclared words": f'<svg {NS} {PAGE} q:r="1"><metadata><rdf:R/></metadata><q:x>{RECT}</q:x>{RECT}</svg>'.encode(),
}


@pytest.mark.parametrize("way", READABLE)
def test_what_a_strict_parser_stops_at_is_read_where_it_is_sure(way: str) -> None:
    drawing = read_svg(READABLE[way])
    assert size_of(drawing.part) == (5, 4) and len(drawing.part.entities) == 4 and not drawing.findings


def test_undeclared_prefixes_of_inkscape_are_its_own() -> None:
    layer = '<g inkscape:groupmode="layer" inkscape:label="Cut">'
    (named,) = read_svg(f"<svg {NS} {PAGE}>{layer}{RECT}</g></svg>".encode()).part.layers
    assert named.name == "Cut"


def test_lines_keep_their_numbers() -> None:
    data = f'\n\n<?xml version="1.0" encoding="Shift_JIS"?>\n<svg {NS} {PAGE}>\n{RECT}<rect height="x"/></svg>'
    (found,) = read_svg(data.encode("cp932")).findings
    assert "in line 5" in found.text


def test_a_prefix_that_cannot_be_declared_is_refused_in_one_line() -> None:
    with pytest.raises(InputError, match=r"x.svg:1: the XML is damaged, column \d+: unbound prefix"):
        read_svg(b"<a:b/>", "x.svg")


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("Layer_x0020_1", "Layer 1"),
        ("a_x5F_b", "a_b"),
        ("_x7DDA_", "線"),
        ("a_x1_b", "a_x1_b"),
        ("_xD83D__xDE00_", "\U0001f600"),
        ("_xD83D_", "_xD83D_"),
        ("a_x07_b", "a_x07_b"),
    ],
)
def test_encoded_names_of_layers_are_as_they_were_typed(name: str, meant: str) -> None:
    (layer,) = read_svg(f'<svg {NS} {PAGE}><g id="{name}">{RECT}</g></svg>'.encode()).part.layers
    assert layer.name == meant


@pytest.mark.parametrize("name", ["L_x0020_1", "l_x0020_1", "L 1", "l 1"])
def test_a_layer_is_found_as_the_file_has_it_and_as_it_was_typed(name: str) -> None:
    data = f'<svg {NS} {PAGE}><g id="L_x0020_1">{RECT}</g><g id="other"><circle r="1"/></g></svg>'.encode()

    def layers(asked: tuple[str, ...], **how: Any) -> list[str]:
        return [each.layer for each in read_drawing("x.svg", data, None, asked, DrawingOptions(**how)).part.entities]

    assert set(layers((name,))) == set(layers((name,), to_zero=True)) == {"L 1"}
    assert layers((), without_layers=(name,)) == ["other"]


def test_a_layer_whose_name_only_looks_encoded_is_itself() -> None:
    groups = "".join(f'<g data-name="{name}">{RECT}</g>' for name in ("a_x0020_b", "a b"))
    data = f"<svg {NS} {PAGE}>{groups}</svg>".encode()
    for name in ("a_x0020_b", "a b"):
        assert {each.layer for each in read_drawing("x.svg", data, None, (name,)).part.entities} == {name}


@pytest.mark.parametrize(
    ("page", "wide"),
    [
        ('style="width:10mm;height:10mm"', 5.0),
        ('width="100" height="100" style="width:1cm;height:1cm"', 5.0),
        ('width="10mm" height="10mm" style="width:400px;height:auto"', 5.0),
        ('width="10mm" height="10mm" style="width:100%;height:100vh"', 5.0),
        ('width="96" height="96" style="width:400px;height:50vh"', 12.7),
    ],
)
def test_a_page_is_as_large_as_attributes_or_style_sheets_say_in_real_units(page: str, wide: float) -> None:
    drawing = read_svg(f'<svg {NS} viewBox="0 0 10 10" {page}>{RECT}</svg>'.encode())
    assert size_of(drawing.part)[0] == pytest.approx(wide) and drawing.units_named is ("mm" in page or "cm" in page)


def test_a_style_sheet_in_the_words_of_xhtml_counts() -> None:
    sheet = '<style xmlns="http://www.w3.org/1999/xhtml">circle{display:none}</style>'
    drawing = read_svg(f'<svg {NS} {PAGE}>{sheet}{RECT}<circle r="3"/></svg>'.encode())
    assert len(drawing.part.entities) == 4 and dict(drawing.left_out) == {"circle (invisible)": 1}


@pytest.mark.parametrize(
    ("said", "counts"),
    [
        ('rel="stylesheet" href="a.css"', True),
        ('rel="icon" href="a.css"', False),
        ('rel="stylesheet" href="https://fonts.googleapis.com/css2?family=Roboto"', False),
    ],
)
def test_a_linked_style_sheet_is_told(said: str, counts: bool) -> None:
    link = f'<link xmlns="http://www.w3.org/1999/xhtml" {said}/>'
    found = read_svg(f"<svg {NS} {PAGE}>{link}{RECT}</svg>".encode()).findings
    assert [each.counts for each in found] == [True] * counts


@pytest.mark.parametrize(
    "sheet",
    [
        "g{ circle{display:none} }",
        "g{fill:red; circle{x:y;display:none} stroke:blue}",
        "a, g{ > circle, b{display:none}}",
        "circle{ .k &amp;{display:none}}",
        "g{ &amp;.k{ circle{display:none}}}",
        "g{@media screen{circle{display:none}}}",
        "@media screen{g{circle{display:none}}}",
    ],
)
def test_rules_within_rules_are_followed(sheet: str) -> None:
    body = f'<style>{sheet}</style><g class="k"><circle r="3"/></g>{RECT}'
    drawing = read_svg(f"<svg {NS} {PAGE}>{body}</svg>".encode())
    assert len(drawing.part.entities) == 4 and dict(drawing.left_out) == {"circle (invisible)": 1}


@pytest.mark.parametrize(
    "sheet",
    ["g{@media print{circle{display:none}}}", "@supports not (x:y){circle{display:none}}", "g{a{display:none}}"],
)
def test_rules_that_hold_for_nothing_here_hide_nothing(sheet: str) -> None:
    body = f'<style>{sheet}</style><g class="k"><circle r="3"/></g>{RECT}'
    drawing = read_svg(f"<svg {NS} {PAGE}>{body}</svg>".encode())
    assert len(drawing.part.entities) == 5 and not drawing.findings


def test_rules_that_are_nested_too_deep_or_too_often_are_told_and_take_no_time() -> None:
    names = ",".join("abcdefghij")
    many = "&amp;" * 100
    for sheet in (
        f"{names}{{" * 9 + "display:none" + "}" * 9,
        "g{" * 40 + "display:none" + "}" * 40,
        f"{names}{{" * 3 + "&amp;{fill:red}" * 240 + "}" * 3,
        f"g{{{many}{{{many}{{{many}{{display:none}}}}}}}}",
    ):
        found = read_svg(f"<svg {NS} {PAGE}><style>{sheet}</style>{RECT}</svg>".encode()).findings
        assert [each.counts for each in found] == [True]


@pytest.mark.parametrize("sheet", [":is(rect,circle){ .a{display:none}}", "g{:is(rect,circle){display:none}}"])
def test_commas_within_brackets_part_no_selectors(sheet: str) -> None:
    (found,) = read_svg(f"<svg {NS} {PAGE}><style>{sheet}</style>{RECT}</svg>".encode()).findings
    assert found.counts and found.text.startswith("1 rule ") and ":is(rect,circle)" in found.text


def test_a_comma_within_quotes_parts_no_selector() -> None:
    body = f'<style>[id="a,b"]{{display:none}}</style><circle id="a,b" r="3"/>{RECT}'
    drawing = read_svg(f"<svg {NS} {PAGE}>{body}</svg>".encode())
    assert len(drawing.part.entities) == 4 and not [each for each in drawing.findings if each.counts]


@pytest.mark.parametrize("hidden", ['opacity="-1"', 'style="opacity:-.5"', 'requiredExtensions="http://x.y"'])
def test_what_no_viewer_shows_is_not_read(hidden: str) -> None:
    drawing = read_svg(f'<svg {NS} {PAGE}><g {hidden}><circle r="3"/></g>{RECT}</svg>'.encode())
    assert len(drawing.part.entities) == 4 and sum(count for _, count in drawing.left_out) == 1


@pytest.mark.parametrize(
    ("paint", "curves"),
    [
        ("url(#gone)", 4),
        ("url('#gone') none", 4),
        ("url(#gone) #f00", 5),
        ("url(#here)", 5),
        ("url( &quot;#here&quot; ) none", 5),
    ],
)
def test_a_shade_that_is_not_in_the_file_paints_nothing_or_what_stands_behind_it(paint: str, curves: int) -> None:
    shade = '<linearGradient id="here"><stop offset="0"/></linearGradient>'
    body = f'{shade}<g fill="{paint}"><circle r="3"/></g>{RECT}'
    assert len(read_svg(f"<svg {NS} {PAGE}>{body}</svg>".encode()).part.entities) == curves
