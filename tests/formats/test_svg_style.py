"""What style sheets of an SVG say: variables, what is important, places and sizes."""

import time

import pytest

from app.formats.readers import read_drawing
from app.model.curves import Circle, Curve
from app.model.read_options import DrawingOptions

PAGE = 'width="100mm" height="50mm" viewBox="0 0 100 50" xmlns="http://www.w3.org/2000/svg"'
RIM = '<circle cx="40" cy="25" r="5"/>'


def curves(body: str) -> list[Curve]:
    data = f"<svg {PAGE}>{body}</svg>".encode()
    return [each.curve for each in read_drawing("a.svg", data, None, (), DrawingOptions()).part.entities]


@pytest.mark.parametrize(
    "body",
    [
        '<style>:root{--seen:none} .a{display:var(--seen)}</style><rect class="a" width="9" height="9"/>',
        '<g style="--seen:none"><rect style="display:var( --seen )" width="9" height="9"/></g>',
        '<rect style="display:var(--seen, none)" width="9" height="9"/>',
        '<g style="--a:var(--b);--b:none"><rect style="display:var(--a)" width="9" height="9"/></g>',
        '<g style="--a:no;--b:ne"><rect style="--c:none;display:var(--c)" width="9" height="9"/></g>',
        '<style>rect{display:none !important}</style><rect style="display:inline" width="9" height="9"/>',
        '<style>.a{display:none!important} rect.a{display:inline}</style><rect class="a" width="9" height="9"/>',
    ],
)
def test_what_a_variable_or_an_important_rule_hides_is_not_read(body: str) -> None:
    assert curves(body + RIM) == [Circle((40, 25), 5)]


@pytest.mark.parametrize("value", ["var(--not-set)", "var(--a)", "var(", "none;display:inline"])
def test_a_variable_without_a_value_says_nothing(value: str) -> None:
    assert len(curves(f'<g style="--a:var(--a)"><rect style="display:{value}" width="9" height="9"/></g>')) == 4


def test_variables_that_unfold_to_much_are_nothing_at_once() -> None:
    """Ten levels of ten copies each would be 10,000,000,000 letters."""
    unfolded = "".join(f"--v{k}:{f'var(--v{k + 1})' * 10};" for k in range(12))
    begun = time.process_time()
    assert (
        len(curves(f'<g style="{unfolded}--v12:none"><rect style="display:var(--v0)" width="9" height="9"/></g>')) == 4
    )
    assert time.process_time() - begun < 2


@pytest.mark.parametrize(
    "body",
    [
        "<style>circle{cx:40px;cy:25px;r:5px}</style><circle/>",
        '<circle cx="1" r="5" style="cx:40px;cy:25px"/>',
        '<g style="--r:5"><circle cx="40" cy="25" style="r:var(--r)"/></g>',
    ],
)
def test_places_and_sizes_may_stand_in_a_style(body: str) -> None:
    assert curves(body) == [Circle((40, 25), 5)]
