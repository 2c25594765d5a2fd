"""The reference in docs/ and the type stub are what the package says now."""

import subprocess
import sys

import pytest


def test_reference_is_current(source):
    done = subprocess.run(
        [sys.executable, "-B", source / "tools/python-reference.py", "--check"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


def test_stub_is_current(source, tmp_path):
    """Otherwise: python -m nanobind.stubgen -m spawnfield._core -o python/spawnfield/_core.pyi"""
    pytest.importorskip("nanobind")
    made = tmp_path / "_core.pyi"
    stubgen = ["-m", "nanobind.stubgen", "-q", "-m", "spawnfield._core", "-o", made]
    subprocess.run([sys.executable, "-B", *stubgen], check=True)
    assert (source / "python/spawnfield/_core.pyi").read_text() == made.read_text()
