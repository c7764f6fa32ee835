"""Bytes thrown at every reader: success or one clear sentence, in bounded memory, within five seconds.

`HITOFUDE_FUZZ=1000 pytest tests/fuzz` tries that many inputs of each reader, from `HITOFUDE_FUZZ_FROM` on.
"""

from __future__ import annotations

import logging
import os
import random

import pytest

from app.core.errors import InputError
from tests.fuzz import apart
from tests.fuzz.apart import Reader, case, faults
from tests.fuzz.mutations import MUTATIONS
from tests.fuzz.readers import READERS, reader

FEW, MANY = int(os.environ.get("HITOFUDE_FUZZ", "15")), 1000
FIRST = int(os.environ.get("HITOFUDE_FUZZ_FROM", "0"))


def told(name: str, numbers: range) -> list[str]:
    return [f"{fault.what}: {fault.data[:300]!r}" for fault in faults(reader(name), numbers)]


@pytest.mark.parametrize("name", READERS)
def test_bytes_are_read_or_refused_in_one_sentence(name: str) -> None:
    assert told(name, range(FIRST, FIRST + FEW)) == []


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", READERS)
def test_a_thousand_inputs_of_every_kind(name: str) -> None:
    """All together 30,000."""
    assert told(name, range(FIRST + FEW, FIRST + FEW + MANY)) == []


def test_the_same_number_is_the_same_input() -> None:
    job = reader("job")
    assert case(job, 5) == case(job, 5) and case(job, 5) != case(job, 6)


@pytest.mark.parametrize("mutation", MUTATIONS)
def test_every_mutation_takes_any_bytes(mutation) -> None:  # type: ignore[no-untyped-def]
    changed = 0
    for seed in (b"", b"\n", b"a", b"  0\nLINE\n 10\n1.5\n", bytes(range(256))):
        made = [mutation(seed, b"other 12", random.Random(k)) for k in range(30)]
        changed += sum(each != seed for each in made)
    assert changed > 10


def _raises(error: Exception) -> object:
    raise error


def _grown(data: bytes) -> object:
    return bytearray(4 * apart.MEGABYTES * 2**20) if len(data) != 1 else None


BAD: dict[str, tuple[apart.Read, str]] = {
    "another error": (lambda data: _raises(KeyError("k")) if data != b"0" else None, "KeyError"),
    "two lines": (lambda data: _raises(InputError("x" * 20 + " y" * 200)) if data != b"0" else None, "420 letters"),
    "memory": (_grown, "MemoryError"),
    "no word": (lambda data: _raises(InputError("")) if data != b"0" else None, "without a word"),
    "a line of a library": (lambda data: logging.getLogger("a library").warning("odd"), "prints 'odd'"),
    "a sentence with an escape": (lambda data: ["\x1b[2J"], "cannot be printed"),
    "the end of the process": (lambda data: os._exit(0) if data != b"0" else None, "the process died"),
    "a seed that is refused": (lambda data: _raises(InputError("no")), "of a seed: refused: no"),
}


@pytest.mark.parametrize("name", BAD)
def test_the_judge_sees(name: str) -> None:
    read, what = BAD[name]
    found = faults(Reader(read, (b"0",)), range(3))
    assert found and what in found[0].what


def test_the_judge_sees_what_takes_long_and_what_does_not_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(apart, "SECONDS", -1.0)
    assert "takes" in faults(Reader(len, (b"0",)), range(1))[0].what
    monkeypatch.setattr(apart, "ENDLESS", 0.2)

    def endless(data: bytes) -> object:
        while data != b"0":
            pass
        return None

    found = faults(Reader(endless, (b"0",)), range(2))
    assert [fault.what for fault in found] == ["no answer within 0.2 s"] * 2
