"""The moves whose sweep is shown beside the tool: straight or bent, up to where the tool is."""

from __future__ import annotations

import numpy as np

from app.model.motion_part import place_on
from app.ui.views.cut.live_cells import last_tips
from app.usecases.cutting.playback import Playback
from tests.usecases.test_playback import cut_text

TEXT = """G21 G90 G17 G94
T1 M6
S1000 M3
G0 X10 Y0 Z5
G1 Z-1 F100
G1 X20 F300
G3 X30 Y10 I0 J10
G0 Z5
M2
"""


def test_bent_moves_are_shown_by_chords_up_to_the_tool() -> None:
    timeline = Playback(cut_text(TEXT)).timeline
    motions = timeline.programs[0]
    row = int(np.flatnonzero(motions.kind > 1)[0])
    tip = np.asarray(place_on(motions, row, 0.5), float)
    tips = last_tips(timeline, row, tip)
    assert np.allclose(tips[-1], tip) and np.allclose(tips[0], [10, 0, 5])
    bent = tips[tips[:, 0] > 20 + 1e-9]
    assert len(bent) >= 4 and np.allclose(np.hypot(bent[:, 0] - 20, bent[:, 1] - 10), 10, atol=1e-9)
    assert np.all(np.diff(bent[:, 0]) > 0)


def test_rapids_sweep_nothing() -> None:
    timeline = Playback(cut_text(TEXT)).timeline
    last = len(timeline) - 1
    tip = np.array([30.0, 10.0, 5.0])
    assert len(last_tips(timeline, last, tip)) == 1
