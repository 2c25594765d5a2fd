"""Worlds: baked maps, and the queries on them."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _core, commands
from .errors import ArgumentError, NotValid, translated
from .results import Fleet, Pairs, Picture, Raster, Spawns, Verdicts
from .robot import Robot
from .scene import Scene, _host_array, scene_of

File = str | os.PathLike[str]

#: Options of `bake` that say how a scene file is read.
_SCENE_OPTIONS = ("label", "auto_label", "up", "scale", "heightmap", "unknown", "wall_height", "strict",
                  "allow_missing", "model_path")  # fmt: skip
#: Options that say how a robot's file is read.
_ROBOT_OPTIONS = ("joints", "mesh_parts")


def bake(scene: Any, out: File | None = None, *, progress: bool | None = None, **options: Any) -> "World":
    """Makes a map from a scene, as ``spawnfield bake``.

    Args:
        scene: name of a scene file: scene.yaml, a Gazebo world or model, a mesh, an OctoMap, an elevation model or a
            2D map of nav2. Or something in memory: a Scene, a trimesh.Trimesh or trimesh.Scene, or a pair of vertices
            (n, 3) and faces (m, 3); m, z up.
        out: folder of the map; an older map there is replaced. None: a temporary folder that is deleted with the world.
        progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
        **options: those of the program, with "_" in place of "-"; see ``spawnfield.options("bake")``.

    Returns:
        The world with this map.

    Raises:
        FileError: a file is missing or wrong, or the scene has no terrain.
        ArgumentError: an option is wrong.
    """
    inputs: dict[str, Any] = {}
    in_memory = scene_of(scene)
    name = "scene in memory" if in_memory else os.fspath(scene)
    if in_memory:
        if given := [option for option in _SCENE_OPTIONS if options.get(option) is not None]:
            raise ArgumentError(
                f"--{given[0].replace('_', '-')} is for scene files; give labels and lengths to the Scene"
            )
        inputs[name] = in_memory._core
    temporary = tempfile.TemporaryDirectory(prefix="spawnfield-") if out is None else None
    folder = str(Path(temporary.name) / "map") if temporary else os.fspath(out)
    outcome = commands.run("bake", [name, f"--out={folder}"], options, inputs, progress=progress)
    return World(folder, summary=outcome.summary, _temporary=temporary)


def open(folder: File) -> "World":
    """Opens a map that `bake` or the program has made. Raises FileError."""
    return World(folder)


class World:
    """A map, opened for any number of queries. Threads may share it.

    All queries have the options of the program's commands, with "_" in place of "-"; see
    ``spawnfield.options("sample")``. Robots are a Robot, or the name of a robot's file.

    Attributes:
        name: of the scene.
        folder: of the map.
        hash: of the map's files.
        lower, upper: corners of its bounds, m.
        summary: of the bake, if it was just made.
    """

    def __init__(self, folder: File, *, summary: Mapping[str, Any] | None = None, _temporary: Any = None) -> None:
        self._temporary = _temporary  # is deleted with the world
        try:
            self._core = _core.read_map(os.fspath(folder))
        except _core.FileError as error:
            raise translated(error) from None
        about = self._core.about()
        self.name: str = about["name"]
        self.folder: str = about["folder"]
        self.hash: str = about["hash"]
        self.lower: tuple[float, ...] = tuple(about["lower"])
        self.upper: tuple[float, ...] = tuple(about["upper"])
        self.summary = dict(summary or {})

    def __repr__(self) -> str:
        return f"World({self.folder!r}: {self.name})"

    def sample(
        self, robot: Robot | File | None = None, count: int | None = None, *, progress: bool | None = None,
        **options: Any,
    ) -> Spawns | Pairs | Fleet:  # fmt: skip
        """Returns valid poses, uniform by area, as ``spawnfield sample``.

        Args:
            robot: the robot; leave it out with the option ``fleet``.
            count: number of spawns; leave it out with the options ``pairs``, ``fill`` and ``fleet``.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``min_distance=1.0, yaw="random", seed=7, island="largest"``. With ``out`` and
                ``format``, files are written, too.

        Returns:
            Spawns; with ``pairs``, Pairs; with ``fleet`` or ``fill``, Fleet. If fewer are found than wanted, the reason
            is logged.
        """
        if count is not None:
            options["count"] = count
        outcome = self._run("sample", robot, options, progress)
        kinds = ((_core.FoundSpawns, Spawns), (_core.FoundPairs, Pairs), (_core.FoundFleet, Fleet))
        return next(ours(outcome.result, outcome.summary) for kind, ours in kinds if isinstance(outcome.result, kind))

    def search(
        self, robot: Robot | File, count: int, *, progress: bool | None = None, **options: Any
    ) -> Spawns:
        """Returns valid poses from a random search in a box, as ``spawnfield search``."""
        outcome = self._run("search", robot, {"count": count, **options}, progress)
        return Spawns(outcome.result, outcome.summary)

    def check(
        self, robot: Robot | File, poses: Any = None, *, progress: bool | None = None, **options: Any
    ) -> Verdicts | str:
        """Returns the verdict on each pose, as ``spawnfield check``.

        Args:
            robot: the robot.
            poses: (n, 3): x, y, z; (n, 4): and yaw; (n, 6): and roll, pitch, yaw; or (n, 7): and a quaternion x, y, z,
                w; m and rad; from numpy, torch or anything with DLPack. Or spawns, or the name of a CSV file.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``settle=True, repair=1.0, require_valid=True``.

        Returns:
            Verdicts. With the option ``pairs``, the text of the CSV or JSON file.

        Raises:
            NotValid: with ``require_valid``, a pose is neither valid nor repaired.
        """
        inputs: dict[str, Any] = {}
        if poses is not None and "poses" in options:
            raise ArgumentError("--poses is given twice")
        if poses is not None:
            has_text = "out" in options or "repaired" in options
            options["poses"] = poses_word(poses, inputs, has_text)
        wants_text = options.get("pairs") is not None and "out" not in options
        outcome = self._run("check", robot, options, progress, inputs, wants_text)
        found = Verdicts(outcome.result, outcome.summary) if outcome.result is not None else outcome.text
        if outcome.complaint:
            raise NotValid(outcome.complaint, found)
        return found

    def raster(
        self, robot: Robot | File, step: float, *, dims: int = 2, progress: bool | None = None, **options: Any
    ) -> Raster:
        """Returns the verdict at every position of a raster, as ``spawnfield raster``.

        Args:
            robot: the robot.
            step: distance between columns, m.
            dims: 2: a pose for each column and layer of ground; 3: for each column and height.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``stance="settled", yaw=1.57``.
        """
        outcome = self._run("raster", robot, {"step": step, "dims": dims, **options}, progress)
        return Raster(outcome.result, outcome.summary, int(options.get("threads", 0)))

    def heatmap(
        self, robot: Robot | File, *, format: str = "png", out: File | None = None, progress: bool | None = None,
        **options: Any,
    ) -> Picture:  # fmt: skip
        """Returns a picture of where the robot can stand, as ``spawnfield heatmap``.

        Args:
            robot: the robot.
            format: "png", "svg" or "pdf".
            out: file to write, too.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``quantity="clearance", spawns=FILE``. ``spawns`` may be Spawns or an array of poses.
        """
        inputs: dict[str, Any] = {}
        if options.get("spawns") is not None:
            options["spawns"] = poses_word(options["spawns"], inputs, has_text=False)
        with tempfile.TemporaryDirectory(prefix="spawnfield-") as folder:
            file = Path(folder) / f"picture.{format}"
            outcome = self._run("heatmap", robot, {**options, "out": str(file)}, progress, inputs)
            picture = Picture(file.read_bytes(), format, outcome.summary)
        if out is not None:
            picture.save(out)
        return picture

    def export(
        self, robot: Robot | File | None = None, *, progress: bool | None = None, **options: Any
    ) -> str | None:
        """Writes files for simulators and other programs, as ``spawnfield export``. Returns the text if the option
        ``out`` is not given. ``poses`` may be spawns or an array."""
        inputs: dict[str, Any] = {}
        if options.get("poses") is not None:
            options["poses"] = poses_word(options["poses"], inputs, has_text=True)
        wants_text = "out" not in options
        outcome = self._run("export", robot, options, progress, inputs, wants_text)
        return outcome.text if wants_text else None

    def experiment(self, robot: Robot | File, out: File, *, progress: bool | None = None, **options: Any) -> str:
        """Runs rasters of many steps, or searches of many seeds, as ``spawnfield experiment``. Returns the folder."""
        self._run("experiment", robot, {"out": os.fspath(out), **options}, progress)
        return os.fspath(out)

    def info(
        self, robot: Robot | File | None = None, *, progress: bool | None = None, **options: Any
    ) -> dict[str, Any]:
        """Returns the contents of the map, as ``spawnfield info --json``. ``islands=True`` lists the ground within
        which the robot can drive."""
        outcome = self._run("info", robot, {**options, "json": True}, progress, wants_text=True)
        return json.loads(outcome.text)

    def _run(
        self, command: str, robot: Robot | File | None, options: Mapping[str, Any], progress: bool | None,
        inputs: Mapping[str, Any] | None = None, wants_text: bool = False,
    ) -> commands.Outcome:  # fmt: skip
        things = {self.folder: self._core, **(inputs or {})}
        words = [self.folder]
        if robot is not None:
            words.append(robot_word(robot, things, options))
        return commands.run(command, words, options, things, wants_text, progress)


def robot_word(robot: Robot | File, inputs: dict[str, Any], options: Mapping[str, Any]) -> str:
    """Returns the option ``--robot``, and adds a robot in memory to the inputs. Raises ArgumentError if it is in
    memory, and `options` say how its file is read."""
    if not isinstance(robot, Robot):
        return f"--robot={os.fspath(robot)}"
    if given := [option for option in _ROBOT_OPTIONS if options.get(option) is not None]:
        raise ArgumentError(f"--{given[0].replace('_', '-')} is for a robot's file; give it to Robot()")
    inputs[robot.file] = robot._core
    return f"--robot={robot.file}"


def poses_word(poses: Any, inputs: dict[str, Any], has_text: bool) -> str:
    """Returns what stands for poses in a command: the name of their file, or a name under which poses in memory are
    added to the inputs. `has_text`: the command writes them to a file."""
    if isinstance(poses, (str, os.PathLike)):
        return os.fspath(poses)
    word = "poses in memory"
    if hasattr(poses, "pose"):
        poses = poses.pose
    numbers = np.ascontiguousarray(_host_array(poses), np.float64)
    if numbers.ndim == 1:
        numbers = numbers[None, :]
    try:
        inputs[word] = _core.poses(numbers, has_text)
    except _core.ArgumentError as error:
        raise translated(error) from None
    return word


def info(what: File | Scene, *, progress: bool | None = None, **options: Any) -> dict[str, Any]:
    """Returns the contents of a map, a scene or a robot, as ``spawnfield info --json``."""
    inputs = {"scene in memory": what._core} if isinstance(what, Scene) else {}
    word = "scene in memory" if inputs else os.fspath(what)
    return json.loads(commands.run("info", [word], {**options, "json": True}, inputs, True, progress).text)


__all__: Sequence[str] = ["World", "bake", "info", "open"]
