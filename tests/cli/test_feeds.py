"""`hitofude feeds`, and the feeds that `make` proposes: printed, reported, kept in a library, asked for by a job."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.main import main
from app.formats.tools.library import read_library

ROOT = Path(__file__).parents[2]
PLATE = ROOT / "resources/samples/plate.draw"


def test_a_tool_its_reasons_and_the_library_that_keeps_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    told = ["feeds", "--material", "aluminium", "--tool", "flat:6", "--flutes", "3", "--edges", "carbide"]
    out, report = tmp_path / "mine.toml", tmp_path / "r.json"
    assert main([*told, "--engaged", "30", "--machine", "vmc", "--write", str(out), "--report", str(report)]) == 0
    shown = capsys.readouterr().out
    assert "1000 x 250 / (pi x 6) = 13263 rpm, but Vertical machining centre turns at 50 to 10000" in shown
    assert "1 / sin = 2: 0.096 mm" in shown
    (tool,) = read_library(out.name, out.read_bytes()).tools
    assert (tool.spindle_speed, tool.feed_rate) == (10000.0, 2880.0)
    assert (tool.feeds[0].material, tool.feeds[0].surface_speed) == ("aluminium", 250.0)
    (values,) = json.loads(report.read_text())["tools"]
    assert values["feed_per_tooth_mm"] == pytest.approx(0.096)
    assert {why["of"] for why in values["reasons"]} >= {"spindle_speed", "feed_rate", "power"}
    out.write_text(out.read_text().replace("feed_per_tooth = 0.048", "feed_per_tooth = 0.05"))
    assert main(["feeds", "--material", "aluminium", "--tools", str(out)]) == 0
    assert "the tool's own row" in capsys.readouterr().out


def test_chips_that_rub_count(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["feeds", "--material", "mild steel", "--tool", "flat:1", "--stick-out", "30", "--depth", "2"]) == 1
    assert "rub" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--tool", "flat:6"], "hitofude: --material is missing"),
        (["--material", "cheese", "--tool", "flat:6"], "'cheese' is no material"),
        (["--material", "brass"], "hitofude: --tool or --tools is missing; name"),
        (["--material", "brass", "--tool", "flat:6", "--engaged", "0"], "0 degrees"),
        (["--material", "brass", "--tool", "flat:6", "--flutes", "0"], "no number of flutes"),
        (["--material", "brass", "--tools", "x.toml", "--flutes", "2"], "--flutes has no effect with --tools"),
    ],
)
def test_what_is_wrong_is_told_in_one_line(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["feeds", *arguments]) == 2
    shown = capsys.readouterr()
    assert (shown.out, shown.err.count("\n")) == ("", 1)
    assert words in shown.err


def test_make_proposes_feeds_and_a_job_file_asks_for_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    job, first, second = tmp_path / "job.toml", tmp_path / "a.ngc", tmp_path / "b.ngc"
    kept, report = tmp_path / "kept.toml", tmp_path / "r.json"
    common = [str(PLATE), "--machine", "bench_mill", "--quiet"]
    told = ["--material", "aluminium", "--feeds", "proposed", "--report", str(report), "--write-job", str(kept)]
    assert main(["make", *common, "-o", str(first), *told]) in (0, 1)
    assert json.loads(report.read_text())["feeds"]["material"] == "aluminium"
    text = first.read_text()
    assert "S5000 M3" in text, "250 m/min ask for more than the bench mill turns"
    assert "F480" in text, "5000 rpm x 2 x 0.048 mm"
    assert 'material = "aluminium"' in kept.read_text()
    job.write_text('[stock]\nmaterial = "aluminium"\nfeeds = "proposed"\n')
    assert main(["make", *common, "-o", str(second), "--job", str(job)]) in (0, 1)
    assert [line for line in text.splitlines() if line[:1] in "GSF"] == [
        line for line in second.read_text().splitlines() if line[:1] in "GSF"
    ]
    assert main(["make", *common, "-o", str(second), "--job", str(job), "--feed", "300"]) in (0, 1)
    assert "F300" in second.read_text()
    assert "F480" not in second.read_text()
    assert main(["make", *common, "-o", str(second), "--job", str(job), "--feeds", "tools"]) in (0, 1)
    assert "F600" in second.read_text()
    capsys.readouterr()
    assert main(["make", str(PLATE), "-o", str(second), "--feeds", "proposed"]) == 2
    assert "--material NAME" in capsys.readouterr().err
    job.write_text('[stock]\nfeeds = "proposed"\n')
    assert main(["make", str(PLATE), "-o", str(second), "--job", str(job)]) == 2
    assert "job.toml:2: feeds needs a material" in capsys.readouterr().err
