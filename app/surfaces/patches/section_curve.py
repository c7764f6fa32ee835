"""Section curves as rational B-splines: of tables of points, or of contours of drawings in a placed plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...geometry.chaining.chain import chain
from ...model.curves import Spline
from ...model.motion import Nurbs
from ...model.part import Contour, Part
from ...model.scene_curves import CurveForm, SceneFiles, SectionCurve, Spacing
from .nurbs_curve import SplineSpace, brought, even_knots, of_homogeneous, of_primitives, parameters, through

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ResolvedCurve:
    """A section curve in space, and how far it may be off what was drawn, mm (0: exact but for rounding)."""

    curve: Nurbs
    deviation: float = 0.0


def resolve(section: SectionCurve, sources: SceneFiles) -> ResolvedCurve:
    """Return a section as a curve.

    Raises:
        InputError: its drawing cannot be read. GeometryError: it has no such contour.
    """
    if section.drawing:
        return _drawn(section, sources)
    if section.form is CurveForm.CONTROL:
        return ResolvedCurve(_controlled(section))
    return ResolvedCurve(_through(section, own_parameters(section)))


def resolve_all(sections: Sequence[SectionCurve], sources: SceneFiles) -> list[ResolvedCurve]:
    """Return sections as curves; tables of as many points each share the mean of their parameters, so that no knots are
    added.
    """
    if shared_parameters(sections):
        at = np.mean([own_parameters(section) for section in sections], axis=0)
        return [ResolvedCurve(_through(section, at)) for section in sections]
    return [resolve(section, sources) for section in sections]


def shared_parameters(sections: Sequence[SectionCurve]) -> bool:
    """Tell whether sections are tables of as many points, that curves of one sort go through."""
    kinds = {(len(each.points), each.form, each.degree, each.closed, each.spacing) for each in sections}
    return len(kinds) == 1 and bool(sections[0].points) and sections[0].form is CurveForm.THROUGH


def own_parameters(section: SectionCurve) -> Floats:
    """Return parameters from 0 to 1 of the points that a curve goes through; with that of the first once more where it
    is closed.
    """
    return parameters(_places(section), 0.5 if section.spacing is Spacing.CENTRIPETAL else 1.0)


def _places(section: SectionCurve) -> Floats:
    """Return the points (n, 3) in space, the first repeated where the curve is closed."""
    places = np.array(section.points)
    if places.shape[1] == 2:
        places = placed(np.column_stack([places, np.zeros(len(places))]), section)
    return np.concatenate([places, places[:1]]) if section.closed else places


def placed(points: Floats, section: SectionCurve) -> Floats:
    """Return points (n, 3) of the plane z = 0 in the section's plane."""
    x, y = (np.array(axis) / np.linalg.norm(axis) for axis in (section.x_axis, section.y_axis))
    made: Floats = np.array(section.origin) + points[:, :1] * x + points[:, 1:2] * y
    return made


def _through(section: SectionCurve, at: Floats) -> Nurbs:
    spline = through(_places(section), at, section.degree, section.closed)
    return Nurbs(spline.points, np.ones(len(spline.points)), spline.knots, spline.degree)


def _controlled(section: SectionCurve) -> Nurbs:
    places = _places(section)
    weights = np.array(section.weights or [1.0] * len(section.points))
    degree = min(section.degree, len(section.points) - 1)
    if section.knots:
        return Nurbs(places, weights, np.array(section.knots), degree)
    if not section.closed:
        return Nurbs(places, weights, even_knots(len(places), degree), degree)
    count = len(section.points)
    around = np.arange(count + degree) % count
    rows = np.column_stack([places[around] * weights[around, None], weights[around]])
    knots = np.arange(-degree, count + degree + 1) / count
    inner = np.arange(1, count) / count
    ends = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    made = brought(rows, SplineSpace(knots, degree), SplineSpace(ends, degree))
    return of_homogeneous(made, ends, degree)


def contours_of(part: Part, layer: str, name: str) -> tuple[Contour, ...]:
    """Return the contours of a drawing's layer, or of all layers, in the order of the drawing.

    Raises:
        GeometryError: there is none.
    """
    found = chain([each for each in part.entities if layer in ("", each.layer) and not each.lettering]).contours
    if not found:
        known = ", ".join(dict.fromkeys(each.layer for each in part.entities)) or "no layer"
        raise GeometryError(
            f"{name} has no contour on layer {layer}; curves are on {known}." if layer else f"{name} has no contour."
        )
    return tuple(found)


def _drawn(section: SectionCurve, sources: SceneFiles) -> ResolvedCurve:
    part = sources.part(section.drawing)
    contours = contours_of(part, section.layer, section.drawing)
    if section.number > len(contours):
        raise GeometryError(
            f"{section.drawing} has {len(contours)} contours there, so none with number {section.number}; "
            f"use 1 to {len(contours)}."
        )
    flat = flat_curve(contours[section.number - 1], part)
    return ResolvedCurve(
        Nurbs(placed(flat.curve.points, section), flat.curve.weights, flat.curve.knots, flat.curve.degree),
        flat.deviation,
    )


def flat_curve(contour: Contour, part: Part) -> ResolvedCurve:
    """Return a contour of a drawing as a curve in the plane z = 0: splines as they are, lines, arcs and circles
    exactly.
    """
    curve = part.curve(contour.entity_ids[0]) if len(contour.entity_ids) == 1 else None
    return (
        ResolvedCurve(_spline(curve))
        if isinstance(curve, Spline)
        else ResolvedCurve(of_primitives(contour.primitives), contour.deviation)
    )


def _spline(spline: Spline) -> Nurbs:
    points = np.array(spline.control_points)
    weights = np.array(spline.weights or [1.0] * len(points))
    return Nurbs(np.column_stack([points, np.zeros(len(points))]), weights, np.array(spline.knots), spline.degree)
