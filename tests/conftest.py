"""What all tests share: no screen, folders of their own, and where the data is."""

import gc
import itertools
import math
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from app.cli import files
from tests.examples import PROFILE, examples

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ["LC_ALL"] = "C.UTF-8"  # the window speaks English, whatever the desktop does

pytest_plugins = ("tests.parallel", "tests.exhaustive")

# a busy machine is no slow code
settings.register_profile("quick", derandomize=True, max_examples=examples(100), deadline=None)
settings.register_profile("full", derandomize=True, deadline=None)
settings.load_profile(PROFILE)


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    """Take what is there now, which is there until the end, from what is looked through for garbage again and again."""
    gc.collect()
    gc.freeze()


ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def config_folders(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """New folders for settings, numbered: the usual temporary ones are numbered by looking through all that there
    are.
    """
    base = tmp_path_factory.mktemp("config")
    return (base / str(k) for k in itertools.count())


@pytest.fixture(autouse=True)
def own_settings(config_folders: Iterator[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    """No test reads or changes the settings of the person who runs it."""
    folder = next(config_folders)
    folder.mkdir()
    monkeypatch.setenv("HITOFUDE_CONFIG", str(folder))


@pytest.fixture
def lines_by_the_clock() -> None:
    """A command called in this process tells how far it is every few seconds."""


@pytest.fixture(autouse=True)
def no_lines_by_the_clock(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """A busy machine adds no line to what a command says here, unless a test is about such lines."""
    if "lines_by_the_clock" not in request.fixturenames:
        monkeypatch.setattr(files, "EVERY", math.inf)


@pytest.fixture
def root() -> Path:
    """The project's folder."""
    return ROOT


@pytest.fixture
def data() -> Path:
    """Drawings and programs that travel with the project."""
    return ROOT / "tests" / "data"


@pytest.fixture
def samples() -> Path:
    """Drawings that ship with the program."""
    return ROOT / "resources" / "samples"


@pytest.fixture
def shared() -> Path:
    """The larger collection beside the checkout; a clone without it skips these tests."""
    folder = ROOT.parent / "shared"
    if not (folder / "data").is_dir():
        pytest.skip("the shared collection of drawings is not beside this checkout")
    return folder
