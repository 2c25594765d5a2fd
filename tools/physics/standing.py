#!/usr/bin/env python3
"""Compares settled poses with the physics engine Bullet: do robots stay where spawnfield says that they stand?

    standing.py SPAWNFIELD ROBOT COUNT MAP... > table.md

For each map, COUNT settled spawns (`sample --settle`) and COUNT random places (`check --settle`) with random yaws are
put into Bullet: the robot as one rigid body of all its parts with its centre of mass, raised by 2 cm, with friction 0.8
(1.0 for the ground). A robot stays if it is within 5 cm and 3 degrees of its settled pose after two seconds. Needs the
Python packages pybullet and numpy. Prints one Markdown table row for each map.
"""
import csv
import io
import json
import math
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pybullet

LIFT, FRICTION, SECONDS = 0.02, 0.8, 2
NEAR, TURNED = 0.05, math.radians(3)


def spawnfield(program, *arguments):
    """Returns what a command writes to standard output."""
    run = subprocess.run([program, *map(str, arguments), "--quiet"], capture_output=True, text=True)
    if run.returncode not in (0, 3):
        sys.exit(f"standing.py: {' '.join(map(str, run.args))}: {run.stderr}")
    return run.stdout


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def write_ground(program, map_folder, file):
    """Writes the solid surfaces of a map as an OBJ file in the map's frame. Returns the triangles of each obstacle."""
    glb = file.with_suffix(".glb")
    spawnfield(program, "export", map_folder, "--format", "glb", "-o", glb)
    data = glb.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    document, binary = json.loads(data[20:20 + length]), data[28 + length:]

    def array(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5125: "<u4", 5123: "<u2", 5121: "<u1"}[accessor["componentType"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        width = 3 if accessor["type"] == "VEC3" else 1
        return np.frombuffer(binary, kind, accessor["count"] * width, start).reshape(-1, width)

    obstacles = []
    with file.open("w") as out:
        count = 0

        def visit(node, parent):
            nonlocal count
            matrix = parent @ matrix_of(node)
            if "mesh" in node:
                for primitive in document["meshes"][node["mesh"]]["primitives"]:
                    if document["materials"][primitive["material"]]["name"] == "water":
                        continue
                    points = array(primitive["attributes"]["POSITION"]).astype(float)
                    points = points @ matrix[:3, :3].T + matrix[:3, 3]
                    corners = array(primitive["indices"]).ravel() if "indices" in primitive else range(len(points))
                    for x, y, z in points:  # from glTF's y up to z up
                        out.write(f"v {x:.9g} {-z:.9g} {y:.9g}\n")
                    faces = np.asarray(corners).reshape(-1, 3)
                    for a, b, c in faces:
                        out.write(f"f {count + a + 1} {count + b + 1} {count + c + 1}\n")
                    if document["materials"][primitive["material"]]["name"] == "obstacle":
                        upright = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
                        obstacles.append(upright[faces])
                    count += len(points)
            for child in node.get("children", []):
                visit(document["nodes"][child], matrix)

        for root in document["scenes"][0]["nodes"]:
            visit(document["nodes"][root], np.eye(4))
    return obstacles


def is_inside(obstacles, point):
    """Returns whether a vertical line from a point upwards leaves some obstacle once more often than it enters it."""
    for triangles in obstacles:
        a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
        near = (triangles[:, :, :2].min(1) <= point[:2]).all(1) & (triangles[:, :, :2].max(1) >= point[:2]).all(1)
        a, b, c = a[near], b[near], c[near]
        if not len(a):
            continue

        def side(p, q):
            return (q[:, 0] - p[:, 0]) * (point[1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (point[0] - p[:, 0])

        weights = np.stack([side(b, c), side(c, a), side(a, b)], axis=1)
        over = (weights > 0).all(1) | (weights < 0).all(1)
        weights = weights[over] / weights[over].sum(1, keepdims=True)
        heights = (weights * np.stack([a[over, 2], b[over, 2], c[over, 2]], axis=1)).sum(1)
        if (heights > point[2]).sum() % 2 == 1:
            return True
    return False


def matrix_of(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    out = np.eye(4)
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    out[:3, :3] = np.array(pybullet.getMatrixFromQuaternion([x, y, z, w])).reshape(3, 3) @ np.diag(
        node.get("scale", [1, 1, 1]))
    out[:3, 3] = node.get("translation", [0, 0, 0])
    return out


def write_hull(points, file):
    """Writes the corners of a convex hull. Bullet ignores the faces, but reads only corners that belong to one."""
    faces = range(1, len(points) - 1)
    file.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in points) +
                    "".join(f"f {k} {k + 1} {k + 2}\n" for k in faces))
    return str(file)


def geometry_of(part, file):
    """Returns a URDF geometry of a part of the robot. The file is for the corners of a hull."""
    size = part.get("size")
    if part["shape"] == "box":
        return f'<box size="{size[0]} {size[1]} {size[2]}"/>'
    if part["shape"] == "sphere":
        return f'<sphere radius="{size[0]}"/>'
    if part["shape"] in ("cylinder", "capsule"):
        return f'<{part["shape"]} radius="{size[0]}" length="{size[1]}"/>'
    return f'<mesh filename="{write_hull(part["points"], file)}"/>'


def start_world():
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, -9.81)
    # By default, Bullet takes contacts of a part within 2 cm of each other for one. It may then lose the contact with
    # the triangle below a foot, because of one with the edge of another triangle that is still below it.
    pybullet.setPhysicsEngineParameter(contactBreakingThreshold=0.001)


def make_ground(program, map_folder, folder):
    """Puts the solid surfaces of a map into Bullet. Returns the triangles of each obstacle."""
    obstacles = write_ground(program, map_folder, folder / "ground.obj")
    ground = pybullet.createCollisionShape(pybullet.GEOM_MESH, fileName=str(folder / "ground.obj"),
                                           flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH)
    pybullet.changeDynamics(pybullet.createMultiBody(0, ground), -1, lateralFriction=1, restitution=0)
    return obstacles


def make_robot(info, folder):
    """Returns a rigid body of all parts of the robot, and its centre of mass in the robot's frame, m."""
    mass_center = np.array(info["mass_center"])
    size = np.array(info["bounds"]["max"]) - np.array(info["bounds"]["min"])
    ixx, iyy, izz = 50 / 12 * (size @ size - size**2)  # of a box with the robot's size and 50 kg
    link = (f'<inertial><origin xyz="{mass_center[0]} {mass_center[1]} {mass_center[2]}"/><mass value="50"/>'
            f'<inertia ixx="{ixx}" iyy="{iyy}" izz="{izz}" ixy="0" ixz="0" iyz="0"/></inertial>\n')
    for index, part in enumerate(info["parts"]):
        x, y, z = part.get("position", [0, 0, 0])
        roll, pitch, yaw = pybullet.getEulerFromQuaternion(part.get("quaternion", [0, 0, 0, 1]))
        link += (f'<collision><origin xyz="{x} {y} {z}" rpy="{roll} {pitch} {yaw}"/>'
                 f'<geometry>{geometry_of(part, folder / f"hull_{index}.obj")}</geometry></collision>\n')
    file = folder / "robot.urdf"
    file.write_text(f'<robot name="robot"><link name="base">{link}</link></robot>')
    # Without the second flag, Bullet makes prisms with 32 sides of cylinders: wheels that do not roll.
    body = pybullet.loadURDF(str(file),
                             flags=pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_USE_IMPLICIT_CYLINDER)
    pybullet.changeDynamics(body, -1, lateralFriction=FRICTION, restitution=0, linearDamping=0, angularDamping=0)
    return body, mass_center


def rotation_of(quaternion):
    return np.array(pybullet.getMatrixFromQuaternion(quaternion)).reshape(3, 3)


def stays(body, mass_center, pose):
    """Puts the robot at a settled pose (x, y, z, roll, pitch, yaw). Returns whether it is there two seconds later."""
    start = pybullet.getQuaternionFromEuler(pose[3:])
    turned = rotation_of(start)
    place = np.array(pose[:3])
    pybullet.resetBasePositionAndOrientation(body, place + [0, 0, LIFT] + turned @ mass_center, start)
    pybullet.resetBaseVelocity(body, [0, 0, 0], [0, 0, 0])
    for _ in range(240 * SECONDS):
        pybullet.stepSimulation()
    position, end = pybullet.getBasePositionAndOrientation(body)
    then = rotation_of(end)
    moved = np.linalg.norm(np.array(position) - then @ mass_center - place)
    angle = math.acos(max(-1, min(1, (np.trace(turned.T @ then) - 1) / 2)))
    return moved <= NEAR and angle <= TURNED


def settled_pose(row):
    return [float(row[key]) for key in ("x", "y", "settled_z", "settled_roll", "settled_pitch", "yaw")]


def places(program, map_folder, robot, count, folder):
    """Returns the rows of `check --settle` for random places on the ground of a map."""
    bounds = json.loads(spawnfield(program, "info", map_folder, "--json"))["bounds"]
    width, depth = (bounds["max"][axis] - bounds["min"][axis] for axis in (0, 1))
    step = math.sqrt(width * depth / (6 * count))
    rows = rows_of(spawnfield(program, "raster", map_folder, "--robot", robot, "--dims", "2", "--step", step))
    chosen = random.Random(1).sample(rows, min(count, len(rows)))
    file = folder / "places.csv"
    with file.open("w") as out:
        out.write("x,y,z,yaw\n")
        yaws = random.Random(2)
        for row in chosen:
            out.write(f"{row['x']},{row['y']},{row['z']},{yaws.uniform(-math.pi, math.pi)}\n")
    return rows_of(spawnfield(program, "check", map_folder, "--robot", robot, "--poses", file, "--settle"))


def spawns(program, map_folder, robot, count, folder):
    """Returns the rows of `check --settle` for settled spawns."""
    file = folder / "spawns.csv"
    file.write_text(spawnfield(program, "sample", map_folder, "--robot", robot, "-n", count, "--yaw", "random",
                               "--settle"))
    return rows_of(spawnfield(program, "check", map_folder, "--robot", robot, "--poses", file, "--settle"))


def share(part, whole):
    return f"{part} of {whole}" + (f" ({100 * part / whole:.2f} %)" if whole else "")


def compare(program, robot, count, map_folder):
    """Prints the row of a map."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        start_world()
        info = json.loads(spawnfield(program, "info", robot, "--json"))
        obstacles = make_ground(program, map_folder, folder)
        body, mass_center = make_robot(info, folder)
        valid = [row for row in spawns(program, map_folder, robot, count, folder) if row["verdict"] == "valid"]
        kept = sum(stays(body, mass_center, settled_pose(row)) for row in valid)
        tips, tips_moved, narrow, narrow_stay = 0, 0, 0, 0
        refused = {20: 0, 30: 0}
        standing = {20: 0, 30: 0}
        for row in places(program, map_folder, robot, count, folder):
            if not row["settled_z"] or row["verdict"] in ("outside", "aerial", "off_terrain", "submerged"):
                continue
            # Bullet's meshes are surfaces, so a robot fits into an obstacle. A pose on the layer above belongs there.
            pose = settled_pose(row)
            mass = rotation_of(pybullet.getQuaternionFromEuler(pose[3:])) @ mass_center + pose[:3]
            if row["verdict"] == "collision" and (not row["hit"] or is_inside(obstacles, mass)):
                continue
            tilt, margin = math.degrees(float(row["tilt"])), float(row["margin"])
            is_kept = stays(body, mass_center, pose)
            if row["verdict"] == "unstable" and margin > 0:
                narrow += 1
                narrow_stay += is_kept
            elif row["verdict"] == "unstable":
                tips += 1
                tips_moved += not is_kept
            if is_kept and tilt < 30:
                limit = 20 if tilt < 20 else 30
                standing[limit] += 1
                refused[limit] += row["verdict"] != "valid"
        print(f"| {info['name']} | {Path(map_folder).name} | {share(kept, len(valid))} | {share(tips_moved, tips)} | "
              f"{share(narrow_stay, narrow)} | {share(refused[20], standing[20])} | "
              f"{share(refused[30], standing[30])} |", flush=True)


def run(description, columns, compare_map):
    """Prints a table with a row for each map of the command line."""
    if len(sys.argv) < 5:
        sys.exit(description)
    program, robot, count, maps = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4:]
    pybullet.connect(pybullet.DIRECT)
    print("| " + " | ".join(columns) + " |")
    print("|---" * len(columns) + "|")
    for map_folder in maps:
        compare_map(program, robot, count, map_folder)


if __name__ == "__main__":
    run(__doc__, ["robot", "map", "spawns that stay", "tipping robots that move", "with a small margin that stay",
                  "standing at 0-20 degrees, refused", "at 20-30 degrees"], compare)
