"""The sheet in Japanese: all that the program says on it, names and one's own words as they are, on the paper too."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from html import unescape
from itertools import pairwise
from pathlib import Path

import pytest

from app.core.resources import resource
from app.formats.job.toml import read_job
from app.formats.plot.page import TextLine
from app.formats.plot.pdf_fonts import has_letters
from app.formats.plot.pdf_text import is_wide, runs_of, text_width, wrapped
from app.formats.readers import read_drawing
from app.formats.sheet.content import SetupSheet
from app.formats.sheet.layout import MARGIN, WIDTH, sheet_pages
from app.formats.sheet.write import sheet_bytes, translated
from app.model.contour_operation import ContourOperation
from app.model.entry import Tabs
from app.model.job import Job, Stock
from app.model.operation import CutParameters, PocketOperation
from app.model.tool import Tool
from app.usecases.cutting.cut import cut
from app.usecases.cutting.ready_setup import SetupRequest, setup_of
from app.usecases.cutting.report import cut_report
from app.usecases.cutting.setup_tools import ToolSource
from app.usecases.examine import ExamineOptions, examine
from app.usecases.making.make import export
from app.usecases.sheet.made import made_sheet
from app.usecases.sheet.program import SheetCut, SheetNotes, program_sheet
from tests.formats.pdf_words import pdf_pages

ENGLISH = re.compile(r"[A-Za-z]{2,} [a-z]{2,}|\b(?:the|of|with|Flat|Min|Tool)\b")
NOTE = "Two vices; jaws 8 mm high, clean."
CLAMPED = "rect 0,0 120,80\ncircle 20,20 2.5\ncircle 60,40 15\nlayer clamps\nrect 0,70 20,80\n"
FOREIGN = "G21 G90 G94\nT7 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X30 F300\nG0 Z5\nM30\n"


def of_sample(drawing: str, job: str) -> SetupSheet:
    part = read_drawing(drawing, resource("samples", drawing).read_bytes()).part
    read = read_job(job, resource("samples", job).read_bytes())
    return made_sheet(export(replace(read.job, part=part)), Path("a.ngc"), {f"Drawing: {drawing}": b""})


def clamped() -> SetupSheet:
    """Clamps, tabs, cuts through, findings that count, and somebody's own words."""
    tools = (Tool(1, 6.0), Tool(2, 3.0))
    operations = (
        PocketOperation(CutParameters(1, depth=10)),
        ContourOperation(CutParameters(2, depth=10), tabs=Tabs(3)),
    )
    stock = Stock(thickness=10, material="brass")
    job = Job(read_drawing("plate.draw", CLAMPED.encode()).part, tools=tools, operations=operations, stock=stock)
    job = replace(job, keep_out_layers=("clamps",), keep_out_height=8.0, clamping_note=NOTE, zero_note="左下を測る")
    return made_sheet(export(job), Path("a.ngc"), {"Drawing: plate.draw": b""})


def foreign(tool: bool) -> SetupSheet:
    examined = (examine("other.nc", FOREIGN.encode(), ExamineOptions()),)
    if not tool:
        return program_sheet(examined, {"Program: other.nc": b""}, None, "", SheetNotes(clamping=NOTE))
    ready = setup_of(examined, SetupRequest((ToolSource("--tool", {7: Tool(7, 4.0)}),)))
    done = cut(ready.setup)
    return program_sheet(examined, {"Program: other.nc": b""}, SheetCut(ready, done, cut_report(done, ready)))


SHEETS: dict[str, Callable[[], SetupSheet]] = {
    "holes": lambda: of_sample("holes.draw", "holes.toml"),
    "clamps": clamped,
    "read": lambda: foreign(tool=False),
    "cut": lambda: foreign(tool=True),
}


def said(page: str) -> list[str]:
    """What stands on a page for browsers, without the picture's numbers."""
    body = re.sub(r"<svg.*?</svg>", "", page.split("<body>")[1], flags=re.DOTALL)
    return [unescape(text).strip() for text in re.findall(r">([^<>]+)<", body) if text.strip()]


@pytest.mark.parametrize("which", SHEETS)
def test_no_english_is_left_but_names_and_own_words(which: str) -> None:
    sheet = SHEETS[which]()
    page = sheet_bytes(sheet, ".html", "ja").decode()
    assert '<html lang="ja">' in page and "段取り票" in page
    left = [text for text in said(page) if ENGLISH.search(text.replace(NOTE, "").replace("--write-job", ""))]
    assert left == []
    if which in ("clamps", "read"):
        assert any(text.startswith(NOTE) for text in said(page))


def test_names_and_figures_are_the_same_in_both_languages() -> None:
    sheet = clamped()
    other = translated(sheet, "ja")
    assert other.language == "ja"
    assert [other.title, other.good, other.made_by] == [sheet.title, sheet.good, sheet.made_by]
    assert [each.sha256 for each in other.hashes] == [each.sha256 for each in sheet.hashes]
    for one, two in zip(sheet.proofs, other.proofs, strict=True):
        assert sorted(re.findall(r"\d[\d.]*\d", one.bound)) == sorted(re.findall(r"\d[\d.]*\d", two.bound))
    assert translated(sheet, "en") is sheet


def test_everything_on_its_paper_lies_between_the_margins() -> None:
    for page in sheet_pages(translated(clamped(), "ja")):
        for words in page.frame.words:
            if not words.angle:
                left = words.at[0] - words.anchor * text_width(words.text, words.height, words.bold)
                right = left + text_width(words.text, words.height, words.bold)
                assert left >= MARGIN - 0.1 and right <= WIDTH - MARGIN + 0.1, words.text


def test_the_legend_stays_in_its_frame() -> None:
    """Four kinds of line beside a picture that is drawn small."""
    sheet = clamped()
    page = sheet_pages(translated(sheet, "ja"))[0]
    words = {word for word, _ in translated(sheet, "ja").picture.legend}
    found = [each for each in page.frame.words if each.text in words and each.at[1] < page.window[1]]
    assert page.window[2] < MARGIN + 90 and len(found) >= 4
    ends = [each.at[0] + text_width(each.text, each.height) for each in found if each.at[0] < page.window[2]]
    assert len(ends) == 4 and max(ends) <= page.window[2]


def test_signs_of_japanese_fill_their_squares_between_other_letters() -> None:
    words = TextLine("深さ 3 mm、直径", (10.0, 20.0), 4.0)
    runs = list(runs_of(words))
    assert [run.text for run in runs] == ["深さ", " 3 mm", "、直径"]
    for one, two in pairwise(runs):
        assert two.at[0] == pytest.approx(one.at[0] + text_width(one.text, 4.0))


def test_paper_in_japanese_is_small_and_its_words_can_be_searched() -> None:
    sheet = clamped()
    if not has_letters(translated(sheet, "ja").verdict):
        pytest.skip("no font is installed here that has these letters")
    data = sheet_bytes(sheet, ".pdf", "ja")
    assert len(data) < 100_000 and data == sheet_bytes(sheet, ".pdf", "ja")
    for page, read in zip(sheet_pages(translated(sheet, "ja")), pdf_pages(data), strict=True):
        meant = [run for words in page.frame.words for run in runs_of(words)]
        assert [(word.text, word.bold) for word in read] == [(run.text, run.bold) for run in meant]
        for word, run in zip(read, meant, strict=True):
            if is_wide(run.text):
                assert word.size == pytest.approx(run.height, rel=0.02)  # a sign fills its square


def test_japanese_is_broken_between_signs_as_its_rules_have_it() -> None:
    text = "工具は、そのまま 12.5 mm 下まで「深さ」進みます。"
    for room in range(12, 60):
        lines = wrapped(text, 3.0, float(room))
        assert "".join(lines).replace(" ", "") == text.replace(" ", "")
        assert all(text_width(line, 3.0) <= room for line in lines)
        assert not any(line[0] in "、。」" for line in lines)
        assert not any(line.endswith("「") for line in lines)
        assert any("12.5 mm" in line for line in lines)
