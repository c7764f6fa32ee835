"""The report of a cut: whose motions are counted as what, where things are, and nothing where nobody has looked."""

from __future__ import annotations

import json
from typing import Any

import pytest

from app.model.finding import FindingKind
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.simulation.field.workpiece import BoxStock
from app.usecases.cutting.cut import CutOptions, cut
from app.usecases.cutting.ready_setup import SetupRequest, setup_of
from app.usecases.cutting.report import CutReport, cut_report
from app.usecases.cutting.setup_tools import ToolSource
from app.usecases.examine import ExamineOptions, examine

STOCK = BoxStock(StockBox(0.0, 0.0, -10.0, 60.0, 40.0, 0.0))
TOLD = (ToolSource("--tool", {1: Tool(1, 6.0), 2: Tool(2, 4.0)}),)
HEAD, FOOT = "G21 G90\nT1 M6\n", "G0 Z5\nM2\n"


def report(*bodies: str, cells: int = 240) -> CutReport:
    programs = tuple(
        examine(f"p{k}.ngc", f"{HEAD}{body}{FOOT}".encode(), ExamineOptions()) for k, body in enumerate(bodies, 1)
    )
    ready = setup_of(programs, SetupRequest(tools=TOLD, stock=STOCK))
    return cut_report(cut(ready.setup, CutOptions(cells)), ready)


def data(*bodies: str) -> dict[str, Any]:
    told = report(*bodies)
    assert json.loads(told.text()) == json.loads(json.dumps(told.data))
    return told.data


def test_feed_that_takes_metal_is_cut_and_other_feed_is_link() -> None:
    made = data("G0 Z5\nX10 Y10\nG1 Z1 F300\nX15\nZ-1\nX35\nZ1\nX40\n")
    assert made["length_mm"] == {"cut": 2 + 20, "link": 4 + 5 + 2 + 5, "rapid": 0 + 4}
    again = data("G0 Z5\nX10 Y10\nG1 Z-1 F300\nX30\nX10\n")
    assert again["length_mm"] == {"cut": 6 + 20, "link": 20, "rapid": 6}


@pytest.mark.parametrize(
    ("body", "strokes", "retracts"),
    [
        ("G0 Z5\nX10 Y10\nG1 Z-1 F300\nX30\nY20\n", 1, 1),
        ("G0 Z5\nX10 Y10\nG1 Z-1 F300\nX30\nG0 Z1\nY25\nG1 Z-1\nX10\n", 2, 2),
        ("G0 Z5\nX10 Y10\nG1 Z-1 F300\nX30\nG1 Z1\nY25\nZ-1\nX10\n", 2, 2),
        ("G0 Z5\nX10 Y10\nG1 Z-1 F300\nX30\nG0 X20\nG1 X10 Y20\n", 2, 1),
        ("G0 Z5\nX10 Y10\nG1 Z1 F300\nX30\n", 0, 0),
    ],
)
def test_strokes_and_retracts(body: str, strokes: int, retracts: int) -> None:
    made = data(body)
    assert (made["strokes"], made["retracts"]) == (strokes, retracts)


def test_where_no_part_is_nobody_has_looked() -> None:
    made = report("G0 Z5\nX10 Y10\nG1 Z-1 F300\nX30\n")
    assert [made.data[key] for key in ("gouge", "left", "certificate", "worst", "bands")] == [None, None, None, [], []]
    assert set(made.data["tolerance"]) == {"heights_mm", "heights", "pitch_mm"}
    assert "compared with no part (--against)" in made.summary()[0]
    assert "0.0000 mm gouge" not in "\n".join(made.summary())


def test_a_program_that_misses_the_stock_is_told() -> None:
    made = report("G0 Z5\nX110 Y10\nG1 Z-1 F300\nX130\n")
    assert (
        "nothing was removed: the motions at feed rate reach X 110.000 to 130.000, Y 10.000 to 10.000, Z -1.000 to "
        "5.000 mm, and the stock X 0.000 to 60.000, Y 0.000 to 40.000, Z -10.000 to 0.000 mm"
    ) in made.summary()[1]
    assert "nothing was removed" not in "\n".join(report("G0 Z5\nX10 Y10\nG1 Z-1 F300\n").summary())


def test_tools_share_what_was_removed() -> None:
    made = data("G0 Z5\nX10 Y10\nG1 Z-1 F300\nX30\nG0 Z5\nT2 M6\nG0 X10 Y30\nG1 Z-2\nX50\n")
    first, second = made["tools"]
    assert (first["number"], first["from"], second["number"]) == (1, "--tool", 2)
    assert first["removed_mm3"] + second["removed_mm3"] == pytest.approx(made["removed_mm3"], rel=1e-6)
    assert second["removed_mm3"] == pytest.approx(2 * (40 * 4 + 12.566), rel=0.02)
    assert (first["cut_mm"], second["cut_mm"]) == (26.0, 47.0)
    assert first["time_s"] + second["time_s"] == pytest.approx(made["time_s"])


def test_places_name_their_file_where_there_are_several() -> None:
    rapid = "G0 Z5\nX10 Y10\nZ-3\nG1 X30 F300\n"
    one = data(rapid)
    assert [set(hit) for hit in one["rapids_in_material"]] == [{"x", "y", "z", "line", "depth_mm", "cells"}]
    assert one["rapids_in_material"][0] | {"x": 0, "y": 0} == {
        "x": 0,
        "y": 0,
        "z": -3,
        "line": 5,
        "depth_mm": 3.0,
        "cells": one["rapids_in_material"][0]["cells"],
    }
    two = data("G0 Z5\nX10 Y30\nG1 Z-1 F300\nX30\n", rapid)
    assert [(hit["file"], hit["line"]) for hit in two["rapids_in_material"]] == [("p2.ngc", 5)]
    assert [each["file"] for each in two["programs"]] == ["p1.ngc", "p2.ngc"]


def test_findings_and_what_was_assumed() -> None:
    programs = (examine("p.ngc", f"{HEAD}G0 Z5\nX10 Y10\nG0 Z-1\nG1 X30 F300\n{FOOT}".encode(), ExamineOptions()),)
    ready = setup_of(programs, SetupRequest(tools=TOLD))
    made = cut_report(cut(ready.setup, CutOptions(120)), ready)
    assert made.data["assumed"] == [ready.findings[0].text]
    kinds = [finding["kind"] for finding in made.data["findings"]]
    assert kinds[-1] == FindingKind.ASSUMED.value
    assert FindingKind.RAPID_IN_MATERIAL.value in kinds
    assert made.data["stock"] == {"low": [7, 7, -1], "high": [33, 13, 0], "from": "round the cuts"}
