"""Layers that a job asks for: which are to be read, and by which names the drawing has them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ...core.errors import InputError
from ...model.curve_selectors import OnLayer, Selector, layer_names
from ...model.job import Job
from ...model.part import Part


def layers_to_read(job: Job) -> tuple[str, ...]:
    """Return the layers of a drawing that a job needs; empty = all."""
    own = [name for operation in job.operations if operation.cut.enabled for name in layer_names(operation.cut.curves)]
    return tuple(dict.fromkeys((*job.layer_names, *own, *job.keep_out_layers))) if job.layer_names else ()


def with_layers_spelled(job: Job) -> Job:
    """Return the job with its layers' names as its part spells them: drawings tell no case, and some controls write
    capitals alone.

    Raises:
        InputError: the part has no such layer.
    """
    operations = tuple(
        replace(each, cut=replace(each.cut, curves=_curves_spelled(each.cut.curves, job.part)))
        if each.cut.enabled
        else each
        for each in job.operations
    )
    return replace(
        job,
        operations=operations,
        layer_names=_spelled(job.layer_names, job.part),
        keep_out_layers=_spelled(job.keep_out_layers, job.part),
    )


def _curves_spelled(curves: Iterable[Selector], part: Part) -> tuple[Selector, ...]:
    """Return selectors whose layers are called as the part calls them."""
    return tuple(
        dict.fromkeys(OnLayer(*_spelled((each.name,), part)) if isinstance(each, OnLayer) else each for each in curves)
    )


def _spelled(names: Iterable[str], part: Part) -> tuple[str, ...]:
    known = {layer.name.casefold(): layer.name for layer in part.layers}
    found: dict[str, None] = {}
    for name in names:
        if name.casefold() not in known:
            raise InputError(
                f"{part.name}: there is no layer '{name}'; the drawing has {', '.join(known.values()) or 'none'}."
            )
        found[known[name.casefold()]] = None
    return tuple(found)
