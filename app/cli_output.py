"""What the command line prints, for readers that may go away before the end, as `head` does."""

from __future__ import annotations

import os
import sys


def tell(text: str) -> None:
    """Print lines to stdout; a stdout that is closed takes nothing more, silently.

    The work is done when this is called, so that a stdout that fails changes no exit status.
    """
    try:
        print(text, flush=True)
    except BrokenPipeError:
        _let_go()
    except OSError as error:
        _let_go()
        print(f"hitofude: the summary could not be printed ({error.strerror or error}); the files are as the exit status says",
              file=sys.stderr)


def _let_go() -> None:
    """Send what is still to come to nowhere, as the interpreter flushes stdout at its end and would complain."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
