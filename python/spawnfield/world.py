"""Worlds: baked maps, and the queries on them."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, overload

import numpy as np

from . import _core, commands
from .errors import ArgumentError, NotValid, translated
from .results import Fleet, Page, Pairs, Picture, Raster, Spawns, Verdicts
from .robot import Robot
from .scene import Scene, _host_array, scene_of

File = str | os.PathLike[str]

#: Options of `bake` that say how a scene file is read.
_SCENE_OPTIONS = ("label", "auto_label", "up", "scale", "heightmap", "unknown", "wall_height", "strict",
                  "allow_missing", "model_path", "any_mesh")  # fmt: skip
#: Options that say how a robot's file is read.
_ROBOT_OPTIONS = ("joints", "mesh_parts")
#: Options that decide how a robot comes to rest.
_REST_OPTIONS = (*_ROBOT_OPTIONS, "model_path", "with_", "with", "without", "time", "max_height", "lift", "max_tilt",
                 "min_stability", "friction", "threads")  # fmt: skip


def bake(scene: Any, out: File | None = None, *, progress: bool | None = None, **options: Any) -> World:
    """Makes a map from a scene, as ``spawnfield bake`` (docs/input-files.md).

    Args:
        scene: name of a scene file: scene.yaml, a Gazebo world or model, a mesh, an OctoMap, an elevation model or a
            2D map of nav2. Or something in memory: a `Scene`, a trimesh.Trimesh or trimesh.Scene, or a pair of vertices
            (n, 3) and faces (m, 3); m, z up.
        out: folder of the map; an older map there is replaced. None: a temporary folder that is deleted with the World.
        progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
        **options: for example ``model_path="models", label="terrain"``; see ``spawnfield.options("bake")``.

    Returns:
        The world with this map.

    Raises:
        FileError: a file is missing or wrong, or the scene has no terrain.
        ArgumentError: an option is wrong.
    """
    inputs: dict[str, Any] = {}
    in_memory = scene_of(scene)
    name: str = "scene in memory" if in_memory else os.fspath(scene)
    if in_memory:
        if given := [option for option in _SCENE_OPTIONS if options.get(option) is not None]:
            raise ArgumentError(
                f"--{given[0].replace('_', '-')} is for scene files; give labels and lengths to the Scene"
            )
        inputs[name] = in_memory._core
    temporary = None
    if out is None:
        temporary = tempfile.TemporaryDirectory(prefix="spawnfield-")
        out = Path(temporary.name) / "map"
    folder = os.fspath(out)
    outcome = commands.run("bake", [name, f"--out={folder}"], options, inputs, progress=progress)
    return World(folder, summary=outcome.summary, _temporary=temporary)


def open(folder: File) -> World:
    """Opens a map that `bake` or the program has made.

    Args:
        folder: of the map.

    Raises:
        FileError: the folder is missing or is not a map.
    """
    return World(folder)


class World:
    """A map, opened for any number of queries. `bake` and `open` return it. Threads may share it.

    All queries take the options of the program's command of the same name, with "_" in place of "-", and have its
    defaults; ``spawnfield.options("sample")`` lists them. A robot is a `Robot`, or the name of a robot's file.

    Raises:
        ArgumentError: an option of a query is unknown, or beyond its limits.
        FileError: a file that a query reads is missing or wrong, or a file cannot be written.
        NothingFits: no pose can be valid, for example because the ``offset`` of a level robot puts it into the ground.

    Attributes:
        name: of the scene.
        folder: of the map.
        hash: 16 hexadecimal digits, of the map's files.
        lower, upper: (x, y, z) of the corners of its bounds, m.
        summary: of the bake, if it was just made, as of ``--summary``; or empty.
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

    @overload
    def sample(
        self, robot: Robot | File, count: int, *, progress: bool | None = None, **options: Any
    ) -> Spawns: ...

    @overload
    def sample(
        self, robot: Robot | File, *, pairs: int, progress: bool | None = None, **options: Any
    ) -> Pairs: ...

    @overload
    def sample(
        self, robot: Robot | File | None = None, *, progress: bool | None = None, **options: Any
    ) -> Fleet: ...

    def sample(
        self, robot: Robot | File | None = None, count: int | None = None, *, progress: bool | None = None,
        **options: Any,
    ) -> Spawns | Pairs | Fleet:  # fmt: skip
        """Returns valid poses, uniform by area, as ``spawnfield sample``.

        Args:
            robot: the robot; leave it out with the option ``fleet``.
            count: number of spawns; leave it out with the options ``pairs``, ``fill`` and ``fleet``.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``min_distance=1.0, yaw="random", seed=7, island="largest"``. ``avoid`` is a file,
                `Spawns`, an array of poses as for `check`, or a list of these. With ``out`` and ``format``, files are
                written, too.

        Returns:
            `Spawns`; with the option ``pairs``, `Pairs`; with ``fleet`` or ``fill``, a `Fleet`. If fewer are found than
            wanted, the reason is logged.
        """
        if count is not None:
            options["count"] = count
        outcome = self._run("sample", robot, options, progress)
        if isinstance(outcome.result, _core.FoundPairs):
            return Pairs(outcome.result, outcome.summary)
        if isinstance(outcome.result, _core.FoundFleet):
            return Fleet(outcome.result, outcome.summary)
        assert robot is not None  # only a fleet has none
        return Spawns(outcome.result, outcome.summary, self._settler(robot, options))

    def search(
        self, robot: Robot | File, count: int, *, progress: bool | None = None, **options: Any
    ) -> Spawns:
        """Returns valid poses from a random search in a box, as ``spawnfield search``.

        Args:
            robot: the robot.
            count: number of poses.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``max_failures=10000, seed=3``.

        Returns:
            The poses, in the order in which they were found. If fewer are found than wanted, the reason is logged.
        """
        outcome = self._run("search", robot, {"count": count, **options}, progress)
        return Spawns(outcome.result, outcome.summary, self._settler(robot, options))

    @overload
    def check(
        self, robot: Robot | File, poses: Any, *, progress: bool | None = None, **options: Any
    ) -> Verdicts: ...

    @overload
    def check(self, robot: Robot | File, *, pairs: File, progress: bool | None = None, **options: Any) -> str: ...

    def check(
        self, robot: Robot | File, poses: Any = None, *, progress: bool | None = None, **options: Any
    ) -> Verdicts | str:
        """Returns the verdict on each pose, as ``spawnfield check``.

        Args:
            robot: the robot.
            poses: (n, 3): x, y, z; (n, 4): and yaw; (n, 6): and roll, pitch, yaw; or (n, 7): and a quaternion x, y, z,
                w, of any length; m and rad, in the world's frame. They come from a list, numpy, torch or anything with
                DLPack. Or `Spawns`, or the name of a CSV file.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``settle=True, repair=1.0, require_valid=True``. Without ``settle``, poses are
                judged as they are.

        Returns:
            `Verdicts`. With the option ``pairs`` in place of `poses`, the text of the CSV or JSON file.

        Raises:
            NotValid: with ``require_valid``, a pose is neither valid nor repaired.
        """
        inputs: dict[str, Any] = {}
        numbers = None if poses is None or isinstance(poses, (str, os.PathLike)) else pose_array(poses)
        if poses is not None:
            has_text = "out" in options or "repaired" in options
            options["poses"] = poses_word(poses if numbers is None else numbers, inputs, has_text)
        wants_text = options.get("pairs") is not None and "out" not in options
        outcome = self._run("check", robot, options, progress, inputs, wants_text)
        found = outcome.text if outcome.result is None else Verdicts(outcome.result, outcome.summary, numbers)
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
            **options: for example ``stance="settled", yaw=1.57``. Robots are level by default.

        Returns:
            One row for each pose; ``Raster.image`` and ``Raster.to_xarray`` make grids of them.
        """
        outcome = self._run("raster", robot, {"step": step, "dims": dims, **options}, progress)
        return Raster(outcome.result, outcome.summary, int(options.get("threads", 0)))

    def heatmap(
        self, robot: Robot | File, *, format: str | None = None, out: File | None = None, progress: bool | None = None,
        **options: Any,
    ) -> Picture:  # fmt: skip
        """Returns a picture of where the robot can stand, as ``spawnfield heatmap``.

        Args:
            robot: the robot.
            format: "png", "svg" or "pdf"; None: that of the ending of `out`, or "png".
            out: file to write, too.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``quantity="clearance", spawns=spawns``, which may be `Spawns`, an array of poses as
                for `check`, or a file.

        Returns:
            The picture; see docs/pictures.md.
        """
        inputs: dict[str, Any] = {}
        ending = Path(out or "").suffix.lower().lstrip(".")
        if format == "html" or ending == "html" or options.get("html"):
            raise ArgumentError("a heat map is a picture here: png, svg or pdf; World.review() returns a page")
        if format is None:
            format = ending if ending in ("svg", "pdf") else "png"
        if options.get("spawns") is not None:
            options["spawns"] = poses_word(options["spawns"], inputs, has_text=False)
        with tempfile.TemporaryDirectory(prefix="spawnfield-") as folder:
            file = Path(folder) / f"picture.{format}"
            outcome = self._run("heatmap", robot, {**options, "out": str(file)}, progress, inputs)
            picture = Picture(file.read_bytes(), format, outcome.summary)
        if out is not None:
            picture.save(out)
        return picture

    def review(
        self, robot: Robot | File, *, out: File | None = None, progress: bool | None = None, **options: Any
    ) -> Page:
        """Returns a page that shows the world in 3D, and says for any place why the robot cannot stand there, as
        ``spawnfield review``.

        Args:
            robot: the robot.
            out: HTML file to write, too.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``raster=0.1, spawns=spawns``, which may be `Spawns`, an array of poses as for
                `check`, or a file.

        Returns:
            The page. A notebook shows it in its cell.
        """
        if options.get("serve"):
            raise ArgumentError("--serve is only for the program: a page that Python makes cannot be changed")
        inputs: dict[str, Any] = {}
        if options.get("spawns") is not None:
            options["spawns"] = poses_word(options["spawns"], inputs, has_text=True)
        outcome = self._run("review", robot, {**options, "out": "-"}, progress, inputs, True)
        page = Page(outcome.text, outcome.summary)
        if out is not None:
            page.save(out)
        return page

    def export(
        self, robot: Robot | File | None = None, *, progress: bool | None = None, **options: Any
    ) -> str | None:
        """Writes the map, or poses, in the format of another program, as ``spawnfield export`` (docs/exports.md).

        Args:
            robot: the robot, for formats that need one.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``format="unreal", poses=spawns``, which may be Spawns, an array of poses as for
                `check`, or a file; and ``out``, the file to write.

        Returns:
            The text of the file; None with the option ``out``, which formats that are not text need.
        """
        inputs: dict[str, Any] = {}
        if options.get("poses") is not None:
            options["poses"] = poses_word(options["poses"], inputs, has_text=True)
        wants_text = "out" not in options
        outcome = self._run("export", robot, options, progress, inputs, wants_text)
        return outcome.text if wants_text else None

    def experiment(self, robot: Robot | File, out: File, *, progress: bool | None = None, **options: Any) -> str:
        """Runs rasters of many steps, or searches of many seeds, as ``spawnfield experiment``.

        Args:
            robot: the robot.
            out: folder to write: tables of counts and times.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: for example ``dims=2, steps="0.5:1:0.25", runs=3``.

        Returns:
            The folder.
        """
        self._run("experiment", robot, {"out": os.fspath(out), **options}, progress)
        return os.fspath(out)

    def info(
        self, robot: Robot | File | None = None, *, progress: bool | None = None, **options: Any
    ) -> dict[str, Any]:
        """Returns the contents of the map, as ``spawnfield info --json``.

        Args:
            robot: the robot, for ``islands``.
            progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
            **options: ``islands=True`` lists the ground within which the robot can drive; see docs/reach.md.
        """
        outcome = self._run("info", robot, {**options, "json": True}, progress, wants_text=True)
        return dict(json.loads(outcome.text))

    def _settler(self, robot: Robot | File, options: Mapping[str, Any]) -> Callable[[Spawns], Verdicts]:
        """Returns a function that lets a robot down at spawns, with those options of a query that matter then."""
        kept = {name: options[name] for name in _REST_OPTIONS if name in options}
        return lambda spawns: self.check(robot, spawns, settle=True, **kept)

    def _run(
        self, command: str, robot: Robot | File | None, options: Mapping[str, Any], progress: bool | None,
        inputs: Mapping[str, Any] | None = None, wants_text: bool = False,
    ) -> commands.Outcome:  # fmt: skip
        things = {self.folder: self._core, **(inputs or {})}
        words = [self.folder]
        if robot is not None:
            words.append(robot_word(robot, things, options))
        if options.get("avoid") is not None:
            options = {**options, "avoid": avoided_words(options["avoid"], things)}
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


def pose_array(poses: Any) -> np.ndarray:
    """Returns poses in memory as an array of shape (n, 3), (n, 4), (n, 6) or (n, 7). Raises ArgumentError."""
    if hasattr(poses, "pose"):
        poses = poses.pose
    try:
        numbers = np.ascontiguousarray(_host_array(poses), np.float64)
    except (TypeError, ValueError) as error:  # for example rows of unequal length
        raise ArgumentError(f"--poses is not an array of numbers: {error}") from None
    return numbers[None, :] if numbers.ndim == 1 else numbers


def poses_word(poses: Any, inputs: dict[str, Any], has_text: bool, word: str = "poses in memory") -> str:
    """Returns what stands for poses in a command: the name of their file, or a name (`word`) under which poses in
    memory are added to the inputs. `has_text`: the command writes them to a file."""
    if isinstance(poses, (str, os.PathLike)):
        return os.fspath(poses)
    try:
        inputs[word] = _core.poses(pose_array(poses), has_text)
    except _core.ArgumentError as error:
        raise translated(error) from None
    return word


def avoided_words(avoid: Any, inputs: dict[str, Any]) -> list[str]:
    """Returns what stands for the option ``avoid``: a file, poses in memory, or a list of both."""
    is_list = isinstance(avoid, list) and all(isinstance(o, (str, os.PathLike)) or hasattr(o, "__len__") for o in avoid)
    is_rows = is_list and all(isinstance(one, (list, tuple)) for one in avoid)  # one array of poses
    groups = avoid if is_list and not is_rows else [avoid]
    return [poses_word(group, inputs, False, f"avoided poses {k + 1}") for k, group in enumerate(groups)]


def info(what: File | Scene, *, progress: bool | None = None, **options: Any) -> dict[str, Any]:
    """Returns the contents of a map, a scene or a robot, as ``spawnfield info --json``.

    Args:
        what: name of a map folder, a scene file or a robot's file, or a Scene.
        progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
        **options: for example ``model_path="models"``; see ``spawnfield.options("info")``.

    Raises:
        FileError: the file is missing or wrong.
    """
    inputs: dict[str, Any] = {}
    if isinstance(what, Scene):
        word = "scene in memory"
        inputs[word] = what._core
    else:
        word = os.fspath(what)
    return dict(json.loads(commands.run("info", [word], {**options, "json": True}, inputs, True, progress).text))


__all__: Sequence[str] = ["World", "bake", "info", "open"]
