"""Start: the window for `open`, a file or nothing; the command line for everything else."""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
import threading
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

_heard_before = signal.getsignal(signal.SIGINT)
_is_first = threading.current_thread() is threading.main_thread() and _heard_before is signal.default_int_handler
if _is_first:  # Ctrl+C while all this is imported ends the process, as it does any other, without a traceback
    signal.signal(signal.SIGINT, signal.SIG_DFL)

# bands of our own use the cores; threads of the library wait busily for small matrices
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# imports and small jobs make many objects and hardly any rings: looking for these took a fifth of `make`
gc.set_threshold(300_000, 20, 20)

from .core.quick_dataclasses import make_dataclasses_quickly  # noqa: E402

make_dataclasses_quickly()

from .cli.main import BAD_INPUT  # noqa: E402 (all three first: importing makes most of the objects, reads the environment)
from .cli.main import main as command_line  # noqa: E402
from .cli.output import say  # noqa: E402
from .core.errors import shortened  # noqa: E402
from .core.processor_level import lacking_here  # noqa: E402

if _is_first:
    signal.signal(signal.SIGINT, _heard_before)

_LIBRARIES = (
    "libegl1 libgl1 libglib2.0-0 libfontconfig1 libdbus-1-3 libxkbcommon0 libxkbcommon-x11-0 libxcb-cursor0 "
    "libxcb-icccm4 libxcb-keysyms1 libxcb-shape0"
)


def main() -> int:
    """Run what the arguments ask for.

    Returns:
        Exit status: 0 done, 1 done with findings, 2 bad input, 130 cancelled.
    """
    _hold_streams()
    if missing := lacking_here():
        return _refuse(
            f"this processor lacks {', '.join(missing)}, which the libraries are built for; Hitofude needs one of the "
            "level x86-64-v2, as PC processors are since 2009"
        )
    arguments = sys.argv[1:]
    if not arguments:
        return _window(None)
    if arguments[0] == "open":
        return _open(arguments[1:])
    if len(arguments) == 1 and not arguments[0].startswith("-") and Path(arguments[0]).suffix:
        return _open(arguments)
    return _end(command_line(arguments))


def _hold_streams() -> None:
    """Let what is closed of the three streams be nowhere, so that no file that is opened takes its number and gets what
    is said.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free: this one


def _end(status: int) -> NoReturn:
    """End the process without taking it apart first, object by object, which takes longer than many a command."""
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):
            stream.flush()
    os._exit(status)


def _open(files: list[str]) -> int:
    if len(files) > 1:
        return _refuse(f"open takes one drawing, not {len(files)}; open the others with File, Open")
    if files and files[0] in ("-h", "--help"):
        return command_line(["--help"])
    if files and files[0].startswith("-"):
        return _refuse(f"open has no option {files[0]}; name a file, or nothing to choose from the last ones")
    if files and not Path(files[0]).is_file():
        return _refuse(f"{files[0]}: there is no such file; name one, or nothing to choose from the last ones")
    return _window(Path(files[0]) if files else None)


def _has_screen() -> bool:
    return not sys.platform.startswith("linux") or any(
        os.environ.get(n) for n in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    )


def _window(path: Path | None) -> int:
    if not _has_screen():
        return _refuse(
            "there is no screen here to open a window on; start it on a desktop, or use: hitofude make DRAWING -o "
            "OUT.ngc"
        )
    try:
        from .ui.shell.start import start

        gc.freeze()  # what was imported stays
        gc.set_threshold(700, 10, 10)  # a window stays smooth by many short looks
    except ImportError as error:
        if "PySide6" not in f"{error.name}{error.path}{error}" and ".so" not in str(error):
            raise
        return _refuse(
            f"the window needs libraries that are missing here ({error}); install them, on Debian or Ubuntu with: "
            f"apt-get install {_LIBRARIES}"
        )
    return _end(start(path))


def _refuse(sentence: str) -> int:
    say(f"hitofude: {shortened(sentence)}")
    return BAD_INPUT


if __name__ == "__main__":
    sys.exit(main())
