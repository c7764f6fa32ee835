"""The library of DXF is read without the grammar of its queries, what reads typefaces and the table of hatch patterns,
and knows all three when asked.
"""

from __future__ import annotations

import subprocess
import sys

from tests.conftest import ROOT

_ASK = """
import sys
from app.formats.readers import read_drawing
read_drawing("fig2.dxf", open("resources/samples/fig2.dxf", "rb").read())
assert "pyparsing" not in sys.modules and "fontTools.ttLib" not in sys.modules
import ezdxf
from ezdxf.tools import pattern
assert not hasattr(sys.modules["ezdxf.tools.pattern"], "__file__")
print(len(pattern.load()["ANSI31"]), hasattr(sys.modules["ezdxf.tools.pattern"], "__file__"))
document = ezdxf.new()
document.modelspace().add_circle((0, 0), 1)
document.modelspace().add_line((0, 0), (1, 1))
print(len(document.modelspace().query("CIRCLE")), len(document.modelspace().query("*")), "pyparsing" in sys.modules)
import io
from ezdxf.fonts import font_manager
try:
    font_manager.TTFont(io.BytesIO(bytes(99)))
except font_manager.TTLibError:
    print("refused")
"""


def test_queries_are_answered_patterns_and_typefaces_read_when_somebody_asks() -> None:
    done = subprocess.run([sys.executable, "-c", _ASK], check=True, capture_output=True, text=True, cwd=ROOT)
    assert done.stdout.split() == ["1", "True", "1", "2", "True", "refused"]
