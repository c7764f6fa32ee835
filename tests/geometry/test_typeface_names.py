"""Fonts of this machine by the names that a user knows them by."""

import pytest

from app.geometry import typeface


def test_every_name_that_is_offered_is_found():
    names = typeface.installed_names()
    if not names:
        pytest.skip("no fonts are installed")
    assert list(names) == sorted(set(names), key=str.casefold)
    for name in names:
        assert typeface._found(name).is_file()
