"""A graphics context for the pictures of the Cut view, without a screen."""

import pytest

from tests.ui.cut import pictures


@pytest.fixture(scope="module")
def context():
    made = pictures.without_a_screen()
    yield made
    made.release()
