"""The menu Compute lets a job take a share of the machine's memory, and the window remembers which."""

import pytest

from app.core.memory import budget_limit, machine_memory
from app.core.settings import JobMemory, load_settings
from app.ui.shell.memory_choice import SHARES
from app.ui.shell.window_controller import WindowController


@pytest.mark.parametrize("choice", [JobMemory.QUARTER, JobMemory.MOST])
def test_jobs_go_by_the_share_that_was_chosen(qtbot, wiring: WindowController, choice: JobMemory) -> None:
    window = wiring.window_
    assert window.actions_["memory_half"].isChecked()
    window.actions_[f"memory_{choice.value}"].trigger()
    try:
        with qtbot.waitSignal(window.worker.done) as caught:
            window.worker.start(lambda progress: budget_limit(), 1)
        assert caught.args[0].value == int(SHARES[choice] * machine_memory())
        assert load_settings().memory is choice
    finally:
        window.actions_["memory_half"].trigger()
    assert budget_limit() == int(SHARES[JobMemory.HALF] * machine_memory())
