"""The fixture `spawn_ok` for pytest."""

from collections.abc import Callable

import pytest


@pytest.fixture
def spawn_ok() -> Callable[..., None]:
    """The function `spawnfield.spawn_ok`: asserts that a robot can stand at all poses."""
    import spawnfield

    return spawnfield.spawn_ok
