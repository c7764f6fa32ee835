"""The sheet says what was computed and proven, in figures of the report, and everything on it is on the paper."""

from __future__ import annotations

import hashlib
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from app.formats.job.toml import read_job
from app.formats.job.write import job_lines
from app.formats.plot.pdf_text import text_width, wrapped
from app.formats.readers import read_drawing
from app.formats.sheet.content import SetupPicture, SetupSheet, SheetColumn, SheetFact, SheetProof, SheetTable
from app.formats.sheet.layout import HEIGHT, MARGIN, WIDTH
from app.formats.sheet.write import sheet_bytes
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import read_selectors
from app.model.finding import Finding, FindingKind
from app.model.hole_operations import DrillOperation, TapOperation
from app.model.job import Job, OriginXY, OriginZ, Stock
from app.model.operation import CutParameters, PocketOperation, Side
from app.model.thread_sizes import ThreadSize
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.usecases.making.make import MakeResult, export
from app.usecases.sheet.common import offset_fact
from app.usecases.sheet.made import made_sheet
from tests.formats.pdf_words import pdf_pages

HOLDER = ((0.0, 14.0), (20.0, 14.0))


@pytest.fixture(scope="module")
def job() -> Job:
    part = read_drawing("plate.draw", b"rect 0,0 60,40\ncircle 30,20 8\n").part
    tools = (Tool(1, 6.0, name="Roughing mill", stick_out=25.0, holder=HOLDER), Tool(2, 3.0, feed_rate=350.0))
    pocket = PocketOperation(CutParameters(tool=1, depth=3, stepdown=1.5))
    contour = ContourOperation(CutParameters(tool=2, depth=3))
    return Job(part, tools=tools, operations=(pocket, contour), stock=Stock(margin=5.0, thickness=12.0))


@pytest.fixture(scope="module")
def made(job: Job) -> MakeResult:
    return export(job)


@pytest.fixture(scope="module")
def sheet(made: MakeResult) -> SetupSheet:
    return made_sheet(made, Path("plate.ngc"), {"Drawing: plate": b"some bytes"})


def cells(sheet: SetupSheet, table: int, column: str) -> list[str]:
    found = sheet.tables[table]
    at = [each.title for each in found.columns].index(column)
    return [row[at] for row in found.rows]


def test_it_says_how_the_stock_lies(sheet: SetupSheet) -> None:
    facts = {fact.label: fact.text for fact in sheet.facts}
    assert facts["Stock"] == "70 x 50 x 12 mm"
    assert facts["Zero X Y"] == "the drawing's zero: 5 mm right of and 5 mm above the stock's lower left corner"
    assert facts["Zero Z"] == "top of the stock"
    assert facts["Work offset"] == "G54"
    assert [word for word, _ in sheet.picture.legend] == ["Part", "Clearing", "Along walls"]
    assert "Deepest cut 3 mm below Z 0; jaws may reach up to 9 mm above the underside" in facts["Clamping"]
    assert sheet.picture.stock == (-5.0, -5.0, 65.0, 45.0) and sheet.picture.zero == (0.0, 0.0)


def test_zeros_elsewhere_and_cuts_through(job: Job) -> None:
    through = ContourOperation(CutParameters(tool=2, depth=12, stepdown=6), side=Side.OUTSIDE)
    other = replace(job, operations=(through,), origin_xy=OriginXY.CENTRE, origin_z=OriginZ.BOTTOM)
    facts = {fact.label: fact.text for fact in made_sheet(export(other), Path("a.ngc"), {}).facts}
    assert facts["Zero X Y"].startswith("centre of the stock: 35 mm right of and 25 mm above")
    assert facts["Zero Z"] == "underside of the stock"
    assert "Cuts reach the underside: put waste under it" in facts["Clamping"]
    assert "No tab holds what is cut out" in facts["Clamping"]


def test_who_runs_it_is_told_of_what_and_how_many_holes(job: Job) -> None:
    part = read_drawing("plate.draw", b"rect 0,0 60,40\ncircle 10,20 2.5\ncircle 40,20 2.5\n").part
    hole, tap = CutParameters(1, depth=6, curves=read_selectors("circles:5")), Tool(2, 6.0, ToolKind.TAP)
    drills = (DrillOperation(hole, peck=2.0), TapOperation(replace(hole, tool=2), thread=ThreadSize.M6))
    drilled = replace(
        job,
        part=part,
        tools=(Tool(1, 5.0, ToolKind.DRILL), tap),
        operations=drills,
        stock=replace(job.stock, material="brass"),
    )
    sheet = made_sheet(export(drilled), Path("a.ngc"), {})
    facts = {fact.label: fact.text for fact in sheet.facts}
    assert facts["Stock"] == "70 x 50 x 12 mm, brass"
    assert cells(sheet, 1, "Operation") == ["Drill, 2 holes, curves circles:5", "Tap M6, 2 holes, curves circles:5"]
    assert [word for word, _ in sheet.picture.legend] == ["Part"], "nothing else is seen from above"


@pytest.mark.parametrize(
    ("text", "told"),
    [("N10 g054\n(G55)\nG59.1 ; G56\n", "G54 and G59.1"), ("G540 G5.4\n", "the program chooses none")],
)
def test_work_offsets_are_those_of_the_code_and_not_of_its_comments(text: str, told: str) -> None:
    assert offset_fact([text]).text.startswith(told)


def test_its_figures_are_those_of_the_report(sheet: SetupSheet, made: MakeResult) -> None:
    assert cells(sheet, 0, "T") == ["1", "2"]
    assert cells(sheet, 0, "Stick-out mm") == ["25", "> 3"]
    assert cells(sheet, 0, "Holder") == ["Ø 28 x 20 mm", "not given"]
    assert cells(sheet, 1, "Operation") == ["Pocket", "Contour"]
    assert cells(sheet, 1, "Depth mm") == ["3", "3"] and cells(sheet, 1, "Stepdown") == ["1.5", "2"]
    assert cells(sheet, 1, "Feeds mm/min") == ["200 to 600", "200 to 350"] == cells(sheet, 0, "Feeds mm/min")
    seconds = round(made.report.data["time_s"])
    assert sheet.tables[1].total[-1] == f"{seconds // 60}:{seconds % 60:02d}"
    assert cells(sheet, 1, "Min") == [
        f"{round(each['time_s']) // 60}:{round(each['time_s']) % 60:02d}" for each in made.report.data["operations"]
    ]


def test_the_certificate_is_about_these_files(sheet: SetupSheet, made: MakeResult) -> None:
    hashes = {each.what: each.sha256 for each in sheet.hashes}
    assert hashes["Drawing: plate"] == hashlib.sha256(b"some bytes").hexdigest()
    assert hashes["Program: plate.ngc"] == hashlib.sha256(made.nc.text.encode()).hexdigest()
    assert {proof.claim: proof.holds for proof in sheet.proofs} == {
        "No gouge": True,
        "Nothing left within reach": True,
        "No rapid in metal": True,
        "The file is the path": True,
        "Cut, it is the part": True,
        "Shank and holder keep clear": None,  # T2 has none
    }
    assert sheet.good and sheet.verdict.startswith("Proven")


@pytest.mark.parametrize(
    ("places", "told"),
    [
        (0, "nothing is out of reach"),
        (1, "2.655 mm² in 1 place are out of reach of every tool"),
        (11, "2.655 mm² in 11 places are out of reach of every tool"),
    ],
)
def test_what_no_tool_reaches_is_said_in_words(made: MakeResult, places: int, told: str) -> None:
    left = {**made.report.data["left"], "out_of_reach_places": places, "unreachable_mm2": 2.655 * bool(places)}
    report = replace(made.report, data={**made.report.data, "left": left})
    sheet = made_sheet(replace(made, report=report), Path("plate.ngc"), {})
    assert next(each.bound for each in sheet.proofs if each.claim == "Nothing left within reach").endswith(f"; {told}")


def test_what_does_harm_is_said_in_red(job: Job) -> None:
    wide = replace(job, tools=(replace(job.tools[0], diameter=30.0), job.tools[1]))
    sheet = made_sheet(export(wide), Path("a.ngc"), {})
    assert not sheet.good and "do not run this program" in sheet.verdict
    assert sheet.findings and any(proof.holds is False for proof in sheet.proofs)


@pytest.mark.parametrize(
    ("kind", "claim"),
    [
        (FindingKind.GOUGE, "No gouge"),
        (FindingKind.GOUGE, "Cut, it is the part"),
        (FindingKind.LEFT_REACHABLE, "Nothing left within reach"),
        (FindingKind.RAPID_IN_MATERIAL, "No rapid in metal"),
        (FindingKind.HOLDER_CONTACT, "Shank and holder keep clear"),
        (FindingKind.PLUNGE, "Nothing else counts"),
    ],
)
def test_a_claim_that_a_finding_gives_the_lie_to_does_not_hold(made: MakeResult, kind: FindingKind, claim: str) -> None:
    harmed = replace(made, findings=(Finding(kind, "It does harm."), *made.findings))
    sheet = made_sheet(harmed, Path("a.ngc"), {})
    assert {proof.claim: proof.holds for proof in sheet.proofs}[claim] is False
    assert not sheet.good and sheet.findings == ("It does harm.",)


def test_everything_is_on_the_paper(sheet: SetupSheet) -> None:
    pages = pdf_pages(sheet_bytes(sheet, ".pdf"))
    assert len(pages) == 1
    said = " ".join(word.text for word in pages[0])
    for text in (
        sheet.title,
        sheet.verdict,
        *(proof.claim for proof in sheet.proofs),
        *(h.sha256 for h in sheet.hashes),
    ):
        assert text in said
    for fact in sheet.facts:
        assert all(word in said for word in fact.text.split())
    for word in pages[0]:
        right = word.x + text_width(word.text, word.size, word.bold)
        assert word.x >= MARGIN - 0.1 and right <= WIDTH - MARGIN + 0.1, word
        assert 5 < word.y < HEIGHT - MARGIN


def lines_of(words: list) -> list[tuple[float, float, float]]:
    return [(word.y, word.x, word.x + text_width(word.text, word.size, word.bold)) for word in words]


def test_no_text_lies_on_another(sheet: SetupSheet) -> None:
    lines = sorted(lines_of(pdf_pages(sheet_bytes(sheet, ".pdf"))[0]))
    for number, (y, left, right) in enumerate(lines):
        for other, a, b in lines[number + 1 :]:
            assert other - y > 2.0 or b <= left or right <= a or y < 9 or (left > 12 and right < 121 and y > 160)


def test_nine_tools_stand_on_one_page(sheet: SetupSheet) -> None:
    """Everything stands closer where that saves the second page; nothing lies on another, and no sheet is squeezed for
    nothing.
    """
    tools, operations = (replace(table, rows=tuple(table.rows[k % 2] for k in range(9))) for table in sheet.tables)
    many = replace(sheet, tables=(tools, operations), remarks=("A remark of one line that says something.",))
    (page,) = pdf_pages(sheet_bytes(many, ".pdf"))
    assert [word.text for word in page].count("Roughing mill") == 5
    assert min(word.y for word in page if word.y > 9) > 10
    lines = sorted(lines_of(page))
    for number, (y, left, right) in enumerate(lines):
        for other, a, b in lines[number + 1 :]:
            assert other - y > 2.0 or b <= left or right <= a or y < 9 or (left > 12 and right < 121 and y > 160)
    sizes = {round(word.size, 2) for word in pdf_pages(sheet_bytes(sheet, ".pdf"))[0]}
    assert 3.0 in sizes and 3.0 not in {round(word.size, 2) for word in page}


def test_what_somebody_writes_of_clamping_and_zero_is_on_it(job: Job) -> None:
    noted = replace(job, clamping_note="Two vices, jaws 8 mm  high", zero_note="3D taster on the lower left corner")
    facts = {fact.label: fact.said for fact in made_sheet(export(noted), Path("a.ngc"), {}).facts}
    assert facts["Clamping"].startswith("Two vices, jaws 8 mm high. No clamp is drawn")
    assert facts["Setting the zero"] == "3D taster on the lower left corner."
    text = "\n".join(job_lines(noted))
    assert read_job("job.toml", text.encode()).job.clamping_note == noted.clamping_note
    assert '[sheet]\nclamping = "Two vices' in text


def test_long_tables_go_on_on_another_page(sheet: SetupSheet) -> None:
    columns = (SheetColumn("#", 0.1, True), SheetColumn("What", 0.9))
    table = SheetTable("Many", columns, tuple((str(k), f"row {k}") for k in range(150)))
    pages = pdf_pages(sheet_bytes(replace(sheet, tables=(table,)), ".pdf"))
    said = [word.text for page in pages for word in page]
    assert len(pages) > 2 and [text for text in said if text.startswith("row ")] == [f"row {k}" for k in range(150)]
    assert said.count("What") == sum(any(word.text.startswith("row ") for word in page) for page in pages)


def test_the_page_for_browsers_needs_no_other_file(sheet: SetupSheet) -> None:
    page = sheet_bytes(sheet, ".html").decode()
    assert not re.search(r"src=|<link|url\(|@import", page)
    open_tags: list[str] = []
    reader = HTMLParser()
    reader.handle_starttag = lambda tag, _: open_tags.append(tag)  # type: ignore[method-assign]
    reader.handle_startendtag = lambda tag, _: None  # type: ignore[method-assign]
    reader.handle_endtag = lambda tag: open_tags.remove(tag)  # type: ignore[method-assign]
    reader.feed(page)
    assert set(open_tags) == {"meta"}
    for text in (sheet.verdict, sheet.hashes[0].sha256, "prefers-color-scheme: dark", "size: A4"):
        assert text in page


def test_names_are_no_markup_and_other_scripts_are_drawn() -> None:
    picture = SetupPicture(None, None, ())
    facts, proofs = (SheetFact("a", "b"),), (SheetProof("c", "d", True),)
    sheet = SetupSheet("<b>段取り", "a & b", "Proven", True, picture, facts, (), proofs, (), (), (), "h")
    assert b"<b>" not in sheet_bytes(sheet, ".html").split(b"<body>")[1].split(b"</header>")[0]
    assert "a & b" in [word.text for word in pdf_pages(sheet_bytes(sheet, ".pdf"))[0]]


def test_lines_are_broken_where_they_fit() -> None:
    lines = wrapped("many words that do not fit into one line, and aVeryLongWordThatFitsIntoNone" * 2, 3.0, 40.0)
    assert all(text_width(line, 3.0) <= 40.0 for line in lines)
    assert "".join(lines).replace(" ", "") == "manywordsthatdonotfitintooneline,andaVeryLongWordThatFitsIntoNone" * 2
