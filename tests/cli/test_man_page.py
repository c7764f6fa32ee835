"""The manual page, the desktop's files and the list of licences are of what there is."""

from __future__ import annotations

import configparser
import re
import shlex
import shutil
import subprocess
import tomllib
import xml.etree.ElementTree as ElementTree
from importlib.metadata import distribution
from pathlib import Path

import pytest

from app import __version__
from app.cli.main import main
from app.cli.man_page import man_page
from app.cli.program import SUMMARIES, load_command
from app.core.desktop import PLACES
from app.core.licences import installed_licences

ROOT = Path(__file__).resolve().parents[2]
DESKTOP = ROOT / "resources/desktop"


def test_the_page_is_that_of_the_commands() -> None:
    told = (DESKTOP / "hitofude.1").read_text(encoding="utf-8")
    assert told == man_page(), "write it anew: python -m app.cli.man_page > resources/desktop/hitofude.1"
    assert all(f"\\fBhitofude {name}" in told for name in SUMMARIES)
    assert f"Hitofude {__version__}" in told and told.isascii()


@pytest.mark.parametrize("name", SUMMARIES)
def test_a_command_has_examples_that_it_takes_and_its_help_ends_with_them(name: str) -> None:
    command = load_command(name)
    assert command.examples
    for example in command.examples:
        program, called, *arguments = shlex.split(example)
        assert (program, called) == ("hitofude", name)
        command.arguments(arguments)
    shown = command.parser().format_help().rstrip().splitlines()[-len(command.examples) :]
    assert shown == [f"  {example}" for example in command.examples]


@pytest.mark.parametrize("name", SUMMARIES)
@pytest.mark.parametrize("columns", [80, 132])
def test_help_is_as_wide_as_the_screen(name: str, columns: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    command = load_command(name)
    lines = set(command.parser().format_help().splitlines()) - {f"  {example}" for example in command.examples}
    usage = next(line for line in command.parser().format_usage().splitlines())
    assert usage.startswith(f"usage: hitofude {name}")
    assert [line for line in lines if len(line) > columns and " " in line.strip()] == []


def test_man_takes_the_page() -> None:
    man = shutil.which("man") or shutil.which("mandoc")
    if man is None:
        pytest.skip("there is no man here to read the page with")
    done = subprocess.run([man, "-l", str(DESKTOP / "hitofude.1")], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "EXIT STATUS" in done.stdout and not done.stderr


def test_the_wheel_puts_each_file_where_desktops_look() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    shared = project["tool"]["hatch"]["build"]["targets"]["wheel"]["shared-data"]
    assert shared == {f"resources/desktop/{name}": f"share/{place}" for name, place in PLACES.items()}
    assert all((ROOT / path).is_file() for path in shared)


def test_the_entry_names_its_icon_and_the_kinds_of_files() -> None:
    entry = configparser.ConfigParser(interpolation=None)
    entry.optionxform = str  # type: ignore[assignment,method-assign]
    entry.read(DESKTOP / "hitofude.desktop", encoding="utf-8")
    told = dict(entry["Desktop Entry"])
    assert told["Exec"] == "hitofude open %f" and told["Icon"] == "hitofude"
    types = ElementTree.parse(DESKTOP / "hitofude-mime.xml").getroot()
    space = "{http://www.freedesktop.org/standards/shared-mime-info}"
    globs = {each.get("pattern"): kind.get("type") for kind in types for each in kind.iter(f"{space}glob")}
    assert set(globs) == {"*.hito", "*.draw", "*.ngc"}
    assert set(globs.values()) <= set(told["MimeType"].split(";"))
    assert ElementTree.parse(DESKTOP / "hitofude.svg").getroot().get("width") == "128"


def test_desktop_writes_and_takes_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    assert main(["desktop", "--quiet"]) == 0
    assert all((tmp_path / place).is_file() for place in PLACES.values())
    (line,) = [each for each in (tmp_path / PLACES["hitofude.desktop"]).read_text().splitlines() if each[:5] == "Exec="]
    command = line.removeprefix("Exec=").removesuffix(" open %f").split()
    done = subprocess.run([*command, "--version"], capture_output=True, text=True, timeout=60, cwd=ROOT)
    assert done.stdout == f"hitofude {__version__}\n"
    assert main(["desktop", "--remove", "--quiet"]) == 0
    assert not any((tmp_path / place).exists() for place in PLACES.values())


def test_every_package_that_is_needed_has_its_licence(capsys: pytest.CaptureFixture[str]) -> None:
    packages = {each.name.lower().replace("_", "-"): each for each in installed_licences()}
    needed = [each for each in distribution("hitofude").requires or () if "extra ==" not in each]
    for name in (re.split(r"[<>=!~ ;]", each)[0] for each in needed):
        assert packages[name.lower()].version == distribution(name).version
    assert len(needed) > 10
    assert "llvmlite" in packages and "pytest" not in packages  # what a package needs; what only tests need
    assert not [each.name for each in packages.values() if each.licence == "not stated"]
    assert main(["licences"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith("hitofude ") and "LGPL" in shown and "BSD" in shown
