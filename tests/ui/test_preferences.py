"""What is remembered outlives a window that is killed."""

from app.core.settings import Settings, load_settings
from app.ui.framework.preferences import Preferences


def test_a_file_that_was_opened_is_remembered_at_once(tmp_path, monkeypatch):
    monkeypatch.setenv("HITOFUDE_CONFIG", str(tmp_path))
    preferences = Preferences(Settings())
    for name in ("plate.dxf", "die.toml"):
        preferences.add_recent(tmp_path / name)
    assert [path.rpartition("/")[2] for path in load_settings().recent_files] == ["die.toml", "plate.dxf"]
    assert load_settings().last_folder == str(tmp_path)
