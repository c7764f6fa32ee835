"""The command `make` as its user sees it: exit status, one line for every error, files whole or not at all."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from app.cli.main import main
from tests.called import call
from tests.said import without_how_far

ROOT = Path(__file__).resolve().parents[2]
FIG2 = ROOT / "resources/samples/fig2.dxf"
OLD = b"(the program of yesterday)\n"


def run(*arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
    """Run the real command."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "app", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, env=environment, **options)  # type: ignore[call-overload]


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """An output file that is there already."""
    path = tmp_path / "out.ngc"
    path.write_bytes(OLD)
    return path


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """Run a command that must be refused; return its one line."""
    assert main(["make", *map(str, arguments)]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("hitofude: ")
    assert shown.err.count("\n") == 1
    assert "Traceback" not in shown.err
    return shown.err


@pytest.mark.exhaustive
def test_the_whole_command(out: Path, tmp_path: Path) -> None:
    done = run("make", FIG2, "-o", out, "--report", tmp_path / "r.json", "--image", tmp_path / "i.svg", cwd=tmp_path)
    assert (done.returncode, without_how_far(done.stderr)) == (0, "")
    assert "out.ngc: 0.0000 mm gouge, 0.000 mm2 left within reach" in done.stdout
    assert "is out of reach of every tool" in done.stdout
    report = json.loads((tmp_path / "r.json").read_text())
    keys = {
        "gouge",
        "left",
        "rapids_in_material",
        "strokes",
        "retracts",
        "length_mm",
        "time_s",
        "moves",
        "skipped",
        "open_contours",
        "engine",
        "tolerance",
    }
    assert keys <= set(report)
    assert {"max_mm", "x", "y", "z", "line", "count"} <= set(report["gouge"])
    assert {"reachable_mm2", "unreachable_mm2", "largest_disc_mm"} <= set(report["left"])
    assert {"cut", "link", "rapid"} <= set(report["length_mm"])
    assert set(report["moves"]) == {"G0", "G1", "G2", "G3"}
    assert out.read_text().count("M6") == 2
    assert (tmp_path / "i.svg").read_text().startswith("<svg")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["i.svg", "out.ngc", "r.json"]


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize(
    ("drawing", "options", "status"),
    [
        ("resources/samples/fig2.dxf", ["--safe-z=6"], 0),
        ("tests/data/dxf/forms.dxf", ["--pocket-tool=60", "--contour-tool=40"], 1),
    ],
)
def test_a_closed_stdout_is_silent_and_keeps_the_status(
    drawing: str, options: list[str], status: int, unbuffered: str, out: Path
) -> None:
    done, told = unread(unbuffered, "make", str(ROOT / drawing), "-o", str(out), *options)
    assert (done, told) == (status, "")
    assert out.read_bytes() != OLD


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["make", "--help"]])
def test_help_that_nobody_reads_is_silent(arguments: list[str]) -> None:
    assert unread("1", *arguments) == (0, "")


def unread(unbuffered: str, *arguments: str) -> tuple[int, str]:
    """Run a command whose stdout is a pipe that is closed at the other end; return exit status and stderr."""
    read, write = os.pipe()
    os.close(read)
    environment = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    done = subprocess.run(
        [sys.executable, "-m", "app", *arguments],
        stdout=write,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env=environment,
        timeout=120,
    )
    os.close(write)
    return done.returncode, without_how_far(done.stderr)


def test_a_full_stdout_is_told_and_keeps_the_status(out: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "app", "make", str(FIG2), "-o", str(out)],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            timeout=120,
        )
    assert done.returncode == 0
    said = without_how_far(done.stderr)
    assert said.count("\n") == 1
    assert "the summary could not be printed" in said


@pytest.mark.exhaustive
def test_findings_give_exit_status_1(out: Path, data: Path) -> None:
    done = call("make", data / "dxf/forms.dxf", "-o", out, "--pocket-tool=60", "--contour-tool=40")
    assert done.returncode == 1
    assert "  ! " in done.stdout
    assert "is too small" in done.stdout
    assert out.read_bytes() != OLD


def test_make_never_imports_qt(out: Path) -> None:
    code = (
        "import sys; from app.cli.main import main; assert main(sys.argv[1:]) == 0; "
        "print([name for name in sys.modules if 'PySide' in name or 'pyqtgraph' in name or name.startswith('app.ui')])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, "make", str(FIG2), "-o", str(out), "--quiet", "--image", str(out) + ".png"],
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=True,
    )
    assert done.stdout.strip() == "[]"


def test_make_imports_nothing_that_a_drawing_of_pockets_does_not_need(out: Path) -> None:
    """What takes long: pictures, masked arrays, patterns of comments and of hatches, kinds of operation."""
    unused = [
        *("cv2", "scipy", "trimesh", "pyparsing", "numpy.ma.core"),
        "app.gcode.interpreter.foreign_notes",
        *("app.operations.adaptive", "app.operations.vcarve", "app.operations.thread"),
    ]
    code = (
        "import sys; from app.cli.main import main; assert main(sys.argv[1:]) == 0; "
        f"print({set(unused)} & sys.modules.keys(), hasattr(sys.modules['ezdxf.tools.pattern'], '__file__'))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, "make", str(FIG2), "-o", str(out), "--quiet"],
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=True,
    )
    assert done.stdout.strip() == "set() False"


def test_help_and_version_need_no_heavy_library() -> None:
    heavy = {"numpy", "numba", "ezdxf", "shapely", "cv2", "PySide6"}
    code = (
        f"import sys; from app.cli.main import main; main(['--help']); main(['--version']); print({heavy} & "
        "sys.modules.keys())"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True)
    assert done.stdout.strip().endswith("set()")
    assert "hitofude make DRAWING -o OUT.ngc" in done.stdout
    assert "hitofude 0." in done.stdout


def test_help_of_make_names_every_option() -> None:
    text = call("make", "--help").stdout
    options = """--job --contour-tool --pocket-tool --stepover --overlap --depth --stepdown --stock-to-leave --safe-z
    --feed --plunge
        --speed --climb --conventional --order --post --out-units --units --origin --layer --join-tolerance --image
        --report --quiet --side --entry --ramp-angle --lead --lead-radius --tabs --tab-width --tab-height --dog-bones
        --finish-depth --finish-width --spring-passes --floor-to-leave --outside-in --most-engaged --drill --peck
        --through --copies --keep-out --keep-out-height
        --skip-layer --skip-type --layout --to-zero --px-per-inch"""
    assert all(option in text for option in options.split())
    assert "lower-left" in text
    assert "--bitmap" in text


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("--safe-z -1", "--safe-z is -1 mm; the clearance height must be 0.001 mm or more"),
        ("--safe-z=-1mm", "--safe-z is -1 mm"),
        ("--safe-z -1mm", "--safe-z is -1 mm"),
        ("--depth 0", "--depth is 0 mm; the depth must be 0.001 to 99999 mm"),
        ("--depth 0.0005", "--depth is 0.0005 mm; the depth must be 0.001 to 99999 mm"),
        ("--stepdown 1e-9", "--stepdown is 1e-09 mm; the stepdown must be 0.001 to 99999 mm"),
        ("--depth 20 --stepdown 0.001", "makes 20000 passes; 1000 are the most"),
        ("--safe-z 0.0001", "--safe-z is 0.0001 mm"),
        ("--feed 0.1", "--feed is 0.1 mm/min; the feed rate must be 1 mm/min or more"),
        ("--plunge 0.99", "--plunge is 0.99 mm/min; the plunge rate must be 1 mm/min or more"),
        ("--stepover 0.5%", "--stepover is 0.5 %; it must be 1 % or more and not more than the tool's diameter"),
        ("--stepover 0.0001", "--stepover is 0.0001 mm; it must be 0.001 mm or more"),
        ("--overlap 5.9999", "Stepover is 0.0001 mm with a pocket tool of 6 mm; it must be 0.001 mm or more"),
        ("--join-tolerance 1000", "oin tolerance is 1000 mm; use 0 to 10 mm"),
        ("--depth -1/4in", "--depth is -6.35 mm"),
        ("--depth nan", "--depth is wrong: 'nan' is no number"),
        (
            "--contour-tool flat:0.2",
            "--contour-tool is wrong: 'flat:0.2' is no diameter (its kind is not asked for here); write a length in mm",
        ),
        ("--depth deep", "--depth is wrong"),
        ("--drill circles:5", "--drill is wrong: it takes the diameter of the drill alone, such as 5"),
        ("--stock-to-leave -0.1", "must be 0 to 9999 mm"),
        ("--stepover 120%", "--stepover is 120 %; it must be 1 % or more and not more than the tool's diameter"),
        ("--stepover -5%", "--stepover is -5 %"),
        ("--stepover wide", "--stepover is wrong: 'wide' is neither a length nor per cent"),
        ("--stepover 7", "Stepover is 7 mm with a pocket tool of 6 mm"),
        ("--overlap 6", "Overlap is 6 mm with a pocket tool of 6 mm"),
        ("--overlap 2 --stepover 3", "Stepover and overlap are both given"),
        ("--feed fast", "--feed is wrong: 'fast' is no number; write the feed rate in mm/min"),
        ("--feed", "--feed has no value"),
        ("--speed -100", "--speed is -100 rpm"),
        ("--climb --conventional", "exclude one another"),
        ("--order 1987", "choose one of 'pocket-first', '1986'"),
        ("--origin left", "'left' is no origin"),
        ("--origin centre,drawing", "is no origin"),
        ("--units yards", "'yards' is no unit; use mm"),
        ("--out-units m", "'m' is no unit of an NC program"),
        ("--post abacus", "no post 'abacus'"),
        ("--layer walls", "no layer walls"),
        ("--bitmap 4", "The bitmap is 4 px wide; use 16 to 8192 px"),
        ("--bitmap many", "'many' is no whole number"),
        ("--pitch 0", "the pitch must be greater than 0 mm"),
        ("--dpi 300", "fig2.dxf is no picture"),
        ("--image picture.jpg", "a picture is .svg or .png"),
        ("--nonsense 3", "--nonsense 3 is no option"),
        ("--contour 3", "no option"),
        ("--contour-tool 200", "nothing can be cut. Region 1 at (52.339, 46.341) is too small"),
        ("--job nowhere.toml", "nowhere.toml does not exist"),
        ("other.dxf", "no second drawing"),
    ],
)
def test_a_wrong_option_is_told_in_one_line(
    arguments: str, words: str, out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert words in refused(capsys, FIG2, "-o", out, *arguments.split(" "))
    assert out.read_bytes() == OLD


@pytest.mark.parametrize("diameter", ["6", "6mm", "0.6cm", "1/4in", '.25"', "0.25in", "3mm + 1/8in"])
def test_diameters_with_and_without_unit(diameter: str, out: Path, tmp_path: Path) -> None:
    assert (
        main(
            [
                "make",
                str(FIG2),
                "-o",
                str(out),
                "--pocket-tool",
                diameter,
                "--quiet",
                "--report",
                str(tmp_path / "r.json"),
            ]
        )
        == 0
    )
    (tool,) = json.loads((tmp_path / "r.json").read_text())["tools"]
    expected = 6.0 if diameter[0] in "6" or "cm" in diameter else 6.175 if "+" in diameter else 6.35
    assert tool["diameter_mm"] == pytest.approx(expected)


def test_missing_arguments(capsys: pytest.CaptureFixture[str]) -> None:
    assert "-o/--output is missing" in refused(capsys, FIG2)
    assert "DRAWING, -o/--output are missing" in refused(capsys)


def test_files_that_cannot_be(out: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty, closed = tmp_path / "empty.dxf", tmp_path / "closed"
    empty.touch()
    closed.mkdir()
    assert "does not exist" in refused(capsys, tmp_path / "nothing.dxf", "-o", out)
    assert "is empty" in refused(capsys, empty, "-o", out)
    assert "is a folder" in refused(capsys, tmp_path, "-o", out)
    assert "is a folder" in refused(capsys, FIG2, "-o", closed)
    assert "there is no folder" in refused(capsys, FIG2, "-o", tmp_path / "none" / "out.ngc")
    assert "is also an input" in refused(capsys, FIG2, "-o", FIG2)
    assert "named twice" in refused(capsys, FIG2, "-o", out, "--report", out)
    assert "cannot be read" in refused(capsys, empty / "x.dxf", "-o", out)
    assert "drawings of type .txt cannot be read" in refused(capsys, _copy(tmp_path / "fig2.txt"), "-o", out)
    link = tmp_path / "link.dxf"
    link.symlink_to(FIG2)
    assert "is also an input" in refused(capsys, link, "-o", FIG2)
    assert out.read_bytes() == OLD
    assert FIG2.read_bytes().startswith(b"  0")


def _copy(path: Path) -> Path:
    path.write_bytes(FIG2.read_bytes())
    return path


def test_a_report_that_cannot_be_written_leaves_the_old_program(
    out: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    assert "/dev/full" in refused(capsys, FIG2, "-o", out, "--report", "/dev/full")
    assert out.read_bytes() == OLD


@pytest.mark.parametrize("length", [1, 100, 3000, 9000, 17000])
def test_truncated_drawings(length: int, out: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    torn = tmp_path / "torn.dxf"
    torn.write_bytes(FIG2.read_bytes()[:length])
    status = main(["make", str(torn), "-o", str(out), "--quiet"])
    shown = capsys.readouterr()
    assert status in (0, 1, 2)
    assert "Traceback" not in shown.err
    assert (status == 2) == (shown.err.count("\n") == 1)
    assert (out.read_bytes() == OLD) == (status == 2)


@pytest.mark.parametrize("seed", range(6))
def test_garbage(seed: int, out: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import random

    chance, good = random.Random(seed), bytearray(FIG2.read_bytes())
    for _ in range(3 * 10**seed if seed < 4 else 0):
        good[chance.randrange(len(good))] = chance.randrange(256)
    torn = tmp_path / "torn.dxf"
    torn.write_bytes(bytes(good) if seed < 4 else chance.randbytes(5000) if seed == 4 else b"0\nSECTION\n" * 2000)
    status = main(["make", str(torn), "-o", str(out), "--quiet"])
    shown = capsys.readouterr()
    assert status in (0, 1, 2)
    assert "should not have happened" not in shown.err
    assert shown.err.count("\n") == (1 if status == 2 else 0)
    assert (out.read_bytes() == OLD) == (status == 2)


def test_quiet_says_nothing(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["make", str(FIG2), "-o", str(out), "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")


def test_job_file(out: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = tmp_path / "r.json"
    job = ROOT / "resources/samples/job.toml"
    assert (
        main(["make", str(FIG2), "-o", str(out), "--job", str(job), "--depth", "3", "--quiet", "--report", str(report)])
        == 0
    )
    data = json.loads(report.read_text())
    assert [tool["diameter_mm"] for tool in data["tools"]] == [6, 3]
    assert [(each["kind"], each["tool"], each["depth_mm"]) for each in data["operations"]] == [
        ("pocket", 1, 3),
        ("rest", 2, 3),
        ("contour", 2, 3),
    ]
    bad = tmp_path / "bad.toml"
    bad.write_text("[stock]\nthick = 3\n")
    assert "bad.toml:2: thick is no key of [stock]" in refused(capsys, FIG2, "-o", out, "--job", bad)


def test_unknown_commands(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["mkae"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_an_unexpected_exception_is_one_line(
    out: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("two\nlines")

    monkeypatch.setattr("app.usecases.making.make.make", broken)
    assert "RuntimeError: two lines" in refused(capsys, FIG2, "-o", out)
    monkeypatch.setenv("HITOFUDE_DEBUG", "1")
    assert main(["make", str(FIG2), "-o", str(out)]) == 2
    assert "Traceback" in capsys.readouterr().err
    assert out.read_bytes() == OLD


def hears(pid: int, number: int) -> bool:
    """Tell whether a process has a handler for a signal of its own, as a command has from its first step on."""
    caught = re.search(r"^SigCgt:\s*(\w+)", Path(f"/proc/{pid}/status").read_text(), re.MULTILINE)
    return caught is not None and bool(int(caught[1], 16) >> (number - 1) & 1)


def worked(pid: int) -> float:
    """Return the processor seconds of a process, which others that are at work do not change."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")


@pytest.mark.parametrize("seconds", [0.7, 1.5])
def test_ctrl_c_is_130_and_leaves_the_old_file(seconds: float, out: Path, data: Path) -> None:
    command = [
        sys.executable,
        "-m",
        "app",
        "make",
        str(data / "dxf/complex.dxf"),
        "-o",
        str(out),
        "--pocket-tool=1",
        "--contour-tool=.5",
    ]
    running = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not hears(running.pid, signal.SIGTERM) or worked(running.pid) < seconds:
        assert running.poll() is None, "it ended before it could be stopped"
        time.sleep(0.01)
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=60)
    assert running.returncode == 130
    assert without_how_far(told) == "hitofude: cancelled; no file was written\n"
    assert out.read_bytes() == OLD


def test_progress_is_shown_on_a_terminal(out: Path) -> None:
    import pty

    master, slave = pty.openpty()
    command = [sys.executable, "-m", "app", "make", str(FIG2), "-o", str(out)]
    done = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=slave)
    done.communicate(timeout=60)
    os.close(slave)
    shown = os.read(master, 65536).decode()
    os.close(master)
    assert "%" in shown
    assert shown.endswith("\x1b[K")
