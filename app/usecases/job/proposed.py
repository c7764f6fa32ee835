"""A proposal in the place of the operations that a job would have."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from ...core.errors import InputError
from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...model.part import Part
from ..proposal.propose import Proposal, propose
from .machining import MachiningOptions
from .options import MakeOptions, job_with_options


class ProposedOptions(NamedTuple):
    """Options with the proposed job in them, and the proposal; None where none was asked for."""

    options: MakeOptions
    proposal: Proposal | None


def with_proposal(part: Part, options: MakeOptions, progress: Progress = NO_PROGRESS) -> ProposedOptions:
    """Return options with the job that is proposed for a drawing, where that is asked for, and the proposal.

    What else is asked for goes into the operations that are proposed, but for the depth, which is that of the pockets.

    Raises:
        HitofudeError: nothing can be proposed, or something asked for does not go with a proposal.
        Cancelled: by progress.
    """
    if options.propose is None:
        return ProposedOptions(options, None)
    requested = options.machining
    if requested.drills:
        raise InputError(
            f"{option('drill')} does not go with {option('propose')}, which proposes the drills; leave one of the two "
            "away."
        )
    if "curves" in requested.values:
        raise InputError(
            f"{option('curves')} does not go with {option('propose')}, which says what curves each operation has; "
            "leave one of the two away."
        )
    about = replace(
        options,
        propose=None,
        machining=MachiningOptions(keep_out=requested.keep_out, keep_out_height=requested.keep_out_height),
        contour_diameter=None,
        pocket_diameter=None,
        stepover=None,
        overlap=None,
    )
    own = (
        options.propose
        if "depth" not in requested.values
        else replace(options.propose, depth=requested.values["depth"])
    )
    proposal = propose(job_with_options(part, about), own, progress)
    values = {key: value for key, value in requested.values.items() if key != "depth"}
    machining = replace(requested, values=values)
    return ProposedOptions(replace(options, job=proposal.job, propose=None, machining=machining), proposal)
