"""A format of drawings is registered in one place: one that is added here is read by every command."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.cli.main import main
from app.core.errors import InputError
from app.formats.drawing import Drawing, WrittenDrawing
from app.formats.readers import check_options, fit_for, format_of, formats, known_format, offered_suffixes, read_drawing
from app.formats.registry import DrawingFormat, FormatWriter, register, withdraw
from app.model.curves import Line
from app.model.part import Part
from app.model.read_options import DrawingOptions
from app.model.reading import ReadingOptions


def read_boxes(name: str, data: bytes, reading: ReadingOptions) -> Drawing:
    """A drawing of boxes: x, y, width and height in each line."""
    lines: list[Line] = []
    for row in data.decode().splitlines():
        try:
            x, y, wide, high = map(float, row.split())
        except ValueError as error:
            raise InputError(f"{name}: {row} is no box") from error
        corners = ((x, y), (x + wide, y), (x + wide, y + high), (x, y + high))
        lines += [Line(corners[k - 1], corners[k]) for k in range(4)]
    return Drawing(Part(name=name).with_curves(lines, "0"))


BOXES = DrawingFormat(
    (".foo",),
    read_boxes,
    takes=frozenset({"layout"}),
    writers=(FormatWriter(".foo", "Boxes", lambda part: WrittenDrawing(f"{len(part.entities)}".encode())),),
)


@pytest.fixture(autouse=True)
def registered() -> Iterator[None]:
    register(BOXES)
    yield
    withdraw(BOXES)


def test_the_command_line_reads_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drawing, program, report = tmp_path / "x.foo", tmp_path / "x.ngc", tmp_path / "x.json"
    drawing.write_text("0 0 40 30\n60 0 20 20\n")
    assert main(["make", str(drawing), "-o", str(program), "--report", str(report), "--quiet"]) == 0
    assert len(json.loads(report.read_text())["regions"]) == 2
    assert main(["cut", str(program), "--against", str(drawing), "--quiet"]) == 0
    assert main(["tools", str(drawing), "--quiet"]) == 0
    drawing.write_text("0 0 40\n")
    assert main(["make", str(drawing), "-o", str(program), "--quiet"]) == 2
    assert "x.foo: 0 0 40 is no box" in capsys.readouterr().err
    assert main(["make", "--help"]) == 0
    assert ".hito .dxf .svg .svgz .draw .foo" in " ".join(capsys.readouterr().out.split())


def test_what_it_takes_is_asked_of_it() -> None:
    check_options(DrawingOptions(layout="A4"), "x.foo")
    with pytest.raises(
        InputError, match=r"--to-zero is for \.dxf, \.svg and \.svgz drawings and says nothing of x\.foo; take"
    ):
        read_drawing("x.foo", b"0 0 1 1", how=DrawingOptions(to_zero=True))
    with pytest.raises(InputError, match=r"--layout is for \.dxf and \.foo drawings and says nothing of a\.svg"):
        check_options(DrawingOptions(layout="A4"), "a.svg")
    both = DrawingOptions(layout="A4", to_zero=True, without_layers=("a",))
    assert fit_for(both, "x.FOO") == DrawingOptions(layout="A4", without_layers=("a",))
    assert fit_for(both, "solid.stl") == DrawingOptions(without_layers=("a",))


def test_layers_are_left_out_of_it_as_of_any_other() -> None:
    with pytest.raises(InputError, match="there is no layer walls to leave out"):
        read_drawing("x.foo", b"0 0 1 1", how=DrawingOptions(without_layers=("walls",)))


def test_it_is_known_by_its_suffix_alone() -> None:
    assert format_of("A.FOO") is BOXES
    assert known_format("x.bar") is None
    assert ".foo" in offered_suffixes()
    assert ".hito~" not in offered_suffixes()
    with pytest.raises(
        InputError, match=r"x\.bar: drawings of type \.bar cannot be read; supported: \.hito, \.hito~, "
    ):
        format_of("x.bar")


def test_two_formats_cannot_have_one_suffix() -> None:
    with pytest.raises(ValueError, match=r"two formats of drawings have the suffix \.foo"):
        register(DrawingFormat((".foo",), read_boxes))


def test_every_way_to_write_has_a_name_of_its_own() -> None:
    keys = [writer.key for each in formats() for writer in each.writers]
    assert len(keys) == len(set(keys))
    assert BOXES.writer("R12") is BOXES.writers[0]
