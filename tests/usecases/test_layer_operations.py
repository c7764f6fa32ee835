"""Rules for layers: by name, by colour, with the depth that a layer's name tells; one template, many drawings."""

from __future__ import annotations

import io
import json
from pathlib import Path

import ezdxf
import pytest

from app.cli.main import main
from app.core.errors import InputError, ParameterError
from app.core.resources import resource
from app.formats.job.toml import JobFile, read_job
from app.model.contour_operation import ContourOperation
from app.model.hole_operations import DrillOperation
from app.model.layer_rules import LayerRule, depth_in
from app.model.operation import CutParameters, PocketOperation, Side
from app.model.part import Layer
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make

TEMPLATE = resource("samples", "layers.toml")
SQUARES = ("Pocket 4mm", "POCKET_2.5mm", "Marks", "Cut out", "Notes")


def drawing(layers: tuple[str, ...] = SQUARES, colours: dict[str, int] | None = None) -> bytes:
    """A DXF with a square of 30 mm on each layer, 50 mm apart."""
    document = ezdxf.new(units=ezdxf.units.MM)
    for k, name in enumerate(layers):
        document.layers.add(name, color=(colours or {}).get(name, 7))
        x = 50 * k
        corners = [(x, 0), (x + 30, 0), (x + 30, 30), (x, 30)]
        document.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": name})
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


def template(text: str = "") -> JobFile:
    return read_job("t.toml", text.encode() if text else TEMPLATE.read_bytes())


def made(data: bytes, file: JobFile) -> MakeResult:
    return make("part.dxf", data, MakeOptions(job=file.job, rules=file.rules))


@pytest.mark.parametrize(
    ("name", "depth"),
    [
        ("pocket 4mm", 4.0),
        ("POCKET_2.5mm", 2.5),
        ("Tasche 3,5 mm", 3.5),
        ("DEPTH_12", 12.0),
        ("z-3", 3.0),
        ("cut t=6.35", 6.35),
        ("↓4", 4.0),
        ("深さ5", 5.0),
        ("20mm holes deep 8", 8.0),
        ("depth 0.25in", 6.35),
        ("depth 12 d5", 12.0),
        ("layer 4", None),
        ("part2", None),
        ("depth 0", None),
        ("bit 3", None),
    ],
)
def test_the_depth_in_a_name(name: str, depth: float | None) -> None:
    assert depth_in(name) == (depth if depth is None else pytest.approx(depth))


def test_rules_take_layers_by_name_and_colour_in_any_case() -> None:
    pocket = PocketOperation(CutParameters(1))
    by_name, by_both = LayerRule(pocket, "POCKET*"), LayerRule(pocket, "pocket ?", "Red")
    assert by_name.takes(Layer("pocket 1")) and not by_name.takes(Layer("my pocket"))
    assert by_both.takes(Layer("Pocket 1", "#FF0000")) and not by_both.takes(Layer("Pocket 1", "#00ff00"))
    for wrong, words in (
        ({"name": " "}, "names no layer"),
        ({"colour": "reddish"}, "no colour"),
        ({}, "name or its colour"),
    ):
        with pytest.raises(ParameterError, match=words):
            LayerRule(pocket, **wrong)


@pytest.mark.parametrize(
    ("rule", "layer", "taken"),
    [
        ("A_x2A_", "A*", True),
        ("A_x2A_", "ABC", False),
        ("A_x3F_", "A?", True),
        ("A_x3F_", "AB", False),
        ("Cut_x5B_6mm_x5D_", "Cut[6mm]", True),
        ("Cut_x5B_6mm_x5D_", "Cut6", False),
        ("Cut[6mm]", "CUT[6mm]", True),
        ("Cut_x5B_*", "Cut[9mm]", True),
        ("L_x0020_*", "L 1", True),
        ("L_x0020_*", "l_x0020_1", True),
    ],
)
def test_letters_that_a_rule_writes_as_numbers_are_those_letters_alone(rule: str, layer: str, taken: bool) -> None:
    assert LayerRule(PocketOperation(CutParameters(1)), rule).takes(Layer(layer)) == taken


def test_a_template_makes_the_operations_of_a_drawing() -> None:
    result = made(drawing(colours={"Marks": 5}), template())
    own = result.job.operations
    assert [(type(each), each.cut.tool, each.cut.depth) for each in own] == [
        (PocketOperation, 1, 4.0),
        (PocketOperation, 1, 2.5),
        (ContourOperation, 2, 0.5),
        (ContourOperation, 1, 10.0),
    ]
    assert [each.cut.curves[0].text for each in own] == [
        "layer:Pocket 4mm",
        "layer:POCKET_2.5mm",
        "layer:Marks",
        "layer:Cut out",
    ]
    assert isinstance(own[2], ContourOperation) and own[2].side is Side.ON
    texts = [finding.text for finding in result.findings]
    assert "No rule takes the layer 'Notes'; nothing is done there." in texts
    assert any("rule for layers 'drill*' (drill) takes no layer" in text for text in texts)
    moves = result.program.moves
    for index, depth, low, high in ((0, 4.0, 0, 30), (1, 2.5, 50, 80), (3, 10.0, 150 - 7, 180 + 7)):
        mine = (moves.operation == index) & (moves.end[:, 2] < 0)
        assert moves.end[mine, 2].min() == pytest.approx(-depth)
        assert low <= moves.end[mine, 0].min() and moves.end[mine, 0].max() <= high


def test_the_same_template_serves_another_drawing() -> None:
    document = ezdxf.new(units=ezdxf.units.MM)
    for x in (10, 30):
        document.modelspace().add_circle((x, 10), 2.5, dxfattribs={"layer": "DRILL 5"})
    text = io.StringIO()
    document.write(text)
    result = made(text.getvalue().encode(), template())
    (drill,) = result.job.operations
    assert isinstance(drill, DrillOperation)
    assert result.job.operations[0].cut.depth == 8.0


def test_a_layer_that_tells_no_depth_counts() -> None:
    result = made(drawing(("pocket", "pocket 3mm")), template())
    (finding,) = (each for each in result.findings if "tell its depth" in each.text)
    assert finding.counts
    assert len(result.job.operations) == 1


def test_operations_of_the_file_come_first() -> None:
    text = (
        '[[tool]]\nnumber = 1\ndiameter = 6\n[[operation]]\nkind = "pocket"\ntool = 1\ncurves = ["layer:B"]\n'
        '[[layer]]\nname = "A"\nkind = "pocket"\ntool = 1\ndepth = 3\n'
    )
    result = made(drawing(("A", "B")), template(text))
    assert [each.cut.curves[0].text for each in result.job.operations] == ["layer:B", "layer:A"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[[layer]]\nname = "a"\nkind = "pocket"\n', r"j:1: tool is missing in this \[\[layer\]\]"),
        ('[[layer]]\nname = "a"\nkind = "pocket"\ntool = 1\ncurves = ["open"]\n', "j:5: curves has no effect"),
        ('[[layer]]\nname = "a"\nkind = "pocket"\ntool = 9\n', "j:1: The job has no tool T9"),
        ('[[layer]]\nname = "a"\nkind = "pocket"\ntool = 1\ndepth = "deep"\n', "j:5: depth is 'deep'"),
        ('[[layer]]\nkind = "pocket"\ntool = 1\n', "j:1: A rule is to have a layer's name or its colour"),
        ('[[layer]]\nname = 3\nkind = "pocket"\ntool = 1\n', "j:2: name is 3: it must be a text"),
        ("[layer]\n", "layer is a list of tables"),
    ],
)
def test_mistakes_name_the_line(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_job("j", text.encode())


def test_the_command_the_job_that_it_writes_and_what_it_refuses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "part.dxf").write_bytes(drawing())
    part, out, kept, report = (str(tmp_path / name) for name in ("part.dxf", "o.ngc", "kept.toml", "r.json"))
    told = ["make", part, "-o", out]
    assert main([*told, "--template", str(TEMPLATE), "--write-job", kept, "--report", report]) in (0, 1)
    assert "layer 'Pocket 4mm': pocket T1, 4 mm deep, as its name says" in capsys.readouterr().out
    assert len(json.loads(Path(report).read_text())["operations"]) == 3
    again = str(tmp_path / "again.ngc")
    assert main(["make", part, "-o", again, "--job", kept, "--quiet"]) in (0, 1)
    assert Path(again).read_text() == Path(out).read_text()
    for more, words in (
        (["--template", str(TEMPLATE), "--job", kept], "exclude one another"),
        (["--template", kept], r"has no [[layer]]"),
        (["--template", str(TEMPLATE), "--layer", "Notes"], "no rule of the template makes an operation"),
        (["--template", str(TEMPLATE), "--propose"], "--propose does not go with rules"),
        (["--template", str(TEMPLATE), "--bitmap", "64"], "no effect on pixels"),
    ):
        capsys.readouterr()
        assert main([*told, *more]) == 2
        assert words in capsys.readouterr().err


ESCAPED = b"""<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm" viewBox="0 0 40 40"><g id="L_x0020_1">
<rect x="5" y="5" width="30" height="30"/></g><g id="K"><circle cx="20" cy="20" r="4"/></g></svg>"""
"""A drawing whose editor wrote the layer "L 1" as no blank could stand in its name."""


@pytest.mark.parametrize("name", ["L_x0020_1", "L 1"])
def test_rules_and_jobs_find_a_layer_as_the_file_has_it_and_as_it_was_typed(name: str) -> None:
    tool = "[[tool]]\nnumber = 1\ndiameter = 3\n"
    rules = template(f"{tool}[[layer]]\nname = '{name}'\nkind = 'contour'\ntool = 1\ndepth = 2\n")
    job = template(f"{tool}[drawing]\nlayers = ['{name}']\n[[operation]]\nkind = 'pocket'\ntool = 1\ndepth = 2\n")
    by_rules, by_job = (make("part.svg", ESCAPED, MakeOptions(job=file.job, rules=file.rules)) for file in (rules, job))
    assert by_rules.ruled == ("  layer 'L 1': contour T1, 2 mm deep",)
    assert by_job.job.layer_names == ("L 1",)
