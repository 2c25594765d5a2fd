"""Scenes that are made in memory."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import _core
from .errors import ArgumentError, translated

LABELS = ("terrain", "obstacle", "water")


class Scene:
    """A world of labelled parts, in metres, z up. `bake` makes a map of it.

    Labels are "terrain" (robots may stand on it), "obstacle" and "water". All ``add_…`` methods return the scene
    itself, so calls can be chained. They raise `ArgumentError` for wrong labels, shapes and numbers.

    Args:
        name: of the scene.
    """

    def __init__(self, name: str = "scene") -> None:
        self._core = _core.Scene()
        self._core.name = name

    def __repr__(self) -> str:
        return f"Scene({self._core.name!r}: {len(self.part_names)} parts)"

    @property
    def part_names(self) -> list[str]:
        """The names of the parts, in the order in which they were added."""
        return self._core.part_names()

    def add_mesh(
        self,
        vertices: Any,
        faces: Any,
        label: str | Sequence[str] = "obstacle",
        name: str = "mesh",
        solid: str = "auto",
    ) -> Scene:
        """Adds a mesh.

        Args:
            vertices: (n, 3) numbers, m, in the scene's frame.
            faces: (m, 3) indices of vertices, counterclockwise seen from outside.
            label: one label, or one for each face. Faces of different labels become parts of their own, NAME.LABEL;
                each is solid only if it is watertight alone.
            name: of the part, for messages and for rules such as ``near``.
            solid: "auto": the inside of watertight pieces is solid; "yes": of all pieces; "no": faces have no
                thickness.
        """
        vertices = np.ascontiguousarray(_host_array(vertices), np.float64)
        faces = np.ascontiguousarray(_host_array(faces), np.int64)
        if isinstance(label, str):
            return self._add(name, label, vertices, faces, solid)
        labels = np.asarray(label)
        if labels.shape != (len(faces),):
            raise ArgumentError(f"--label has {labels.size} labels for {len(faces)} faces; give one for each, or one")
        for one in LABELS:
            if (labels == one).any():
                self._add(f"{name}.{one}", one, vertices, np.ascontiguousarray(faces[labels == one]), solid)
        if unknown := sorted(set(labels.tolist()) - {*LABELS, "ignore"}):
            raise ArgumentError(f"--label has {unknown[0]!r}, needs terrain, obstacle, water or ignore")
        return self

    def add_trimesh(self, mesh: Any, label: str | Sequence[str] = "obstacle", name: str | None = None) -> Scene:
        """Adds a trimesh.Trimesh, or each mesh of a trimesh.Scene with the name of its node.

        Args:
            mesh: the mesh or scene, m, z up.
            label: one label, or one for each face.
            name: of the part of a Trimesh; default: "mesh".
        """
        if not hasattr(mesh, "geometry"):
            return self.add_mesh(mesh.vertices, mesh.faces, label, name or "mesh")
        for node in mesh.graph.nodes_geometry:
            transform, geometry = mesh.graph[node]
            placed = mesh.geometry[geometry].copy()
            placed.apply_transform(transform)
            self.add_mesh(placed.vertices, placed.faces, label, node)
        return self

    def add_heights(
        self, heights: Any, transform: Any = None, label: str = "terrain", name: str = "heights"
    ) -> Scene:
        """Adds a surface through a grid of heights.

        Args:
            heights: (rows, cols) numbers, m; NaN: there is no surface.
            transform: (a, b, c, d, e, f) of the affine transform from the corner of a cell, (col, row), to the world,
                x = a col + b row + c, y = d col + e row + f, as rasterio's ``dataset.transform``. Heights are those at
                the centres of the cells. Default: x = col, y = -row.
            label: of the surface.
            name: of the part.
        """
        grid = np.asarray(_host_array(heights), np.float64)
        if grid.ndim != 2 or min(grid.shape) < 2:
            raise ArgumentError(f"--heights has the shape {grid.shape}, needs at least 2 rows and 2 columns")
        a, b, c, d, e, f = tuple(transform)[:6] if transform is not None else (1, 0, 0, 0, -1, 0)
        row, col = np.meshgrid(np.arange(grid.shape[0]) + 0.5, np.arange(grid.shape[1]) + 0.5, indexing="ij")
        vertices = np.stack([a * col + b * row + c, d * col + e * row + f, grid], -1).reshape(-1, 3)
        index = np.arange(grid.size).reshape(grid.shape)
        corners = [index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]]
        faces = np.concatenate(
            [
                np.stack([corners[0], corners[2], corners[1]], -1).reshape(-1, 3),
                np.stack([corners[1], corners[2], corners[3]], -1).reshape(-1, 3),
            ]
        )
        if a * e - b * d > 0:  # rows go up: turn the faces, so that they look up
            faces = faces[:, ::-1]
        faces = faces[~np.isnan(vertices[faces, 2]).any(axis=1)]
        used, faces = np.unique(faces, return_inverse=True)
        return self._add(name, label, np.ascontiguousarray(vertices[used]),
                         np.ascontiguousarray(faces.reshape(-1, 3), np.int64), "no")  # fmt: skip

    def add_box(self, size: Sequence[float], xyz: Sequence[float] = (0, 0, 0), yaw: float = 0,
                label: str = "obstacle", name: str = "box") -> Scene:  # fmt: skip
        """Adds a solid box.

        Args:
            size: side lengths along x, y and z, m.
            xyz: its centre, m.
            yaw: rotation about the vertical, rad, counterclockwise seen from above.
            label: its label.
            name: of the part.
        """
        return self._add_solid(name, label, "box", size, xyz, yaw)

    def add_cylinder(self, radius: float, length: float, xyz: Sequence[float] = (0, 0, 0),
                     label: str = "obstacle", name: str = "cylinder") -> Scene:  # fmt: skip
        """Adds a solid upright cylinder.

        Args:
            radius: m.
            length: along z, m.
            xyz: its centre, m.
            label: its label.
            name: of the part.
        """
        return self._add_solid(name, label, "cylinder", (radius, length, 0), xyz, 0)

    def add_sphere(self, radius: float, xyz: Sequence[float] = (0, 0, 0), label: str = "obstacle",
                   name: str = "sphere") -> Scene:  # fmt: skip
        """Adds a solid sphere.

        Args:
            radius: m.
            xyz: its centre, m.
            label: its label.
            name: of the part.
        """
        return self._add_solid(name, label, "sphere", (radius, 0, 0), xyz, 0)

    def _add(self, name: str, label: str, vertices: np.ndarray, faces: np.ndarray, solid: str) -> Scene:
        try:
            self._core.add_triangles(name, label, vertices, faces, solid)
        except _core.ArgumentError as error:
            raise translated(error) from None
        return self

    def _add_solid(self, name: str, label: str, kind: str, size: Sequence[float], xyz: Sequence[float],
                   yaw: float) -> Scene:  # fmt: skip
        pose = np.array([[*xyz, yaw]], np.float64)
        try:
            a, b, c = map(float, size)
            self._core.add_solid(name, label, kind, a, b, c, pose)
        except _core.ArgumentError as error:
            raise translated(error) from None
        return self


def _host_array(values: Any) -> Any:
    """Returns values as numpy can read them, without a copy if possible; also those of other libraries with DLPack."""
    if isinstance(values, np.ndarray) or not hasattr(values, "__dlpack__"):
        return np.asarray(values)
    return np.from_dlpack(values.cpu() if hasattr(values, "cpu") else values)


def scene_of(thing: Any) -> Scene | None:
    """Returns the scene that something in memory is: a Scene, a trimesh.Trimesh or trimesh.Scene, or a pair of vertices
    and faces. None: it is the name of a file."""
    if isinstance(thing, Scene):
        return thing
    scene = Scene()
    if (hasattr(thing, "vertices") and hasattr(thing, "faces")) or hasattr(thing, "geometry"):
        scene.add_trimesh(thing, "terrain")
    elif isinstance(thing, tuple) and len(thing) == 2:
        scene.add_mesh(*thing, "terrain")
    else:
        return None
    scene._core.is_unlabelled = True  # as a mesh file without labels
    return scene
