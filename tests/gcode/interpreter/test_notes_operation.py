"""Comments that say where a contour begins: of every post's own programs, and of texts that only look like it."""

import time

import pytest

from app.gcode.interpreter.notes_operation import contour_motions
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post, post_names
from app.gcode.writer.write import write_files
from app.model.contour_operation import ContourOperation
from app.model.moves import MoveKind
from tests.gcode.programs import job, two_tools

HEAD = b"G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F100\n"


def contours_of(data: bytes) -> list[int]:
    """The lines whose motions go along a contour."""
    program = read_program(data)
    return program.motions.line[contour_motions(data, program)].tolist()


@pytest.mark.parametrize("name", post_names())
def test_what_every_post_writes_tells_its_contours(name):
    post, program = load_post(name), two_tools().program()
    contour = {operation for operation, each in enumerate(job().operations) if isinstance(each, ContourOperation)}
    for file in write_files(program, job(), post):
        data = file.nc.text.encode()
        read = read_program(data, ReadOptions(post.dialect))
        told = dict(zip(read.motions.line.tolist(), contour_motions(data, read).tolist(), strict=True))
        own = slice(file.first, file.first + len(file.nc.lines))
        moves = zip(
            file.nc.lines.tolist(), program.moves.operation[own].tolist(), program.moves.kind[own].tolist(), strict=True
        )
        feeds = [(line, operation in contour) for line, operation, kind in moves if kind != MoveKind.RAPID]
        assert feeds
        assert [(line, told[line]) for line, _ in feeds] == feeds


@pytest.mark.parametrize("ends", [b"\n", b"\r\n", b"\r"])
def test_a_contour_reaches_to_the_next_operation(ends):
    text = (
        HEAD + b"(Contour T2: depth 1 mm)\nG1 X5\nG1 Y5\n(Pocket T2: depth 1 mm)\nG1 X9\n(Contour T2: depth 2 mm)\nG1 "
        b"X1\nM2\n"
    )
    assert contours_of(text.replace(b"\n", ends)) == [5, 6, 10]


def test_a_contour_ends_at_a_tool_change():
    assert contours_of(HEAD + b"(CONTOUR T2: DEPTH 1 MM)\nG1 X5\nT3 M6\nG1 X9\nM2\n") == [5]


@pytest.mark.parametrize(
    "comment",
    [b"(the Contour T2: is next)", b"(Contour Tool)", b"G4 P1 (Contour T2: depth)", b"(contour T2: depth)", b""],
)
def test_other_words_are_no_contour(comment):
    assert contours_of(HEAD + comment + b"\nG1 X5\nM2\n") == []


def test_comments_behind_a_semicolon_and_at_the_very_beginning_count():
    assert contours_of(b"; Contour T1: depth 1 mm\nG1 X5 F100\nM2\n") == [2]
    assert contours_of(b"(Contour T1: depth 1 mm)\nG1 X5 F100\nM2\n") == [2]


def test_two_hundred_thousand_lines_take_no_time():
    lines = b"".join(
        b"(Contour T1: depth %d mm)\n" % k if k % 50 == 0 else b"G1 X%d.5 F100\n" % k for k in range(200_000)
    )
    program = read_program(lines)
    begun = time.process_time()  # of this process alone, whatever else the machine does
    found = contour_motions(lines, program)
    assert time.process_time() - begun < 0.5
    assert found.all()
    assert len(found) == 196_000
