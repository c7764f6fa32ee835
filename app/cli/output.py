"""What the command line prints, for readers that may go away before the end, as `head` does."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from typing import Self, TextIO

from ..core.errors import printable
from ..model.finding import Finding, FindingKind

REMARKS = 3
"""Remarks of one kind that are printed; the report has all."""

COUNTED = 10
"""Findings of one kind that are printed; the report has all."""

_LAYOUT = "\n\t"
"""Signs of our own; what else a terminal would obey can only come from a file."""


def _encodable(text: str, stream: TextIO | None) -> str:
    r"""Return a text as a stream can take it: signs that its encoding lacks as \xb2 or \u51fa, as Python writes them.

    A console need not be UTF-8: PYTHONIOENCODING may say otherwise, and an older Windows does.
    """
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return text.encode(encoding, "backslashreplace").decode(encoding)


def say(text: str) -> None:
    """Print a line to stderr; where that is closed, as under cron, or full, nobody hears it and the work goes on."""
    if sys.stderr is not None:
        with suppress(OSError, ValueError):
            print(_encodable(printable(text, _LAYOUT), sys.stderr), file=sys.stderr, flush=True)


def on_terminal() -> bool:
    """Tell whether stderr is there, and a terminal."""
    return sys.stderr is not None and not sys.stderr.closed and sys.stderr.isatty()


def show(text: str) -> None:
    """Print to the line of a terminal on stderr that goes on."""
    if on_terminal():
        with suppress(OSError, ValueError):
            print(_encodable(text, sys.stderr), end="", file=sys.stderr, flush=True)


def tell(text: str) -> None:
    """Print lines to stdout; a stdout that is closed takes nothing more, silently.

    The work is done when this is called, so that a stdout that fails changes no exit status.
    """
    try:
        print(_encodable(printable(text, _LAYOUT), sys.stdout), flush=True)
    except BrokenPipeError:
        _let_go()
    except OSError as error:
        _let_go()
        say(
            f"hitofude: the summary could not be printed ({error.strerror or error}); the files are as the exit status "
            "says"
        )


def tell_lines(lines: Sequence[str]) -> None:
    """Print lines to stdout, each as one: an end of line in a file's name makes no second."""
    tell("\n".join(printable(line, "\t") for line in lines))


def finding_lines(findings: Sequence[Finding]) -> list[str]:
    """Return a line for each of the first few findings of a kind, and one for how many more there are."""
    lines: list[str] = []
    shown: Counter[FindingKind] = Counter()
    for finding in findings:
        shown[finding.kind] += 1
        if shown[finding.kind] <= (COUNTED if finding.counts else REMARKS):
            lines.append(f"  {'!' if finding.counts else '-'} {finding.text}")
    for kind, count in shown.items():
        counting = sum(1 for finding in findings if finding.kind is kind and finding.counts)
        reported = max(min(counting, COUNTED), min(count, REMARKS))
        if count > reported:
            lines.append(f"  - {count - reported} more of this kind ({kind.words}); --report R.json lists them all")
    return lines


class WaitLine:
    """Says on stderr what a command waits for: on a terminal in one line that goes on, elsewhere once."""

    def __init__(self, quiet: bool) -> None:
        self._quiet, self._said = quiet, False

    def show(self, text: str) -> None:
        """Say it; `text` may change from call to call."""
        if self._quiet:
            return
        if on_terminal():
            show(f"\r\x1b[K{text}")
        elif not self._said:
            say(f"hitofude: {text}")
        self._said = True

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the terminal's line as it was."""
        if self._said:
            show("\r\x1b[K")


def _let_go() -> None:
    """Send what is still to come to nowhere, as the interpreter flushes stdout at its end and would complain."""
    if sys.stdout is None:
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
