"""The rules of the house, read from the source: who may know whom (contracts in pyproject.toml), what starts light."""

import io
import re
import subprocess
import sys
import tokenize
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

from tests.conftest import ROOT

APP = ROOT / "app"
QT = {"PySide6", "pyqtgraph", "shiboken6"}
COMPILER = {"numba"}
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
FILES = sorted(APP.rglob("*.py"))


CLASS = re.compile(r"^ *class (\w+)[(:\[]", re.MULTILINE)


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


MARK = re.compile(r"# *(type|noqa|fmt|mypy):?")


def comments_share(text: str) -> float:
    """Comments of a text that a reader has something of, by its lines: marks for the type checker and the linter say no
    why.
    """
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    comments = [token.string for token in tokens if token.type == tokenize.COMMENT]
    return sum(not MARK.match(comment) for comment in comments) / text.count("\n")


def test_kernels_say_why_they_compute_what_they_compute() -> None:
    assert comments_share("x = 1  # why\ny = 2\n") == 0.5
    assert comments_share("def f(x):  # type: ignore[no-untyped-def]\n    return x  # noqa: E501\n") == 0.0
    kernels = [path for path in FILES if "kernels" in path.stem]
    assert kernels and not offenders(kernels, lambda path: comments_share(path.read_text("utf-8")) < 0.02)


def test_public_things_say_what_they_are() -> None:
    """What is said to the linter in a line does not count here."""
    judge = ["ruff", "check", "--ignore-noqa", "--select=D1", "--ignore=D105,D107", "--output-format=concise", "app"]
    done = subprocess.run([sys.executable, "-m", *judge], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stdout + done.stderr


DOCSTRING = re.compile(r'"""(.*?)"""', re.DOTALL)


def test_what_docstrings_name_is_there() -> None:
    """A name between back quotes is of the code, or of a module: what was renamed is renamed in docstrings, too."""
    texts = {path: path.read_text("utf-8") for path in FILES}
    known = {part for path in FILES for part in (*path.relative_to(ROOT).parts, path.stem)} | sys.stdlib_module_names
    for text in texts.values():
        known.update(re.findall(r"\w+", DOCSTRING.sub("", text)))

    def unknown(path: Path) -> list[str]:
        named = re.findall(r"`([A-Za-z_][\w.]*)`", " ".join(DOCSTRING.findall(texts[path])))
        return [name for name in named if not known.issuperset(name.split("."))]

    assert not offenders(FILES, unknown)


def test_no_two_classes_have_one_name() -> None:
    places: dict[str, set[Path]] = {}
    for path in FILES:
        for name in CLASS.findall(path.read_text("utf-8")):
            places.setdefault(name, set()).add(path)
    twice = {name: found for name, found in places.items() if len(found) > 1}
    assert not twice, "one word, one class: choose another name"


def modules_after(statement: str) -> set[str]:
    code = f"{statement}\nimport sys\nprint(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    return printed_words(code)


def printed_words(code: str) -> set[str]:
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    return set(done.stdout.split())


def test_the_command_line_starts_without_heavy_libraries() -> None:
    assert not modules_after("import app.cli.main") & (QT | COMPILER | {"ezdxf", "trimesh", "cv2", "shapely", "scipy"})


def test_the_window_opens_without_heavy_libraries() -> None:
    assert not modules_after("import app.ui.shell.main_window") & (COMPILER | {"ezdxf", "trimesh", "scipy"})


def test_the_session_of_1986_is_loaded_when_it_is_asked_for() -> None:
    code = "import app.ui.shell.start, sys; print(*sorted(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    loaded = set(done.stdout.split())
    assert "app.ui.views.session1986.controller" in loaded
    assert not loaded & {
        f"app.ui.views.session1986.{name}" for name in ("dialogue", "picture_tube", "processing", "stills")
    }


@pytest.mark.parametrize("door", ["app.cli.main", "app.usecases.making.make", "app.ui.shell.main_window"])
def test_exhibits_are_loaded_when_they_are_asked_for(door: str) -> None:
    code = f"import {door}, sys; print(*[name for name in sys.modules if name.startswith('app.exhibits')])"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout.split() == []


def test_kernel_modules_know_no_window() -> None:
    code = (
        "import app.core.jit.warm, importlib\nfor name in app.core.jit.warm.kernel_modules(): "
        "importlib.import_module(name)"
    )
    assert not modules_after(code) & (QT | COMPILER)


DOCS = ROOT / "resources" / "docs"
PAGES = [DOCS / "architecture.md", *sorted((DOCS / "house").glob("*.md"))]
PAGE = "\n".join(path.read_text("utf-8") for path in PAGES)


def named_files(text: str) -> set[str]:
    """The Python files that a text names in back quotes."""
    return set(re.findall(r"`([\w/]+\.py)`", text))


def door_is_there(door: str) -> bool:
    """Whether `room.module.name` is a name that a module, or a package, has."""
    parts = door.split(".")
    for at in range(len(parts) - 1, 0, -1):
        folder = APP.joinpath(*parts[:at])
        for module in (folder.with_suffix(".py"), folder / "__init__.py"):
            if module.exists():
                name = rf"^(?:def |class )?{parts[at]}\b|^from .* import .*\b{parts[at]}\b"
                return re.search(name, module.read_text("utf-8"), re.MULTILINE) is not None
    return False


def test_the_page_of_the_house_names_files_that_are_there() -> None:
    there = [f"/{path.relative_to(ROOT)}" for path in (*FILES, *(ROOT / "tests").rglob("*.py"))]
    assert not {name for name in named_files(PAGE) if not any(path.endswith(f"/{name}") for path in there)}
    assert named_files("see `geometry/nowhere.py`") == {"geometry/nowhere.py"}


def test_the_pages_of_the_house_name_classes_and_functions_that_are_there() -> None:
    files = (*FILES, *(ROOT / "tests").rglob("*.py"))
    known = {path.stem for path in files} | set(re.findall(r"\w+", " ".join(path.read_text("utf-8") for path in files)))
    spelled = r"[A-Z][a-z]+(?:[A-Z]\w*)+|[a-z]+(?:_[a-z0-9]+)+"
    named = {name for quoted in re.findall("`([^`\n]+)`", PAGE) for name in re.findall(rf"^(?:{spelled})$", quoted)}
    assert len(named) > 80
    assert not named - known


def test_the_page_of_the_house_lists_its_other_pages() -> None:
    listed = re.findall(r"`house/(\w+)\.md`", PAGES[0].read_text("utf-8"))
    assert sorted(listed) == [path.stem for path in PAGES[1:]]


def test_the_page_of_the_house_names_doors_that_are_there() -> None:
    doors = set(re.findall(r"^    ([a-z]+(?:\.[A-Za-z_]+){2,})\(", PAGE, re.MULTILINE))
    assert len(doors) > 50
    assert not {door for door in doors if not door_is_there(door)}
    assert not door_is_there("geometry.region.nowhere") and not door_is_there("geometry.nowhere.nested")
