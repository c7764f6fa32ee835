"""Feeds and speeds of the tools of a job, of a library, or of one tool."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from ...core.errors import InputError
from ...formats.tools.materials import stock_material
from ...model.job import Job
from ...model.machine import Machine
from ...model.operation import Operation
from ...model.tool import Tool
from ...toolpath.feeds.mechanics import engaged_angle
from ...toolpath.feeds.proposal import SLOT, CutEngagement, FeedProposal, proposed_feeds

Json = dict[str, Any]


@dataclass(frozen=True)
class FeedsOptions:
    """What feeds are proposed for.

    Attributes:
        material: word of a material.
        machine: that bounds them; None = a usual one.
    """

    material: str
    machine: Machine | None = None


def engagement_of(job: Job, number: int) -> CutEngagement:
    """Return how much of a tool is in metal at most, as far as the job's operations say so.

    Args:
        number: T number of a tool of the job; one that no operation uses is taken to cut slots.
    """
    tool = job.tool(number)
    own = [each for each in job.operations if each.cut.enabled and each.cut.tool == number]
    if not own:
        return CutEngagement()
    depth = max(min(each.cut.stepdown, each.cut.depth) for each in own)
    widest = max((_engaged(each, tool) for each in own), key=lambda each: each.angle)
    return replace(widest, depth=depth)


def _engaged(operation: Operation, tool: Tool) -> CutEngagement:
    """Return how far round an operation engages its tool at most."""
    if operation.proven_angle is not None:
        return CutEngagement(0.0, operation.proven_angle, f"the limit of the {operation.WORD} operation")
    limit = operation.engagement_limit
    if limit < 1:
        angle = engaged_angle(tool.diameter, limit * tool.diameter)
        return CutEngagement(
            0.0, angle, f"where more than {100 * limit:g} % are engaged the {operation.WORD} operation slows the feed"
        )
    return CutEngagement(0.0, SLOT, f"the {operation.WORD} operation bounds no engagement, so a full slot")


@dataclass(frozen=True)
class JobWithFeeds:
    """A job whose tools have the speed and the feeds that were proposed, and the proposals; none where none were asked
    for.
    """

    job: Job
    proposals: tuple[FeedProposal, ...] = ()

    def report(self) -> Json:
        """Return the proposals as plain values, with their reasons."""
        return {"material": self.job.stock.material, "tools": [proposal_values(each) for each in self.proposals]}

    def lines(self) -> list[str]:
        """Return a line a tool, and one for each limit that held."""
        return [line for each in self.proposals for line in (each.summary(), *each.limits())]


def with_proposed_feeds(job: Job, options: FeedsOptions) -> JobWithFeeds:
    """Return a job whose tools have the speed and the feeds that are proposed for a material: then its stock's.

    Raises:
        InputError: there is no such material.
    """
    material = stock_material(options.material)
    made = tuple(proposed_feeds(tool, material, engagement_of(job, tool.number), options.machine) for tool in job.tools)
    stock = replace(job.stock, material=material.word)
    return JobWithFeeds(replace(job, tools=tuple(each.tool for each in made), stock=stock), made)


def feeds_of_job(job: Job, number: int, machine: Machine | None = None) -> FeedProposal:
    """Return what is proposed for a tool of a job in the job's stock.

    Raises:
        InputError: nobody says what the stock is made of, or there is no such material.
        ParameterError: the job has no such tool.
    """
    if not job.stock.material:
        raise InputError("Feeds depend on what the stock is made of, and nobody says it; choose a material.")
    return proposed_feeds(job.tool(number), stock_material(job.stock.material), engagement_of(job, number), machine)


def feeds_report(proposals: tuple[FeedProposal, ...], options: FeedsOptions) -> Json:
    """Return proposals as plain values: rpm, mm/min, mm, W."""
    return {
        "material": stock_material(options.material).word,
        "machine": options.machine.title if options.machine else None,
        "tools": [proposal_values(each) for each in proposals],
    }


def proposal_values(made: FeedProposal) -> Json:
    """Return a proposal as plain values: rpm, mm/min, mm, W."""
    return {
        "number": made.tool.number,
        "label": made.tool.label,
        "spindle_speed_rpm": made.tool.spindle_speed,
        "feed_rate_mm_min": made.tool.feed_rate,
        "plunge_rate_mm_min": made.tool.plunge_rate,
        "surface_speed_m_min": made.surface_speed,
        "feed_per_tooth_mm": made.feed_per_tooth,
        "power_w": made.power,
        "deflection_mm": made.deflection or None,
        "reasons": [{"of": why.key, "text": why.text, "held": why.held} for why in made.reasons],
    }


def engagement_at(angle: float | None, depth: float) -> CutEngagement:
    """Return an engagement that somebody has said.

    Args:
        angle: radians in (0, pi]; None = nothing is known.
        depth: mm; 0 = not known.
    """
    if angle is None:
        return CutEngagement(depth)
    return CutEngagement(depth, min(angle, math.pi), "as asked for")
