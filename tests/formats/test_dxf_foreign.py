"""What other people's DXF do: decimal commas, frozen inserts, radii below 0, places beyond 1 km, paper space, wrong
units.
"""

import io
from typing import Any

import ezdxf
import pytest

from app.core.errors import InputError
from app.formats.drawing import Drawing
from app.formats.drawing_account import size_of
from app.formats.readers import read_drawing
from app.formats.reading_question import UndecidedError, size_words
from app.model.curves import Circle, Line
from app.model.finding import Finding, FindingKind
from app.model.part import Units
from app.model.read_options import DrawingOptions
from app.model.reading import ReadingOptions
from app.usecases.job.plausible import read_plausible


def new(units: int = 4) -> Any:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = units
    return document


def bytes_of(document: Any) -> bytes:
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()


def read(document: Any, layers: tuple[str, ...] = (), **how: Any) -> Drawing:
    return read_drawing("x.dxf", bytes_of(document), None, layers, DrawingOptions(**how))


def telling(drawing: Drawing, word: str) -> Finding:
    (found,) = [each for each in drawing.findings if word in each.text]
    return found


def plate(space: Any, x: float = 0.0, y: float = 0.0, **attributes: Any) -> None:
    space.add_lwpolyline([(x, y), (x + 40, y), (x + 40, y + 30), (x, y + 30)], close=True, dxfattribs=attributes)


def line_of(data: bytes, value: bytes) -> int:
    return data.split(b"\n").index(value) + 1


def lines_to(x: bytes, y: bytes = b"7.0") -> bytes:
    document = new()
    document.modelspace().add_line((0, 0), (98765, 7), dxfattribs={"layer": "0"})
    return bytes_of(document).replace(b"\n98765.0\n", b"\n" + x + b"\n").replace(b"\n7.0\n", b"\n" + y + b"\n")


def test_decimal_commas_are_read_whole_and_said() -> None:
    data = lines_to(b"40,9")
    drawing = read_drawing("x.dxf", data)
    assert drawing.part.entities[0].curve == Line((0, 0), (40.9, 7))
    found = telling(drawing, "decimal comma")
    assert f"'40,9', in line {line_of(data, b'40,9')}" in found.text and not found.counts


def test_words_with_commas_stay_as_they_are() -> None:
    document = new()
    document.layers.add("a 1,5 b")
    document.modelspace().add_line((0, 0), (98765, 0), dxfattribs={"layer": "a 1,5 b"})
    data = bytes_of(document).replace(b"\n98765.0\n", b"\n1,5\n")
    (entity,) = read_drawing("x.dxf", data).part.entities
    assert entity.layer == "a 1,5 b" and entity.curve == Line((0, 0), (1.5, 0))


@pytest.mark.parametrize("value", [b"40.9mm", b"4O.9", b"1.234,5", b"12;5", b"ten"])
def test_coordinates_that_are_no_numbers_are_refused_with_line_and_value(value: bytes) -> None:
    data = lines_to(value)
    with pytest.raises(InputError) as caught:
        read_drawing("x.dxf", data)
    assert str(caught.value).startswith(f"x.dxf:{line_of(data, value)}: the value {value.decode()!r} is no number")


def test_a_comma_that_may_part_thousands_is_refused() -> None:
    with pytest.raises(InputError, match=r"x\.dxf:\d+: the value '1,234' has a comma and others have points"):
        read_drawing("x.dxf", lines_to(b"1,234"))
    assert read_drawing("x.dxf", lines_to(b"1,234", b"7,5")).part.entities[0].curve == Line((0, 0), (1.234, 7.5))


def with_insert(state: str, layer: str = "HID", nested: bool = False) -> Any:
    """A plate, and a block of a circle on layer 0 and one on layer CUT, inserted on a frozen layer or one that is off,
    also in another.
    """
    document = new()
    for name in ("HID", "CUT"):
        document.layers.add(name)
    getattr(document.layers.get(layer), state)()
    block = document.blocks.new("HOLE")
    block.add_circle((0, 0), 1)
    block.add_circle((0, 0), 2, dxfattribs={"layer": "CUT"})
    space = document.modelspace()
    plate(space)
    if nested:
        outer = document.blocks.new("OUTER")
        outer.add_circle((0, 0), 5, dxfattribs={"layer": "CUT"})
        outer.add_blockref("HOLE", (3, 4), dxfattribs={"layer": layer})
        space.add_blockref("OUTER", (10, 10), dxfattribs={"layer": "CUT"})
    else:
        space.add_blockref("HOLE", (13, 14), dxfattribs={"layer": layer})
    return document


def circles(drawing: Drawing) -> list[tuple[float, str]]:
    return [(each.curve.radius, each.layer) for each in drawing.part.entities if isinstance(each.curve, Circle)]


@pytest.mark.parametrize("nested", [False, True])
def test_an_insert_on_a_frozen_layer_is_left_out_named_and_counted(nested: bool) -> None:
    drawing = read(with_insert("freeze", nested=nested))
    assert circles(drawing) == [(5, "CUT")] * nested
    found = telling(drawing, "frozen")
    assert (
        "Block HOLE is inserted, at (13.000, 14.000), on layer HID, which is frozen; 2 curves are not shown"
        in found.text
    )
    assert "--layer HID --layer CUT" in found.text and found.amount == 2 and not found.counts


def test_a_frozen_insert_that_is_asked_for_is_read() -> None:
    assert circles(read(with_insert("freeze"), ("HID", "CUT"))) == [(1, "HID"), (2, "CUT")]


def test_an_insert_on_a_layer_that_is_off_hides_only_what_takes_its_layer() -> None:
    drawing = read(with_insert("off"))
    assert circles(drawing) == [(1, "HID"), (2, "CUT")]
    assert [layer.visible for layer in drawing.part.layers if layer.name in ("HID", "CUT")] == [False, True]


def test_layer_0_that_is_frozen_hides_what_is_inserted_on_it_but_not_inside_of_blocks_on_others() -> None:
    document = new()
    document.layers.add("CUT")
    document.layers.get("0").freeze()
    document.blocks.new("HOLE").add_circle((0, 0), 1)
    document.blocks.new("OUTER").add_blockref("HOLE", (0, 0))
    document.modelspace().add_blockref("OUTER", (0, 0), dxfattribs={"layer": "CUT"})
    document.modelspace().add_blockref("HOLE", (0, 0))
    assert circles(read(document)) == [(1, "CUT")]


def test_nothing_but_frozen_inserts_is_told() -> None:
    document = with_insert("freeze")
    document.modelspace().delete_all_entities()
    document.modelspace().add_blockref("HOLE", (1, 2), dxfattribs={"layer": "HID"})
    with pytest.raises(InputError, match=r"no curves that are shown\. Block HOLE is inserted"):
        read(document)


def test_a_radius_below_0_is_named_and_missing_never_taken_as_positive() -> None:
    document = new()
    plate(document.modelspace())
    document.modelspace().add_circle((7, 8), -5, dxfattribs={"layer": "H"})
    document.modelspace().add_arc((17, 8), -2, 0, 90)
    drawing = read(document)
    assert len(drawing.part.entities) == 4
    found = telling(drawing, "radius below 0")
    assert "2 circles or arcs have a radius below 0 and are missing from the part" in found.text
    assert "the first: -5 mm round (7.000, 8.000) on layer H" in found.text
    assert found.counts and (found.x, found.y) == (7, 8)


def test_curves_beyond_1_km_are_a_finding_with_the_remedy() -> None:
    document = new()
    plate(document.modelspace())
    document.modelspace().add_line((2e6, 5), (2e6, 9), dxfattribs={"layer": "far"})
    found = telling(read(document), "beyond 1 km")
    assert found.counts and found.kind is FindingKind.LEFT_OUT and found.amount == 1
    assert "1 curve lies beyond 1 km, at (2000000.000, 5.000) on layer far" in found.text and "--to-zero" in found.text


def test_a_drawing_beyond_1_km_is_refused_with_the_remedy_and_read_by_it() -> None:
    document = new()
    plate(document.modelspace(), 2.5e6, -4e9)
    with pytest.raises(InputError, match=r"all of the drawing lies beyond 1 km, at \(2500000.*say --to-zero"):
        read(document)
    drawing = read(document, to_zero=True)
    assert [entity.curve for entity in drawing.part.entities] == [
        Line((0, 0), (40, 0)),
        Line((40, 0), (40, 30)),
        Line((40, 30), (0, 30)),
        Line((0, 30), (0, 0)),
    ]
    assert "moved by (-2500000.000, 4000000000.000) mm" in telling(drawing, "was moved").text


def test_to_zero_goes_by_what_is_machined_and_not_by_strays() -> None:
    document = new()
    document.layers.add("notes").off()
    plate(document.modelspace(), 100, 50)
    document.modelspace().add_circle((-500, -500), 1, dxfattribs={"layer": "notes"})
    document.modelspace().add_line((-9e6, 0), (-9e6, 1))
    drawing = read(document, to_zero=True)
    assert drawing.part.entities[0].curve == Line((0, 0), (40, 0))
    found = telling(drawing, "beyond 1 km")
    assert found.counts and "--to-zero" not in found.text and "delete what lies so far away" in found.text


def test_paper_space_is_offered_and_read() -> None:
    document = new()
    document.layouts.new("Cut sheet")
    plate(document.layouts.get("Cut sheet"))
    with pytest.raises(InputError, match='layout Cut sheet has something: say --layout "Cut sheet"'):
        read(document)
    assert len(read(document, layout="cut SHEET").part.entities) == 4
    with pytest.raises(InputError, match="there is no layout nix; the drawing has Model, Layout1, Cut sheet"):
        read(document, layout="nix")


def sized(units: int, given: Units | None, diameter: float = 6.0) -> Drawing:
    document = new(units)
    plate(document.modelspace())
    return read_plausible("x.dxf", bytes_of(document), ReadingOptions(given), lambda _: [diameter])


def width(drawing: Drawing) -> float:
    return drawing.part.entities[0].curve.end[0]


def test_a_part_of_40_m_for_a_tool_of_6_mm_asks_for_its_units() -> None:
    with pytest.raises(
        InputError, match=r"40000 x 30000 mm, and the largest tool 6 mm.*names m as its units; say which.*--units mm or"
    ):
        sized(6, None)
    assert width(sized(6, Units.MM)) == 40.0 and width(sized(6, Units.M)) == 40000.0


def test_a_part_of_40_micrometres_asks_for_its_units() -> None:
    with pytest.raises(InputError, match=r"0\.04 x 0\.03 mm, and the smallest tool 6 mm"):
        sized(13, None)
    assert width(sized(13, Units.MM)) == 40.0


def test_units_that_are_named_and_can_be_meant_are_kept() -> None:
    assert width(sized(4, Units.INCH)) == 40.0 and width(sized(1, None)) == pytest.approx(1016)
    assert width(sized(6, None, 25.0)) == 40000.0  # 1,600 tools side by side


def test_layers_and_types_are_left_out_as_asked() -> None:
    document = new()
    plate(document.modelspace())
    document.modelspace().add_line((0, 0), (9, 9), dxfattribs={"layer": "Centre"})
    document.modelspace().add_circle((5, 5), 2)
    assert len(read(document, without_layers=("CENTRE",)).part.entities) == 5
    drawing = read(document, without_types=("circle",))
    assert len(drawing.part.entities) == 5 and dict(drawing.left_out) == {"CIRCLE (as asked)": 1}
    with pytest.raises(InputError, match="there is no layer wood to leave out"):
        read(document, without_layers=("wood",))
    with pytest.raises(InputError, match="nothing is left to machine"):
        read(document, without_layers=("0", "centre"))


@pytest.mark.parametrize(
    ("name", "how", "option"),
    [
        ("a.draw", {"to_zero": True}, "--to-zero"),
        ("a.svg", {"layout": "x"}, "--layout"),
        ("a.svg", {"without_types": ("TEXT",)}, "--skip-type"),
        ("a.dxf", {"pixels_per_inch": 90.0}, "--px-per-inch"),
    ],
)
def test_options_that_say_nothing_of_a_kind_of_file_are_refused(name: str, how: dict[str, Any], option: str) -> None:
    with pytest.raises(InputError, match=f"^{option} is for .* and says nothing of {name}"):
        read_drawing(name, b"", None, (), DrawingOptions(**how))


def test_units_that_would_be_no_better_are_not_offered() -> None:
    """3e5 pixels are 79 m: no unit that is offered makes them less, and in metres they lie beyond 1 km."""
    text = b'<svg xmlns="http://www.w3.org/2000/svg"><rect width="3e5" height="1e5" stroke="red" fill="none"/></svg>'
    with pytest.raises(UndecidedError, match="79375 x 26458") as caught:
        read_plausible("a.svg", text, ReadingOptions(), lambda _: [6.0])
    question = caught.value.question
    assert question is not None and [choice.words for choice in question.choices] == ["Keep 96 to the inch"]
    assert read_plausible("a.svg", text, question.choices[0].reading, lambda _: [6.0]).part.entities


def test_every_answer_is_read_as_it_says() -> None:
    document = new(6)
    plate(document.modelspace())
    with pytest.raises(UndecidedError) as caught:
        read_plausible("a.dxf", bytes_of(document), ReadingOptions(), lambda _: [6.0])
    question = caught.value.question
    assert question is not None and [choice.likely for choice in question.choices] == [True, False, False]
    for choice in question.choices:
        part = read_plausible("a.dxf", bytes_of(document), choice.reading, lambda _: [6.0]).part
        assert choice.outcome == size_words(size_of(part))


@pytest.mark.parametrize(
    ("size", "words"),
    [
        ((40.0, 20.0), "40 \u00d7 20 mm"),
        ((1204.1479, 1976.72), "1\u2009204.148 \u00d7 1\u2009976.72 mm"),
        ((0.04, 2e-5), "0.04 \u00d7 2e-05 mm"),
    ],
)
def test_sizes_have_three_decimals_at_most(size: tuple[float, float], words: str) -> None:
    assert size_words(size) == words
