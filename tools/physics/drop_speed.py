#!/usr/bin/env python3
"""Compares the speed of settled poses with dropping the same robot in the physics engine Bullet, on one core each.

    drop_speed.py SPAWNFIELD ROBOT COUNT MAP...

COUNT random places of each map: `check --settle --threads 1`, the whole process, and the same places in Bullet, where
the level robot falls from DROP above the ground until it hardly moves for STILL_STEPS steps, or for two seconds. Both
times include all places, also those where the robot cannot stand. Of Bullet, only the simulation is timed, not the
start. Prints a Markdown table row for each map. Needs the Python packages pybullet and numpy.
"""
import json
import tempfile
import time
from pathlib import Path

import numpy as np
import pybullet

import standing

DROP = 0.1  # m
STILL_STEPS, SLOW, SLOW_TURN = 24, 0.01, 0.02  # steps of 1/240 s, m/s, rad/s
TIMED = 20  # times as many places for spawnfield, so that its start counts little


def fall(body, mass_center, row):
    """Drops the robot. Returns the number of steps until it rests, at most those of two seconds."""
    turned = pybullet.getQuaternionFromEuler([0, 0, float(row["yaw"])])
    place = [float(row["x"]), float(row["y"]), float(row["z"]) + DROP]
    pybullet.resetBasePositionAndOrientation(body, place + standing.rotation_of(turned) @ mass_center, turned)
    pybullet.resetBaseVelocity(body, [0, 0, 0], [0, 0, 0])
    still = 0
    for step in range(240 * standing.SECONDS):
        pybullet.stepSimulation()
        velocity, spin = pybullet.getBaseVelocity(body)
        still = still + 1 if np.dot(velocity, velocity) < SLOW**2 and np.dot(spin, spin) < SLOW_TURN**2 else 0
        if still == STILL_STEPS:
            return step
    return 240 * standing.SECONDS


def compare(program, robot, count, map_folder):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        standing.start_world()
        info = json.loads(standing.spawnfield(program, "info", robot, "--json"))
        standing.make_ground(program, map_folder, folder)
        body, mass_center = standing.make_robot(info, folder)
        rows = standing.places(program, map_folder, robot, TIMED * count, folder)
        begin = time.perf_counter()
        standing.spawnfield(program, "check", map_folder, "--robot", robot, "--poses", folder / "places.csv",
                            "--settle", "--threads", "1")
        ours = (time.perf_counter() - begin) / len(rows)
        dropped = rows[:count]
        begin = time.perf_counter()
        steps = sum(fall(body, mass_center, row) for row in dropped)
        bullet = (time.perf_counter() - begin) / len(dropped)
        print(f"| {info['name']} | {Path(map_folder).name} | {1e6 * ours:.0f} us | {1e3 * bullet:.1f} ms "
              f"({steps / len(dropped):.0f} steps) | {bullet / ours:.0f} |", flush=True)


if __name__ == "__main__":
    standing.run(__doc__, ["robot", "map", "settled pose", "Bullet", "times as fast"], compare)
