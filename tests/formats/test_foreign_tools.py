"""Tools of Fusion, FreeCAD and Vectric: each kind in its units, with feeds and holders, and what is not understood."""

from __future__ import annotations

import copy
import json
import math
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from app.cli.main import main
from app.core.errors import InputError
from app.formats.tools.at_path import tools_at
from app.formats.tools.files import read_tools, write_tools
from app.formats.tools.library import read_library
from app.model.tool import Tool, ToolMaterial
from app.model.tool_kind import ToolKind
from tests.formats.foreign_tools import bit, bit_library, fusion_archive, fusion_json, fusion_tool, preset, vectric

HOLDER = {
    "segments": [
        {"height": 10.0, "lower-diameter": 20.0, "upper-diameter": 24.0},
        {"height": 15.0, "lower-diameter": 30.0, "upper-diameter": 30.0},
    ],
    "type": "holder",
    "unit": "millimeters",
}


def one(name: str, data: bytes) -> Tool:
    (tool,) = read_tools(name, data).library.tools
    return tool


class TestFusion:
    def test_a_mill_with_all_that_its_entry_tells_from_both_kinds_of_file(self) -> None:
        feeds = {"presets": [preset("aluminium", 12000, 1080, 300), preset("steel", 5000, 300, 90)]}
        entries = [fusion_tool(number=7, holder=HOLDER, **{"start-values": feeds})]
        tool = one("mine.json", fusion_json(entries))
        assert tool == one("mine.tools", fusion_archive(entries))
        assert (tool.number, tool.kind, tool.diameter, tool.flutes) == (7, ToolKind.FLAT, 6.0, 3)
        assert (tool.stick_out, tool.flute_length, tool.overall_length, tool.shank_diameter) == (25.0, 15.0, 57.0, 6.0)
        assert tool.tool_material is ToolMaterial.CARBIDE
        assert (tool.spindle_speed, tool.feed_rate, tool.plunge_rate) == (12000.0, 1080.0, 300.0)
        assert tool.holder == ((0.0, 10.0), (10.0, 12.0), (10.0, 15.0), (25.0, 15.0))
        aluminium, steel = tool.feeds
        assert (aluminium.material, steel.material) == ("aluminium", "steel")
        assert aluminium.surface_speed == pytest.approx(math.pi * 6 * 12)
        assert aluminium.feed_per_tooth == pytest.approx(0.03)
        assert steel.plunge_share == pytest.approx(0.3)
        assert tool.in_material(aluminium).feed_rate == pytest.approx(1080.0)

    def test_inches_and_a_holder_in_millimetres(self) -> None:
        feeds = {"presets": [preset("", 18000, 100, 30)]}
        sizes = {"DC": 0.25, "LB": 1.0, "LCF": 0.75, "OAL": 2.5, "SFDM": 0.25}
        tool = one(
            "t.json", fusion_json([fusion_tool(unit="inches", holder=HOLDER, **sizes, **{"start-values": feeds})])
        )
        assert (tool.diameter, tool.stick_out, tool.feed_rate) == (6.35, 25.4, 2540.0)
        assert tool.holder[1] == (10.0, 12.0)
        assert tool.feeds[0].material == "Default preset"

    @pytest.mark.parametrize(
        ("entry", "kind", "shape"),
        [
            (fusion_tool("ball end mill"), ToolKind.BALL, {}),
            (fusion_tool("bull nose end mill", RE=0.5), ToolKind.BULL, {"corner_radius": 0.5}),
            (fusion_tool("drill", SIG=118), ToolKind.DRILL, {"tip_angle": math.radians(118)}),
            (
                fusion_tool("chamfer mill", TA=45, tip_diameter=0.2),
                ToolKind.V,
                {"tip_angle": math.pi / 2, "tip_diameter": 0.2},
            ),
            (fusion_tool("spot drill", SIG=90), ToolKind.V, {"tip_angle": math.pi / 2}),
            (fusion_tool("counter sink", SIG=82), ToolKind.V, {"tip_angle": math.radians(82)}),
            (fusion_tool("face mill"), ToolKind.FLAT, {}),
            (fusion_tool("reamer"), ToolKind.REAMER, {}),
            (fusion_tool("tap right hand", TP=1.0), ToolKind.TAP, {}),
            (fusion_tool("thread mill"), ToolKind.THREAD_MILL, {}),
        ],
        ids=lambda each: each["type"] if isinstance(each, dict) and "type" in each else None,
    )
    def test_each_type_is_its_kind(self, entry, kind, shape) -> None:
        tool = one("t.json", fusion_json([entry]))
        assert (tool.kind, tool.diameter) == (kind, 6.0)
        for key, value in shape.items():
            assert getattr(tool, key) == pytest.approx(value)

    def test_a_tapered_mill_is_as_wide_as_its_cone_at_the_end_of_the_flutes(self) -> None:
        """The cone touches the ball: its radius there is r cos a, at the height r (1 - sin a)."""
        half, r, flutes = math.radians(5), 0.5, 20.0
        tool = one("t.json", fusion_json([fusion_tool("tapered mill", DC=1.0, RE=r, TA=5, LCF=flutes, SFDM=6.0)]))
        radius = r * math.cos(half) + (flutes - r * (1 - math.sin(half))) * math.tan(half)
        assert (tool.kind, tool.tip_diameter, tool.tip_angle) == (ToolKind.TAPER, 1.0, pytest.approx(2 * half))
        assert tool.diameter == pytest.approx(2 * radius)
        flat = one("t.json", fusion_json([fusion_tool("tapered mill", DC=1.0, TA=5, LCF=flutes, SFDM=3.0)]))
        assert (flat.kind, flat.tip_diameter, flat.diameter) == (ToolKind.V, 1.0, 3.0)

    def test_what_is_not_understood_is_named(self) -> None:
        entries = [
            fusion_tool("dovetail mill", 1),
            fusion_tool("holder", 2),
            fusion_tool("flat end mill", 3, unit="furlongs"),
            fusion_tool("chamfer mill", 4),
            fusion_tool("flat end mill", 5, DC="six"),
            fusion_tool("flat end mill", 6, DC=0),
            fusion_tool("face mill", 8, TA=45),
            "nothing",
            fusion_tool("flat end mill", 9, LB=99.0),
            fusion_tool("flat end mill", 9),
        ]
        library, left_out = read_tools("t.json", fusion_json(entries))
        assert [tool.number for tool in library.tools] == [9, 1]
        for words in (
            "dovetail mill 1 is left out: its type 'dovetail mill'",
            "holder 2 is left out",
            "its unit is 'furlongs'",
            "chamfer mill 4 is left out: its angle is not told",
            "its DC is 'six', which is no number",
            "flat end mill 6 is left out",
            "face mill 8 is left out: it is a face mill with slanted sides",
            "entry 8 is left out",
            "flat end mill 9: its length below the holder would be longer than the whole tool",
            "flat end mill 9 is T1: T9 is taken",
        ):
            assert any(words in each for each in left_out), (words, left_out)

    @pytest.mark.parametrize(
        ("name", "data", "words"),
        [
            ("t.json", b"[]", "no list 'data'"),
            ("t.json", b"{", "no JSON text"),
            ("t.json", b"[" * 100_000, "no JSON text"),
            ("t.tools", b"PK\x03\x04 broken", "cannot be opened"),
            ("t.json", fusion_json([]), "no tool in this file"),
            ("t.json", fusion_json([fusion_tool("form mill")]), "form mill 1 is left out"),
        ],
    )
    def test_what_is_no_library_is_told(self, name: str, data: bytes, words: str) -> None:
        with pytest.raises(InputError, match=words):
            read_tools(name, data)


class TestFreeCad:
    @pytest.mark.parametrize(
        ("data", "kind", "shape"),
        [
            (bit("endmill", Diameter="5.0000 mm"), ToolKind.FLAT, {"diameter": 5.0}),
            (bit("ballend", Diameter='0.125 "'), ToolKind.BALL, {"diameter": 3.175}),
            (bit("bullnose", Diameter="6,00 mm", CornerRadius="1 mm"), ToolKind.BULL, {"corner_radius": 1.0}),
            (bit("torus", Diameter=6, TorusRadius="0.5 mm"), ToolKind.BULL, {"corner_radius": 0.5}),
            (bit("bullnose", Diameter="5 mm", FlatRadius="1.5 mm"), ToolKind.BULL, {"corner_radius": 1.0}),
            (
                bit("v-bit", Diameter="10 mm", CuttingEdgeAngle="60 °", TipDiameter="1 mm"),
                ToolKind.V,
                {"tip_angle": math.pi / 3},
            ),
            (bit("chamfer", Diameter="12 mm", CuttingEdgeAngle="90.00 °"), ToolKind.V, {"tip_angle": math.pi / 2}),
            (bit("drill", Diameter="3 mm", TipAngle="119 deg"), ToolKind.DRILL, {"tip_angle": math.radians(119)}),
            (bit("thread-mill", Diameter="4 mm"), ToolKind.THREAD_MILL, {}),
            (
                bit("taperedballnose", Diameter="1 mm", TaperAngle="10 °", TaperDiameter="4 mm"),
                ToolKind.TAPER,
                {"diameter": 4.0, "tip_diameter": 1.0, "tip_angle": math.radians(10)},
            ),
        ],
        ids=lambda each: json.loads(each)["shape"] if isinstance(each, bytes) else None,
    )
    def test_each_shape_is_its_kind(self, data, kind, shape) -> None:
        tool = one("b.fctb", data)
        assert tool.kind is kind
        for key, value in shape.items():
            assert getattr(tool, key) == pytest.approx(value)

    def test_lengths_flutes_and_edges(self) -> None:
        data = bit(
            "endmill",
            "Six",
            {"Flutes": "4", "Material": "Carbide"},
            Diameter="6 mm",
            CuttingEdgeHeight="20 mm",
            Length="60 mm",
            ShankDiameter="6 mm",
            Chipload="0.05 mm",
        )
        library, told = read_tools("b.fctb", data)
        (tool,) = library.tools
        assert (tool.name, tool.flutes, tool.tool_material) == ("Six", 4, ToolMaterial.CARBIDE)
        assert (tool.flute_length, tool.overall_length, tool.shank_diameter) == (20.0, 60.0, 6.0)
        assert "chip load has no surface speed" in told[0]

    def test_a_folder_and_a_library_of_bits(self, tmp_path: Path) -> None:
        bits, libraries = tmp_path / "Bit", tmp_path / "Library"
        bits.mkdir()
        libraries.mkdir()
        (bits / "five.fctb").write_bytes(bit("endmill", "Five", Diameter="5 mm"))
        (bits / "three.fctb").write_bytes(bit("drill", "Three", Diameter="3 mm"))
        (bits / "saw.fctb").write_bytes(bit("slittingsaw", "Saw", Diameter="60 mm"))
        (libraries / "Mine.fctl").write_bytes(bit_library({11: "five.fctb", 4: "three.fctb", 9: "gone.fctb"}))
        for place in (bits, libraries / "Mine.fctl", tmp_path):
            library, told = tools_at(place)
            assert {tool.number: tool.name for tool in library.tools} == {11: "Five", 4: "Three"}, place
            assert any("Saw is left out: its shape 'slittingsaw'" in each for each in told)
            assert any("T9 is left out: its file gone.fctb is not there" in each for each in told)
        empty = tmp_path / "empty"
        empty.mkdir()
        with pytest.raises(InputError, match="no tool bit"):
            tools_at(empty)


class TestVectric:
    def test_kinds_units_names_numbers_and_feeds(self, tmp_path: Path) -> None:
        wood = {"material": "Oak", "feed_rate": 60.0, "plunge_rate": 30.0, "spindle_speed": 18000, "rate_units": 4}
        plain = {"feed_rate": 1000.0, "plunge_rate": 250.0, "spindle_speed": 16000}
        made = vectric(
            [
                {
                    "tool_type": 1,
                    "diameter": 0.25,
                    "units": 1,
                    "name": "Quarter",
                    "cuts": [{**wood, "tool_number": 12}],
                },
                {
                    "tool_type": 0,
                    "diameter": 3.0,
                    "name_format": "{Tool Type} ({Diameter|F}{Units Short})",
                    "cuts": [plain],
                },
                {"tool_type": 3, "diameter": 12.7, "included_angle": 60.0, "name": "V"},
                {"tool_type": 4, "diameter": 6.0, "included_angle": 30.0, "flat_diameter": 0.2, "name": "Engraver"},
                {"tool_type": 2, "diameter": 6.0, "tip_radius": 1.0, "name": "Radiused"},
                {"tool_type": 5, "diameter": 6.0, "included_angle": 5.0, "tip_radius": 0.5, "name": "Tapered"},
                {"tool_type": 6, "diameter": 5.0, "name": "Drill"},
                {"tool_type": 9, "diameter": 1.0, "name": "Drag"},
                {"tool_type": 42, "diameter": 1.0, "name": "Odd"},
                {"tool_type": 1, "diameter": 4.0, "name": "Hasty", "cuts": [{**plain, "rate_units": 77}]},
            ],
            tmp_path / "made.db",
        )
        library, told = read_tools("shop.vtdb", made)
        tools = {tool.name: tool for tool in library.tools}
        quarter = tools["Quarter"]
        assert (quarter.number, quarter.kind, quarter.diameter) == (12, ToolKind.FLAT, 6.35)
        assert (quarter.spindle_speed, quarter.feed_rate, quarter.plunge_rate) == (18000.0, 1524.0, 762.0)
        (row,) = quarter.feeds
        assert (row.material, row.plunge_share) == ("Oak", 0.5)
        assert row.feed_per_tooth == pytest.approx(1524 / (18000 * 2))
        assert tools["Ball Nose (3 mm)"].feed_rate == 1000.0
        assert tools["V"].tip_angle == pytest.approx(math.pi / 3)
        assert (tools["Engraver"].tip_diameter, tools["Engraver"].kind) == (0.2, ToolKind.V)
        assert (tools["Radiused"].kind, tools["Radiused"].corner_radius) == (ToolKind.BULL, 1.0)
        assert (tools["Tapered"].tip_diameter, tools["Tapered"].tip_angle) == (1.0, pytest.approx(math.radians(10)))
        assert tools["Drill"].kind is ToolKind.DRILL
        assert tools["Hasty"].feed_rate == Tool(1, 4.0).feed_rate
        assert len({tool.number for tool in library.tools}) == len(library.tools) == 8
        for words in ("Drag is left out: it is a diamond drag", "Odd is left out", "code 77", "that of one side"):
            assert any(words in each for each in told), (words, told)

    def test_what_is_no_database_is_told(self, tmp_path: Path) -> None:
        whole = vectric([{"tool_type": 1, "diameter": 6.0, "name": "Six"}], tmp_path / "made.db")
        for data in (b"", b"SQLite format 3\x00" + b"x" * 200, b"no", whole[:2000]):
            with pytest.raises(InputError, match=r"t\.vtdb: "):
                read_tools("t.vtdb", data)


def test_damaged_files_make_tools_or_a_sentence(tmp_path: Path) -> None:
    """Nothing but a library or an InputError comes of any bytes, whatever is overwritten, cut or doubled."""
    base = vectric(
        [{"tool_type": 1, "diameter": 6.0, "name": "Six", "cuts": [{"feed_rate": 5.0}]}], tmp_path / "made.db"
    )
    entries = [fusion_tool(number=3, holder=HOLDER), fusion_tool("drill", 4, SIG=118)]
    seeds = {
        "t.json": fusion_json(entries),
        "t.tools": fusion_archive(entries),
        "t.fctb": bit("v-bit", Diameter="6 mm", CuttingEdgeAngle="60 °"),
        "t.vtdb": base,
    }
    chance = random.Random(5)
    for name, data in seeds.items():
        for _ in range(60):
            broken = bytearray(data)
            for _ in range(chance.randint(1, 6)):
                at = chance.randrange(len(broken))
                broken[at : at + chance.choice((0, 1, 4))] = bytes(
                    chance.choices(range(256), k=chance.choice((0, 1, 4)))
                )
            try:
                assert read_tools(name, bytes(broken)).library.tools
            except InputError as error:
                assert str(error).startswith(name)


def _with_odd_values(tree: Any) -> Iterator[Any]:
    """Yield a tree of JSON with each of its values in turn in another kind, in the place of what it is."""
    if not isinstance(tree, dict | list):
        return
    for key in list(tree) if isinstance(tree, dict) else range(len(tree)):
        for odd in (None, "", "x", [], [1], {}, {"a": 1}, True, -1, 0, 1e300, "6,5 mm"):
            changed = copy.deepcopy(tree)
            changed[key] = odd
            yield changed
        for inner in _with_odd_values(tree[key]):
            changed = copy.deepcopy(tree)
            changed[key] = inner
            yield changed


def test_values_of_another_kind_make_tools_or_a_sentence() -> None:
    fusion = json.loads(fusion_json([fusion_tool(number=3, holder=HOLDER), fusion_tool("chamfer mill", 4, TA=45)]))
    cone = json.loads(bit("v-bit", Diameter="6 mm", CuttingEdgeAngle="60 °"))
    for name, whole in (("t.json", fusion), ("t.fctb", cone)):
        for tree in _with_odd_values(whole):
            try:
                assert read_tools(name, json.dumps(tree).encode()).library.tools
            except InputError as error:
                assert str(error).startswith(name)


def test_they_are_read_by_every_command_and_not_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shop, kept = tmp_path / "shop.tools", tmp_path / "kept.toml"
    shop.write_bytes(fusion_archive([fusion_tool(number=3)]))
    assert main(["feeds", "--material", "brass", "--tools", str(shop), "--write", str(kept)]) in (0, 1)
    assert "T3 flat end mill 3 in brass" in capsys.readouterr().out
    assert read_library("kept.toml", kept.read_bytes()).tools[0].stick_out == 25.0
    with pytest.raises(InputError, match=r"read alone; write them as \.toml, \.csv, \.tbl"):
        write_tools("x.json", read_library("kept.toml", kept.read_bytes()))


@pytest.mark.parametrize("digits", [400, 5000])
def test_whole_numbers_of_any_length_are_one_sentence(digits: int) -> None:
    big = "9" * digits
    fusion = fusion_json([fusion_tool(number=3), fusion_tool(number=4)]).replace(
        b'"DC": 6.0', f'"DC": {big}'.encode(), 1
    )
    freecad = bit("endmill", Diameter="6 mm", Length="Z").replace(b'"Z"', big.encode())
    for name, data in (("t.json", fusion), ("t.fctb", freecad)):
        try:
            said = " ".join(read_tools(name, data).left_out)
        except InputError as error:
            said = str(error)
        assert said.startswith(name) and len(said) < 300, said
