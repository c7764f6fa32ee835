"""`hitofude batch` as its user sees it: every part accounted for, whatever happens to the processes on the way."""

from __future__ import annotations

import csv
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import threading
import time
from html.parser import HTMLParser
from pathlib import Path

import pytest

from app.cli.batch_store import BatchStore
from app.cli.main import main
from tests.generated_drawings import write_drawings

ROOT = Path(__file__).resolve().parents[2]


def table(out: Path) -> list[dict[str, str]]:
    with (out / "results.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def verdicts(out: Path) -> list[str]:
    return [row["verdict"] for row in table(out)]


def written(out: Path) -> dict[str, bytes]:
    """All files of a batch but for what it knows of itself."""
    files = (path for path in out.rglob("*") if path.is_file() and ".hitofude" not in path.parts)
    return {path.relative_to(out).as_posix(): path.read_bytes() for path in files}


def started(*arguments: object, **more: object) -> subprocess.Popen[str]:
    command = [sys.executable, "-P", "-m", "app", "batch", *map(str, arguments)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, cwd=ROOT, **more
    )  # type: ignore[call-overload]


def workers_of(process: subprocess.Popen[str]) -> list[int]:
    """The processes that a batch has begun, as the system tells, without the one that looks after semaphores."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parent = (entry / "stat").read_text().rpartition(")")[2].split()[1]
                if parent == str(process.pid) and b"spawn_main" in (entry / "cmdline").read_bytes():
                    found.append(int(entry.name))
            except OSError:
                continue
    return found


linux_only = pytest.mark.skipif(sys.platform != "linux", reason="the test finds the workers in /proc")


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("parts") / "parts"
    write_drawings(folder, 3)
    (folder / "broken.dxf").write_text("no drawing")
    return folder


@pytest.fixture(scope="module")
def done(parts: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A batch of four parts, done by one process."""
    out = tmp_path_factory.mktemp("done") / "out"
    assert main(["batch", str(parts), "-o", str(out), "--depth", "1", "--jobs", "1", "--reports", "--quiet"]) == 1
    return out


def test_every_part_has_its_program_and_its_row(done: Path, parts: Path, tmp_path: Path) -> None:
    rows = table(done)
    assert [row["file"] for row in rows] == ["broken.dxf", *(f"part-00{k}.draw" for k in range(3))]
    assert verdicts(done) == ["refused", "clean", "clean", "clean"]
    assert "this is not a DXF file" in rows[0]["findings"] and rows[0]["time_s"] == rows[0]["outputs"] == ""
    assert float(rows[1]["time_s"]) > 10 and float(rows[1]["length_mm"]) > 100
    assert rows[1]["outputs"].split() == ["part-000.json", "part-000.ngc"]
    alone = tmp_path / "alone.ngc"
    assert main(["make", str(parts / "part-000.draw"), "-o", str(alone), "--depth", "1", "--quiet"]) == 0
    assert (done / "part-000.ngc").read_bytes() == alone.read_bytes()
    report = json.loads((done / "part-000.json").read_text())
    assert f"{report['time_s']:.1f}" == rows[1]["time_s"]


def test_the_page_needs_no_other_file_and_shows_each_part(done: Path) -> None:
    page = (done / "results.html").read_text()
    seen: list[tuple[str, dict[str, str | None]]] = []
    reader = HTMLParser()
    reader.handle_starttag = lambda tag, found: seen.append((tag, dict(found)))  # type: ignore[method-assign]
    reader.feed(page)
    assert not [tag for tag, found in seen if "src" in found or tag == "link"]
    assert {str(found["href"]) for tag, found in seen if tag == "a"} == {*written(done)} - {
        "results.csv",
        "results.html",
    }
    assert sum(tag == "svg" for tag, _ in seen) == 3
    assert "prefers-color-scheme: dark" in page and len(page) < 40_000


@pytest.mark.exhaustive
def test_several_processes_write_the_same_bytes(done: Path, parts: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["batch", str(parts), "-o", str(out), "--depth", "1", "--jobs", "3", "--reports", "--quiet"]) == 1
    assert written(out) == written(done)


@pytest.mark.exhaustive
def test_what_is_done_is_not_done_again(parts: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    parts = shutil.copytree(parts, tmp_path / "parts")  # one is changed below, and others go on with these
    out = tmp_path / "out"
    command = ["batch", str(parts), "-o", str(out), "--depth", "1", "--jobs", "1"]

    def done_anew() -> list[str]:
        main(command)
        told = [line.removeprefix("hitofude: ").partition(":") for line in capfd.readouterr().err.splitlines()]
        return [name for name, _, fate in told if fate.startswith((" clean", " cannot", " with"))]

    assert len(done_anew()) == 4
    assert done_anew() == []
    stamps = {path: path.stat().st_mtime_ns for path in out.glob("*.ngc")}
    (out / "part-001.ngc").write_text("changed by hand\n")
    assert done_anew() == ["part-001.draw"]
    part = parts / "part-002.draw"
    part.write_text(part.read_text() + "circle 7,7 1.1\n")
    assert done_anew() == ["part-002.draw"]
    assert stamps[out / "part-000.ngc"] == (out / "part-000.ngc").stat().st_mtime_ns
    command[-1:] = ["1", "--stepover", "1.5"]
    assert len(done_anew()) == 4


@pytest.mark.exhaustive
def test_a_cluster_writes_the_same_bytes_although_a_worker_is_killed(done: Path, parts: Path, tmp_path: Path) -> None:
    """The command with a scheduler's address; a worker of the local cluster is killed once a part is done."""
    distributed = pytest.importorskip("distributed", reason="Dask is not installed here; the extra `test` brings it")
    out = tmp_path / "out"

    def kill() -> None:
        while not any(out.glob(".hitofude/*.json")):
            time.sleep(0.02)
        os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)
        killed.set()

    killed, killer = threading.Event(), threading.Thread(target=kill, daemon=True)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        killer.start()
        command = ["batch", str(parts), "-o", str(out), "--depth", "1", "--reports", "--quiet"]
        assert main([*command, "--scheduler", cluster.scheduler_address]) == 1
    assert killed.is_set()
    assert (out / "results.csv").read_text().splitlines() == (done / "results.csv").read_text().splitlines()
    assert written(out) == written(done)


@pytest.mark.exhaustive
def test_a_program_of_a_drawing_that_is_broken_now_is_taken_away(tmp_path: Path) -> None:
    parts, out = tmp_path / "parts", tmp_path / "out"
    (part,) = write_drawings(parts, 1)
    command = ["batch", str(parts), "-o", str(out), "--jobs", "1", "--quiet"]
    assert main(command) == 0 and (out / "part-000.ngc").exists()
    part.write_text("rect 0,0")
    assert main(command) == 1 and not (out / "part-000.ngc").exists()
    assert verdicts(out) == ["refused"]


@pytest.mark.exhaustive
def test_a_list_gives_parts_options_of_their_own(parts: Path, tmp_path: Path) -> None:
    (tmp_path / "job.toml").write_text("[stock]\nthickness = 7\n")
    (tmp_path / "list.toml").write_text(
        f'[options]\npost = "grbl"\ndepth = 1\n[[part]]\nfile = "{parts}/part-000.draw"\noutput = "a/thin.nc"\n'
        f'[[part]]\nfile = "{parts}/part-000.draw"\noutput = "thick.nc"\ndepth = 2\n'
        'job = "job.toml"\nexact-path = true\n'
    )
    out = tmp_path / "out"
    assert main(["batch", str(tmp_path / "list.toml"), "-o", str(out), "--jobs", "1", "--quiet"]) == 0
    programs = [f"{name}_{k}_T{k}.nc" for name in ("a/thin", "thick") for k in (1, 2)]
    assert sorted(path for path in written(out) if path.endswith(".nc")) == programs
    assert "Z-1" in (out / "a/thin_1_T1.nc").read_text() and "Z-2" in (out / "thick_1_T1.nc").read_text()
    assert "G61" in (out / "thick_1_T1.nc").read_text()


def test_programs_are_checked_and_smoothed(done: Path, tmp_path: Path) -> None:
    programs = tmp_path / "programs"
    programs.mkdir()
    (programs / "good.ngc").write_bytes((done / "part-000.ngc").read_bytes())
    (programs / "bad.nc").write_text("G21 G90 G94\nG1 X10 Y10 Z0 Q3 F100\nM30\n")
    assert main(["batch", str(programs), "-o", str(tmp_path / "checked"), "--check", "--jobs", "1", "--quiet"]) == 1
    assert verdicts(tmp_path / "checked") == ["findings", "clean"]
    smoothed = tmp_path / "smoothed"
    command = ["batch", str(programs), "-o", str(smoothed), "--smooth", "--tolerance", "0.02", "--jobs", "1", "--quiet"]
    main(command)
    alone = tmp_path / "alone.ngc"
    main(["smooth", str(programs / "good.ngc"), "-o", str(alone), "--tolerance", "0.02", "--quiet"])
    assert (smoothed / "good.ngc").read_bytes() == alone.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nowhere", "-o", "out"], "nowhere is neither a folder nor a list"),
        (["empty", "-o", "out"], "empty has no part in it"),
        (["parts", "-o", "out", "--depth", "-3"], "--depth"),
        (["parts", "-o", "out", "--check", "--depth", "3"], "has no part in it"),
        (["programs", "-o", "out", "--check", "--depth", "3"], "--depth=3 is no option of check"),
        (["programs", "-o", "programs", "--smooth"], "would be written over"),
        (["list.toml", "-o", "out"], "part 1: 'dept' is no option of make"),
        (["parts", "-o", "out", "--jobs", "0"], "--jobs is wrong"),
        (["parts", "-o", "out", "--check", "--smooth"], "exclude one another"),
    ],
)
def test_what_cannot_be_begun_is_one_line(
    arguments: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write_drawings(tmp_path / "parts", 1)
    for name in ("empty", "programs"):
        (tmp_path / name).mkdir()
    (tmp_path / "programs/a.ngc").write_text("M30\n")
    (tmp_path / "list.toml").write_text('[[part]]\nfile = "parts/part-000.draw"\ndept = 3\n')
    assert main(["batch", *arguments]) == 2
    shown = capsys.readouterr().err
    assert told in shown and shown.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_two_batches_on_one_folder_are_kept_apart(
    parts: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """The second is told who works there; a lock whose process died holds nobody."""
    out = tmp_path / "out"
    command = ["batch", str(parts), "-o", str(out), "--check", "--jobs", "1", "--quiet"]
    (parts.parent / "program.ngc").write_text("M30\n")
    command[1] = str(parts.parent / "list.toml")
    (parts.parent / "list.toml").write_text('[[part]]\nfile = "program.ngc"\n')
    first = BatchStore(out)
    assert main(command) == 2
    told = capfd.readouterr().err
    assert f"another batch (process {os.getpid()} of " in told and told.count("\n") == 1
    first.close()
    (out / ".hitofude" / "lock").write_text("1 elsewhere\n")  # its process is gone, and its lock with it
    assert main(command) == 0
    assert not (out / ".hitofude" / "lock").exists()


def killing(process: subprocess.Popen[str], out: Path, kills: int, pause: float) -> None:
    """Kill so many workers of a batch, at random times once parts are done, as long as it runs."""
    rng = random.Random(7)
    while kills and process.poll() is None:
        time.sleep(rng.uniform(pause / 2, pause))
        workers = workers_of(process)
        if workers and any(out.glob(".hitofude/*.json")):
            os.kill(rng.choice(workers), signal.SIGKILL)
            kills -= 1


def killed_batch(parts: Path, out: Path, kills: int, pause: float, *options: str) -> str:
    """Do a batch of which so many workers are killed; return what it said."""
    process = started(parts, "-o", out, "--jobs", "2", *options)
    killer = threading.Thread(target=killing, args=(process, out, kills, pause))
    killer.start()
    _, told = process.communicate(timeout=900)
    killer.join()
    assert process.returncode == 0, told
    return told


@linux_only
@pytest.mark.exhaustive
def test_a_killed_worker_harms_no_part(tmp_path: Path) -> None:
    write_drawings(tmp_path / "parts", 24)
    told = killed_batch(tmp_path / "parts", tmp_path / "out", 1, 1.0, "--depth", "1")
    assert verdicts(tmp_path / "out") == ["clean"] * 24
    assert told.count(": clean, ") == 24


@linux_only
@pytest.mark.exhaustive
def test_three_hundred_parts_are_all_accounted_for_after_random_kills(tmp_path: Path) -> None:
    """Programs, as three hundred drawings would take minutes: parts and processes are handled alike."""
    (tmp_path / "parts").mkdir()
    for number in range(300):
        lines = [f"G1 X{k % 50}.{number} Y{k // 50}" for k in range(400)]
        text = "\n".join(["G21 G90 G94", "T1 M6", "S9000 M3", "G0 X0 Y0 Z5", "G1 Z-1 F100", *lines, "G0 Z5", "M30\n"])
        (tmp_path / f"parts/part-{number:03d}.ngc").write_text(text)
    told = killed_batch(tmp_path / "parts", tmp_path / "out", 4, 0.5, "--check")
    assert verdicts(tmp_path / "out") == ["clean"] * 300
    assert told.count(": clean, ") == 300


@linux_only
@pytest.mark.exhaustive
def test_ctrl_c_keeps_what_is_done_and_the_same_command_goes_on(tmp_path: Path) -> None:
    write_drawings(tmp_path / "parts", 12)
    out = tmp_path / "out"
    arguments = (tmp_path / "parts", "-o", out, "--depth", "1", "--jobs", "1")
    process = started(*arguments, start_new_session=True)
    deadline = time.monotonic() + 120
    while not list(out.glob("*.ngc")) and time.monotonic() < deadline:
        time.sleep(0.02)
    workers = workers_of(process)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: all processes hear it
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert told.endswith("cancelled; what was done is kept, and the same command goes on with the rest\n")
    assert set(verdicts(out)) == {"clean", "open"}
    deadline = time.monotonic() + 10
    while any(Path(f"/proc/{pid}").exists() for pid in workers) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not [pid for pid in workers if Path(f"/proc/{pid}").exists()]
    before = {path: path.stat().st_mtime_ns for path in out.glob("*.ngc")}
    again = started(*arguments)
    again.communicate(timeout=120)
    assert again.returncode == 0 and verdicts(out) == ["clean"] * 12
    assert all(path.stat().st_mtime_ns == stamp for path, stamp in before.items())
