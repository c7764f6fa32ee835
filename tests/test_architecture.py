"""The rules of the house, read from the source: who may know whom (contracts in pyproject.toml), what starts light."""

import ast
import subprocess
import sys
import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

from tests.conftest import ROOT

APP = ROOT / "app"
QT = {"PySide6", "pyqtgraph", "shiboken6"}
COMPILER = {"numba"}
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
FILES = sorted(APP.rglob("*.py"))


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text("utf-8"), str(path))


def offenders(paths: list[Path], rule: Callable[[Path], object]) -> dict[str, object]:
    """What a rule finds wrong, by file."""
    return {str(path.relative_to(ROOT)): wrong for path in paths if (wrong := rule(path))}


def test_who_knows_whom(capsys: pytest.CaptureFixture[str]) -> None:
    status = lint_imports(config_filename=str(ROOT / "pyproject.toml"))
    assert status == EXIT_STATUS_SUCCESS, capsys.readouterr().out


def test_every_room_stands_in_the_contract() -> None:
    (layers,) = (each["layers"] for each in CONTRACTS if each["type"] == "layers" and "containers" not in each)
    named = {room.strip().removeprefix("app.") for layer in layers for room in layer.split("|")}
    assert named == {path.stem for path in APP.iterdir() if path.name == "__main__.py" or any(path.glob("*.py"))}


def test_a_circle_in_a_function_is_seen(tmp_path: Path) -> None:
    package = tmp_path / "tall"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "low.py").write_text("def f() -> None:\n    from .high import g\n")
    (package / "high.py").write_text("from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .low import f\n")
    contract = '[tool.importlinter]\nroot_package = "tall"\n[[tool.importlinter.contracts]]\nname = "none"\n'
    (tmp_path / "pyproject.toml").write_text(contract + 'type = "acyclic_siblings"\nancestors = ["tall"]\n')
    code = (
        "import sys; sys.path.insert(0, '.'); from importlinter.cli import lint_imports; "
        "sys.exit(lint_imports(no_cache=True))"
    )
    done = subprocess.run([sys.executable, "-P", "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert ".high -> .low" in done.stdout or ".low -> .high" in done.stdout


def test_only_kernel_files_make_kernels() -> None:
    others = [path for path in FILES if "kernels" not in path.stem and path.parent.name != "jit"]
    assert not offenders(others, lambda path: "core.jit import" in path.read_text("utf-8"))


def test_public_things_say_what_they_are() -> None:
    def silent(path: Path) -> list[str]:
        public = (
            node
            for node in tree_of(path).body
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_")
        )
        return [
            name
            for name, doc in [
                ("the module", ast.get_docstring(tree_of(path))),
                *((n.name, ast.get_docstring(n)) for n in public),
            ]
            if not doc
        ]

    assert not offenders(FILES, silent)


def modules_after(statement: str) -> set[str]:
    code = f"{statement}\nimport sys\nprint(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    return set(done.stdout.split())


def test_the_command_line_starts_without_heavy_libraries() -> None:
    assert not modules_after("import app.cli.main") & (QT | COMPILER | {"ezdxf", "trimesh", "cv2", "shapely", "scipy"})


def test_the_window_opens_without_heavy_libraries() -> None:
    assert not modules_after("import app.ui.shell.main_window") & (COMPILER | {"ezdxf", "trimesh", "scipy"})


def test_the_window_opens_without_the_exhibits() -> None:
    """The session of 1986 and the films of the stages are loaded when they are asked for."""
    code = "import app.ui.shell.start, sys; print(*sorted(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    loaded = set(done.stdout.split())
    assert "app.ui.views.session1986.opening" in loaded
    assert not loaded & {f"app.ui.views.session1986.{name}" for name in ("session", "tube", "making", "stills")}
    assert "app.exhibits.stages" not in loaded


def test_kernel_modules_know_no_window() -> None:
    code = (
        "import app.core.jit.warm, importlib\nfor name in app.core.jit.warm.kernel_modules(): "
        "importlib.import_module(name)"
    )
    assert not modules_after(code) & (QT | COMPILER)
