"""In how many straight pieces the Cut view draws arcs of the tool's way."""

import numpy as np

from app.ui.views.cut.shown_cut import pieces_of_arcs


def test_arcs_have_no_corners_near_by():
    sweep, radius = np.array([0.5, -np.pi, 2 * np.pi, 0.0, 1.0]), np.array([0.01, 3.0, 70.0, 5.0, 1000.0])
    counts = pieces_of_arcs(sweep, radius)
    away = radius * (1 - np.cos(np.abs(sweep) / counts / 2))
    assert (away[:4] <= 0.002).all() and away[4] < 0.01, "mm from the chords to the arcs"
    assert (np.abs(sweep) / counts <= 0.1).all() and counts[3] == 1
    assert (counts & (counts - 1) == 0).all()


def test_very_many_arcs_are_no_finer_than_by_their_turn():
    many = pieces_of_arcs(np.full(20_000, np.pi), np.full(20_000, 70.0))
    assert many.max() == 32
