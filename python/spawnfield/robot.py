"""Robots."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from . import _core
from .commands import log_notice
from .errors import translated


class Robot:
    """A robot, read from a file once and used in any number of queries.

    Args:
        file: robot.yaml, .urdf, an SDF model, or "box:LX,LY,LZ" with side lengths in m; see docs/robots.md.
        model_path: folder, or a list of folders, that contain models or ROS packages.
        joints: positions of joints of a URDF or SDF model, rad or m; all others are at 0.
        mesh_parts: each mesh of the robot is split into at most this many convex parts; 1: its convex hull.

    Raises:
        FileError: the file is missing or wrong.
        ArgumentError: an argument is beyond its limits.

    Attributes:
        name: of the robot.
        file: from which it was read.
        lower, upper: (x, y, z) of the corners of the box around it in its own frame, m.
        mass_center: (x, y, z) of its centre of mass in its own frame, m.
    """

    def __init__(
        self,
        file: str | os.PathLike[str],
        *,
        model_path: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] = (),
        joints: Mapping[str, float] | None = None,
        mesh_parts: int = 1,
    ) -> None:
        self.file = os.fspath(file)
        paths = [model_path] if isinstance(model_path, (str, os.PathLike)) else model_path
        try:
            self._core = _core.load_robot(self.file, [os.fspath(p) for p in paths], dict(joints or {}), mesh_parts)
        except (_core.ArgumentError, _core.FileError) as error:
            raise translated(error) from None
        about: dict[str, Any] = self._core.about()
        for notice in about["notices"]:
            log_notice(notice)
        self.name: str = about["name"]
        self.lower: tuple[float, ...] = tuple(about["lower"])
        self.upper: tuple[float, ...] = tuple(about["upper"])
        self.mass_center: tuple[float, ...] = tuple(about["mass_center"])

    def __repr__(self) -> str:
        return f"Robot({self.file!r}: {self.name})"
