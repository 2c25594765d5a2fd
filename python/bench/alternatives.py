"""What users write today in place of a pool: three ways to make level spawns on a mesh, in numpy.

Each takes the number of spawns and returns (n, 7) poses, as a pool: x, y, z and a quaternion x, y, z, w. They need
trimesh with embreex (or rtree, which is much slower), and python-fcl.
"""

import numpy as np
import trimesh

OFFSET = 0.1  # m between the lowest point of the robot and the ground, as in `sample --stance level`


def mesh_of(file):
    """Returns the mesh of a file of `export --format glb`, without water, in the map's frame."""
    scene = trimesh.load(file)
    for name, mesh in list(scene.geometry.items()):
        if mesh.visual.material.name == "water":
            scene.delete_geometry(name)
    mesh = scene.to_mesh()
    mesh.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0]))  # glTF has y up
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


class Alternative:
    """Rejection sampling on a mesh for a robot that is a box on its origin."""

    def __init__(self, mesh, box, seed=0):
        self.mesh = mesh
        self.box = np.array(box)
        self.random = np.random.default_rng(seed)

    def spawns(self, count):
        """Returns `count` poses. Draws as many as are missing, until all are there."""
        found = np.empty((0, 7))
        while len(found) < count:
            draws = max(64, count - len(found))
            low, high = self.mesh.bounds[:, :2]
            xy = self.random.uniform(low, high, (draws, 2))
            yaw = self.random.uniform(-np.pi, np.pi, draws)
            z, is_good = self.judge(xy, yaw)
            zero = np.zeros(draws)
            poses = np.column_stack([xy, z + OFFSET, zero, zero, np.sin(yaw / 2), np.cos(yaw / 2)])
            found = np.concatenate([found, poses[is_good]])
        return found[:count]

    def heights(self, xy):
        """Returns the highest surface at places (…, 2), m; NaN: there is none."""
        flat = xy.reshape(-1, 2)
        origins = np.column_stack([flat, np.full(len(flat), self.mesh.bounds[1, 2] + 1)])
        down = np.tile([0.0, 0, -1], (len(flat), 1))
        places, rays, _ = self.mesh.ray.intersects_location(origins, down, multiple_hits=False)
        out = np.full(len(flat), np.nan)
        out[rays] = places[:, 2]
        return out.reshape(xy.shape[:-1])

    def judge(self, xy, yaw):
        """Returns the height of the ground for each draw, and whether the robot may start there."""
        raise NotImplementedError


class RayCasting(Alternative):
    """Nine rays below the robot's box: its corners, the middles of its sides, and its middle. The ground may differ by
    at most `max_difference`; the robot stands on the highest."""

    def __init__(self, *arguments, max_difference=0.2, **options):
        super().__init__(*arguments, **options)
        self.max_difference = max_difference
        x, y = np.meshgrid(*([-s / 2, 0, s / 2] for s in self.box[:2]))
        self.below = np.column_stack([x.ravel(), y.ravel()])

    def judge(self, xy, yaw):
        c, s = np.cos(yaw), np.sin(yaw)
        turn = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
        ground = self.heights(xy[:, None] + np.einsum("nij,kj->nki", turn, self.below))
        return ground.max(axis=1), np.ptp(ground, axis=1) <= self.max_difference


class FlatPatches(Alternative):
    """Isaac Lab's `find_flat_patches`, from its description: ten points on a ring of the patch's radius. If their
    heights differ by more than `max_height_diff`, the patch is drawn again. The patch has the height of its last point.

    The ring is around the corners of the robot; on a slope within the limit, the robot does not touch the ground."""

    def __init__(self, *arguments, patch_radius=0.6, max_height_diff=OFFSET, **options):
        super().__init__(*arguments, **options)
        self.max_height_diff = max_height_diff
        angle = np.linspace(0, 2 * np.pi, 10)
        self.ring = patch_radius * np.column_stack([np.cos(angle), np.sin(angle)])

    def judge(self, xy, yaw):
        ground = self.heights(xy[:, None] + self.ring)
        return ground[:, -1], np.ptp(ground, axis=1) <= self.max_height_diff


class Fcl(Alternative):
    """One ray finds the ground below the robot's middle; FCL says whether its box touches the mesh there."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        import fcl

        self.fcl = fcl
        model = fcl.BVHModel()
        model.beginModel(len(self.mesh.vertices), len(self.mesh.faces))
        model.addSubModel(self.mesh.vertices, self.mesh.faces)
        model.endModel()
        self.world = fcl.CollisionObject(model)
        self.robot = fcl.CollisionObject(fcl.Box(*self.box))

    def judge(self, xy, yaw):
        ground = self.heights(xy)
        is_free = np.zeros(len(xy), bool)
        for i in np.flatnonzero(np.isfinite(ground)):
            middle = [*xy[i], ground[i] + OFFSET + self.box[2] / 2]
            turn = np.array([np.cos(yaw[i] / 2), 0, 0, np.sin(yaw[i] / 2)])  # w, x, y, z
            self.robot.setTransform(self.fcl.Transform(turn, np.array(middle)))
            is_free[i] = self.fcl.collide(self.robot, self.world) == 0
        return ground, is_free
