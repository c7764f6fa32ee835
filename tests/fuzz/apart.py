"""Readers called in a process of their own, whose memory and time are limited; what they answer is judged there."""

from __future__ import annotations

import io
import logging
import multiprocessing
import random
import resource
import time
import traceback
import unicodedata
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout, suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection

from app.core.errors import HitofudeError, shortened
from tests.fuzz.mutations import mutated

SECONDS, ENDLESS, MEGABYTES, LETTERS = 5.0, 60.0, 1000, 300
"""Processor seconds that a reader may take; seconds after which it is killed; how far it may grow; letters of a
sentence.
"""

Read = Callable[[bytes], object]


@dataclass(frozen=True)
class Reader:
    """A reader of bytes.

    Attributes:
        read: raises one of the project's own errors, or returns what was read, or an iterable of sentences about it.
        seeds: what it reads well.
    """

    read: Read
    seeds: tuple[bytes, ...]


@dataclass(frozen=True)
class Fault:
    """What went wrong, and for which bytes."""

    what: str
    data: bytes


def case(reader: Reader, number: int) -> bytes:
    """Return the number-th input of a reader."""
    return mutated(reader.seeds, random.Random(number))


def faults(reader: Reader, numbers: Sequence[int]) -> list[Fault]:
    """Return what goes wrong for the inputs of some numbers; a process that dies or hangs is begun anew behind the
    input that did it.
    """
    found: list[Fault] = []
    left = list(numbers)
    with suppress(HitofudeError):
        reader.read(reader.seeds[0])  # what it imports is here before processes part
    while left:
        done, what = _run(reader, left, found)
        if what:
            found.append(Fault(what, case(reader, left[done])))
        left = left[done + 1 :] if what else []
    return found


def _run(reader: Reader, numbers: Sequence[int], found: list[Fault]) -> tuple[int, str]:
    """Judge inputs in one process; return how many were done, and what ended it before its time."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    child = context.Process(target=_judge, args=(theirs, reader, numbers))
    child.start()
    theirs.close()
    done, what = -1, ""  # the seeds come first
    try:
        while done < len(numbers) and not what:
            if not ours.poll(ENDLESS):
                what = f"no answer within {ENDLESS:g} s"
            elif said := ours.recv():
                found.append(
                    Fault(said, case(reader, numbers[done])) if done >= 0 else Fault(f"of a seed: {said}", b"")
                )
                done += 1
            else:
                done += 1
    except EOFError:
        what = "the process died"
    child.kill()
    child.join()
    return max(done, 0), what


def _judge(answer: Connection, reader: Reader, numbers: Sequence[int]) -> None:
    logging.getLogger().handlers.clear()  # those of pytest would hide what a library says
    answer.send("; ".join(filter(None, (verdict(reader.read, seed, must=True) for seed in reader.seeds))))
    with open("/proc/self/statm") as file:
        size = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + MEGABYTES * 2**20,) * 2)
    for number in numbers:
        answer.send(verdict(reader.read, case(reader, number)))
    answer.close()


def verdict(read: Read, data: bytes, must: bool = False) -> str:
    """Return what is wrong with how bytes are read; "" = nothing.

    Args:
        must: they have to be read, and may take as long as code takes to be compiled.
    """
    with redirect_stdout(io.StringIO()) as out, redirect_stderr(out):
        wrong = _wrong(read, data, must)
    printed = out.getvalue().strip()
    return wrong or (f"prints {printed[:200]!r}" if printed else "")


def _wrong(read: Read, data: bytes, must: bool) -> str:
    begun = time.process_time()
    try:
        wrong = _wrong_sentences(read(data))
    except HitofudeError as error:
        wrong = f"refused: {error}" if must else _wrong_sentence(str(error))
    except BaseException as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__}: {str(error)[:120]!r} at {place.filename.rpartition('/')[2]}:{place.lineno}"
    spent = time.process_time() - begun
    return wrong if must or spent <= SECONDS else f"takes {spent:.1f} s"


def _wrong_sentences(told: object) -> str:
    if not isinstance(told, list):
        return ""
    return next(filter(None, map(_wrong_sentence, told)), "")


def _wrong_sentence(text: str) -> str:
    """Return what is wrong with a sentence for the user."""
    if not text.strip():
        return "an error without a word"
    if any(unicodedata.category(sign) in ("Cc", "Cf", "Cs", "Zl", "Zp") for sign in text):
        return f"signs that cannot be printed: {text[:200]!r}"
    return f"{len(shortened(text))} letters: {text[:400]!r}" if len(shortened(text)) > LETTERS else ""
