"""What a picture leaves open counts, is named first, and says the same place wherever it is told."""

import cv2
import numpy as np
import pytest

from app.core.errors import GeometryError
from app.model.finding import FindingKind
from app.raster.picture import thresholded
from app.raster.picture_options import PictureOptions
from app.usecases.job.options import MakeOptions
from app.usecases.making.bitmap_job import BitmapJob, picture_job
from tests.raster.test_doubts import plate


def job_of(gray: np.ndarray) -> BitmapJob:
    return picture_job(thresholded(gray, 0.1, PictureOptions()), MakeOptions(), PictureOptions(), "plate")


@pytest.mark.parametrize("gap", [1, 2, 3, 40])
def test_an_outline_that_does_not_close_is_refused_with_the_place(gap: int) -> None:
    with pytest.raises(GeometryError, match=r"is enclosed by lines\. At column 1\d\d, row 5[01], \(1.\.\d50, 24\."):
        job_of(plate(gap, island=False))


def test_a_narrow_gap_round_an_island_counts() -> None:
    (finding,) = job_of(plate(1, island=True)).findings
    assert (finding.kind, finding.counts) == (FindingKind.AMBIGUOUS, True)
    assert finding.text.startswith("At column 150, row 50, (15.050, 24.950), a line ends short of another")
    assert (finding.x, finding.y) == pytest.approx((15.05, 24.95))


def test_a_line_that_encloses_nothing_is_an_open_contour() -> None:
    (finding,) = job_of(plate(3, island=True)).findings
    assert (finding.kind, finding.counts) == (FindingKind.OPEN_CONTOUR, True)
    assert "its other end is at column 149, row 50, (14.950, 24.950)" in finding.text
    assert finding.amount == pytest.approx(0.4, abs=0.15)


def test_junctions_are_remarks() -> None:
    gray = plate(0, island=False)
    cv2.line(gray, (200, 52), (200, 250), 0, 2)
    findings = job_of(gray).findings
    assert [(each.kind, each.counts) for each in findings] == [(FindingKind.AMBIGUOUS, False)] * 2


def test_all_ink_is_remarked() -> None:
    (finding,) = job_of(np.zeros((60, 60), np.uint8)).findings
    assert (finding.kind, finding.counts) == (FindingKind.ASSUMED, False)
    assert "All of the picture is ink" in finding.text
