"""What all tests share: no screen, folders of their own, and where the data is."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ["LC_ALL"] = "C.UTF-8"  # the window speaks English, whatever the desktop does

settings.register_profile("same", derandomize=True)
settings.load_profile(os.environ.get("HITOFUDE_HYPOTHESIS", "same"))
"""What a plain run tries is the same each time, so that it fails for a change and not by chance; `default` searches anew."""

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(autouse=True)
def own_settings(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """No test reads or changes the settings of the person who runs it."""
    monkeypatch.setenv("HITOFUDE_CONFIG", str(tmp_path_factory.mktemp("config")))


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
