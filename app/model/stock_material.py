"""What stock is made of: how fast it may be cut, how large its chips may be, how much force they take."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.errors import ParameterError
from .tool import ToolMaterial


@dataclass(frozen=True, slots=True)
class StockMaterial:
    """Cutting data of a material.

    Attributes:
        word: its name in job files and libraries, such as "aluminium"; not empty.
        title: its name for people.
        hss_speed, carbide_speed: surface speed of edges of high-speed steel and of carbide, m/min, > 0.
        chip_share: chip load of a flat end mill as a part of its diameter, in (0, 0.1].
        plunge_share: feed straight down of a mill as a part of its feed sideways, in (0, 1].
        cutting_force: kc1.1, the force that a chip 1 mm wide and 1 mm thick takes, N/mm2, > 0.
        force_exponent: mc, in [0, 1): a chip of thickness h mm takes kc1.1 h^-mc for each mm2 of its section.
        speed_source, chip_source, force_source: where the figures come from, in a few words.
    """

    word: str
    title: str
    hss_speed: float
    carbide_speed: float
    chip_share: float
    plunge_share: float
    cutting_force: float
    force_exponent: float
    speed_source: str = ""
    chip_source: str = ""
    force_source: str = ""

    def __post_init__(self) -> None:
        if not self.word.strip():
            raise ParameterError("A material has no word; give it one, such as aluminium.")
        if not (self.hss_speed > 0 and self.carbide_speed > 0 and self.cutting_force > 0):
            raise ParameterError(f"{self.word}: surface speeds and cutting force must be greater than 0.")
        if not (0 < self.chip_share <= 0.1 and 0 < self.plunge_share <= 1 and 0 <= self.force_exponent < 1):
            raise ParameterError(
                f"{self.word}: the chip load must be above 0 and at most 0.1 of the diameter, the plunge share above 0 "
                "and at most 1, and the exponent of the force 0 or more and less than 1."
            )

    def surface_speed(self, edges: ToolMaterial) -> float:
        """Return the surface speed, m/min, for what a tool's edges are made of."""
        return self.hss_speed if edges is ToolMaterial.HSS else self.carbide_speed
