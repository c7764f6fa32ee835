"""Files that are no DXF, cut short, damaged, binary, or hostile: one clear line, never a traceback."""

import io
import random
import subprocess
import sys
from pathlib import Path
from typing import Any

import ezdxf
import pytest

from app.core.errors import HitofudeError, InputError
from app.formats.dxf.dxf import read_dxf
from app.formats.readers import read_drawing
from app.geometry.chaining.chain import chain
from app.model.read_options import DrawingOptions
from tests.conftest import ROOT


@pytest.mark.parametrize(
    ("data", "what"),
    [
        (b"", "the file is empty"),
        (b"  \r\n ", "the file is empty"),
        (b"<svg/>", "not a DXF file"),
        (bytes(range(256)) * 40, "not a DXF file"),
        (b"AC1027\x00\x00\x00", "this is a DWG file"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n", "cut short"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nENDSEC\n  0\nEOF\n", "no lines, arcs or curves"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00" + b"\x07" * 50, "damaged and cannot be repaired"),
    ],
)
def test_refused_in_one_line(data: bytes, what: str) -> None:
    with pytest.raises(InputError) as caught:
        read_dxf(data, "odd.dxf")
    text = str(caught.value)
    assert text.startswith("odd.dxf: ") and what in text and "\n" not in text


def test_file_cut_short(data: Path) -> None:
    whole = (data / "dxf" / "gear.dxf").read_bytes()
    for share in (0.1, 0.5, 0.9, 0.99):
        with pytest.raises(InputError, match="cut short"):
            read_dxf(whole[: int(len(whole) * share)], "gear.dxf")


LEAST = b"0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n1.0\n20\n2.0\n40\n5.0\n0\nENDSEC\n"


@pytest.mark.parametrize("before", [b"", b"\n", b"\r\n  \r\n"])
@pytest.mark.parametrize("end", [b"", b"\n\n", b"0\nEOF\n", b"0\nEOF"])
def test_a_whole_drawing_without_its_end_mark_is_read_and_told(before: bytes, end: bytes) -> None:
    found = read_dxf(before + LEAST + end, "a.dxf")
    assert len(found.part.entities) == 1
    assert [each.amount for each in found.findings if "repaired" in each.text] == ([] if b"EOF" in end else [1.0])


@pytest.mark.parametrize("end", [b"0\nENDSE", b"0\n", b""])
def test_entities_that_do_not_end_are_cut_short(end: bytes) -> None:
    with pytest.raises(InputError, match="cut short"):
        read_dxf(LEAST.removesuffix(b"0\nENDSEC\n") + end, "a.dxf")


def test_a_file_that_ends_before_its_entities_is_cut_short() -> None:
    with pytest.raises(InputError, match="cut short"):
        read_dxf(LEAST.replace(b"ENTITIES", b"HEADER"), "a.dxf")


def test_least_dxf_of_old() -> None:
    line = ["0", "LINE", "8", "0", "10", "0.0", "20", "0.0", "11", "5.0", "21", "7.0"]
    lines = ["0", "SECTION", "2", "ENTITIES", *line, "0", "ENDSEC", "0", "EOF"]
    for newline in ("\n", "\r\n"):
        drawing = read_dxf((newline.join(lines) + newline).encode(), "old.dxf")
        assert drawing.part.entities[0].curve.end == (5, 7) and not drawing.units_named


def test_every_section_of_entities_is_read() -> None:
    def section(name: str, *corners: str) -> list[str]:
        lines = [each for y in corners for each in ("0", "LINE", "8", "0", "10", "0", "20", y, "11", "5", "21", y)]
        return ["0", "SECTION", "2", name, *lines, "0", "ENDSEC"]

    lines = [*section("ENTITIES", "1", "2"), *section("OBJECTS"), *section("ENTITIES", "3"), "0", "EOF", ""]
    for newline in ("\n", "\r\n"):
        part = read_dxf(newline.join(lines).encode(), "parts.dxf").part
        assert [entity.curve.start[1] for entity in part.entities] == [1, 2, 3]


def test_binary_dxf() -> None:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 1
    document.modelspace().add_line((0, 0), (1, 2))
    stream = io.BytesIO()
    document.write(stream, fmt="bin")
    assert read_dxf(stream.getvalue(), "b.dxf").part.entities[0].curve.end == pytest.approx((25.4, 50.8))


def test_layer_names_in_other_scripts() -> None:
    for version in ("R2000", "R2010"):
        document = ezdxf.new(version)
        document.encoding = "cp932" if version == "R2000" else "utf-8"
        document.header["$DWGCODEPAGE"] = "ANSI_932"
        document.modelspace().add_line((0, 0), (1, 0), dxfattribs={"layer": "加工"})
        stream = io.StringIO()
        document.write(stream)
        drawing = read_dxf(stream.getvalue().encode("cp932" if version == "R2000" else "utf-8"), "jp.dxf")
        assert drawing.part.entities[0].layer == "加工"


def test_repaired_file_says_so(data: Path) -> None:
    text = (data / "dxf" / "fig2.dxf").read_text("utf-8")
    damaged = text.replace("ENTITIES", "ENTITIES\n  0\nNONSENSE\n  8\n0\n 10\nabc", 1)
    drawing = read_dxf(damaged.encode(), "fig2.dxf")
    assert len(drawing.part.entities) == 20


def nasty(space: Any) -> None:
    space.add_line((0, 0), (1, 0))
    spline = space.add_spline()
    spline.control_points = [(0, 0, 0), (1, 1, 0), (2, 0, 0), (3, 1, 0)]
    spline.knots = [0, 0, 0, 0, 1, 1, 1]
    empty = space.add_spline()
    empty.dxf.degree = 3
    space.add_ellipse((0, 0), (1, 0), 0.5).dxf.major_axis = (1e-11, 0, 0)
    space.add_lwpolyline([])
    space.add_arc((0, 0), 1e-12, 0, 90)


def test_senseless_entities_are_left_out() -> None:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    nasty(document.modelspace())
    stream = io.StringIO()
    document.write(stream)
    drawing = read_dxf(stream.getvalue().encode(), "n.dxf")
    assert len(drawing.part.entities) == 1
    assert dict(drawing.left_out) == {"SPLINE (damaged)": 2}
    (nothing,) = [each for each in drawing.findings if "have no length" in each.text]
    assert nothing.amount == 2  # ezdxf itself does not write the empty polyline


@pytest.mark.parametrize("number", ["nan", "inf", "1e400", "-1e308"])
def test_numbers_that_are_none(data: Path, number: str) -> None:
    text = (data / "dxf" / "fig2.dxf").read_text("utf-8").replace("\n 10\n24.0\n", f"\n 10\n{number}\n")
    assert number in text
    drawing = read_dxf(text.encode(), "f.dxf")
    assert len(drawing.part.entities) < 20
    assert drawing.left_out == (("curve beyond 1 km or without a place", 20 - len(drawing.part.entities)),)


@pytest.mark.parametrize("seed", range(40))
def test_random_damage_never_escapes(data: Path, seed: int) -> None:
    """Lines lost, doubled, swapped and overwritten: a drawing or one of our own errors."""
    rng = random.Random(seed)
    name = rng.choice(["fig2.dxf", "genshi.dxf", "broken_loop.dxf", "insert.dxf", "POLI-ALL210_12.dxf"])
    lines = (data / "dxf" / name).read_bytes().split(b"\n")
    for _ in range(rng.randint(1, 20)):
        k = rng.randrange(len(lines) - 8)
        action = rng.randrange(4)
        if action == 0:
            del lines[k]
        elif action == 1:
            lines.insert(k, lines[k])
        elif action == 2:
            lines[k], lines[k + 1] = lines[k + 1], lines[k]
        else:
            lines[k] = rng.choice(
                [b"", b"0", b"-1", b"nan", b"1e999", b"\xff\xfe", b"LINE", b"ENDSEC", b"999999999999"]
            )
    try:
        read_dxf(b"\n".join(lines), name)
    except HitofudeError as error:
        assert "\n" not in str(error)


def altered(content: bytes, rng: random.Random) -> bytes:
    """Numbers of geometry replaced by extreme ones, some pairs lost; the order of codes and values stays."""
    lines = content.split(b"\n")
    first = max(k for k, line in enumerate(lines) if b"ENTITIES" in line or b"BLOCKS" in line)
    for _ in range(rng.randint(1, 20)):
        k = rng.randrange(first, len(lines) - 8) | 1
        code = lines[k - 1].strip()
        if not code.isdigit() or not 10 <= int(code) < 80:
            continue
        choices = (
            [b"0.0", b"-1.0", b"1e15", b"1e300", b"1e-300", b"7.0"]
            if int(code) < 60
            else [b"0", b"1", b"-1", b"3", b"16"]
        )
        lines[k] = rng.choice(choices)
        if rng.random() < 0.1:
            del lines[k - 1 : k + 1]
    return b"\n".join(lines)


@pytest.mark.parametrize("seed", range(40))
def test_extreme_numbers_go_through_chaining(data: Path, seed: int) -> None:
    rng = random.Random(seed)
    name = rng.choice(["fig2.dxf", "genshi.dxf", "insert.dxf", "POLI-ALL210_12.dxf", "forms.dxf", "LM2.dxf"])
    try:
        drawing = read_dxf(altered((data / "dxf" / name).read_bytes(), rng), name)
    except HitofudeError as error:
        assert "\n" not in str(error)
        return
    for contour in chain(drawing.part.entities).contours:
        assert contour.closed == (contour.primitives[0].start == contour.primitives[-1].end)


def test_threads_that_read_the_first_drawings_at_once_do_not_find_the_library_half_made(samples) -> None:
    """The window does so when it opens: its engines are loaded on one thread and the drawing is read on another."""
    code = f"""
import threading
from importlib import import_module
from pathlib import Path
data = Path({str(samples / "fig2.dxf")!r}).read_bytes()
from app.formats.dxf.load import load
told, together = [], threading.Barrier(4)
def read():
    together.wait()
    told.append(load(data, "fig2.dxf").repaired)
def engine():
    together.wait()
    import_module("ezdxf")
    import_module("ezdxf.recover")
    told.append(0)
threads = [threading.Thread(target=task) for task in (read, engine, read, engine)]
for thread in threads: thread.start()
for thread in threads: thread.join()
print(told)
"""
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60)
        assert (done.stdout.strip(), done.stderr) == ("[0, 0, 0, 0]", "")


def test_a_document_that_falls_apart_when_it_is_looked_at_is_repaired_or_refused() -> None:
    """A record of a block without a name, in the section of entities, takes the place of model space in the library's
    table.
    """
    tables = [
        "0",
        "SECTION",
        "2",
        "TABLES",
        "0",
        "TABLE",
        "70",
        "1",
        *record("1F", "*MODEL_SPACE"),
        *record("1B", "*PAPER_SPACE"),
    ]
    spline = [
        "0",
        "SPLINE",
        "5",
        "100",
        "100",
        "AcDbSpline",
        "70",
        "8",
        "71",
        "3",
        "330",
        "0",
        "100",
        "AcDbSymbolTable",
        "70",
        "2",
    ]
    nameless = [
        "0",
        "BLOCK_RECORD",
        "5",
        "1F",
        "330",
        "1",
        "100",
        "AcDbBlockBegin",
        "2",
        "*Model_Space",
        "70",
        "0",
        "281",
        "1",
    ]
    lines = [
        "0",
        "SECTION",
        "2",
        "HEADER",
        "9",
        "$ACADVER",
        "1",
        "AC1014",
        "9",
        "$HANDSEED",
        "5",
        "FFFF",
        *tables,
        "0",
        "ENDTAB",
    ]
    lines += [
        "0",
        "ENDSEC",
        "100",
        "AcDbBlockEnd",
        "0",
        "ENDSEC",
        "0",
        "SECTION",
        "2",
        "ENTITIES",
        *spline,
        *nameless,
        "0",
        "ENDSEC",
    ]
    with pytest.raises(InputError, match=r"^d\.dxf: [^\n]+$"):
        read_dxf("\n".join([*lines, "0", "EOF"]).encode(), "d.dxf")


def record(handle: str, name: str) -> list[str]:
    return ["0", "BLOCK_RECORD", "5", handle, "2", name]


KNOTS = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0]
PLACES = [(1.0, 2.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (1.0, 2.0)]


@pytest.mark.parametrize(
    ("knots", "weights"),
    [
        ([0.0, 0.0, 0.0, 0.0, 2.0, 1.0, 2.0, 2.0, 2.0], []),
        (KNOTS, [1.0, -2.0, 1.0, 0.0, 1.0]),
        ([0.0, 0.0, 0.0, 1.0, 1.0, 1.0], []),
    ],
    ids=["knots that go back", "weights below zero", "too few knots"],
)
def test_a_spline_that_cannot_be_drawn_is_missing_from_the_part(knots: list[float], weights: list[float]) -> None:
    """It is not "without length": a part without it is another part, and the verdict is not clean."""
    document = ezdxf.new(units=4)
    spline = document.modelspace().add_spline()
    spline.control_points, spline.knots, spline.weights = PLACES, knots, weights
    document.modelspace().add_circle((50, 50), 3)
    stream = io.StringIO()
    document.write(stream)
    drawing = read_drawing("a.dxf", stream.getvalue().encode(), None, (), DrawingOptions())
    assert dict(drawing.left_out) == {"SPLINE (damaged)": 1} and len(drawing.part.entities) == 1
    (counted,) = [each for each in drawing.findings if each.counts and "Missing from the part" in each.text]
    assert counted.text.endswith("which cannot be read; repair or draw what this is again.")
    assert any("SPLINE (damaged) at (1.000, 2.000) on layer 0" in each.text for each in drawing.findings)


def test_a_spline_whose_points_are_one_has_no_length() -> None:
    document = ezdxf.new(units=4)
    spline = document.modelspace().add_spline()
    spline.control_points, spline.knots = [(1.0, 2.0)] * 5, [0.0] * 9
    document.modelspace().add_circle((50, 50), 3)
    stream = io.StringIO()
    document.write(stream)
    drawing = read_drawing("a.dxf", stream.getvalue().encode(), None, (), DrawingOptions())
    assert not drawing.left_out and any("has no length" in each.text for each in drawing.findings)
