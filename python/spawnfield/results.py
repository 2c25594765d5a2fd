"""What the queries return: values as numpy arrays, and the same files as the command line program writes.

All lengths are in metres and angles in radians. The frame is that of the world: x forward, y left, z up (REP-103). A
pose is the position of the robot's origin, x, y, z, and its rotation as a quaternion x, y, z, w.
"""

from __future__ import annotations

import functools
import io
import operator
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from html import escape
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import _core
from .errors import ArgumentError, translated

#: The name of each verdict by its code, as in files and in arrays of verdicts; see docs/verdicts.md.
VERDICTS = {
    0: "outside", 1: "aerial", 2: "off_terrain", 3: "submerged", 4: "collision", 5: "steep", 6: "unstable",
    7: "valid", 8: "obstructed", 9: "unreachable",
}  # fmt: skip
#: The code of the verdict "valid".
VALID = 7


class Table:
    """Columns of equal length, one row for each pose: the base of `Spawns`, `Pairs`, `Fleet`, `Verdicts` and `Raster`.

    Each column is an attribute, for example ``spawns.yaw``. ``len()`` is the number of rows, and ``spawns[0]`` the
    first one, with its values as attributes. The arrays are made once and stay when the table is deleted.

    Attributes:
        columns: dictionary of all columns by their names.
        summary: the summary of the query, as of ``--summary``.
    """

    def __init__(self, columns: Mapping[str, np.ndarray], summary: Mapping[str, Any]) -> None:
        self.columns = dict(columns)
        self.summary = dict(summary)

    def __getattr__(self, name: str) -> np.ndarray:
        columns = self.__dict__.get("columns", {})
        if name in columns:
            return columns[name]
        raise AttributeError(f"{type(self).__name__} has no {name!r}; it has {', '.join(columns)}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.columns]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, index: int) -> SimpleNamespace:
        i = range(len(self))[operator.index(index)]
        return SimpleNamespace(**{name: values[i] for name, values in self.columns.items()}, **self._words(i))

    def _words(self, i: int) -> dict[str, str]:
        """Returns what a row has beside its columns."""
        return {}

    def __repr__(self) -> str:
        return f"{type(self).__name__}({len(self)}: {', '.join(self.columns)})"

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame. Needs pandas. Poses become the columns x, y, z, qx, qy, qz, qw, with the name as
        a prefix unless the name is ``pose``."""
        import pandas as pd

        frame = {}
        for name, values in self.columns.items():
            if values.ndim == 1:
                frame[name] = values
                continue
            prefix = "" if name == "pose" else name + "_"
            for k, axis in enumerate(("x", "y", "z", "qx", "qy", "qz", "qw")):
                frame[prefix + axis] = values[:, k]
        return pd.DataFrame(frame)


def write_bytes(data: bytes, file: str | os.PathLike[str] | None) -> bytes:
    """Writes bytes to a file, completely or not at all, unless it is None. Returns them."""
    if file is not None:
        try:
            _core.write_file(os.fspath(file), data)
        except _core.OutputError as error:
            raise translated(error) from None
    return data


class Contacts:
    """Where robots touch the ground at their settled poses. ``contacts[i]`` are those of pose i.

    Attributes:
        point: (k, 3) float64, m: the contacts of all poses, in their order.
        normal: (k, 3) float64, of the ground at these points; length 1, upwards.
        first: (n + 1,) int64, the first contact of each pose; then their number.
    """

    def __init__(self, point: np.ndarray, normal: np.ndarray, first: np.ndarray) -> None:
        self.point, self.normal, self.first = point, normal, first

    def __len__(self) -> int:
        return len(self.first) - 1

    def __getitem__(self, index: int) -> Contacts:
        i = range(len(self))[index]
        part = slice(self.first[i], self.first[i + 1])
        return Contacts(self.point[part], self.normal[part], np.array([0, part.stop - part.start]))

    def __repr__(self) -> str:
        return f"Contacts({len(self.point)} of {len(self)} poses)"


class Spawns(Table):
    """Valid poses of ``World.sample`` and ``World.search``, in the order in which they were found.

    Attributes:
        pose: (n, 7) float64: x, y, z in m and a quaternion x, y, z, w. Settled robots are raised by the option
            ``lift`` (0.02 m).
        roll, pitch, yaw: (n,) float64, rad, as in URDF's rpy.
        tilt, margin: (n,) float64, rad and m, only of settled robots; see docs/standing.md.
        clearance, head_room, …: (n,) float64, those of the option ``columns``; see docs/places.md. ``clearance`` and
            ``way`` (m) are also columns of ``yaw="best:K:clearance"`` and ``yaw="along"``.
        counts: number of judged positions for each verdict, by its name.
        draws: number of drawn positions, also those that were not judged.
        is_full: fewer spawns than wanted were found, and it is proven that no other one fits.
        undecided_area: m2 in which another one may fit; NaN if nothing is proven.
    """

    def __init__(
        self, found: _core.FoundSpawns, summary: Mapping[str, Any], settle: Callable[[Spawns], Verdicts]
    ) -> None:
        super().__init__(found.columns(), summary)
        self._found = found
        self._settle = settle
        facts = found.facts()
        self.counts: dict[str, int] = facts["counts"]
        self.draws: int = facts["draws"]
        self.is_full: bool = facts["is_full"]
        self.undecided_area: float = facts["undecided_area"]

    @property
    def position(self) -> np.ndarray:
        """(n, 3) float64, m: a view of `pose`."""
        return self.pose[:, :3]

    @property
    def verdict(self) -> np.ndarray:
        """(n,) uint8: all are VALID."""
        return np.full(len(self), VALID, np.uint8)

    @functools.cached_property
    def contacts(self) -> Contacts:
        """Where the robots touch the ground if they are let down at the spawns. They are let down when this is asked
        for first."""
        return self._settle(self).contacts

    def to_csv(self, file: str | os.PathLike[str] | None = None) -> bytes:
        """Returns the CSV file that ``spawnfield sample`` writes, and writes it to `file` if that is given."""
        return write_bytes(self._found.csv(), file)


class Pairs(Table):
    """Starts and goals of ``World.sample(pairs=N)``.

    Attributes:
        start, goal: (n, 7) float64: x, y, z in m and a quaternion x, y, z, w.
        path_length, straight, detour: (n,) float64: length of the path, m; of the straight line, m; and their ratio.
        island: (n,) int64, its number in ``World.info(robot, islands=True)``, 0 for the largest.
    """

    def __init__(self, found: _core.FoundPairs, summary: Mapping[str, Any]) -> None:
        super().__init__(found.columns(), summary)
        self._found = found

    @property
    def paths(self) -> list[np.ndarray]:
        """For each pair the poses of its path, (k, 7) float64, as ``start``. Empty arrays unless the option ``path``
        was given."""
        return self._found.paths()


class Fleet(Table):
    """Robots of ``World.sample(fleet=FILE)`` or ``World.sample(robot, fill=True)``, which do not overlap.

    Attributes:
        pose: (n, 7) float64: x, y, z in m and a quaternion x, y, z, w.
        roll, pitch, yaw, tilt, margin: (n,) float64, as of Spawns.
        kind: (n,) int64, index in `kinds`.
        names: the names of the robots, n texts.
        kinds: the names of the kinds of robots.
    """

    def __init__(self, found: _core.FoundFleet, summary: Mapping[str, Any]) -> None:
        super().__init__(found.columns(), summary)
        self.names: list[str] = found.names()
        self.kinds: list[str] = found.kinds()


class Verdicts(Table):
    """The verdicts of ``World.check``, one for each pose.

    Attributes:
        code: (n,) uint8, see `VERDICTS`.
        ground: (n,) float64, height of the ground below the pose, m; NaN: there is none.
        hit_part: (n,) int64, index of the part of the map that the robot meets, whose name `hit` has; -1: none; -2: a
            voxel of the map.
        settled: (n, 7) float64, only of settled robots: the pose at rest, not raised; NaN: it has no room.
        tilt, tip_over: (n,) float64, rad, only of settled robots; see docs/standing.md.
        margin, belly: (n,) float64, m, only of settled robots.
        repair, repair_distance: (n, 7) and (n,) float64, only with the option ``repair``: the nearest valid pose, and
            how far it is, m; NaN: the pose is valid, or there is none.
    """

    def __init__(
        self, found: _core.FoundVerdicts, summary: Mapping[str, Any], poses: np.ndarray | None = None
    ) -> None:
        super().__init__(found.columns(), summary)
        self._found = found
        self._poses = poses  # None: the table of the poses has their text

    @property
    def valid(self) -> np.ndarray:
        """(n,) bool: whether the verdict is "valid"."""
        return self.code == VALID

    @property
    def name(self) -> list[str]:
        """The verdict of each pose in words: "valid", "collision", …"""
        return [VERDICTS[code] for code in self.code.tolist()]

    @property
    def hit(self) -> list[str]:
        """The part of the world that the robot meets at each pose; "" if it meets none, or if that is not known."""
        return [self._part_names[part] for part in self.hit_part.tolist()]

    def _words(self, i: int) -> dict[str, str]:
        hit = self._part_names[int(self.hit_part[i])]
        return {"name": VERDICTS[int(self.code[i])], "hit": hit, "reason": self._found.reason(i)}

    @functools.cached_property
    def _part_names(self) -> dict[int, str]:
        return {-1: "", -2: "occupancy", **dict(enumerate(self._found.parts()))}

    @property
    def reason(self) -> list[str]:
        """The verdict of each pose and its cause in words, for example "collision with thin_wall"."""
        return [self._found.reason(i) for i in range(len(self))]

    @functools.cached_property
    def contacts(self) -> Contacts:
        """Where the robots touch the ground at their settled poses. None for poses that were not let down (option
        ``settle``), or that have no pose at rest."""
        return Contacts(**self._found.contacts())

    def to_csv(self, file: str | os.PathLike[str] | None = None) -> bytes:
        """Returns the CSV file that ``spawnfield check`` writes, and writes it to `file` if that is given."""
        return write_bytes(self._found.csv() if self._poses is None else self._found.csv(self._poses), file)

    def to_pandas(self) -> Any:
        """The same as for other tables, with the columns ``verdict`` (in words), ``hit`` and ``reason`` before them."""
        frame = super().to_pandas()
        for k, (name, values) in enumerate({"verdict": self.name, "hit": self.hit, "reason": self.reason}.items()):
            frame.insert(k, name, values)
        return frame


class Raster(Table):
    """The verdicts of ``World.raster``: one row for each pose, as in the CSV file.

    Attributes:
        pose: (n, 7) float64: x, y, z in m and a quaternion x, y, z, w.
        verdict: (n,) uint8, see `VERDICTS`.
        layer: (n,) int32: the layer of ground, 0 is the highest; -1: the ground is not a layer.
        row, col: (n,) int32, place in the grid: y = y0 + row * step, x = x0 + col * step.
        roll, pitch, yaw, tilt, tip_over: (n,) float64, rad, only of settled robots; see docs/standing.md.
        layer_height, margin, belly: (n,) float64, m, only of settled robots.
        grid: dictionary of x0, y0, z0, step, step_z (m), cols, rows, heights, dims.
        counts: number of poses for each verdict, by its name; of 3D rasters also of those without a row.
    """

    def __init__(self, found: _core.FoundRaster, summary: Mapping[str, Any], threads: int) -> None:
        super().__init__(found.columns(), summary)
        self._found = found
        self._threads = threads
        self.grid: dict[str, Any] = found.facts()
        self.counts: dict[str, int] = self.grid.pop("counts")

    def _levels(self) -> np.ndarray:
        """(n,) int: of 2D rasters, how many poses of the same column come before; of 3D rasters, the number of the
        height."""
        if self.grid["dims"] == 3:
            return np.rint((self.pose[:, 2] - self.grid["z0"]) / self.grid["step_z"]).astype(np.int64)
        columns = self.row.astype(np.int64) * self.grid["cols"] + self.col
        first = np.flatnonzero(np.diff(columns, prepend=-1))
        return np.arange(len(columns)) - np.repeat(first, np.diff(first, append=len(columns)))

    def image(self, name: str = "verdict", fill: float | None = None) -> np.ndarray:
        """Returns a column as an image.

        Args:
            name: of the column; "z" for the height of the robot's origin, m.
            fill: the value of places without a pose: by default NaN, or 255 for verdicts.

        Returns:
            (levels, rows, cols), uint8 for verdicts, float64 for other columns; y ascends along the rows. For 2D
            rasters, level 0 has the highest pose of each column. For 3D rasters, levels are heights; poses that
            ``snap`` put between two of them have the nearest one, and free poses high above the ground have no row.
        """
        values = self.pose[:, 2] if name == "z" else self.columns[name]
        if fill is None:
            fill = 255 if name == "verdict" else np.nan
        level = self._levels()
        levels = self.grid["heights"] if self.grid["dims"] == 3 else int(level.max(initial=-1)) + 1
        dtype = values.dtype if name == "verdict" else float
        out = np.full((max(levels, 1), self.grid["rows"], self.grid["cols"]), fill, dtype)
        out[np.clip(level, 0, max(levels, 1) - 1), self.row, self.col] = values
        return out

    def to_xarray(self) -> Any:
        """Returns an xarray.Dataset with the dimensions level (2D) or z (3D), y and x, and units. Needs xarray."""
        import xarray as xr

        grid = self.grid
        is_3d = grid["dims"] == 3
        units = {"z": "m", "layer_height": "m", "tilt": "rad", "margin": "m", "tip_over": "rad", "belly": "m",
                 "roll": "rad", "pitch": "rad", "yaw": "rad"}  # fmt: skip
        first = "z" if is_3d else "level"
        names = ["verdict", *(n for n in ("z", *self.columns) if n in units and not (is_3d and n == "z"))]
        data = {}
        for name in names:
            attributes = {"units": units[name]} if name in units else {
                "flag_values": np.array(list(VERDICTS), np.uint8), "flag_meanings": " ".join(VERDICTS.values()),
            }  # fmt: skip
            data[name if name != "z" else "height"] = ((first, "y", "x"), self.image(name), attributes)
        levels = next(iter(data.values()))[1].shape[0]
        metres = {"units": "m"}
        coordinates = {
            "x": ("x", grid["x0"] + grid["step"] * np.arange(grid["cols"]), metres),
            "y": ("y", grid["y0"] + grid["step"] * np.arange(grid["rows"]), metres),
            first: (first, grid["z0"] + grid["step_z"] * np.arange(levels), metres) if is_3d
            else (first, np.arange(levels)),
        }  # fmt: skip
        return xr.Dataset(data, coordinates, {"frame": "x forward, y left, z up (REP-103)"})

    def to_csv(self, file: str | os.PathLike[str] | None = None, write_aerial: bool = False) -> bytes:
        """Returns the CSV file that ``spawnfield raster`` writes, and writes it to `file` if that is given.
        `write_aerial`: also rows of ``aerial`` poses of 3D rasters."""
        return write_bytes(self._found.csv(write_aerial, self._threads), file)


class Page:
    """The review page of a world (docs/review.md). A notebook shows it if it is the last value of a cell.

    Attributes:
        html: the text of the file.
        summary: the summary of the query, as of ``--summary``.
    """

    def __init__(self, html: str, summary: Mapping[str, Any]) -> None:
        self.html = html
        self.summary = dict(summary)

    def __repr__(self) -> str:
        return f"Page({len(self.html)} bytes)"

    def _repr_html_(self) -> str:
        # A frame of its own: neither the page nor the notebook changes the other.
        return (f'<iframe title="spawnfield review" style="width: 100%; height: 640px; border: 0" '
                f'srcdoc="{escape(self.html)}"></iframe>')  # fmt: skip

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the file, completely or not at all. Raises OSError."""
        write_bytes(self.html.encode(), file)


class Picture:
    """A picture. A notebook shows it if it is the last value of a cell.

    Attributes:
        data: the bytes of the file.
        format: "png", "svg" or "pdf".
        summary: the summary of the query, as of ``--summary``.
    """

    def __init__(self, data: bytes, format: str, summary: Mapping[str, Any]) -> None:
        self.data = data
        self.format = format
        self.summary = dict(summary)

    def __repr__(self) -> str:
        return f"Picture({self.format}, {len(self.data)} bytes)"

    def _repr_png_(self) -> bytes | None:
        return self.data if self.format == "png" else None

    def _repr_svg_(self) -> str | None:
        return self.data.decode() if self.format == "svg" else None

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the file, completely or not at all. Raises OSError, or ArgumentError if its ending is that of another
        format."""
        ending = Path(file).suffix.lower().lstrip(".")
        if ending in ("png", "svg", "pdf") and ending != self.format:
            raise ArgumentError(f'--format of the picture is "{self.format}"; make one with format="{ending}"')
        write_bytes(self.data, file)

    def show(self) -> None:
        """Shows the picture: in a notebook, or with the program that the desktop has for such files. Without a desktop,
        prints the name of a temporary file with the picture."""
        if _is_notebook() and self.format != "pdf":  # notebooks do not show PDF
            from IPython.display import display

            display(self)
            return
        handle, name = tempfile.mkstemp(f".{self.format}", "spawnfield-")
        with os.fdopen(handle, "wb") as file:
            file.write(self.data)
        if not _opens_on_desktop(name):
            print(f"the picture is in {name}")

    def axis(self, ax: Any = None) -> Any:
        """Draws the picture on an axis of matplotlib. Needs matplotlib.

        Args:
            ax: the axis; None: that of a new figure, which ``matplotlib.pyplot.show()`` shows.

        Returns:
            The axis.

        Raises:
            ArgumentError: the picture is not a PNG.
        """
        if self.format != "png":
            raise ArgumentError(f'--format is "{self.format}", needs png for an axis')
        import matplotlib.image
        import matplotlib.pyplot

        if ax is None:
            ax = matplotlib.pyplot.figure(layout="constrained").add_subplot()
        ax.imshow(matplotlib.image.imread(io.BytesIO(self.data), format="png"))
        ax.set_axis_off()
        return ax


def _is_notebook() -> bool:
    """Returns whether a notebook runs this: it has imported IPython, and its shell has a kernel."""
    ipython = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def _opens_on_desktop(file: str) -> bool:
    """Opens a file with the program that the desktop has for it. Returns whether there is a desktop that can."""
    has_screen = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    opener = shutil.which("xdg-open")
    if not has_screen or opener is None:
        return False
    subprocess.Popen(
        [opener, file], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True,
    )  # fmt: skip
    return True
