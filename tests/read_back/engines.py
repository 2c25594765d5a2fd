"""Checks files for CARLA, Unreal and Unity: by the rules of these programs they must give the true poses."""
import csv
import json
import math

from truth import FOLDER, ROBOTS, check_pose, from_quaternion, from_rpy, multiply, transpose

# The columns are the directions forward, left and up of REP-103 in the axes of the other program.
UNREAL = [[1, 0, 0], [0, -1, 0], [0, 0, 1]]
UNITY = [[0, -1, 0], [0, 0, 1], [1, 0, 0]]


def unreal_axes(roll, pitch, yaw):
    """Returns the axes forward, right and up of an Unreal rotator, in degrees.

    Yaw turns forward to the right, then pitch lifts it, then roll turns about it.
    """
    r, p, y = (math.radians(a) for a in (roll, pitch, yaw))
    turn = [[math.cos(y), -math.sin(y), 0], [math.sin(y), math.cos(y), 0], [0, 0, 1]]   # turns x to y
    lift = [[math.cos(p), 0, -math.sin(p)], [0, 1, 0], [math.sin(p), 0, math.cos(p)]]   # turns x to z
    lower = [[1, 0, 0], [0, math.cos(r), math.sin(r)], [0, -math.sin(r), math.cos(r)]]  # turns right to down
    return multiply(turn, multiply(lift, lower))


def back(position, rotation, world, body, unit=1):
    """Returns position and rotation in REP-103: world^T p and world^T R body."""
    turned = multiply(transpose(world), multiply(rotation, body))
    return [sum(world[k][i] * position[k] for k in range(3)) / unit for i in range(3)], turned


def rows(name):
    with open(FOLDER / name, newline='') as file:
        return list(csv.DictReader(file))


carla = json.loads((FOLDER / 'carla.json').read_text())
assert 'left-handed' in carla['frame']
for robot, transform in zip(ROBOTS, carla['transforms'], strict=True):
    assert (transform['id'], transform['type']) == (robot['name'], 'vehicle.audi.tt')
    place = [transform['location'][a] for a in 'xyz']
    check_pose(robot, *back(place, unreal_axes(**transform['rotation']), UNREAL, UNREAL))

for robot, thing in zip(ROBOTS, json.loads((FOLDER / 'objects.json').read_text())['objects'], strict=True):
    assert (thing['id'], thing['type'], thing['sensors']) == (robot['name'], 'vehicle.audi.tt', [])
    point = thing['spawn_point']
    check_pose(robot, [point[a] for a in 'xyz'], from_rpy(*(math.radians(point[a]) for a in ('roll', 'pitch', 'yaw'))))

for robot, row in zip(ROBOTS, rows('unreal.csv'), strict=True):
    assert row['Name'] == robot['name']
    place = [float(row[a]) for a in 'XYZ']
    axes = unreal_axes(float(row['Roll']), float(row['Pitch']), float(row['Yaw']))
    check_pose(robot, *back(place, axes, UNREAL, UNREAL, 100))

# A world that Unity exported as glTF has x negated. It was baked with y up as (x, -z, y). This matrix leads back to
# Unity.
GLTF = [[-1, 0, 0], [0, 0, 1], [0, -1, 0]]
for name, world in (('unity.csv', UNITY), ('unity_gltf.csv', GLTF)):
    for robot, row in zip(ROBOTS, rows(name), strict=True):
        assert row['name'] == robot['name']
        rotation = from_quaternion(*(float(row['q' + a]) for a in 'wxyz'))
        check_pose(robot, *back([float(row[a]) for a in 'xyz'], rotation, world, UNITY))
