"""`hitofude sheet` and `make --sheet`: the paper for the machine, of our own programs and of any other."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from app.cli.main import main
from app.core.resources import resource
from tests.formats.pdf_words import pdf_pages

OTHER = "G21 G90 G94\nT7 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X30 F300\nG2 X40 Y10 I0 J10\nG0 Z5\nM30\n"


def said(path: Path) -> str:
    return " ".join(word.text for page in pdf_pages(path.read_bytes()) for word in page)


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    path = tmp_path / "plate.draw"
    path.write_text("rect 0,0 30,20\n")
    return path


def test_a_program_that_was_made_has_its_sheet(drawing: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = drawing.parent
    command = ["make", str(drawing), "-o", str(folder / "a.nc"), "--post", "grbl", "--sheet", str(folder / "a.pdf")]
    assert main(command) == 0
    text = said(folder / "a.pdf")
    assert "a_1_T1.nc" in text and "a_2_T2.nc" in text and "Proven: no gouge" in text
    assert main([*command[:-1], str(folder / "a.doc")]) == 2
    assert "a sheet is .pdf or .html" in capsys.readouterr().err


def test_its_program_read_back_says_the_same(drawing: Path) -> None:
    folder = drawing.parent
    assert main(["make", str(drawing), "-o", str(folder / "a.ngc"), "--quiet"]) == 0
    command = ["sheet", str(folder / "a.ngc"), "--against", str(drawing), "-o", str(folder / "b.pdf"), "--grid", "128"]
    assert main([*command, "--quiet"]) == 0
    text = said(folder / "b.pdf")
    assert "30 x 20 x 10 mm" in text and "Proven: no gouge" in text and "Program, tool by tool" in text


def test_it_says_how_the_stock_is_held_as_somebody_has_written_it(drawing: Path) -> None:
    folder, notes = drawing.parent, ["--clamping", "Two vices", "--zero", "3D taster"]
    job = folder / "job.toml"
    made = [
        "make",
        str(drawing),
        "-o",
        str(folder / "a.ngc"),
        "--write-job",
        str(job),
        "--sheet",
        str(folder / "a.pdf"),
    ]
    assert main([*made, *notes, "--quiet"]) == 0
    command = ["sheet", str(folder / "a.ngc"), "--grid", "64", "--quiet"]
    assert main([*command, *notes, "-o", str(folder / "b.pdf")]) == 0
    assert main([*command, "--job", str(job), "-o", str(folder / "c.pdf")]) == 0
    for name in "abc":
        text = said(folder / f"{name}.pdf")
        assert "Two vices." in text and "Setting the zero 3D taster." in text


def test_any_other_program_says_what_nobody_knows(tmp_path: Path) -> None:
    program = tmp_path / "other.nc"
    program.write_text(OTHER)
    assert main(["sheet", str(program), "-o", str(tmp_path / "o.pdf"), "--quiet"]) == 0
    text = said(tmp_path / "o.pdf")
    assert "Not proven: the program was read, but not cut" in text and "T7" in text
    with_tool = ["sheet", str(program), "-o", str(tmp_path / "o.html"), "--tool", "7=flat:4", "--grid", "128"]
    assert main([*with_tool, "--quiet"]) == 0
    page = (tmp_path / "o.html").read_text()
    assert "compared with no part" in page and "no holder is given for T7" in page
    row = re.search(r"<tr><td class=\"number\">7</td>(.*?)</tr>", page)
    assert row is not None  # speeds and feeds are the program's, what it does not say is not made up
    assert re.findall(r">([^<>]+)</td>", row[1])[1:7] == ["4", "-", "&gt; 1", "not given", "9000", "100 to 300"]


def test_errors_of_the_text_are_on_it(tmp_path: Path) -> None:
    program = tmp_path / "bad.nc"
    program.write_text(OTHER.replace("G1 X30", "G1 X30 Q3 X31"))
    assert main(["sheet", str(program), "-o", str(tmp_path / "o.pdf"), "--quiet"]) == 1
    assert "do not run this program" in said(tmp_path / "o.pdf")


@pytest.mark.exhaustive
def test_a_browser_prints_it_on_one_page(tmp_path: Path) -> None:
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if browser is None:
        pytest.skip("no browser is installed here that prints")
    page, printed = tmp_path / "a.html", tmp_path / "a.pdf"
    command = ["make", str(resource("samples", "fig2.dxf")), "-o", str(tmp_path / "a.ngc"), "--sheet", str(page)]
    assert main([*command, "--quiet"]) == 0
    options = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        f"--user-data-dir={tmp_path}",
        f"--print-to-pdf={printed}",
    ]
    subprocess.run([browser, *options, page.as_uri()], check=True, capture_output=True, timeout=300)
    assert len(re.findall(rb"/Type\s*/Page\b", printed.read_bytes())) == 1
