"""One tolerance for all that happens to a surface on its way to a program: who may spend how much of it, and did."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

Json = dict[str, Any]


class Evidence(Enum):
    """How it is known what was spent."""

    PROVEN = "proven"
    MEASURED = "measured"


@dataclass(frozen=True, slots=True)
class BudgetShare:
    """One share of a tolerance.

    Attributes:
        name: what spends it: "facets", "chords", "smoothing", "digits", "cells".
        allowed_mm, spent_mm: lengths square to the surface, mm, >= 0.
        evidence: how the latter is known. how: by what, in words.
    """

    name: str
    allowed_mm: float
    spent_mm: float
    evidence: Evidence
    how: str

    @property
    def kept(self) -> bool:
        """Whether no more was spent than is allowed."""
        return self.spent_mm <= self.allowed_mm


@dataclass(frozen=True, slots=True)
class ToleranceBudget:
    """All shares of one tolerance.

    Attributes:
        tolerance_mm: what they add up to at most, mm. shares: in the order in which they are spent.
    """

    tolerance_mm: float
    shares: tuple[BudgetShare, ...]

    @property
    def allowed_mm(self) -> float:
        """What all shares together may spend, mm."""
        return sum(share.allowed_mm for share in self.shares)

    @property
    def spent_mm(self) -> float:
        """What all shares have spent together, mm: no place is off by more, if each is as it says."""
        return sum(share.spent_mm for share in self.shares)

    @property
    def kept(self) -> bool:
        """Whether each share, and all together, kept to what they may spend."""
        return all(share.kept for share in self.shares) and self.spent_mm <= self.tolerance_mm

    @property
    def proven(self) -> bool:
        """Whether all that was spent is proven."""
        return all(share.evidence is Evidence.PROVEN for share in self.shares)

    def lines(self) -> tuple[str, ...]:
        """Return it in words, a line a share and one for all."""
        shares = [
            f"{share.name}: {share.spent_mm:.6f} of {share.allowed_mm:.6f} mm, {share.evidence.value} ({share.how})"
            for share in self.shares
        ]
        word = "kept" if self.kept else "NOT kept"
        return (
            *shares,
            f"together {self.spent_mm:.6f} of {self.tolerance_mm:.6f} mm, "
            f"{'proven' if self.proven else 'in part measured'}: {word}",
        )

    def report(self) -> Json:
        """Return it for a report, lengths in mm."""
        return {
            "tolerance_mm": self.tolerance_mm,
            "spent_mm": self.spent_mm,
            "kept": self.kept,
            "proven": self.proven,
            "shares": [
                {
                    "name": share.name,
                    "allowed_mm": share.allowed_mm,
                    "spent_mm": share.spent_mm,
                    "evidence": share.evidence.value,
                    "how": share.how,
                }
                for share in self.shares
            ],
        }
