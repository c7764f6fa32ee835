"""Compressed SVG: read as what it holds, whatever it is called; damage, and bombs, are refused in one sentence."""

import gzip

import pytest

from app.core.errors import InputError
from app.formats.readers import read_drawing
from app.formats.svg import xml
from app.model.curves import Circle

RIM = b'<svg width="100mm" height="50mm" viewBox="0 0 100 50" xmlns="http://www.w3.org/2000/svg"><circle r="5"/></svg>'


def _packed(data: bytes) -> bytes:
    """Return data compressed, the same at any time: what a test is called must be alike in every worker."""
    return gzip.compress(data, mtime=0)


@pytest.mark.parametrize("name", ["a.svgz", "A.SVGZ", "a.svg"])
@pytest.mark.parametrize("packed", [_packed(RIM), _packed(RIM[:40]) + _packed(RIM[40:]) + bytes(9)])
def test_what_it_holds_is_read(name: str, packed: bytes) -> None:
    (entity,) = read_drawing(name, packed).part.entities
    assert entity.curve == Circle((0, 50), 5)


def test_one_that_is_not_compressed_is_read_all_the_same() -> None:
    assert len(read_drawing("a.svgz", RIM).part.entities) == 1


@pytest.mark.parametrize(
    ("packed", "told"),
    [
        (_packed(RIM)[:-9], "cut short"),
        (_packed(RIM)[:-8] + bytes(8), "is damaged"),
        (_packed(RIM) + _packed(RIM)[:30], "cut short"),
        (b"\x1f\x8b", "cut short"),
        (_packed(b""), "the file is empty"),
        (_packed(_packed(RIM)), "this is not an SVG file"),
    ],
)
def test_damage_is_refused(packed: bytes, told: str) -> None:
    with pytest.raises(InputError, match=told):
        read_drawing("a.svgz", packed)


def test_a_file_of_many_members_is_read_in_one_go() -> None:
    """Each member copied all that was behind it: 90,000 of them took 12 s."""
    with pytest.raises(InputError, match="the file is empty"):
        read_drawing("a.svgz", _packed(b" ") * 60_000)


@pytest.mark.parametrize("members", [1, 3])
def test_a_bomb_is_unpacked_no_further_than_what_is_read(monkeypatch: pytest.MonkeyPatch, members: int) -> None:
    monkeypatch.setattr(xml, "MOST_BYTES", 1000)
    with pytest.raises(InputError, match="the file has more than 1000 bytes"):
        read_drawing("a.svgz", _packed(b"<svg>" + b" " * 5000) * members)
