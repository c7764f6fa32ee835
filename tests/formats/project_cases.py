"""Random jobs and drawings, for what must write and read every one of them."""

import math

from hypothesis import strategies as st

from app.drafting.expressions.grammar import read_script
from app.drafting.expressions.syntax import CommandDefinition
from app.drafting.expressions.values import Curves
from app.drafting.history import HistoryState
from app.formats.project.extras import ProjectExtras
from app.formats.project.project import Project, SavedView
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import CirclesOf, ContourKind, CurveNumber, Selector, on_layers
from app.model.curves import Arc, Circle, Ellipse, Line, Spline
from app.model.entry import Entry, EntryKind, Lead, LeadKind, Tabs
from app.model.hole_operations import DrillOperation
from app.model.job import Copies, Job, OriginXY, OriginZ, Stock
from app.model.notes import Dimension, DimensionKind, Guide, Mark, Note
from app.model.operation import CutParameters, Direction, Order, PocketOperation, RestOperation, Side
from app.model.part import Entity, Layer, Part, Units
from app.model.read_options import DrawingOptions
from app.model.reading import DrawingSource, ReadingOptions
from app.model.tool import FeedRow, Tool
from app.model.tool_kind import shape_keys, tool_kinds
from app.model.underlay import Underlay


def floats(low: float, high: float, **more: bool) -> st.SearchStrategy[float]:
    return st.floats(low, high, **more)


LENGTH = st.floats(-1e6, 1e6)
POINT = st.tuples(LENGTH, LENGTH)
TEXT = st.text(st.characters(codec="utf-8"), max_size=12)
NAMES = st.lists(
    st.one_of(TEXT, st.sampled_from(["0", "a'b", 'a"b', "'''", "\x7f", "a\\b", "a\u2028b", "穴"])),
    unique=True,
    max_size=4,
)
CURVES = st.one_of(
    st.builds(Line, POINT, POINT),
    st.builds(Arc, POINT, POINT, POINT, st.booleans()),
    st.builds(Circle, POINT, floats(0, 1e6), st.booleans()),
    st.builds(Ellipse, POINT, st.tuples(floats(1e-3, 1e3), LENGTH), floats(1e-6, 1), ccw=st.booleans()),
    st.builds(
        Ellipse,
        POINT,
        st.tuples(floats(1e-3, 1e3), LENGTH),
        floats(1e-6, 1),
        floats(-7, 0),
        floats(0.1, 7),
        st.booleans(),
    ),
    st.builds(
        Spline,
        st.just(2),
        st.tuples(POINT, POINT, POINT),
        st.just((0.0, 0.0, 0.0, 1.0, 1.0, 1.0)),
        st.one_of(st.just(()), st.tuples(*[floats(1e-3, 10)] * 3)),
    ),
)
TWO = st.tuples(POINT, POINT)
SHAPES = st.one_of(
    st.builds(Mark, POINT),
    st.builds(Guide, POINT, floats(0, math.pi, exclude_max=True)),
    st.builds(
        Dimension, st.sampled_from([each for each in DimensionKind if each is not DimensionKind.ANGLE]), TWO, POINT
    ),
    st.builds(Dimension, st.just(DimensionKind.ANGLE), st.tuples(POINT, POINT, POINT), POINT),
)


@st.composite
def parts(draw: st.DrawFn) -> Part:
    layers = tuple(
        Layer(name, draw(st.sampled_from(["", "#d55e00", "#FFFFFF"])), draw(st.booleans()), draw(st.booleans()))
        for name in draw(NAMES)
    ) or (Layer(),)
    on = st.sampled_from([layer.name for layer in layers])
    ids = draw(st.lists(st.integers(1, 300), unique=True, max_size=12))
    cut = draw(st.integers(0, len(ids)))
    entities = tuple(Entity(number, draw(CURVES), draw(on), draw(st.booleans())) for number in ids[:cut])
    notes = tuple(Note(number, draw(SHAPES), draw(on)) for number in ids[cut:])
    return Part(
        entities, layers, draw(st.sampled_from(Units)), draw(TEXT), draw(st.sampled_from([0, 300, 1000])), notes
    )


@st.composite
def tools(draw: st.DrawFn, number: int) -> Tool:
    kind, diameter = draw(st.sampled_from(tool_kinds())), draw(floats(0.1, 100))
    known = {
        "corner_radius": floats(0, diameter / 2.01),
        "tip_diameter": floats(0, diameter / 1.01),
        "tip_angle": floats(0, 3.14),
    }
    shape = {key: draw(known[key]) for key in sorted(shape_keys(kind))}
    rates = {key: draw(floats(1, 9e5)) for key in ("spindle_speed", "feed_rate", "plunge_rate")}
    holder = draw(st.sampled_from([(), ((0.0, 10.0), (25.0, 15.5)), ((0.0, 1 / 3), (0.0, 2.0), (7.5, 0.0))]))
    feeds = tuple(
        FeedRow(name, draw(floats(1, 1e3)), draw(floats(1e-3, 1)), draw(floats(1e-3, 1)))
        for name in draw(st.lists(st.sampled_from(["steel", "wood, oak", 'a "b"']), unique=True, max_size=2))
    )
    return Tool(
        number,
        diameter,
        kind,
        draw(TEXT),
        draw(st.integers(1, 100)),
        **rates,
        **shape,
        flute_length=draw(floats(0, 50)),
        overall_length=draw(floats(50, 90)),
        stick_out=draw(floats(0, 50)),
        shank_diameter=draw(floats(0, 50)),
        holder=holder,
        length_offset=draw(floats(-99, 99)),
        feeds=feeds,
        remark=draw(TEXT),
    )


def selectors() -> st.SearchStrategy[tuple[Selector, ...]]:
    """Return what operations may say of their curves."""
    circles = st.tuples(floats(0.01, 99), floats(0.01, 99)).map(
        lambda ends: CirclesOf(*(round(e, 9) for e in sorted(ends)))
    )
    others = st.one_of(st.integers(1, 10**9 - 1).map(CurveNumber), circles, st.sampled_from(ContourKind))
    return st.tuples(NAMES.map(on_layers), st.lists(others, unique=True, max_size=3)).map(
        lambda two: (*two[0], *two[1])
    )


@st.composite
def operations(draw: st.DrawFn) -> ContourOperation | PocketOperation | RestOperation | DrillOperation:
    entry = Entry(draw(st.sampled_from(EntryKind)), draw(floats(1e-3, math.pi / 4)))
    depth = draw(floats(1, 100))
    cut = CutParameters(
        draw(st.integers(1, 9)),
        depth,
        draw(floats(0.5, 1e3)),
        draw(floats(0, 10)),
        draw(st.sampled_from(Direction)),
        draw(st.booleans()),
        draw(floats(0, 0.2)),
        draw(floats(0, 0.5)),
        entry,
        draw(selectors()),
    )
    maybe = st.one_of(st.none(), floats(0.1, 50))
    share = floats(0.05, 1)
    kind = draw(st.integers(0, 3))
    if kind == 0:
        return PocketOperation(cut, draw(maybe), draw(st.booleans()), draw(share))
    if kind == 1:
        return RestOperation(cut, draw(maybe), draw(share))
    if kind == 2:
        least, most = (draw(st.one_of(st.none(), floats(low, low + 1))) for low in (0.1, 2))
        return DrillOperation(cut, least, most, draw(maybe), through=draw(floats(0, 1000)))
    lead = Lead(draw(st.sampled_from(LeadKind)), draw(maybe), draw(floats(0, 50)))
    tabs = Tabs(
        draw(st.integers(0, 100)),
        draw(floats(0.1, 1000)),
        draw(floats(0.01, 1000)),
        tuple(
            draw(st.lists(TWO.map(lambda p: (max(min(p[0][0], 9e5), -9e5), max(min(p[0][1], 9e5), -9e5))), max_size=3))
        ),
    )
    side = draw(st.sampled_from([Side.INSIDE, Side.OUTSIDE]))
    return ContourOperation(
        cut,
        side,
        lead,
        tabs,
        draw(st.integers(0, 10)),
        draw(st.booleans()),
        draw(floats(0, 100)),
        draw(st.booleans()),
        draw(share),
    )


@st.composite
def jobs(draw: st.DrawFn, part: Part | None = None) -> Job:
    safe = draw(floats(1, 100))
    copies = draw(
        st.one_of(
            st.just(Copies()),
            st.builds(Copies, st.integers(2, 30), st.integers(2, 30), floats(1, 99), floats(-99, -1)),
            st.builds(Copies, st.just(1), st.just(1), floats(0, 99), floats(0, 99)),
        )
    )
    numbers = draw(st.lists(st.integers(1, 9999), max_size=3))
    return Job(
        part or Part(),
        tuple(draw(tools(number)) for number in numbers),
        tuple(draw(st.lists(operations(), max_size=3))),
        Stock(draw(floats(0, 9e4)), draw(floats(1e-3, 9e4))),
        draw(st.sampled_from(OriginXY)),
        draw(st.sampled_from(OriginZ)),
        safe,
        draw(floats(1e-3, 1)),
        tuple(draw(NAMES)),
        draw(floats(0, 10)),
        draw(st.sampled_from(["grbl", "x y"])),
        draw(st.sampled_from([Units.MM, Units.INCH])),
        draw(st.sampled_from(Order)),
        draw(st.booleans()),
        copies,
        tuple(draw(NAMES)),
        draw(floats(0, 9e4)),
    )


def plate() -> Part:
    """Return a rectangle with a hole."""
    corners = [(0.0, 0.0), (60.0, 0.0), (60.0, 40.0), (0.0, 40.0)]
    sides = [Line(corners[k], corners[(k + 1) % 4]) for k in range(4)]
    return Part(name="plate").with_curves([*sides, Circle((30.0, 20.0), 8.0)], "0")


BOLT = 'define Bolt(c, r)\n  circle c r # "hole"\n  if r > 2\n    layer "deep"\n  end\nend'


def command() -> CommandDefinition:
    (defined,) = read_script(BOLT)
    assert isinstance(defined, CommandDefinition)
    return defined


@st.composite
def projects(draw: st.DrawFn) -> Project:
    part = draw(parts())
    values = st.one_of(LENGTH, POINT, st.lists(st.integers(1, 40), max_size=9).map(lambda ids: Curves(tuple(ids))))
    names = draw(st.dictionaries(st.sampled_from(["w", "hole", "ö", "a_1", "穴"]), values))
    commands = draw(st.sampled_from([{}, {"bolt": command()}]))
    layer = draw(st.sampled_from([layer.name for layer in part.layers]))
    look = SavedView(
        draw(st.sampled_from(["", "view_cut"])), draw(st.one_of(st.none(), POINT)), draw(floats(1e-6, 1e6))
    )
    place = st.builds(
        Underlay, TEXT.map(lambda name: f"p{name}"), POINT, floats(1e-6, 1e3), floats(-7, 7), floats(0, 1)
    )
    text = st.lists(TEXT, min_size=1, max_size=5).map(lambda lines: "\n".join(["x", *lines]))
    beside = ProjectExtras(
        draw(st.one_of(st.none(), place)), *draw(st.one_of(st.just(()), st.tuples(text, st.booleans())))
    )
    state = HistoryState(
        draw(jobs(part)), layer, draw(POINT), names, commands, source=draw(st.one_of(st.none(), sources()))
    )
    return Project(state, look, beside)


def sources() -> st.SearchStrategy[DrawingSource]:
    """Return drawings that parts were read from, in every way that they can be read."""
    names = NAMES.map(tuple)
    how = st.builds(
        DrawingOptions, st.booleans(), TEXT, st.booleans(), st.one_of(st.none(), floats(1, 1e5)), names, names
    )
    reading = st.builds(ReadingOptions, st.one_of(st.none(), st.sampled_from(Units)), names, how)
    return st.builds(DrawingSource, TEXT.map(lambda name: f"d{name}.dxf"), reading)
