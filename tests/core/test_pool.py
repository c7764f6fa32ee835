"""Work in bands: all of it, once, in order, and on the caller's own thread where it is little."""

import threading

from app.core.pool import WORTH_TWO_CORES, in_bands


def test_bands_hold_everything_once_and_in_order() -> None:
    for count in (WORTH_TWO_CORES, WORTH_TWO_CORES + 1, WORTH_TWO_CORES + 7):
        found = in_bands(lambda band: list(range(band.start, band.stop)), count)
        assert len(found) > 1 and [k for some in found for k in some] == list(range(count))


def test_little_work_is_done_at_once() -> None:
    here = threading.get_ident()
    for count in (0, 1, WORTH_TWO_CORES - 1):
        assert in_bands(lambda band: (threading.get_ident(), band), count) == [(here, slice(0, count))]
    assert len(in_bands(lambda band: band, 10, worth=10)) > 1


def test_bands_within_bands_wait_for_no_thread() -> None:
    """Were they given to the executor too, all its threads would wait for ever."""

    def inner(band: slice) -> int:
        return sum(in_bands(lambda each: each.stop - each.start, WORTH_TWO_CORES))

    assert set(in_bands(inner, WORTH_TWO_CORES)) == {WORTH_TWO_CORES}
