"""A plugin of pytest that runs tests in another order: `-p tests.ui.shuffled`, with HITOFUDE_SEED for which."""

import os
import random

import pytest


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the tests into a random order that the seed tells."""
    random.Random(int(os.environ.get("HITOFUDE_SEED", "0"))).shuffle(items)
