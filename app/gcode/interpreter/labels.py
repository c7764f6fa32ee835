"""What LinuxCNC refuses of O words beside their grammar: a label for two things, a subroutine out of its place."""

from __future__ import annotations

from .places import Statement
from .program import BlockFault


class Labels:
    """The labels that were met so far.

    A label is one for each subroutine and for the program, but where it begins with an underscore. Those of subroutines
    are others, and everybody's.
    """

    def __init__(self) -> None:
        self._defined: dict[tuple[str, str], Statement] = {}
        self._subroutines: dict[str, Statement] = {}
        self._met: set[str] = set()

    def define(self, statement: Statement, where: str) -> None:
        """Note what begins at a statement.

        Args:
            statement: if, while, repeat, or the while that ends a do.
            where: the subroutine that is running, "" = none.

        Raises:
            Fault: another one of this label was met before.
        """
        first = self._defined.setdefault(_key(statement.label, where), statement)
        if first.at.line != statement.at.line:
            raise BlockFault(
                f"O{statement.label} is the label of what begins in line {first.at.line} already; LinuxCNC takes each "
                "once, so use another."
            )

    def begin_do(self, statement: Statement, where: str) -> None:
        """Note where a do begins; LinuxCNC looks only at its while whether the label is free."""
        self._defined.setdefault(_key(statement.label, where), statement)

    def end_do(self, begin: Statement, where: str, line: int) -> None:
        """Check the label of a do at the line of its while.

        Raises:
            Fault: something else of this label was met before.
        """
        first = self._defined[_key(begin.label, where)]
        if first is not begin and first.at.line != begin.at.line:
            raise BlockFault(
                f"O{begin.label} is the label of what begins in line {first.at.line} already, so this while in line "
                f"{line} belongs to that; use another."
            )

    def need_if(self, statement: Statement, where: str) -> None:
        """Check that an else or endif belongs to an if.

        Raises:
            Fault: it does not.
        """
        first = self._defined.get(_key(statement.label, where))
        if first is None:
            raise BlockFault(f"O{statement.label} {statement.keyword} belongs to no if.")
        if first.keyword != "if":
            raise BlockFault(
                f"O{statement.label} {statement.keyword} belongs to no if: line {first.at.line} has {first.keyword}."
            )

    def meet_subroutine(self, statement: Statement, inner: Statement | None) -> None:
        """Note a subroutine whose lines are passed over.

        Args:
            statement: its sub.
            inner: a sub within it, None = there is none.

        Raises:
            Fault: it was met or called before; one stands within it.
        """
        first = self._subroutines.setdefault(statement.label, statement)
        if first.at.line != statement.at.line:
            raise BlockFault(
                f"the subroutine O{statement.label} is in line {first.at.line} already; use another label."
            )
        if statement.label in self._met:
            raise BlockFault(
                f"the program comes to the subroutine O{statement.label} again; it must stand before its first call, "
                "and in nothing that is repeated."
            )
        self._met.add(statement.label)
        if inner is not None:
            raise BlockFault(
                f"the subroutine O{inner.label} begins in line {inner.at.line} within another, O{statement.label}; put "
                "it before."
            )

    def call_subroutine(self, found: Statement) -> Statement:
        """Note a subroutine that is called, and return the one that this label stands for: the one met first."""
        self._met.add(found.label)
        return self._subroutines.setdefault(found.label, found)


def _key(label: str, where: str) -> tuple[str, str]:
    return ("", label) if label.startswith("<_") else (where, label)
