"""The films of the texts B to E: every numbered step is there, and its figures hold by other means than those that made
them.
"""

from __future__ import annotations

import json
import math
from functools import cache
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from app.cli.main import main
from app.core.resources import resource
from app.exhibits.films.compound import evaluated
from app.exhibits.films.depth_raster import drawn
from app.exhibits.films.dexels import SAMPLE, dexel_film, sample_input
from app.exhibits.films.effective import EffectiveFilmOptions, effective_film, range_trials, ranges_of
from app.exhibits.films.making import FilmSource, film_files, make_film
from app.exhibits.films.measures import distances_to_polyline
from app.exhibits.films.program_input import input_of, program_input
from app.exhibits.films.programs import points_of
from app.exhibits.films.proven import ChordAxis, intervals_in_cylinder, proven_film, surface_witness
from app.exhibits.films.step import TEXTS, FilmStep, PublishedText, TextFilm
from app.exhibits.films.step_drawing import BOLD, FAINT, FINE
from app.fitting.point_curves.effective_points import EffectiveOptions, effective_points
from app.fitting.point_curves.region_profile import profile_of_formula
from app.fitting.point_curves.space_curve import SpaceCurve
from app.geometry.arcs.bezier import elevated
from app.model.part import Units
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.field.workpiece import Grid
from app.simulation.gpu.wedges import polygon_counts
from app.surfaces.patches.patch import BsplineSurface
from app.usecases.examine import ExamineOptions
from tests import raster_program

STEPS = {
    "B": [f"S{n}" for n in range(100, 111)],
    "C": [f"({letter})" for letter in "abcdefghi"],
    "D": ["S111", "S112", "S113", "S114", "S115", "S116", "S117", "S21", "S22", "S23", "S12"],
    "E": ["figure 2", "figure 3", "figure 5", "figure 6", "figure 7", "figure 8", "figure 4, end"],
}


@cache
def film(letter: str) -> TextFilm:
    return make_film(TEXTS[letter])


def step(letter: str, number: str) -> FilmStep:
    return next(each for each in film(letter).steps if each.number == number)


def value(of: FilmStep, name: str) -> float:
    [found] = [each.value for each in of.figures if each.name == name]
    assert isinstance(found, int | float)
    return float(found)


@pytest.mark.parametrize("letter", [pytest.param("B", marks=pytest.mark.exhaustive), "C", "D", "E"])
def test_every_numbered_step_is_there_with_words_figures_and_a_picture(letter: str) -> None:
    made = film(letter)
    numbers = [each.number for each in made.steps]
    assert len(set(numbers)) == len(numbers)
    assert [number for number in numbers if ", round " not in number] != []
    assert {number for number in numbers if ", round " not in number} == set(STEPS[letter])
    for each in made.steps:
        assert each.name and each.says.endswith(".") and each.figures
        assert each.page.frame.traces or each.page.frame.patches or each.page.drawing.patches, each.number


@pytest.mark.parametrize("letter", ["D", "E"])
def test_files_are_pictures_tables_and_one_list_of_all_figures(letter: str) -> None:
    files = film_files(film(letter))
    told = json.loads(files["film.json"])
    assert [each["number"] for each in told["steps"]] == [each.number for each in film(letter).steps]
    for each in told["steps"]:
        root = ElementTree.fromstring(files[f"{each['files']}.svg"])
        assert root.tag.endswith("svg") and files[f"{each['files']}.png"].startswith(b"\x89PNG")
        assert (f"{each['files']}.csv" in files) == bool(each["table"])


@pytest.mark.parametrize("letter", "ABCDE")
@pytest.mark.exhaustive
def test_the_command_writes_each_text_on_its_sample(letter: str, tmp_path: Path) -> None:
    out = tmp_path / "film"
    assert main(["stages", "--text", letter, "-o", str(out), "--quiet"]) in (0, 1)
    assert len(list(out.glob("*.png"))) >= 9


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--text", "C", "--facet", "2"], "--facet belongs to --text B"),
        (["--text", "D", "--pocket-tool", "6"], "--pocket-tool belongs to --text A"),
        (["--epsilon", "0.1"], "--text D"),
        (["--text", "E", "--region", "f:z"], "--region"),
    ],
)
def test_options_of_another_text_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], told: str
) -> None:
    try:
        status = main(["stages", "-o", str(tmp_path / "film"), *options])
    except SystemExit as left:
        status = int(str(left.code))
    assert status == 2 and told in capsys.readouterr().err and not (tmp_path / "film").exists()


# ---- D


def ellipse_distance(places: np.ndarray) -> np.ndarray:
    """How far places are from the half ellipse that the sample was made of, by dense chords."""
    t = np.linspace(0, math.pi, 200_001)
    curve = np.column_stack([40 * np.cos(t), 25 * np.sin(t), np.full_like(t, -1.0)])
    nearest = np.clip(np.searchsorted(-curve[:, 0], -places[:, 0]), 1, len(t) - 2)
    window = np.arange(-2500, 2500)
    at = np.clip(nearest[:, None] + window, 0, len(t) - 1)
    return np.linalg.norm(curve[at] - places[:, None], axis=2).min(axis=1)


def test_effective_points_of_the_sample_are_those_on_the_true_shape() -> None:
    data = resource("samples", "facets.ngc").read_bytes()
    points = points_of("facets.ngc", data)
    found = effective_points(points, EffectiveOptions(0.01)).passed
    off = ellipse_distance(points)
    assert off[found].max() < 1e-3 and np.delete(off, found).min() > 0.02
    assert value(step("D", "S116"), "effective points") == len(found) == 25
    assert value(step("D", "S12"), "by effective points: farthest effective point") < 0.001
    assert value(step("D", "S12"), "by all points: farthest effective point") > 0.05


def test_the_loop_of_the_text_finds_what_the_program_finds() -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        points = np.cumsum(rng.normal(size=(60, 3)) * [1, 0.2, 0.05], axis=0)
        trials = range_trials(points, 0.3, frozenset())
        assert ranges_of(trials) == [
            tuple(row) for row in effective_points(points, EffectiveOptions(0.3)).ranges.tolist()
        ]


def test_moved_points_lie_on_the_curve_that_is_drawn() -> None:
    assert value(step("D", "S23"), "moved points off the curve") < 1e-5
    assert value(step("D", "S23"), "largest move in this range") > 0.01


def test_a_film_of_another_program_and_of_one_that_has_nothing_to_show() -> None:
    data = resource("samples", "points.ngc").read_bytes()
    made = effective_film("points.ngc", data, points_of("points.ngc", data), EffectiveFilmOptions(0.3, 1.0))
    assert made.text is PublishedText.D and len(made.steps) == 11


def test_of_a_long_program_the_film_measures_no_more_than_was_proven() -> None:
    """Chords of a picture would be farther off, about the short arcs between passes."""
    data = raster_program.text(raster_program.rows(wide=12.0, deep=3.0)).encode()
    made = effective_film("raster.ngc", data, points_of("raster.ngc", data), EffectiveFilmOptions(0.005, 0.1))
    last = made.steps[-1]
    farthest = value(last, "by effective points: farthest effective point")
    assert 0 < farthest <= value(last, "nearness that was proven") + 1e-5


# ---- E


def bezier(*pieces: list[list[float]]) -> SpaceCurve:
    control = np.concatenate([elevated(np.array([piece], float), 5) for piece in pieces])
    return SpaceCurve(control, np.zeros(len(control), np.int64))


def test_where_a_curve_passes_a_cylinder_is_found_to_the_last_digit() -> None:
    curve = bezier(
        [[0, -0.1, 0], [1, 0.4, 0.1], [2, -0.5, 0], [3, 0.1, 0]], [[3, 0.1, 0], [4, 0.7, 0], [5, -0.6, 0.2], [6, 0, 0]]
    )
    axis = (np.zeros(3), np.array([6.0, 0, 0]))
    cuts, held = intervals_in_cylinder(curve, ChordAxis(*axis), 0.05, (0.0, 2.0))
    off = np.linalg.norm(curve.at(np.array(cuts))[:, 1:], axis=1)
    assert len(cuts) >= 4 and np.allclose(off, 0.05, atol=1e-9)
    u = np.linspace(0, 2, 100_001)
    inside = np.linalg.norm(curve.at(u)[:, 1:], axis=1) <= 0.05
    told = np.zeros(len(u), bool)
    for low, high in held:
        told |= (u >= low) & (u <= high)
    assert np.mean(told != inside) < 2e-4


def test_no_way_by_the_surface_is_shorter_and_no_curve_longer() -> None:
    curve = bezier([[0, 0.0, 0], [1, 0.04, 0.01], [2, 0.04, 0], [3, 0.01, 0]])
    axis, profile = (np.zeros(3), np.array([3.0, 0, 0])), profile_of_formula("0.02 + 0.06*sin(pi*z)")
    seen = surface_witness(curve, ChordAxis(*axis), profile, (0.0, 1.0))
    rng = np.random.default_rng(0)
    z, turn = rng.uniform(0, 1, 200_000), rng.uniform(0, 2 * math.pi, 200_000)
    r = 0.02 + 0.06 * np.sin(math.pi * z)
    places = np.column_stack([3 * z, r * np.cos(turn), r * np.sin(turn)])
    ways = np.linalg.norm(places - seen.p, axis=1) + np.linalg.norm(places - seen.q, axis=1)
    assert seen.way <= ways.min() + 1e-6
    u = np.linspace(0, 1, 20_001)
    stretch = curve.at(u)
    stretch = stretch[(stretch[:, 0] >= seen.p[0] - 1e-12) & (stretch[:, 0] <= seen.q[0] + 1e-12)]
    assert np.linalg.norm(np.diff(stretch, axis=0), axis=1).sum() <= seen.length + 1e-9


def test_the_curve_of_the_film_is_in_its_region_by_dense_samples() -> None:
    formula, name = "0.02 + 0.03*sin(pi*z)", "points.ngc"
    points = points_of(name, resource("samples", name).read_bytes())
    made = proven_film(name, points, profile_of_formula(formula))
    [drawn_curve] = [trace for trace in made.steps[-1].page.frame.traces if len(trace.points) >= 600][:1]
    place = made.steps[-1].page.place
    back = (drawn_curve.points[:, 0] + 1j * drawn_curve.points[:, 1] - place.b) / place.a
    curve = np.column_stack([back.real, back.imag, np.full(len(back), -1.0)])
    least = np.full(len(curve), np.inf)
    for a, b in pairwise(points):
        chord = b - a
        z = (curve - a) @ chord / (chord @ chord)
        off = np.linalg.norm(curve - a - z[:, None] * chord, axis=1)
        body = np.where((z >= 0) & (z <= 1), off - (0.02 + 0.03 * np.sin(math.pi * np.clip(z, 0, 1))), np.inf)
        least = np.minimum.reduce([least, body, *(np.linalg.norm(curve - end, axis=1) - 0.02 for end in (a, b))])
    assert least.max() <= 1e-4
    assert distances_to_polyline(curve, points).max() <= value(made.steps[-1], "proven") + 1e-6


def test_rounds_are_those_of_figure_4_until_nothing_fails() -> None:
    rounds = [each for each in film("E").steps if ", round " in each.number]
    counts = [value(each, "control points") for each in rounds]
    assert counts == sorted(counts) and len(rounds) >= 3
    answers = [next(figure.value for figure in each.figures if figure.name == "region") for each in rounds]
    assert answers[-1] == "inside" and set(answers[:-1]) <= {"outside", "undecided"}
    assert value(step("E", "figure 8"), "spare") > 0


# ---- C


def basis(knots: np.ndarray, degree: int, at: float) -> np.ndarray:
    """The basis functions by their recursion, none of scipy's."""
    count = len(knots) - degree - 1
    value = [
        1.0 if knots[i] <= at < knots[i + 1] or (at == knots[-1] and knots[i] < at == knots[i + 1]) else 0.0
        for i in range(len(knots) - 1)
    ]
    for k in range(1, degree + 1):
        value = [
            (0 if knots[i + k] == knots[i] else (at - knots[i]) / (knots[i + k] - knots[i]) * value[i])
            + (
                0
                if knots[i + k + 1] == knots[i + 1]
                else (knots[i + k + 1] - at) / (knots[i + k + 1] - knots[i + 1]) * value[i + 1]
            )
            for i in range(len(knots) - 1 - k)
        ]
    return np.array(value[:count])


def test_boundary_points_are_as_high_on_both_surfaces() -> None:
    assert value(step("C", "(f)"), "largest distance in z, all planes") <= 1e-9
    assert value(step("C", "(g)"), "boundary points") == 34


def test_covered_section_curves_are_drawn_lightly_and_the_topmost_in_their_colours() -> None:
    """Of the places of the picture of (f): over a covered one is a coloured one, over a coloured one is none."""
    traces = step("C", "(f)").page.frame.traces
    light = [trace for trace in traces if trace.pen.width == FINE and trace.pen.colour == FAINT]
    bold = [trace for trace in traces if trace.pen.width == BOLD]
    assert len(light) == 3 and len({trace.pen.colour for trace in bold}) == 3 and len(bold) > 60
    chords = np.array([[trace.points[0], trace.points[-1]] for trace in bold])
    rows = np.concatenate([trace.points for trace in light])
    left, right = chords[:, :, 0].min(axis=1), chords[:, :, 0].max(axis=1)
    over = []
    for x, y in rows.tolist():
        at = np.flatnonzero((left <= x) & (x <= right))
        if len(at):
            (x0, y0), (x1, y1) = chords[at[0]]
            over.append(y0 + (y1 - y0) * (x - x0) / max(x1 - x0, 1e-12) - y)
    assert np.mean(np.array(over) > 0.5) > 0.3  # covered
    assert min(over) > -0.05  # nothing light is above what is topmost


def test_a_place_of_a_surface_is_that_of_the_recursion() -> None:
    rng = np.random.default_rng(1)
    surface = BsplineSurface(
        rng.normal(size=(5, 4, 3)),
        rng.uniform(0.5, 2, (5, 4)),
        np.array([0, 0, 0, 0, 0.4, 1, 1, 1, 1.0]),
        np.array([0, 0, 0, 0.3, 1, 1, 1.0]),
        3,
        2,
    )
    for u, v in rng.uniform(0, 1, (20, 2)):
        one, two = basis(surface.knots_u, 3, u), basis(surface.knots_v, 2, v)
        weights = one[:, None] * two * surface.weights
        assert np.allclose(evaluated(surface, u, v), np.einsum("ij,ijk->k", weights, surface.points) / weights.sum())


# ---- B


def test_a_depth_buffer_keeps_the_lowest_of_what_is_over_a_cell() -> None:
    grid = Grid.over((0, 0, 4, 4), 4)
    low = np.array([[0, 0, 1], [4, 0, 1], [4, 4, 3], [0, 4, 3.0]])
    high = low + [0, 0, 5]
    small = np.array([[0, 0, -1], [1.2, 0, -1], [1.2, 1.2, -1], [0, 1.2, -1.0]])
    depth = drawn(np.stack([high, low, small]), grid)
    rows = 1 + 0.5 * grid.ys()
    want = np.repeat(rows[:, None], 4, axis=1)
    want[0, 0] = -1
    assert np.allclose(depth, want)
    assert not np.isfinite(drawn(np.zeros((0, 4, 3)), grid)).any()


@pytest.mark.exhaustive
def test_facets_are_as_near_to_the_closed_form_as_is_stated() -> None:
    table = step("B", "S105").table
    assert [row[0] for row in table[1:]] == ["1", "2", "4", "8"]
    off = [float(row[2]) for row in table[1:]]
    assert off == sorted(off) and off[1] < 1.3 * float(table[2][3])


def test_the_heights_of_record_are_the_closed_form_of_a_ball_along_lines() -> None:
    """The lowest height of a ball over a place: by dense places along each move, refined about the best."""
    from app.simulation.sweeps.trim import trim

    course, stock = SAMPLE.course(), sample_input().stock
    grid = Grid.over((40, 40, 60, 60), 24)
    heights = trim(stock.over(grid), course, SAMPLE.cutters).heights
    start, end = course.motions.start, course.motions.end
    r = SAMPLE.radius
    for i, j in ((3, 4), (11, 12), (20, 7), (15, 22)):
        x, y = grid.xs()[j], grid.ys()[i]
        share = np.linspace(0, 1, 2001)[:, None, None]
        near = np.flatnonzero(
            (np.minimum(start[:, 1], end[:, 1]) < y + r) & (np.maximum(start[:, 1], end[:, 1]) > y - r)
        )
        places = start[near] + share * (end - start)[near]
        square = r**2 - (places[..., 0] - x) ** 2 - (places[..., 1] - y) ** 2
        low = np.where(square >= 0, places[..., 2] + r - np.sqrt(np.maximum(square, 0)), np.inf)
        assert abs(heights[i, j] - min(low.min(), 0.0)) < 1e-5 + 2e-6


GROOVE = (
    b"G21 G90 G17 G94\nT1 M6\nS9000 M3\nG0 X10 Y10 Z5\nG1 Z-2 F100\nG1 X20 F400\nG3 X20 Y16 I0 J3\n"
    b"G1 X10.5\nG0 Z5\nM30\n"
)


@pytest.mark.parametrize(
    "kind", [ToolKind.V, *(pytest.param(kind, marks=pytest.mark.exhaustive) for kind in (ToolKind.BALL, ToolKind.FLAT))]
)
def test_any_tool_is_shown_and_every_cell_lies_within_its_bounds(kind: ToolKind) -> None:
    """Only a ball was shown; arcs were chords 1 mm off, and heights beside them 1.1 mm, which nothing told of."""
    tool = Tool(1, 3.0, kind, tip_angle=math.radians(60.0) if kind is ToolKind.V else 0.0)
    source = FilmSource("groove.ngc", GROOVE, no_file, tools={1: tool})
    made = make_film(PublishedText.B, source, cutting=input_of(source))
    steps = {step.number: step for step in made.steps}
    assert list(steps) == STEPS["B"]
    trimmed = steps["S108"]
    assert value(trimmed, "cells outside of their bounds") == 0
    off, most = (value(trimmed, name) for name in ("facets off the closed form, straight up", _BOUND))
    assert 0 <= off <= most + 1e-5 < 0.05
    assert all(row[-1] == "0" for row in steps["S105"].table[1:])
    assert ("no ball" in steps["S104"].settled) == (kind is not ToolKind.BALL)


_BOUND = "by the bound of each cell, at most"


def test_passes_apart_are_not_joined_where_polygons_are_counted() -> None:
    """Moves of two passes were counted with a cylinder from the end of one to the beginning of the other."""
    text = b"G21 G90 G94\nT1 M6\nG0 X10 Y10 Z5\nG1 Z-2 F100\nX11\nG0 Z5\nG0 X10 Y11\nG1 Z-2\nX11\nG0 Z5\nM30\n"
    tools = {1: Tool(1, 6.0, ToolKind.BALL)}
    source = FilmSource("two.ngc", text, no_file, tools=tools)
    given = input_of(source)
    steps = {step.number: step for step in dexel_film(given).steps}
    counts = polygon_counts(given.course, given.cutters, value(steps["S105"], "d"))
    assert value(steps["S104"], "polygons with whole spheres") == counts.spheres


@pytest.mark.parametrize("letter", ["D", "E"])
def test_films_of_curves_read_a_program_in_the_units_that_were_said(letter: str) -> None:
    """One that names none was shown 25.4 times too small, whatever had been said of it in the window."""
    text = b"G90 G17 G94\nG0 X.5 Y0 Z.2\nG1 Z-.1 F10\nX.6 Y.05\nX.7 Y.11\nX.8 Y.18\nX.9 Y.26\nG0 Z.2\nM2\n"
    said = FilmSource("a.ngc", text, no_file, ExamineOptions(units=Units.INCH))
    named = FilmSource("a.ngc", b"G20\n" + text, no_file)
    films = [make_film(TEXTS[letter], source) for source in (said, named)]
    assert [step.figures for step in films[0].steps] == [step.figures for step in films[1].steps]


@pytest.mark.parametrize(
    ("name", "kind"),
    [("gear.draw", "a drawing"), ("a.PNG", "a picture"), ("b.stl", "a solid"), ("die.toml", "a scene")],
)
def test_what_is_no_program_is_told_so_and_not_taken_for_a_faulty_one(name: str, kind: str) -> None:
    from app.core.errors import InputError

    for read in (lambda: points_of(name, b"arc 1,2"), lambda: program_input(FilmSource(name, b"arc 1,2", no_file))):
        with pytest.raises(InputError, match=f"{name} is {kind}.*an NC program"):
            read()
    assert len(points_of("no-suffix", resource("samples", "points.ngc").read_bytes())) > 4


def test_a_program_is_read_as_the_window_reads_it() -> None:
    """One that names no units was cut in mm, in the stock that had been told for its inches."""
    text = b"G90 G17\nT1 M6\nG0 X0 Y0 Z.2\nG1 Z-.04 F8\nX2\nX2 Y1\nM2\n"
    stock = (-3.0, -3.0, -5.0, 54.0, 29.0, 0.0)
    tools = {1: Tool(1, 3.0, ToolKind.BALL)}
    inches = FilmSource("a.ngc", text, no_file, ExamineOptions(units=Units.INCH), tools, stock)
    plain = FilmSource("a.ngc", text, no_file, tools=tools, stock=stock)
    ends = [float(np.nanmax(input_of(source).course.motions.end[:, 0])) for source in (inches, plain)]
    assert ends == pytest.approx([50.8, 2.0])


def test_passes_over_a_surface_are_seen_from_the_side_and_not_carried_round_their_steps() -> None:
    """They bend along Z, which a plan does not show; a step to the next pass is a corner however wide the tolerance."""
    made = make_film(PublishedText.D, FilmSource("raster.ngc", resource("samples", "raster.ngc").read_bytes(), no_file))
    steps = {step.number: step for step in made.steps}
    for number in ("S116", "S22", "S113"):
        path = steps[number].page.frame.traces[0].points
        assert np.ptp(path, axis=0).min() > 0.03 * np.ptp(path, axis=0).max(), f"{number} is one straight line"
    assert value(steps["S23"], "largest move of all") < 0.05
    assert "stayed as it was" not in steps["S12"].settled


def test_the_correction_curve_that_is_shown_goes_round_no_corner() -> None:
    """What is computed looks beyond none; the picture's curve bulged round one, and points looked off it."""
    turn = np.linspace(0.0, 0.3, 4)
    bend = 20 * np.column_stack([np.sin(turn), 1 - np.cos(turn)])
    facets = np.concatenate([a + np.arange(4)[:, None] / 4 * (b - a) for a, b in pairwise(bend)] + [bend[-1:]])
    leg = facets[-1] + np.array([[-0.8, 1.0], [-1.4, 2.1]])
    rows = "".join(f"G1 X{x:.4f} Y{y:.4f}\n" for x, y in [*facets[1:], *leg])
    made = make_film(
        PublishedText.D, FilmSource("bend.ngc", f"G21 G90 G94\nG0 X0 Y0 Z0\nF600\n{rows}M2\n".encode(), no_file)
    )
    steps = {step.number: step for step in made.steps}
    assert value(steps["S21"], "chosen") == 4
    path, curve, *_ = (np.asarray(trace.points) for trace in steps["S22"].page.frame.traces)
    assert len(curve) > 100 and np.all(np.ptp(curve, axis=0) < 1.05 * np.ptp(path, axis=0))
    assert value(steps["S23"], "moved points off the curve") < 1e-5


def test_a_stretch_that_stays_as_it_was_is_no_curve_that_was_proven() -> None:
    """Where every point is effective, curves as near as the digits take no fewer blocks."""
    random = np.random.default_rng(4)
    turn = np.cumsum(random.uniform(-0.2, 0.2, 60))
    x, y = np.cumsum(0.7 * np.cos(turn)), np.cumsum(0.7 * np.sin(turn))
    text = "G21 G90 G17 G94\nG0 X0 Y0 Z0\n" + "".join(f"G1 X{a:.4f} Y{b:.4f} F600\n" for a, b in zip(x, y, strict=True))
    made = make_film(PublishedText.D, FilmSource("wild.ngc", text.encode() + b"M2\n", no_file))
    last = made.steps[-1]
    assert "stayed as it was: it would not take fewer blocks" in last.settled
    assert "tolerance to the facets, proven" not in {figure.name for figure in last.figures}


def no_file(name: str) -> bytes:
    raise AssertionError(name)
