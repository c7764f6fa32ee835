"""Lists the kernels that the sample part's program takes: `python -m tests.core.usual_kernels` writes the list anew.

The list says what is compiled ahead when a command runs for the first time; a test asks that it is up to date.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.conftest import ROOT

LIST = ROOT / "resources" / "usual_kernels.txt"

_RECORDER = """
import sys
from app.core.jit import compiled
from app.cli.main import main

called = []
ready = compiled.Kernel._ready
compiled.Kernel._ready = lambda self: called.append(self) or ready(self)
main(["make", "resources/samples/fig2.dxf", "-o", sys.argv[1]])
found = {}
while called:
    kernel = called.pop()
    found[kernel.name.partition(".")[2]] = None
    called.extend(kernel.callees)
print("", *sorted(found), sep="\\nkernel ")
"""


def taken(output: Path) -> list[str]:
    """Return the names, without the package's, of all kernels that the sample part's program takes.

    Args:
        output: where the program may be written.
    """
    done = subprocess.run(
        [sys.executable, "-P", "-c", f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{_RECORDER}", str(output)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    )
    return [line.partition(" ")[2] for line in done.stdout.splitlines() if line.startswith("kernel ")]


if __name__ == "__main__":
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        LIST.write_text("".join(f"{name}\n" for name in taken(Path(folder) / "fig2.ngc")), encoding="utf-8")
