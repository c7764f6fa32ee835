"""Numbers as a control reads them: whole counts of the last decimal, so that nothing is rounded twice."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Position = tuple[int, int, int]
"""X, Y and Z as counts of their last decimal."""


def whole(values: NDArray[np.float64], decimals: int) -> NDArray[np.int64]:
    """Return values as counts of their last decimal, the nearest ones."""
    return np.rint(values * 10.0**decimals).astype(np.int64)


def counts(values: NDArray[np.float64], decimals: int) -> list[int]:
    """Return the same as a list."""
    rounded: list[int] = whole(values, decimals).tolist()
    return rounded


def spelled(count: int, decimals: int) -> str:
    """Return a count of the last decimal as text with all its decimals; zero has no sign."""
    return f"{count / 10**decimals:.{decimals}f}"


def numeral(count: int, decimals: int, zeros: bool) -> str:
    """Return a count of the last decimal as the number of an axis word; without `zeros` only with those that count."""
    text = spelled(count, decimals)
    return text if zeros or "." not in text else text.rstrip("0")
