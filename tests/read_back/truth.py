"""Reads the true poses that spawnfield_read_back wrote, and compares poses with them (tolerance 1e-9)."""
import json
import math
import pathlib
import sys

FOLDER = pathlib.Path(sys.argv[1])
ROBOTS = json.loads((FOLDER / 'truth.json').read_text())
URDF = '/opt/a robot\'s <home> & "more"/husky.urdf'

MODELS = ["/opt/a robot's/husky.urdf", '/opt/cart.sdf']  # of fleets, in turn


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def transpose(a):
    return [list(row) for row in zip(*a)]


def from_rpy(roll, pitch, yaw):
    """Returns the rotation about the fixed axes x, y and z."""
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    x = [[1, 0, 0], [0, cr, -sr], [0, sr, cr]]
    y = [[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]]
    z = [[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]
    return multiply(z, multiply(y, x))


def from_quaternion(w, x, y, z):
    assert abs(w * w + x * x + y * y + z * z - 1) < 1e-12
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def check_pose(robot, position, rotation, tolerance=1e-9):
    for ours, theirs in zip(robot['position'], position):
        assert abs(ours - theirs) <= tolerance, (robot['name'], robot['position'], position)
    for our_row, their_row in zip(robot['rotation'], rotation):
        for ours, theirs in zip(our_row, their_row):
            assert abs(ours - theirs) <= tolerance, (robot['name'], robot['rotation'], rotation)
