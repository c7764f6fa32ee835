"""The computation of the document's paths, without a window."""

from app.ui.framework.computation import ComputationState
from tests.ui.conftest import WAIT_MS


def test_a_run_begun_while_another_is_on_its_way_ends_up_to_date(qtbot, workspace) -> None:
    computation = workspace.computation
    workspace.document.run("rect 0,0 30,20")
    computation.start()
    computation.start()
    under_way = (ComputationState.NONE, ComputationState.RUNNING)
    qtbot.waitUntil(lambda: computation.state not in under_way, timeout=WAIT_MS)
    assert computation.state is ComputationState.CURRENT
