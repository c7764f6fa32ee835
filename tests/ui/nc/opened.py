"""Programs opened in the window as a user opens them."""

WAIT_MS = 20_000
SMALL = "G21 G90 G17 G94\nT1 M6\nS1000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X40 F300\nG3 X40 Y20 J10\nG1 X0\nG0 Z5\nM2\n"


def nc_of(wiring):
    return wiring.window_.views.nc


def open_file(qtbot, wiring, path):
    """Open a program as the user would, and wait until it is read."""
    wiring.files.open_file(path)
    qtbot.waitUntil(
        lambda: nc_of(wiring).shown is not None and nc_of(wiring).shown.source.path == path, timeout=WAIT_MS
    )
    return nc_of(wiring)
