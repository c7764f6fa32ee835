"""Selectors of curves: what a text selects, and the same text again."""

from __future__ import annotations

import pytest

from app.core.errors import ParameterError
from app.model.curve_selectors import CirclesOf, ContourKind, CurveNumber, OnLayer, Selector, read_selector


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("#12", CurveNumber(12)),
        ("layer:holes", OnLayer("holes")),
        ("layer:a:b #1", OnLayer("a:b #1")),
        ("circles:6", CirclesOf(6.0, 6.0)),
        ("circles:5.9-6.1", CirclesOf(5.9, 6.1)),
        ("outer", ContourKind.OUTER),
        ("inner", ContourKind.INNER),
        ("open", ContourKind.OPEN),
    ],
)
def test_a_text_and_what_it_selects(text: str, meant: Selector) -> None:
    assert read_selector(text) == meant and meant.text == text
    assert read_selector(text.upper()) == (OnLayer(meant.name.upper()) if isinstance(meant, OnLayer) else meant)


@pytest.mark.parametrize(
    "text", ["", "12", "#", "#0", "#-1", "#1.5", "circles:", "circles:0", "circles:6-5", "circles:nan", "outside"]
)
def test_what_selects_nothing_is_refused(text: str) -> None:
    with pytest.raises(ParameterError):
        read_selector(text)


def test_the_error_says_what_can_be_written() -> None:
    with pytest.raises(ParameterError, match=r'\'outside\' selects no curves; write "#12", "layer:holes", "circles:6"'):
        read_selector("outside")
