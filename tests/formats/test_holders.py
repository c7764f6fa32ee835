"""Holders by name, in libraries, spreadsheets and job files."""

import pytest

from app.core.errors import InputError
from app.formats.job.toml import read_job
from app.formats.tools.csv import read_tool_csv
from app.formats.tools.holders import name_of_outline, named_holders, outline_of
from app.formats.tools.library import read_library
from app.model.tool import Tool

LIBRARY = b'format = 1\n[[tool]]\nnumber = 1\ndiameter = 6\nstick_out = 30\nholder = "%b"\n'


def test_every_named_holder_makes_a_tool_and_is_found_again():
    assert len(named_holders()) == len({each.outline for each in named_holders()}) > 8
    for holder in named_holders():
        assert Tool(1, 6.0, stick_out=30.0, holder=holder.outline).holder == holder.outline
        assert name_of_outline(holder.outline) == holder.name
    assert name_of_outline(((0.0, 1.0), (2.0, 3.0))) == ""


def test_a_collet_nut_is_as_wide_as_the_standard_says():
    assert outline_of("ER20") == ((0.0, 17.5), (60.0, 17.5))


@pytest.mark.parametrize("name", ["er20", " ER 20", "ER-20"])
def test_names_are_read_in_any_case_and_spacing(name):
    assert outline_of(name) == outline_of("ER20")


def test_a_library_a_spreadsheet_and_a_job_name_holders():
    assert read_library("t.toml", LIBRARY % b"ER16").tools[0].holder == outline_of("ER16")
    table = b"number,diameter,holder\n1,6,Shrink fit 6\n2,6,0 x 10; 9 x 10\n"
    assert [tool.holder for tool in read_tool_csv("t.csv", table)[0].tools] == [
        outline_of("shrinkfit6"),
        ((0.0, 10.0), (9.0, 10.0)),
    ]
    assert read_job("j.toml", b'[[tool]]\nnumber = 1\ndiameter = 6\nholder = "weldon 10"\n').job.tools[
        0
    ].holder == outline_of("Weldon 10")


def test_unknown_names_are_refused_with_those_that_are_known():
    with pytest.raises(InputError, match=r"t.toml: tool\[1\].holder: 'ER99' is no holder; use one of ER11, "):
        read_library("t.toml", LIBRARY % b"ER99")
    with pytest.raises(InputError, match="holder"):
        read_job("j.toml", b'[[tool]]\nnumber = 1\ndiameter = 6\nholder = "ER99"\n')
