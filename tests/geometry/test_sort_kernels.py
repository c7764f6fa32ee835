"""Sorting for kernels: as numpy sorts, whatever lies in the numbers."""

import numpy as np
import pytest

from app.geometry.sort_kernels import order_of, sort_integers, sort_numbers

ODD = np.array([3.0, -1.0, np.nan, -np.nan, -np.inf, np.inf, 0.0, -0.0, 5e-324, -5e-324, 1.7e308, -1.7e308])


@pytest.mark.parametrize("count", [0, 1, 2, 15, 16, 17, 31, 32, 33, 48, 100, 1000, 4097])
@pytest.mark.parametrize("spread", [3, 2**62])
def test_integers_are_sorted_as_numpy_sorts_them(count: int, spread: int) -> None:
    values = np.random.default_rng(count).integers(-spread, spread, count)
    for given in (values, np.sort(values), np.sort(values)[::-1].copy()):
        expected = np.sort(given)
        sort_integers(given)
        assert np.array_equal(given, expected)


@pytest.mark.parametrize("count", [0, 1, 12, 16, 17, 33, 1000])
def test_numbers_are_sorted_as_numpy_sorts_them(count: int) -> None:
    values = np.random.default_rng(count).choice([*ODD, *np.linspace(-9, 9, 40)], count)
    expected = np.sort(values)
    sort_numbers(values)
    assert np.array_equal(values, expected, equal_nan=True)


def test_an_order_sorts() -> None:
    values = np.random.default_rng(1).normal(size=500)
    assert np.array_equal(values[order_of(values)], np.sort(values))
