"""The quick start of docs/python.md runs as it is, with a real world."""

import os
import re
import tempfile
from pathlib import Path

import numpy as np
import pytest

import spawnfield as sf


@pytest.fixture
def scenes(source):
    """The folder of the shared scenes, as in tests/shared_scenes.h."""
    folder = Path(os.environ.get("SPAWNFIELD_SCENES", source.parent / "shared/scenes"))
    if not folder.is_dir():
        pytest.skip(f"no shared scenes at {folder}; set SPAWNFIELD_SCENES to their folder")
    return folder


def test_quick_start(scenes, source, tmp_path, monkeypatch, capsys):
    pytest.importorskip("xarray")
    for name, file in {
        "warehouse.world": "warehouse/worlds/small_warehouse.world",
        "models": "warehouse/models",
        "husky.urdf": "robot_husky/husky_description/urdf/husky.urdf",
        "husky_description": "robot_husky/husky_description",  # its meshes
    }.items():
        (tmp_path / name).symlink_to(scenes / file)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    page = (source / "docs/python.md").read_text()
    block = re.search(r"## Quick start\n\n```python\n(.*?)```", page, re.DOTALL).group(1)
    names = {}
    exec(block, names)  # noqa: S102

    spawns, verdict, grid = names["spawns"], names["verdict"], names["grid"]
    assert len(spawns) > 100 and spawns.pose.shape == (len(spawns), 7) and spawns.pose.dtype == np.float64
    assert (spawns.verdict == sf.VALID).all()
    assert verdict.code.dtype == np.uint8 and verdict.code.shape == verdict.ground.shape == verdict.valid.shape == (2,)
    assert len(verdict.hit) == 2
    data = grid.to_xarray()
    assert int((data.verdict == sf.VALID).sum()) == grid.counts["valid"] > 500 and data.x.attrs["units"] == "m"
    picture = Path(re.search(r"the picture is in (.*)\n", capsys.readouterr().out).group(1))
    assert picture.parent == tmp_path and picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert sf.open("warehouse.map").hash == names["world"].hash
