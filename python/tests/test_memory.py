"""Memory does not grow with the number of calls."""

import gc
import os

import numpy as np
import pytest

import spawnfield as sf

#: Bytes of growth per call that the test allows. The smallest result, a verdict on one pose, has more.
LIMIT = 100


def resident() -> int:
    """Returns the bytes of this process that are in memory."""
    gc.collect()
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.fixture(scope="module")
def calls():
    """Returns a function that makes calls, eight checks for a settled check and a sample, and returns by how many bytes
    the memory has grown for each. It keeps the results in a list if one is given."""
    scene = sf.Scene("plate").add_box((3, 3, 1), (0, 0, -0.5), label="terrain")
    world, robot = sf.bake(scene, resolution=0.2), sf.Robot("box:0.5,0.4,0.3")
    poses = np.array([[0, 0, 0.2, 0]])

    def run(count, kept=None):
        before = resident()
        for k in range(count):
            if k % 10 == 0:
                result = world.sample(robot, 3, seed=k, threads=1, quiet=True)
            else:
                result = world.check(robot, poses, settle=k % 10 == 1, threads=1, quiet=True)
            if kept is not None:
                kept.append(result)
        return (resident() - before) / count

    run(300)  # warm-up
    return run


def test_ten_thousand_calls(calls):
    assert calls(10_000) < LIMIT


def test_kept_results_are_found(calls):
    """The test above can fail: a leak of results is more than the limit."""
    assert calls(1000, kept=[]) > LIMIT
