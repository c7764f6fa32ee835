"""The page of `man hitofude`, made from the commands that there are: `python -m hitofude.cli.man_page` prints it."""

from __future__ import annotations

from collections.abc import Iterator

from .. import __version__
from .program import SUMMARIES, load_command


def man_page() -> str:
    """Return the page as troff."""
    return "\n".join(_lines()) + "\n"


def _lines() -> Iterator[str]:
    yield f'.TH HITOFUDE 1 "" "Hitofude {__version__}" "User Commands"'
    yield from (".SH NAME", r"hitofude \- from a line drawing to tool paths that can be trusted on a real machine")
    yield ".SH SYNOPSIS"
    yield from (r"\fBhitofude\fR [\fBopen\fR] [\fIFILE\fR]", ".br", r"\fBhitofude\fR \fICOMMAND\fR [\fIOPTIONS\fR]")
    yield ".SH DESCRIPTION"
    yield _plain(
        "Without a command the window is opened, with FILE or the last ones to choose from. A command works without a "
        "window and without a display. Each has its own options: hitofude COMMAND --help lists them."
    )
    yield ".SH COMMANDS"
    for name, summary in SUMMARIES.items():
        yield ".TP"
        yield rf"\fBhitofude {_plain(summary.usage)}\fR"
        yield _plain(load_command(name).about)
        for example in load_command(name).examples[:1]:
            yield from (".br", rf"Example: \fB{_plain(example)}\fR")
    yield ".SH OPTIONS"
    yield from (".TP", r"\fB\-\-help\fR", "The commands, or behind a command its options.")
    yield from (".TP", r"\fB\-\-version\fR", "The version.")
    yield ".SH EXIT STATUS"
    for status, words in (
        ("0", "done and clean"),
        ("1", "done, with findings: gouge, material left within reach, rapid in material, a region skipped whole"),
        ("2", "bad input or usage, told in one line; nothing was written"),
        ("130", "cancelled by Ctrl+C (143 by TERM, 129 by HUP)"),
    ):
        yield from (".TP", rf"\fB{status}\fR", _plain(words))
    yield ".SH ENVIRONMENT"
    yield from (".TP", r"\fBHITOFUDE_CONFIG\fR", "folder of settings, posts and machines of your own")
    yield from (".TP", r"\fBHITOFUDE_DEBUG\fR", _plain("1: where in the program an unexpected error happened"))


def _plain(text: str) -> str:
    r"""Return a text as one line of troff: dashes that can be copied, and no dot or backslash that it would obey."""
    line = " ".join(text.split()).replace("\\", r"\e").replace("-", r"\-")
    return rf"\&{line}" if line[:1] in (".", "'") else line


if __name__ == "__main__":
    print(man_page(), end="")
