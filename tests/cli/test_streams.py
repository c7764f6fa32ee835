"""The command line where its streams are closed, where it is ended, and where killed runs have left something."""

from __future__ import annotations

import io
import os
import platform
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from app.cli.main import main
from app.cli.signals import Stopped, stoppable, undisturbed
from app.core import atomic
from app.core.atomic import sweep, waiting_prefix, write_together
from app.core.errors import MOST_QUOTED, shortened

ROOT = Path(__file__).resolve().parents[2]
RING = "G21 G90\nG0 X0 Y0\nG1 Z-1 F100\n" + "".join(f"G1 X{k / 10:.4f} Y0\n" for k in range(1, 20)) + "M2\n"


def shell(line: str, folder: Path) -> int:
    """Run a line with the program as "$HITOFUDE"."""
    program = f"{sys.executable} -m app"
    run = subprocess.run(
        ["sh", "-c", line.replace("HITOFUDE", program)], cwd=ROOT, env=os.environ | {"OUT": str(folder)}, timeout=120
    )
    return run.returncode


@pytest.mark.parametrize("closed", ["2>&-", ">&- 2>&-", "<&- >&- 2>&-"])
def test_closed_streams_change_nothing(tmp_path: Path, closed: str) -> None:
    (tmp_path / "in.ngc").write_text(RING)
    assert shell(f'HITOFUDE smooth "$OUT/in.ngc" -o "$OUT/out.ngc" {closed}', tmp_path) == 0
    text = (tmp_path / "out.ngc").read_text()
    assert "hitofude smooth" in text and text.endswith("M2\n")
    assert shell(f'HITOFUDE smooth "$OUT/none.ngc" -o "$OUT/no.ngc" {closed}', tmp_path) == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.ngc", "out.ngc"]


def test_without_stderr_errors_do_not_go_to_stdout(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stderr", None)
    assert main(["nothing"]) == 2
    assert main(["check", "nowhere.ngc"]) == 2
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "cp932"])
def test_a_console_that_lacks_a_sign_is_told_it_otherwise(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, encoding: str
) -> None:
    """It was "this should not have happened", exit 2, after the file had been written."""
    (tmp_path / "\u51fa \u00df.ngc").write_text(RING)
    took = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(took, encoding=encoding))
    monkeypatch.setattr(sys, "stderr", io.TextIOWrapper(io.BytesIO(), encoding=encoding))
    assert main(["check", str(tmp_path / "\u51fa \u00df.ngc")]) == 0
    said = took.getvalue().decode(encoding)
    assert ("\u51fa" if encoding == "cp932" else r"\u51fa") in said and (
        "\u00df" if encoding == "cp1252" else r"\xdf"
    ) in said


@pytest.mark.parametrize("command", ["make", "cut", "batch", "stages"])
def test_help_is_told_on_any_console(monkeypatch: pytest.MonkeyPatch, command: str) -> None:
    took = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(took, encoding="ascii"))
    assert main([command, "--help"]) == 0
    assert f"usage: hitofude {command}".encode() in took.getvalue()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_ended_while_writing_it_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest, number: signal.Signals
) -> None:
    (tmp_path / "a").write_bytes(b"old")
    monkeypatch.setattr(os, "fsync", lambda _: os.kill(os.getpid(), number))
    # under nohup it is ignored
    request.addfinalizer(partial(signal.signal, number, signal.signal(number, signal.SIG_DFL)))
    with pytest.raises(Stopped) as stop, stoppable() as stopped:
        write_together({tmp_path / "a": b"new", tmp_path / "b": b"new"})
    assert stop.value.status == 128 + number and stopped.is_set()
    assert [path.name for path in tmp_path.iterdir()] == ["a"] and (tmp_path / "a").read_bytes() == b"old"


def test_while_files_take_their_places_nobody_is_heard(tmp_path: Path) -> None:
    with stoppable() as stopped:
        with undisturbed():
            os.kill(os.getpid(), signal.SIGTERM)
            write_together({tmp_path / "a": b"new"})
        assert not stopped.is_set()
    assert (tmp_path / "a").read_bytes() == b"new"


def test_what_is_ignored_stays_so() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stoppable() as stopped:
            os.kill(os.getpid(), signal.SIGHUP)
        assert not stopped.is_set()
    finally:
        signal.signal(signal.SIGHUP, before)


def dead_process() -> int:
    """The number of a process that lives no more."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def left_by(folder: Path, prefix: str) -> list[Path]:
    paths = [folder / f"{prefix}a1b2c3d4.part", folder / f"{prefix}a1b2c3d4.part.old"]
    for path in paths:
        path.write_bytes(b"half")
    return paths


def test_leftovers_of_dead_writers_are_swept_and_those_of_living_ones_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = waiting_prefix("part.ngc")
    alive = left_by(tmp_path, own)
    dead = left_by(tmp_path, own.replace(str(os.getpid()), str(dead_process())))
    others = [tmp_path / name for name in ("part.ngc", ".part.ngc", "a1b2c3d4.part", ".x.part")]
    for path in others:
        path.write_bytes(b"mine")
    sweep(tmp_path, tmp_path / "nowhere")
    assert not any(path.exists() for path in dead) and all(path.exists() for path in (*alive, *others))


def test_of_another_machine_they_stay_for_a_day(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as elsewhere:
        elsewhere.setattr(platform, "node", lambda: "elsewhere")
        prefix = waiting_prefix("part.ngc").replace(str(os.getpid()), str(dead_process()))
    young, old = left_by(tmp_path, prefix)
    nameless = left_by(tmp_path, ".part.ngc.")[0]
    for path in (old, nameless):
        os.utime(path, (0, time.time() - 2 * atomic._ABANDONED_S))
    sweep(tmp_path)
    assert young.exists() and not old.exists() and not nameless.exists()


def test_a_killed_run_leaves_nothing_for_long(tmp_path: Path) -> None:
    """Killed between writing and placing; the next command into that folder sweeps."""
    code = (
        "import os, signal; from pathlib import Path; from app.core import atomic; os.chmod = lambda *_: "
        f"os.kill(os.getpid(), signal.SIGKILL); atomic.write_together({{Path({str(tmp_path / 'out.ngc')!r}): b'x'}})"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=False)
    assert len([path for path in tmp_path.iterdir() if path.name.endswith(".part")]) == 1
    (tmp_path / "in.ngc").write_text(RING)
    assert main(["smooth", str(tmp_path / "in.ngc"), "-o", str(tmp_path / "out.ngc"), "--quiet"]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.ngc", "out.ngc"]


@pytest.mark.parametrize("text", ["G1 X1\no{} call\nM2\n", "G1 X{}\nM2\n", "G1 X#<{}>\nM2\n"])
def test_a_bad_word_is_quoted_for_sixty_letters(tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "in.ngc"
    source.write_text("F100\n" + text.format("<" + "a" * 190 + ">" if "o{}" in text else "z" * 3069))
    assert main(["smooth", str(source), "-o", str(tmp_path / "o.ngc")]) == 2
    assert len(capsys.readouterr().err) < 330
    assert main(["check", str(source)]) == 1
    assert max(map(len, capsys.readouterr().out.splitlines())) < 330


def test_options_are_quoted_for_sixty_letters_and_files_whole(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["smooth", "x", "-o", "y", "--tolerance", "q" * 4000]) == 2
    assert len(capsys.readouterr().err) < 300
    long = tmp_path / ("n" * 100 + ".ngc")
    assert main(["check", str(long)]) == 2
    assert str(long) in capsys.readouterr().err


def test_quotations_are_cut_and_sentences_are_not() -> None:
    said = "the program's zero is not where the control's own table says that it is, and nobody's word helps 'so' long"
    assert shortened(said) == said
    assert shortened(f"'{'a b ' * 40}' is no word.") == f"'{('a b ' * 40)[:MOST_QUOTED]}...' is no word."
    assert shortened("x" * 61) == "x" * 60 + "..." and shortened("x" * 60) == "x" * 60


def test_a_signal_that_a_library_turns_into_its_own_error_is_still_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def turned(*_: object, **__: object) -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(1.0)
        except Stopped as stop:
            raise SystemError("returned a result with an exception set") from stop

    monkeypatch.setattr("app.cli.commands.check.examine", turned)
    (tmp_path / "a.ngc").write_text(RING)
    assert main(["check", str(tmp_path / "a.ngc")]) == 143
    assert capsys.readouterr().err == "hitofude: cancelled; no file was written\n"


_BEGUN = """
import os, runpy, signal, sys

class Interrupting:
    def find_spec(self, name, *_):
        if name == {module!r}:
            sys.meta_path.remove(self)
            os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)  # whoever runs the tests in the background ignores it
sys.meta_path.insert(0, Interrupting())
sys.argv = ["hitofude", "tools", "none.dxf"]
runpy.run_module("app", run_name="__main__")
"""


@pytest.mark.parametrize(
    "module",
    [
        "app.core.quick_dataclasses",
        "app.cli.signals",
        "app.cli.commands.tools",
        "numpy",
        "numpy._core._multiarray_umath",
    ],
)
def test_ended_while_it_is_imported_it_says_no_more_than_a_line(module: str) -> None:
    run = subprocess.run(
        [sys.executable, "-c", _BEGUN.format(module=module)], cwd=ROOT, capture_output=True, text=True, timeout=60
    )
    assert run.stderr in ("", "hitofude: cancelled; no file was written\n")
    assert run.returncode in (-signal.SIGINT, 128 + signal.SIGINT)


def test_a_pipe_is_written_by_the_name_that_the_system_has_for_it(tmp_path: Path) -> None:
    (tmp_path / "in.ngc").write_text(RING)
    assert shell('HITOFUDE smooth "$OUT/in.ngc" -o /dev/stdout --quiet | cat > "$OUT/out.ngc"', tmp_path) == 0
    assert (tmp_path / "out.ngc").read_text().endswith("M2\n")


def test_a_name_with_an_end_of_line_makes_no_second_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "in.ngc").write_text(RING)
    assert main(["check", str(tmp_path / "in.ngc"), "--report", str(tmp_path / "r.json")]) == 0
    plain = len(capsys.readouterr().out.splitlines())
    (tmp_path / "a\nb.ngc").write_text(RING)
    assert main(["check", str(tmp_path / "a\nb.ngc")]) == 0
    told = capsys.readouterr().out.splitlines()
    assert len(told) == plain and told[0].startswith("a b.ngc: ")
