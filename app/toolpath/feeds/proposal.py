"""What speed and feeds a tool may have in a material on a machine, each number with a line that says why."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ...model.machine import Machine
from ...model.stock_material import StockMaterial
from ...model.tool import LEAST_RATE, FeedRow, Tool, ToolMaterial
from ...model.tool_kind import ToolKind
from . import mechanics
from .mechanics import Chip

MOST_THINNING = 4.0
"""A chip load is raised for thin chips by so much at most: beyond, feed marks and the entry into metal decide."""

LEAST_CHIP = 0.002
"""mm; a thinner chip is none: the edge rubs, whatever it is made of."""

POWER_SHARE = 0.8
"""Of the spindle's power that a proposal takes."""

MOST_DEFLECTION = 0.025
"""mm at the tip."""

USUAL_LOW, USUAL_HIGH = 1000.0, 24000.0
"""rpm, where no machine is named."""

SLOT = math.pi
"""Engaged angle, radians, of the full width."""

_EDGES = {ToolMaterial.HSS: "high-speed steel", ToolMaterial.CARBIDE: "carbide"}


@dataclass(frozen=True, slots=True)
class CutEngagement:
    """How much of a tool is in metal at most.

    Attributes:
        depth: along the axis, mm; 0 = not known: as deep as the tool is thick.
        angle: of the rim, radians in (0, pi]; pi = the full width.
        why: who says so, in words.
    """

    depth: float = 0.0
    angle: float = SLOT
    why: str = "a full slot, since nothing is known of the width"


@dataclass(frozen=True, slots=True)
class FeedReason:
    """Why a number is what it is.

    Attributes:
        key: of the number: a field of `FeedProposal`, or of `Tool`.
        text: one line: the number, where it comes from, which limit held.
        held: whether a limit of tool or machine held it down.
    """

    key: str
    text: str
    held: bool = False


@dataclass(frozen=True, slots=True)
class FeedProposal:
    """Speed and feeds of a tool in a material.

    Attributes:
        tool: with speed and feeds, and with `row` among its rows of feeds.
        row: surface speed and chip load of the material for this tool, before machine and forces held them down: what
            a library keeps.
        surface_speed: m/min. feed_per_tooth: mm.
        power: at the tool, W. deflection: of the tip at most, mm; 0 = not known, as the stick-out is not.
        reasons: one a number, in the order of the reckoning.
        rubs: whether chips are so thin that the edges rub.
    """

    tool: Tool
    row: FeedRow
    surface_speed: float
    feed_per_tooth: float
    power: float
    deflection: float
    reasons: tuple[FeedReason, ...]
    rubs: bool = False

    def summary(self) -> str:
        """Return speed and feeds in one line."""
        tool = self.tool
        return (
            f"T{tool.number} {tool.label} in {self.row.material}: {tool.spindle_speed:.0f} rpm, {tool.feed_rate:.0f} "
            f"mm/min, down {tool.plunge_rate:.0f} mm/min"
        )

    def limits(self) -> tuple[str, ...]:
        """Return a line for each limit that held a number down."""
        return tuple(f"  ! {each.text}" for each in self.reasons if each.held)

    def reason(self, key: str) -> str:
        """Return the lines about a number, "" where there are none."""
        return "\n".join(each.text for each in self.reasons if each.key == key)


def proposed_feeds(
    tool: Tool,
    material: StockMaterial,
    engagement: CutEngagement = CutEngagement(),
    machine: Machine | None = None,
) -> FeedProposal:
    """Return what a tool may do in a material.

    A row of feeds that the tool has for the material goes before the material's own figures.

    Args:
        tool: its stick-out, lengths and edges count where they are known.
        material: that it cuts.
        engagement: how much of it is in metal at most.
        machine: whose spindle and axes bound it; None = a usual spindle, of unknown power.
    """
    return _Reckoning(tool, material, engagement, machine).proposal()


class _Reckoning:
    """One proposal while it is made: each step takes what those before it left, and says why."""

    def __init__(self, tool: Tool, material: StockMaterial, engagement: CutEngagement, machine: Machine | None) -> None:
        self._tool, self._material, self._engagement, self._machine = tool, material, engagement, machine
        self._reasons: list[FeedReason] = []
        self._depth = engagement.depth or tool.diameter
        if tool.flute_length:
            self._depth = min(self._depth, tool.flute_length)

    def proposal(self) -> FeedProposal:
        """Return it."""
        row = self._row()
        rpm = self._speed(row)
        chip = self._thinned(row.feed_per_tooth)
        rpm = self._slowed_for_feed(chip, rpm)
        chip = self._within_feed(chip, rpm)
        chip = self._within_power(chip, rpm)
        chip = self._within_deflection(chip, rpm)
        self._warn_of_rubbing(chip)
        feed = self._feed(chip, rpm)
        plunge = self._plunge(row, rpm, feed)
        cut = self._chip(chip, rpm)
        rows = tuple(each for each in self._tool.feeds if each.material.casefold() != row.material.casefold())
        made = replace(self._tool, spindle_speed=rpm, feed_rate=feed, plunge_rate=plunge, feeds=(*rows, row))
        return FeedProposal(
            tool=made,
            row=row,
            surface_speed=mechanics.surface_speed(rpm, self._tool.diameter),
            feed_per_tooth=chip,
            power=mechanics.milling_power(cut, self._tool, self._material),
            deflection=self._deflection(cut),
            reasons=tuple(self._reasons),
            rubs=self._thickest(chip) < LEAST_CHIP,
        )

    def _say(self, key: str, text: str, held: bool = False) -> None:
        self._reasons.append(FeedReason(key, text, held))

    def _chip(self, feed_per_tooth: float, rpm: float) -> Chip:
        return Chip(self._depth, self._engagement.angle, feed_per_tooth, rpm)

    def _row(self) -> FeedRow:
        """Return surface speed and chip load: the tool's own, else those of the material's table."""
        tool, material = self._tool, self._material
        own = next((each for each in tool.feeds if each.material.casefold() == material.word.casefold()), None)
        if own is not None and own != self._of_table():
            self._say(
                "surface_speed", f"Surface speed {own.surface_speed:g} m/min: the tool's own row for {material.word}."
            )
            self._say(
                "feed_per_tooth",
                f"Chip load {own.feed_per_tooth:g} mm a tooth: the tool's own row for {material.word}.",
            )
            return own
        row, slowed = self._of_table(), _SLOWED.get(tool.kind.value, _AS_MILLS)
        taken = "" if tool.tool_material is not ToolMaterial.UNKNOWN else ", as the tool is taken to be"
        share = f", {slowed.speed:g} of it for a {tool.kind.value}" if slowed.speed != 1 else ""
        self._say(
            "surface_speed",
            f"Surface speed {row.surface_speed:.4g} m/min: {material.word} with {_EDGES[tool.edges]}{taken}, "
            f"{material.surface_speed(tool.edges):g}{share}{_of(material.speed_source)}.",
        )
        kind = f" times {slowed.chip:g} for a {tool.kind.value}" if slowed.chip != 1 else ""
        self._say(
            "feed_per_tooth",
            f"Chip load {row.feed_per_tooth:.4g} mm a tooth: {100 * material.chip_share:g} % of {self._width:g} mm in "
            f"{material.word}{kind}{_of(material.chip_source)}.",
        )
        return row

    @property
    def _width(self) -> float:
        """The diameter that the chip load is a part of, mm: of a tapered mill, that of its tip."""
        tool = self._tool
        return tool.tip_diameter if tool.kind is ToolKind.TAPER and tool.tip_diameter else tool.diameter

    def _of_table(self) -> FeedRow:
        """Return surface speed and chip load as the material's figures have them for a tool of this kind and size."""
        tool, material, slowed = self._tool, self._material, _SLOWED.get(self._tool.kind.value, _AS_MILLS)
        return FeedRow(
            material.word,
            material.surface_speed(tool.edges) * slowed.speed,
            max(material.chip_share * slowed.chip * self._width, LEAST_CHIP),
            1.0 if tool.kind.drills else material.plunge_share,
        )

    def _speed(self, row: FeedRow) -> float:
        """Return the spindle's speed within its range, in tens of rpm."""
        wanted = mechanics.spindle_speed(row.surface_speed, self._tool.diameter)
        spindle = self._machine.spindle if self._machine else None
        low, high = (spindle.low, spindle.high) if spindle else (USUAL_LOW, USUAL_HIGH)
        whose = self._machine.title if self._machine else "a usual spindle, as no machine is named"
        formula = f"1000 x {row.surface_speed:.4g} / (pi x {self._tool.diameter:g}) = {wanted:.0f} rpm"
        if low <= wanted <= high:
            rpm = min(max(round(wanted, -1), low), high)
            self._say("spindle_speed", f"Speed {rpm:.0f} rpm: {formula}.")
            return float(rpm)
        rpm = high if wanted > high else low
        fault = "" if wanted > high else "; the edges run faster than the material wants, so take a thinner tool"
        self._say(
            "spindle_speed",
            f"Speed {rpm:.0f} rpm: {formula}, but {whose} turns at {low:.0f} to {high:.0f}{fault}.",
            held=True,
        )
        return rpm

    def _thinned(self, load: float) -> float:
        """Return the feed per tooth at which the thickest chip is as thick as the chip load."""
        if self._tool.kind.drills:
            return load
        angle, said = self._engagement.angle, f"{math.degrees(self._engagement.angle):.4g} degrees engaged"
        wanted = mechanics.chip_thinning(angle)
        if wanted == 1:
            self._say(
                "feed_per_tooth",
                f"No chip thinning: {said} ({self._engagement.why}), from 90 on the chip is as thick as fed.",
            )
            return load
        factor = min(wanted, MOST_THINNING)
        bound = f", held at {MOST_THINNING:g}" if wanted > factor else ""
        self._say(
            "feed_per_tooth",
            f"Chip thinning: {said} ({self._engagement.why}), 1 / sin = {wanted:.3g}{bound}: {load * factor:.4g} mm a "
            "tooth.",
            held=bool(bound),
        )
        return load * factor

    @property
    def _most_feed(self) -> float:
        """The fastest that the machine feeds the tool, mm/min; endless where no machine is named."""
        if self._machine is None:
            return math.inf
        return min(self._machine.largest_feed, self._machine.z.rapid if self._tool.kind.drills else math.inf)

    def _slowed_for_feed(self, load: float, rpm: float) -> float:
        """Return the speed at which the machine's axes keep up with full chips, as far as its spindle turns so slowly:
        thin chips rub and burn.
        """
        feed, most = mechanics.feed_rate(rpm, self._tool.flutes, load), self._most_feed
        if self._machine is None or feed <= most:
            return rpm
        slowed = max(self._machine.spindle.low, math.floor(rpm * most / feed / 10) * 10.0)
        if slowed < rpm:
            self._say(
                "spindle_speed",
                f"Speed lowered to {slowed:.0f} rpm: {self._machine.title} feeds at {most:g} mm/min at most, and "
                f"{feed:.0f} was wanted; chips stay thick.",
                held=True,
            )
        return min(slowed, rpm)

    def _within_feed(self, load: float, rpm: float) -> float:
        """Return the chip load at which the machine's axes keep up."""
        most, feed = self._most_feed, mechanics.feed_rate(rpm, self._tool.flutes, load)
        if self._machine is None or feed <= most:
            return load
        kept = load * most / feed
        self._say(
            "feed_per_tooth",
            f"Chip load held at {kept:.4g} mm: {self._machine.title} feeds at {most:g} mm/min at most, and "
            f"{feed:.0f} was wanted.",
            held=True,
        )
        return kept

    def _within_power(self, load: float, rpm: float) -> float:
        """Return the chip load at which the spindle's power suffices; power goes with its (1 - mc)-th power."""
        needs = mechanics.milling_power(self._chip(load, rpm), self._tool, self._material)
        has = self._machine.spindle.power if self._machine else 0.0
        cut = "" if self._tool.kind.drills else f" at {self._depth:g} mm deep"
        force = _of(self._material.force_source)
        if not has:
            whose = f"{self._machine.title} tells no power" if self._machine else "no machine is named"
            self._say("power", f"Power {needs:.3g} W{cut}{force}; {whose}, so it bounds nothing.")
            return load
        most = POWER_SHARE * has
        if needs <= most:
            self._say(
                "power", f"Power {needs:.3g} W{cut}{force}: within {100 * POWER_SHARE:g} % of the spindle's {has:g} W."
            )
            return load
        kept = load * math.pow(most / needs, 1 / (1 - self._material.force_exponent))
        self._say(
            "power",
            f"Power would be {needs:.3g} W{cut}, more than {100 * POWER_SHARE:g} % of the spindle's {has:g} W: chip "
            f"load held at {kept:.4g} mm.",
            held=True,
        )
        return kept

    def _deflection(self, chip: Chip) -> float:
        if self._tool.kind.drills:
            return 0.0
        return mechanics.deflection(mechanics.side_force(chip, self._tool, self._material), self._tool)

    def _within_deflection(self, load: float, rpm: float) -> float:
        """Return the chip load at which the tip gives way by no more than MOST_DEFLECTION."""
        if self._tool.kind.drills:
            return load
        if not self._tool.stick_out:
            self._say("deflection", "Deflection is not bounded: the tool's stick-out is not known.")
            return load
        bent = self._deflection(self._chip(load, rpm))
        whole = f"{self._tool.stick_out:g} mm out of the holder"
        if bent <= MOST_DEFLECTION:
            self._say(
                "deflection", f"The tip gives way by at most {bent:.3f} mm, {whole}; {MOST_DEFLECTION:g} is allowed."
            )
            return load
        kept = load * math.pow(MOST_DEFLECTION / bent, 1 / (1 - self._material.force_exponent))
        self._say(
            "deflection",
            f"The tip would give way by up to {bent:.3f} mm, {whole}, and {MOST_DEFLECTION:g} is allowed: chip load "
            f"held at {kept:.4g} mm.",
            held=True,
        )
        return kept

    def _thickest(self, load: float) -> float:
        """Return the thickness of the thickest chip, mm."""
        return load if self._tool.kind.drills else load / mechanics.chip_thinning(self._engagement.angle)

    def _warn_of_rubbing(self, load: float) -> None:
        if self._thickest(load) < LEAST_CHIP:
            self._say(
                "feed_per_tooth",
                f"Chips of less than {LEAST_CHIP:g} mm rub: take a smaller stepdown, a shorter tool or fewer flutes.",
                held=True,
            )

    def _feed(self, load: float, rpm: float) -> float:
        feed = max(mechanics.feed_rate(rpm, self._tool.flutes, load), LEAST_RATE)
        kept = float(max(math.floor(feed + 1e-6), LEAST_RATE))
        tap = (
            " A tap's feed is its pitch times the speed, whatever stands here."
            if self._tool.kind is ToolKind.TAP
            else ""
        )
        self._say(
            "feed_rate", f"Feed {kept:.0f} mm/min: {rpm:.0f} rpm x {self._tool.flutes} x {load:.4g} mm a tooth.{tap}"
        )
        return kept

    def _plunge(self, row: FeedRow, rpm: float, feed: float) -> float:
        """Return the feed straight down: a part of the feed of the full width, which the chip load alone tells."""
        full = min(feed, mechanics.feed_rate(rpm, self._tool.flutes, row.feed_per_tooth))
        most = self._machine.z.rapid if self._machine else math.inf
        plunge = float(max(math.floor(min(full * row.plunge_share, most) + 1e-6), LEAST_RATE))
        bound = f", held by Z's {most:g}" if full * row.plunge_share > most else ""
        self._say(
            "plunge_rate",
            f"Plunge {plunge:.0f} mm/min: {100 * row.plunge_share:g} % of {full:.0f} mm/min, the feed of full chips"
            f"{bound}.",
            held=bool(bound),
        )
        return plunge


def _of(source: str) -> str:
    """Return where a figure comes from, in brackets."""
    return f" ({source})" if source else ""


@dataclass(frozen=True, slots=True)
class _Slowed:
    """What a kind of tool takes of the figures of flat end mills: of the surface speed, of the chip load."""

    speed: float
    chip: float


_AS_MILLS = _Slowed(1.0, 1.0)
"""Speed and feed as shares of those of an end mill: the same."""
_SLOWED = {
    "ball": _Slowed(1.0, 0.8),  # its chips are thinner towards the tip, where it has no speed
    "v": _Slowed(1.0, 0.5),  # its tip is slender
    "taper": _Slowed(1.0, 0.5),
    "drill": _Slowed(1.0, 1.25),  # all its edges cut all the time, and steadily
    "reamer": _Slowed(0.5, 0.6),  # handbooks: half to two thirds of a drill's speed
    "tap": _Slowed(0.33, 1.25),  # turns back at full depth
    "thread-mill": _Slowed(0.67, 0.6),  # its teeth cut over their whole flanks
}
