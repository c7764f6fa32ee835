"""From the bytes of a drawing or a picture to a job and its part on the display memory."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import PurePath

import numpy as np

from ...core.errors import GeometryError, InputError, ParameterError
from ...core.options import option
from ...geometry.outlines import nest
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.part import Entity, Part, Region
from ...model.read_options import AS_DRAWN
from ...operations.compute import regions_of
from ...raster.ambiguities import Ambiguity, AmbiguityKind, Place, ambiguities, pixel_words
from ...raster.faces import ink_meaning, inner_faces
from ...raster.frame import BitmapFrame
from ...raster.picture import RasterPicture, read_picture
from ...raster.picture_options import InkMeaning, PictureOptions
from ...raster.walls import Mask, free_contours
from ..job.options import MakeOptions, job_with_options, with_own_job
from ..job.plausible import read_for
from ..pixels.options import BitmapOptions, BitmapSize, is_picture
from ..pixels.part import BitmapPart, part_of_mask, part_of_regions

_TOLD = 20
"""Doubtful places of one kind that are findings of their own."""

_LOOK = "look at what will be machined there, and draw it clearer if it is wrong"
_ADVICE = {
    AmbiguityKind.GAP: "close it in the picture, or make it wider if it is meant",
    AmbiguityKind.OPEN: "close it in the picture, or take it out if nothing is to be machined there",
}


@dataclass(frozen=True)
class BitmapJob:
    """A job whose part is pixels.

    Attributes:
        job: with the drawing, or the edges of the picture's pixels, as its part.
        part: the pixels.
        findings: of reading and chaining the drawing, or of what the picture leaves open.
    """

    job: Job
    part: BitmapPart
    findings: tuple[Finding, ...] = ()


def bitmap_job(name: str, data: bytes, options: MakeOptions) -> BitmapJob:
    """Return the job for the bytes of a drawing or a picture.

    Args:
        name: file name; its suffix tells the format.

    Raises:
        HitofudeError: it cannot be used, or an option is out of its range.
    """
    bitmap = options.bitmap or BitmapOptions()
    if is_picture(name):
        if options.reading != AS_DRAWN:
            raise InputError(
                f"{name}: a picture has no layers, types, layouts or units to choose; take {option('skip-layer')}, "
                f"{option('skip-type')}, {option('layout')}, {option('to-zero')} and {option('px-per-inch')} away."
            )
        return picture_job(read_picture(name, data, bitmap.picture), options, bitmap.picture, PurePath(name).stem)
    options = with_own_job(name, data, options)
    drawing = read_for(name, data, options)
    job = job_with_options(drawing.part, options)
    return drawn_job(job, bitmap.size, drawing.findings)


def drawn_job(job: Job, size: BitmapSize, findings: tuple[Finding, ...] = ()) -> BitmapJob:
    """Return a job with its drawing drawn on a bitmap.

    Args:
        findings: of reading the drawing.

    Raises:
        GeometryError: nothing in it is closed.
        ParameterError: the bitmap cannot hold it, or clamps are to be kept off, which paths made from pixels cannot do.
    """
    if job.keep_out_layers:
        raise ParameterError(
            "Paths made from pixels do not know clamps; compute the drawing exactly, or take the keep-out layers away."
        )
    if any(operation.cut.curves for operation in job.operations if operation.cut.enabled):
        raise ParameterError(
            "Paths made from pixels machine all that is drawn; compute the drawing exactly, or take curves out of the "
            "operations."
        )
    regions, own = regions_of(job)
    if not regions:
        raise GeometryError(
            f"{job.part.name}: there is no closed contour to machine; draw one, or choose other layers."
        )
    return BitmapJob(job, part_of_regions(regions, size), (*own, *findings))


def picture_job(picture: RasterPicture, options: MakeOptions, read: PictureOptions, name: str) -> BitmapJob:
    """Return the job for a picture: its ink's areas, or what its lines enclose, one pixel of the picture one of the
    bitmap.

    Raises:
        GeometryError: nothing in it is to be machined.
    """
    kind = ink_meaning(picture.ink, read.shows)
    free = picture.ink if kind is InkMeaning.AREAS else inner_faces(picture.ink)
    free = np.pad(free, 1)
    frame = BitmapFrame(free.shape[0], free.shape[1], picture.pitch, -picture.pitch, -picture.pitch)
    doubts = _doubts(picture.ink, frame, kind)
    if not free.any():
        raise GeometryError(_nothing_shown(name, kind, doubts))
    regions = nest(free_contours(frame, free))
    part = part_of_mask(frame, free, regions, np.pad(picture.ink, 1) if kind is InkMeaning.LINES else None)
    job = job_with_options(_as_part(regions, name), options)
    remarks = (Finding(FindingKind.ASSUMED, remark, counts=False) for remark in picture.remarks)
    return BitmapJob(job, part, (*doubts, *remarks))


def _nothing_shown(name: str, kind: InkMeaning, doubts: list[Finding]) -> str:
    """Return why a picture gives no part: where its lines are open, as far as that is known."""
    open_ones = [finding.text for finding in doubts if finding.counts]
    if open_ones:
        more = f" ({len(open_ones) - 1} more such places)" if len(open_ones) > 1 else ""
        return f"{name}: nothing in the picture is enclosed by lines. {open_ones[0]}{more}"
    what = "is inked" if kind is InkMeaning.AREAS else "is enclosed by lines"
    return (
        f"{name}: nothing in the picture {what}; change the threshold, invert it, or say whether its ink is lines or "
        "areas."
    )


def _as_part(regions: tuple[Region, ...], name: str) -> Part:
    """Return the edges of a picture's pixels as a drawing."""
    curves = [curve for region in regions for contour in region.contours for curve in contour.primitives]
    return Part(name=name).with_entities(tuple(Entity(number, curve) for number, curve in enumerate(curves, 1)))


def _doubts(ink: Mask, frame: BitmapFrame, kind: InkMeaning) -> list[Finding]:
    """Return the places that can be read in two ways, as findings; areas of ink leave none open."""
    places = ambiguities(ink) if kind is InkMeaning.LINES else ()
    counts = Counter(place.kind for place in places)
    reported: Counter[object] = Counter()
    found = []
    for place in places:
        reported[place.kind] += 1
        if reported[place.kind] <= _TOLD:
            found.append(_doubt(place, frame, counts[place.kind] - _TOLD if reported[place.kind] == _TOLD else 0))
    return found


def _doubt(place: Ambiguity, frame: BitmapFrame, more: int) -> Finding:
    """Return a place as a finding.

    Args:
        more: further places of the kind that are no findings of their own.
    """
    (x, y), *others = (_at(each, frame) for each in ((place.col, place.row), *place.others))
    also = f" ({more} more like it)" if more > 0 else ""
    is_open = place.kind is AmbiguityKind.OPEN
    reported = f"{place.kind.value}{_other_ends(place, others)}" if is_open else place.kind.value
    text = f"At {place.where}, {_mm((x, y))}, {reported}{also}; {_ADVICE.get(place.kind, _LOOK)}."
    amount = float(np.hypot(x - others[0][0], y - others[0][1])) if others else None
    return Finding(
        FindingKind.OPEN_CONTOUR if is_open else FindingKind.AMBIGUOUS, text, x, y, place.counts, amount=amount
    )


def _other_ends(place: Ambiguity, others: list[Place]) -> str:
    """Return where else an open line ends, in words; others: the same ends, mm."""
    ends = [f"{pixel_words(px)}, {_mm(mm)}" for px, mm in zip(place.others, others, strict=True)]
    if not ends:
        return ""
    return f"; its other {'end is' if len(ends) == 1 else 'ends are'} at {' and at '.join(ends)}"


def _at(place: Place, frame: BitmapFrame) -> Place:
    """Return where a place of the picture lies, mm, on a frame that has one pixel more all round."""
    x, y = frame.to_mm(np.array([place]) + 1)[0].tolist()
    return x, y


def _mm(place: Place) -> str:
    return f"({place[0]:.3f}, {place[1]:.3f})"
