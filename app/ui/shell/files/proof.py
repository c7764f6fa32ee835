"""What was proven of a program before its file is kept, in one sentence. No Qt."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....model.finding import Finding
from ...framework.figures import counted, grouped
from ...framework.verdict import short, worst_first

if TYPE_CHECKING:
    from ....usecases.making.make import MakeResult

NAMED = 2
"""Findings that are named one by one."""


def proof(made: MakeResult) -> str:
    """Return what holds of a clean program, with the numbers."""
    check = made.report.data["check"]["largest_distance_mm"]
    said = [f"Read back within {max(check, 0.0001):.4f} mm"]
    if made.cut is None or made.cut.judgement is None:
        return f"{said[0]}."
    judgement = made.cut.judgement
    said.append(f"cut out of its stock, {grouped(made.cut.cut.removed_volume, 0)} mm³ of it")
    gouge = f"no gouge ({judgement.gouge.max_mm:.4f} mm)" if judgement.exact else "no gouge"
    said += [f"{gouge}, nothing left within reach, no rapid in metal"]
    if judgement.certificate is not None and judgement.certificate.telling:
        said.append(f"no point between the cells deeper than {judgement.certificate.gouge_mm:.3f} mm into the part")
    return f"{'; '.join(said)}."


def warning(findings: tuple[Finding, ...]) -> str:
    """Return what is wrong and where: the worst findings that count, and how many more there are.

    Args:
        findings: at least one that counts.
    """
    counting = [finding for finding in worst_first(findings) if finding.counts]
    named = [f"{short(finding)}{f', line {finding.line}' if finding.line else ''}" for finding in counting[:NAMED]]
    more = f"; {len(counting) - NAMED} more" if len(counting) > NAMED else ""
    return f"{counted(len(counting), 'finding')}: {'; '.join(named)}{more}. Look before the file is written."
