"""First steps: bake a map, sample spawns, judge poses, and draw a picture.

Run it from the project's folder: python python/examples/first_steps.py
"""

from pathlib import Path

import numpy as np

import spawnfield as sf

project = Path(__file__).resolve().parents[2]
world = sf.bake(project / "maps/training/scene.yaml", "out/python-training")
robot = sf.Robot(project / "maps/robots/husky.yaml")

spawns = world.sample(robot, 100, min_distance=1.0, yaw="random", seed=7)
print(f"{len(spawns)} spawns; the first is at {np.round(spawns.pose[0, :3], 3)} m")

poses = [[0, 0, 0.3], [7, 7, 0.1], [5.6, 0.0, 0.1]]  # x, y, z; also with yaw, rpy or a quaternion
verdicts = world.check(robot, poses, settle=True, repair=2.0)
for pose, reason, distance in zip(poses, verdicts.reason, verdicts.repair_distance):
    print(pose, reason, "" if np.isnan(distance) else f"(a valid pose is {distance:.2f} m away)")

grid = world.raster(robot, step=0.25)
print(f"{grid.counts['valid']} of {len(grid)} poses of the raster are valid; image {grid.image().shape}")

world.heatmap(robot, spawns=spawns, yaw=0).save("out/python-training.png")
print("see out/python-training.png")
