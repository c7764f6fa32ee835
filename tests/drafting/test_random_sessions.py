"""Sessions of lines drawn at random from every command, on real drawings: clear errors alone, sound curves, and a log
that draws again.
"""

import math
import random
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
import shapely
import shapely.ops

from app.core.errors import InputError
from app.core.tolerances import WELD
from app.drafting.curves.area import enclosed_area
from app.drafting.curves.shapes import curve_length
from app.drafting.document import Document
from app.drafting.language.language import COMMANDS
from app.drafting.language.write import draw_text
from app.formats.readers import read_drawing
from app.model.curves import Arc, Circle, Curve, Ellipse, Line
from app.model.part import Part
from tests.drafting.test_write import numbers

DRAWINGS = ("fig2", "forms", "apu-mount", "genshi", "insert", "POLI-ALL210_12")


class Chance:
    """Numbers, places and curves of a drawing, as a user may take them."""

    def __init__(self, seed: int, document: Document) -> None:
        self.rng, self._document = random.Random(seed), document

    def length(self) -> str:
        return self.rng.choice(("0", "0.001", "1", "2.5", "10", "1/4in", f"{self.rng.uniform(0.01, 40):.4f}"))

    def angle(self) -> str:
        return self.rng.choice(("0", "30", "90", "180", "-45", f"{self.rng.uniform(-400, 400):.3f}"))

    def curve(self) -> str:
        return str(self.rng.choice(self._document.part.entities).id) if self._document.part.entities else "1"

    def note(self) -> str:
        return str(self.rng.choice(self._document.part.notes).id) if self._document.part.notes else self.curve()

    def curves(self) -> str:
        first = int(self.curve())
        return self.rng.choice(
            (self.curve(), f"{self.curve()} {self.curve()} {self.note()}", f"{first}-{first + 3}", "")
        )

    def point(self) -> str:
        entities = self._document.part.entities
        x, y = self.rng.uniform(-50, 150), self.rng.uniform(-50, 150)
        if entities and self.rng.random() < 0.6:
            curve = self.rng.choice(entities).curve
            x, y = self.rng.choice(
                (curve.start, curve.end, ((curve.start[0] + curve.end[0]) / 2, (curve.start[1] + curve.end[1]) / 2))
            )
        near = self.curve()
        plain = (f"{x!r},{y!r}", f"{x:.2f},{y:.2f}", "@5,-3", "@12<45")
        return self.rng.choice((*plain * 4, f"foot({x},{y}, {near})", f"meet({near}, {self.curve()}, {x},{y})"))

    def line(self) -> str:
        """Return a line of a command drawn at random."""
        one = self.curve()
        fill = {
            "P": self.point,
            "D": self.length,
            "A": self.angle,
            "C": self.curve,
            "S": self.curves,
            "N": self.note,
            "L": self.layer,
            "C1": lambda: one,
            "C2": lambda: str(int(one) + 1),
        }
        template = self.rng.choice(self.rng.choice(list(CHOICES.values())))
        return re.sub(r"\b([PDASNL]|C[12]?)\b", lambda found: fill[found[1]](), template)

    def layer(self) -> str:
        return (
            '"'
            + self.rng.choice([*(layer.name for layer in self._document.part.layers), "new"]).replace('"', "'")
            + '"'
        )


LINES = """
line P P | line P P P close
polyline P P arc P P close
arc P P P | arc P P radius D large | arc on P | arc P P centre P cw
circle P D | circle P through P as c | circle through P P P
rect P P | rect P P round D
polygon 6 P P | polygon 5 P side P
slot P P D
ellipse P P D | ellipse P P D from A to A cw
spline P P P P | spline degree 2 P P P weights 1 2 1
text P 10 "R2" angle A
point P
guide P A | guide up P as g
dimension C place P | dimension P P place P across | dimension angle P P P place P
select all | select C | select chain C | select add crossing P P | select layer L | select none
delete C
reverse S
layer L | layer L C
move @3,-2 S
copy @D<A times 2 S
rotate P A S
scale P 0.5 S | scale P -1 S | scale P 1.001 S
mirror P P copy S
array 2 3 @D,D C | array polar P 4 C
hide L
show L
lock L
unlock L
colour L "#d55e00" | colour L none
order layer L before L
rename layer L to "other"
remove layer L
trim C P | trim C1 middle(C1) by C2 N | line P P; trim C P
extend C P | extend C P to N
break C P | break C P P | break C1 middle(C1)
fillet D C P C P | fillet D S | fillet 0 C1 C2 | fillet D C1 C2
chamfer D C C | chamfer D and D S | chamfer D C1 C2
offset D P C | offset D P S round
join S | join within D S
explode C
measure | measure S | measure P P
heal 0.01 | heal D S
pull C1 start(C1) to P | pull C1 C2 finish(C1) to P | pull S P to P
set C length D | set C radius D | set C angle A | set C major D | set C sweep A | set C start P | set C end P
    | set C centre P
undo | undo 2
redo
"""
"""What is asked for, a command a line: P a point, D a length, A an angle, C a curve, S some curves, N a note, L a
layer.
"""

CHOICES = {words.split()[0]: words.split(" | ") for words in LINES.replace("\n    | ", " | ").strip().splitlines()}


def test_every_command_is_among_those_drawn_at_random() -> None:
    assert set(CHOICES) == set(COMMANDS) - {"clear"}


def session(data: Path, name: str, seed: int, lines: int) -> Iterator[tuple[Document, str]]:
    path = data / "dxf" / f"{name}.dxf"
    document = Document()
    document.run_script(draw_text(read_drawing(str(path), path.read_bytes()).part).text)
    chance = Chance(seed, document)
    for _ in range(lines):
        line = chance.line()
        try:
            document.run(line)
        except InputError as error:
            assert str(error).endswith((".", "?", "…")) and len(str(error)) < 300, (line, str(error))
        yield document, line


def check_sound(part: Part, line: str) -> None:
    ids = [e.id for e in part.entities] + [n.id for n in part.notes]
    assert len(ids) == len(set(ids)) and max(ids, default=0) < part.next_id(), line
    known = {layer.name for layer in part.layers}
    assert {e.layer for e in part.entities} | {n.layer for n in part.notes} <= known, line
    for entity in part.entities:
        check_curve(entity.curve, f"{line}: {entity}")


def check_curve(curve: Curve, what: str) -> None:
    assert all(map(math.isfinite, numbers(curve))), what
    if isinstance(curve, Line | Arc):
        assert math.dist(curve.start, curve.end) >= WELD, what
    if isinstance(curve, Arc):
        a, b = math.dist(curve.start, curve.centre), math.dist(curve.end, curve.centre)
        assert abs(a - b) <= 2e-3 and min(a, b) >= WELD, what
    if isinstance(curve, Circle):
        assert curve.radius >= WELD, what
    if isinstance(curve, Ellipse):
        assert 0 < curve.ratio <= 1 + 1e-12 and 0 < curve.end_parameter - curve.start_parameter <= math.tau + 1e-9, what


def check_alike(one: Part, other: Part) -> None:
    assert [(e.id, e.layer, type(e.curve)) for e in one.entities] == [
        (e.id, e.layer, type(e.curve)) for e in other.entities
    ]
    assert one.layers == other.layers and [(n.id, n.layer) for n in one.notes] == [(n.id, n.layer) for n in other.notes]
    for a, b in zip(one.entities, other.entities, strict=True):
        assert numbers(a.curve) == pytest.approx(numbers(b.curve), rel=1e-9, abs=1e-6)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", DRAWINGS)
def test_random_sessions_end_in_sound_drawings_and_their_logs_draw_them_again(name: str, seed: int, data: Path) -> None:
    before = None
    for document, line in session(data, name, seed, 30):
        if document.part is not before:
            check_sound(document.part, line)
        before = document.part
    again = Document()
    again.run_script(document.recorded.text())
    check_alike(again.part, document.part)


def convex(rng: random.Random, corners: int) -> list[tuple[float, float]]:
    turns = sorted(rng.uniform(0, math.tau) for _ in range(corners))
    return [(50 * math.cos(t), 35 * math.sin(t)) for t in turns]


@pytest.mark.parametrize("seed", range(12))
def test_rounded_corners_enclose_what_a_round_disc_reaches_inside(seed: int) -> None:
    rng = random.Random(seed)
    points = convex(rng, rng.randint(4, 7))
    document = Document()
    document.run(f"line {' '.join(f'{x!r},{y!r}' for x, y in points)} close")
    radius = round(rng.uniform(0.1, 1.0), 3)
    if document.run(f"fillet {radius} 1-{len(points)}") != f"{len(points)} corners.":
        return
    opened = shapely.Polygon(points).buffer(-radius, quad_segs=400).buffer(radius, quad_segs=400)
    assert enclosed_area([e.curve for e in document.part.entities]) == pytest.approx(opened.area, rel=1e-5)


@pytest.mark.parametrize("seed", range(12))
def test_trimming_leaves_what_lies_outside_the_edges(seed: int) -> None:
    rng = random.Random(seed)
    ends = [(rng.uniform(0, 100), rng.uniform(0, 100)) for _ in range(10)]
    segments = [shapely.LineString(pair) for pair in zip(ends[::2], ends[1::2], strict=True)]
    document = Document()
    document.run(
        "; ".join(f"line {a[0]!r},{a[1]!r} {b[0]!r},{b[1]!r}" for a, b in zip(ends[::2], ends[1::2], strict=True))
    )
    at = segments[0].interpolate(rng.uniform(0.1, 0.9), normalized=True)
    pieces = list(shapely.ops.split(segments[0], shapely.MultiLineString(segments[1:])).geoms)
    if len(pieces) < 2:
        with pytest.raises(InputError, match="Nothing crosses"):
            document.run(f"trim 1 {at.x!r},{at.y!r}")
        return
    document.run(f"trim 1 {at.x!r},{at.y!r}")
    left = sum(curve_length(e.curve) for e in document.part.entities if e.id not in range(2, 6))
    assert left == pytest.approx(segments[0].length - min(pieces, key=at.distance).length, abs=1e-9)
