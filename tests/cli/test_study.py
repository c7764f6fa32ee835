"""`hitofude study`: every combination is a program as `make` or `smooth` writes it, in a table that ranks them."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from app.cli.main import main
from app.usecases.batch.study import StudyAxis, best_words, choices_of, ranked, study_html
from app.usecases.batch.task import BatchRow, BatchVerdict

PLATE = "rect 0,0 24,16\n"


def table(out: Path) -> list[dict[str, str]]:
    with (out / "study.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.exhaustive
def test_which_tool_tries_every_pair_that_fits(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "plate.draw").write_text(PLATE)
    (tmp_path / "tools.csv").write_text("number,diameter_mm,kind\n1,4,flat\n2,8,flat\n3,30,flat\n")
    out = tmp_path / "out"
    command = ["study", str(tmp_path / "plate.draw"), "-o", str(out), "--which-tool", "--depth", "1", "--jobs", "2"]
    command += ["--choose-from", str(tmp_path / "tools.csv")]
    assert main(command) == 0
    rows = table(out)
    assert [(row["pocket-tool"], row["contour-tool"]) for row in rows] == [("4", "4"), ("8", "4"), ("8", "8")]
    left = [float(row["left_mm2"]) for row in rows]
    assert left[0] == left[1] < left[2]
    for row in rows:  # what is told is what `make` writes with these tools, byte for byte
        alone = tmp_path / "alone.ngc"
        tools = ["--pocket-tool", row["pocket-tool"], "--contour-tool", row["contour-tool"]]
        assert main(["make", command[1], "-o", str(alone), *tools, "--depth", "1", "--quiet"]) == 0
        assert (out / row["outputs"]).read_bytes() == alone.read_bytes()
    told = capfd.readouterr()
    assert "out/study.html: 3 combinations\nLeast time: pocket-tool=8 contour-tool=8, " in told.out
    assert "Least left: pocket-tool=4 contour-tool=4, " in told.out
    stamps = {path: path.stat().st_mtime_ns for path in out.glob("*.ngc")}
    assert main(command) == 0 and {path: path.stat().st_mtime_ns for path in out.glob("*.ngc")} == stamps
    assert ": clean, " not in capfd.readouterr().err  # nothing was done again


def test_tolerances_against_time(tmp_path: Path) -> None:
    program, out = tmp_path / "wave.ngc", tmp_path / "out"
    lines = [f"G1 X{k / 2:.1f} Y{(k % 4) * 0.004:.4f}" for k in range(1, 40)]
    program.write_text(
        "\n".join(["G21 G90 G94", "T1 M6", "S9000 M3", "G0 X0 Y0 Z5", "G1 Z-1 F300", *lines, "G0 Z5", "M30\n"])
    )
    command = ["study", str(program), "-o", str(out), "--vary", "tolerance=0.005..0.025:0.01", "--jobs", "1", "--quiet"]
    assert main(command) == 0
    rows = table(out)
    assert [row["tolerance"] for row in rows] == ["0.005", "0.015", "0.025"]
    lengths = [len((out / row["outputs"]).read_bytes()) for row in rows]
    assert lengths[0] > lengths[-1] and '<svg class="plot"' in (out / "study.html").read_text()
    alone = tmp_path / "alone.ngc"
    main(["smooth", str(program), "-o", str(alone), "--tolerance", "0.015", "--quiet"])
    assert (out / rows[1]["outputs"]).read_bytes() == alone.read_bytes()


def test_rows_are_ranked_by_time_and_the_best_are_named() -> None:
    choices = choices_of((StudyAxis("pocket-tool", ("4", "6")), StudyAxis("stepover", ("30%", "50%"))))
    assert [choice.name for choice in choices][:2] == ["pocket-tool=4 stepover=30%", "pocket-tool=4 stepover=50%"]
    verdicts = (BatchVerdict.CLEAN, BatchVerdict.FINDINGS, BatchVerdict.REFUSED, BatchVerdict.CLEAN)
    told = ((90.0, 1.0), (30.0, 0.0), (None, None), (60.0, 7.0))
    rows = [
        BatchRow(choice.name, verdict, time_s=time, left_mm2=left)
        for choice, verdict, (time, left) in zip(choices, verdicts, told, strict=True)
    ]
    assert ranked(rows) == [3, 0, 1]
    assert best_words(choices, rows) == (
        "Least time: pocket-tool=6 stepover=50%, 1:00 min, 7.00 mm2 left. "
        "Least left: pocket-tool=4 stepover=30%, 1:30 min, 1.00 mm2 left."
    )
    page = study_html(choices, rows, [()] * 4, "Study").decode()
    assert page.count("<tr data-verdict") == 4 and page.index("1:00") < page.index("1:30") < page.index(
        "cannot be used</span>"
    )


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([], "Nothing is varied; say --vary OPTION=V1,V2,"),
        (["--vary", "pocket-tool="], "--vary pocket-tool: a value is missing"),
        (["--vary", "pocket-tool=4,4"], "--vary pocket-tool: a value is there twice"),
        (["--vary", "depth=1,2", "--vary", "depth=3"], "--vary depth is there twice"),
        (["--vary", "depth=0.001..9:0.001"], "'0.001..9:0.001' has 9000 values"),
        (["--vary", "depth=1..2:0"], "'1..2:0' is no range"),
        (["--vary", "depht=1,2"], "--vary depht: that is no option of make with a value"),
        (["--vary", "depth=1,deep"], "--depth"),
        (["--vary", "depth=1,2", "--choose-from", "a.csv"], "--choose-from has no effect without --which-tool"),
    ],
)
def test_what_cannot_be_studied_is_one_line(
    arguments: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plate.draw").write_text(PLATE)
    assert main(["study", "plate.draw", "-o", "out", *arguments]) == 2
    shown = capsys.readouterr().err
    assert told in shown and shown.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("values", "plotted"), [(("30%", "45%"), ">45%</text>"), (("1.5", "2"), ">2</text>"), (("30%", "2mm"), "")]
)
def test_one_number_that_is_varied_is_plotted_against_time(values: tuple[str, ...], plotted: str) -> None:
    choices = choices_of((StudyAxis("stepover", values),))
    rows = [BatchRow(choice.name, BatchVerdict.CLEAN, time_s=60.0 + at) for at, choice in enumerate(choices)]
    page = study_html(choices, rows, [(), ()], "Study").decode()
    assert ('<svg class="plot"' in page) == bool(plotted) and plotted in page
