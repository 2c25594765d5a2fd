"""The fixture `spawn_ok` for pytest."""

import pytest


@pytest.fixture
def spawn_ok():
    """The function `spawnfield.spawn_ok`: asserts that a robot can stand at all poses."""
    import spawnfield

    return spawnfield.spawn_ok
