"""The rules of the house, read from the source: who may know whom, how long things may be, what starts light."""

import ast
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from tests.conftest import ROOT

APP = ROOT / "app"
LEAVES = {"errors", "progress", "tolerances", "resources", "pool", "jit", "atomic", "settings", "toml_tables", "graphics", "mesh", "memory"}
KNOWS = {
    "model": set(),
    "geometry": {"model", "fit"},
    "fit": {"model", "geometry"},
    "bitmap": {"model", "geometry"},
    "toolpath": {"model", "geometry", "fit", "bitmap", "surface"},
    "nc": {"model", "geometry", "fit"},
    "surface": {"model", "geometry", "fit"},
    "dexel": {"model", "fit"},
    "edit": {"model", "geometry", "fit"},
    "files": {"model", "geometry", "fit", "edit"},
    "workflow": {"model", "geometry", "fit", "bitmap", "toolpath", "dexel", "nc", "files", "surface"},
    "ui": {"model", "geometry", "fit", "bitmap", "toolpath", "nc", "files", "edit", "workflow", "kernels", "cli"},
    "kernels": set(),
    "cli": {"model", "geometry", "fit", "bitmap", "toolpath", "nc", "files", "edit", "workflow"},
    "__main__": {"cli", "ui"},
}
QT = {"PySide6", "pyqtgraph", "shiboken6"}
COMPILER = {"numba"}
FILES = sorted(APP.rglob("*.py"))
PYTHON_FILES = FILES + sorted((ROOT / "tests").rglob("*.py"))


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in FILES}


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text("utf-8"), str(path))


def names_in(node: ast.AST) -> list[str]:
    """Modules that one import statement names."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
        return [full if (full := f"{node.module}.{alias.name}") in MODULES else node.module for alias in node.names]
    return []


@cache
def nodes_of(path: Path) -> tuple[ast.AST, ...]:
    """All of a file, walked once for all rules."""
    return tuple(node for node in ast.walk(tree_of(path)) if isinstance(node, ast.Import | ast.ImportFrom | ast.FunctionDef))


@cache
def imports(path: Path) -> frozenset[str]:
    return frozenset(name for node in nodes_of(path) for name in names_in(node))


def imports_at_start(path: Path) -> set[str]:
    """Modules that importing this file imports: neither those inside functions nor those for types only."""
    found: set[str] = set()
    waiting: list[ast.AST] = [tree_of(path)]
    while waiting:
        node = waiting.pop()
        found.update(names_in(node))
        types_only = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
        if not types_only and not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            waiting.extend(ast.iter_child_nodes(node))
    return found


def room_of(module: str) -> str:
    parts = module.split(".")
    room = parts[1] if len(parts) > 1 else ""
    return "cli" if room.startswith("cli_") else room


def offenders(paths: list[Path], rule: Callable[[Path], object]) -> dict[str, object]:
    """What a rule finds wrong, by file."""
    return {str(path.relative_to(ROOT)): wrong for path in paths if (wrong := rule(path))}


@pytest.mark.exhaustive
def test_rooms_know_only_what_lies_before_them() -> None:
    def strangers(path: Path) -> set[str]:
        room = room_of(module_name(path))
        allowed = LEAVES | {"", room} | (set() if room in LEAVES else KNOWS.get(room, set()))
        return {name for name in imports(path) if name.split(".")[0] == "app" and room_of(name) not in allowed}

    assert not offenders(FILES, strangers)


def test_geometry_knows_of_fit_only_its_arcs() -> None:
    def strangers(path: Path) -> set[str]:
        return {name for name in imports(path) if name.startswith("app.fitting")} - {"app.geometry.arcs.arcs"}

    assert not offenders([path for path in FILES if room_of(module_name(path)) == "geometry"], strangers)


def test_qt_stays_in_the_window() -> None:
    outside = [path for path in FILES if room_of(module_name(path)) != "ui"]
    assert not offenders(outside, lambda path: {name for name in imports(path) if name.split(".")[0] in QT})


def test_only_kernel_files_know_the_compiler() -> None:
    others = [path for path in FILES if "kernels" not in path.stem and room_of(module_name(path)) != "jit"]
    assert not offenders(others, lambda path: {name for name in imports(path) if name.split(".")[0] in COMPILER or name == "app.core.jit"})


def test_only_one_file_of_the_compiler_s_room_imports_it() -> None:
    importing = {path.name for path in FILES if {name.split(".")[0] for name in imports(path)} & COMPILER}
    assert importing == {"numba_door.py"}


def test_every_room_is_in_the_table() -> None:
    assert {room_of(name) for name in MODULES} <= LEAVES | set(KNOWS) | {""}


def test_no_import_cycles() -> None:
    graph = {name: {target for target in imports_at_start(path) if target in MODULES and target != name} for name, path in MODULES.items()}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" imports ".join(reversed(error.args[1])))


def functions_of(path: Path) -> list[ast.FunctionDef]:
    return [node for node in nodes_of(path) if isinstance(node, ast.FunctionDef)]


def test_files_are_short() -> None:
    assert not offenders(PYTHON_FILES, lambda path: max(0, len(path.read_text("utf-8").splitlines()) - 400))


@pytest.mark.exhaustive
def test_functions_are_short() -> None:
    def long(path: Path) -> dict[str, int]:
        return {node.name: size for node in functions_of(path) if (size := (node.end_lineno or 0) - node.lineno + 1) > 50}

    assert not offenders(PYTHON_FILES, long)


def test_functions_take_few_parameters() -> None:
    def greedy(path: Path) -> dict[str, int]:
        counts = {node.name: len({arg.arg for arg in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)} - {"self", "cls"})
                  for node in functions_of(path)}
        return {name: count for name, count in counts.items() if count > 5}

    assert not offenders([path for path in FILES if "kernels" not in path.stem], greedy)


def test_public_things_say_what_they_are() -> None:
    def silent(path: Path) -> list[str]:
        public = (node for node in tree_of(path).body if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"))
        return [name for name, doc in [("the module", ast.get_docstring(tree_of(path))), *((n.name, ast.get_docstring(n)) for n in public)]
                if not doc]

    assert not offenders(FILES, silent)


def modules_after(statement: str) -> set[str]:
    code = f"{statement}\nimport sys\nprint(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60)
    return set(done.stdout.split())


def test_the_command_line_starts_without_heavy_libraries() -> None:
    assert not modules_after("import app.cli.main") & (QT | COMPILER | {"ezdxf", "trimesh", "cv2", "shapely", "scipy"})


def test_the_window_opens_without_heavy_libraries() -> None:
    assert not modules_after("import app.ui.shell.main_window") & (COMPILER | {"ezdxf", "trimesh", "scipy"})


def test_kernel_modules_know_no_window() -> None:
    code = "import app.core.jit.warm, importlib\nfor name in app.core.jit.warm.kernel_modules(): importlib.import_module(name)"
    assert not modules_after(code) & (QT | COMPILER)
