"""Bytes changed as accidents, other programs and enemies change them; the same for the same generator."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence

NUMBERS = (
    b"0",
    b"-0",
    b"1",
    b"-1",
    b"2",
    b"0.001",
    b"1e-9",
    b"1e-300",
    b"-1e15",
    b"1e15",
    b"1e308",
    b"1e999",
    b"-1e400",
    b"nan",
    b"inf",
    b"-inf",
    b"3,25",
    b"-0,5",
    b"1.2.3",
    b"--5",
    b"+7",
    b"0x10",
    b"1_000",
    b"1e",
    b".",
    b"1000000",
    b"-2147483649",
    b"2147483647",
    b"4294967296",
    b"9223372036854775808",
    b"9" * 40,
    b"9" * 400,
    b"9" * 4400,
    b"0." + b"3" * 300,
    b"1" + b"0" * 320,
    "\u0663".encode(),
    "\uff11".encode(),
)
"""What may stand where a number stood."""

TOKENS = (
    b"\0",
    b"\0" * 40,
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\x80",
    "é".encode("latin-1"),
    "\u2028".encode(),
    "\u202e".encode(),
    b"\x1b[2J",
    b"\r",
    b"\n\n",
    b"'",
    b'"',
    b"'''",
    b'"""',
    b"[",
    b"]",
    b"[" * 60,
    b"(" * 60,
    b"{" * 60,
    b"<",
    b">",
    b"&",
    b"&lt;",
    b"<!--",
    b"%",
    b"#",
    b";",
    b"\\",
    b"=",
    b",",
    b":",
    b" ",
    b"\t",
    b"x" * 400,
    b"../../../etc/passwd",
    b"true",
    b"None",
    b"null",
)
"""What may turn up anywhere."""

_NUMBER = re.compile(rb"(?<![A-Za-z_])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|(?<=[A-Za-z])[-+]?(?:\d+\.?\d*|\.\d+)")
_WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9]*|[^\sA-Za-z_0-9]")

Mutation = Callable[[bytes, bytes, random.Random], bytes]


def _span(data: bytes, rng: random.Random, most: int) -> tuple[int, int]:
    at = rng.randrange(len(data) + 1)
    return at, min(len(data), at + 1 + rng.randrange(most))


def flipped(data: bytes, _: bytes, rng: random.Random) -> bytes:
    made = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8, 64))):
        if made:
            made[rng.randrange(len(made))] ^= 1 << rng.randrange(8)
    return bytes(made)


def overwritten(data: bytes, _: bytes, rng: random.Random) -> bytes:
    at, end = _span(data, rng, rng.choice((1, 2, 4, 8)))
    fill = rng.choice((b"\0", b"\xff", b"\x7f", b"\x80", b"\x01", bytes([rng.randrange(256)])))
    return data[:at] + fill * (end - at) + data[end:]


def cut(data: bytes, _: bytes, rng: random.Random) -> bytes:
    at, end = _span(data, rng, max(1, len(data)))
    return rng.choice((data[:at], data[at:], data[:at] + data[end:]))


def doubled(data: bytes, _: bytes, rng: random.Random) -> bytes:
    at, end = _span(data, rng, rng.choice((4, 40, 400)))
    return data[:end] + data[at:end] * rng.choice((1, 2, 20, 200)) + data[end:]


def moved(data: bytes, _: bytes, rng: random.Random) -> bytes:
    (a, b), (at, _end) = _span(data, rng, 200), _span(data, rng, 1)
    return data[:at] + data[a:b] + data[at:]


def spliced(data: bytes, other: bytes, rng: random.Random) -> bytes:
    (at, _end), (begin, end) = _span(data, rng, 1), _span(other, rng, max(1, len(other)))
    return data[:at] + other[begin:end] + (data[at:] if rng.random() < 0.5 else b"")


def lines_changed(data: bytes, _: bytes, rng: random.Random) -> bytes:
    lines = data.split(b"\n")
    for _ in range(rng.choice((1, 1, 3, 10))):
        a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
        action = rng.randrange(4)
        if action == 0:
            lines[a], lines[b] = lines[b], lines[a]
        elif action == 1 and len(lines) > 1:
            del lines[a]
        elif action == 2:
            lines.insert(b, lines[a])
        else:
            lines[a:a] = lines[min(a, b) : min(a, b) + rng.randrange(1, 30)] * rng.choice((1, 1, 10))
    return b"\n".join(lines)


def numbers_changed(data: bytes, _: bytes, rng: random.Random) -> bytes:
    return _replaced(data, _NUMBER, rng, lambda old: rng.choice(NUMBERS) if rng.random() < 0.7 else _scaled(old, rng))


def _scaled(old: bytes, rng: random.Random) -> bytes:
    try:
        return f"{float(old) * rng.choice((-1, 10, 1000, 1e6, 1e-6, 1.0000001)):.10g}".encode()
    except ValueError:
        return b"-" + old


def values_of_pairs_changed(data: bytes, other: bytes, rng: random.Random) -> bytes:
    """Of a text of pairs of lines, a code and a value, values alone; some pairs go, come twice, or come from another
    text.
    """
    lines = data.split(b"\n")
    theirs = other.split(b"\n")
    for _ in range(rng.choice((1, 1, 3, 8))):
        k = rng.randrange(max(1, len(lines) - 1)) | 1
        action = rng.randrange(4)
        if action < 2:
            lines[k : k + 1] = [rng.choice(NUMBERS[:34])]
        elif action == 2:
            lines[k - 1 : k + 1] = lines[k - 1 : k + 1] * rng.choice((0, 2, 50))
        else:
            at = rng.randrange(max(1, len(theirs) - 1)) & ~1
            lines[k - 1 : k - 1] = theirs[at : at + 2 * rng.randrange(1, 20)]
    return b"\n".join(lines)


def words_changed(data: bytes, other: bytes, rng: random.Random) -> bytes:
    words = _WORD.findall(other) or [b""]
    return _replaced(
        data,
        _WORD,
        rng,
        lambda old: rng.choice((b"", old * 2, rng.choice(words), rng.choice(words), rng.choice(TOKENS))),
    )


def _replaced(data: bytes, pattern: re.Pattern[bytes], rng: random.Random, new: Callable[[bytes], bytes]) -> bytes:
    found = list(pattern.finditer(data))
    for match in sorted(rng.sample(found, min(len(found), rng.choice((1, 1, 2, 5)))), key=lambda each: -each.start()):
        data = data[: match.start()] + new(match[0]) + data[match.end() :]
    return data


def inserted(data: bytes, _: bytes, rng: random.Random) -> bytes:
    at, end = _span(data, rng, 3)
    return data[:at] + rng.choice(TOKENS) + data[at if rng.random() < 0.5 else end :]


def recoded(data: bytes, _: bytes, rng: random.Random) -> bytes:
    text = data.decode("latin-1")
    return rng.choice(
        (
            lambda: text.encode("utf-16"),
            lambda: text.encode("utf-16-be"),
            lambda: text.encode("utf-8"),
            lambda: b"\xef\xbb\xbf" + data,
            lambda: data.replace(b"\n", b"\r\n"),
            lambda: data.replace(b"\n", b"\r"),
            lambda: data.replace(b".", b","),
            lambda: data.upper(),
            lambda: data.lower(),
            lambda: data.replace(b"\n", b""),
            lambda: data.replace(b" ", b"\t"),
            lambda: text.encode("utf-32"),
        )
    )()


MUTATIONS: tuple[Mutation, ...] = (
    flipped,
    overwritten,
    cut,
    doubled,
    moved,
    spliced,
    lines_changed,
    numbers_changed,
    numbers_changed,
    numbers_changed,
    values_of_pairs_changed,
    words_changed,
    words_changed,
    inserted,
    recoded,
)


def mutated(seeds: Sequence[bytes], rng: random.Random) -> bytes:
    """Return one of the seeds, changed once to four times."""
    data = rng.choice(seeds)
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        data = rng.choice(MUTATIONS)(data, rng.choice(seeds), rng)
    return data
