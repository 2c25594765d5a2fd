"""The program, the training map and a robot, for all tests."""

import os
import subprocess
from pathlib import Path

import pytest

import spawnfield as sf

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def source():
    return SOURCE


@pytest.fixture(scope="session")
def program():
    """Runs the command line program and returns its standard output."""
    file = os.environ.get("SPAWNFIELD_PROGRAM", str(SOURCE / "build/release/bin/spawnfield"))

    def run(*words, status=0):
        done = subprocess.run([file, *map(str, words)], capture_output=True, check=False, cwd=SOURCE)
        assert done.returncode == status, done.stderr.decode()
        return done.stdout

    return run


@pytest.fixture(scope="session")
def world(tmp_path_factory):
    return sf.bake(SOURCE / "maps/training/scene.yaml", tmp_path_factory.mktemp("maps") / "training")


@pytest.fixture(scope="session")
def robot():
    return sf.Robot("box:0.99,0.67,0.39")
