#!/usr/bin/env python3
"""Draws robots at rest in a map, seen by a camera.

For each pose of a CSV file, `spawnfield check --settle` lets the robot down onto the ground. The picture shows the
robots where they come to rest, also those that are not valid. For each robot, the script prints the verdict, roll,
pitch, margin and belly clearance. The same map, robot, poses and options give the same picture.
"""
import argparse
import csv
import io
import json
import math
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pybullet
import trimesh
from PIL import Image

EXAMPLE = """example:
  pip install numpy pillow pybullet scipy trimesh
  spawnfield bake maps/training/scene.yaml -o /tmp/training
  printf 'x,y,z,yaw\\n6,6,0.8,0.5\\n6,8.2,0.8,2.6\\n' > /tmp/two_poses.csv
  tools/pictures/standing.py /tmp/training --robot maps/robots/husky_wheels.yaml --poses /tmp/two_poses.csv \\
      --camera 9.5,3,3 --target 6,7,0.2 -o /tmp/standing.png
"""

# sRGB. The robots have the vermillion and the orange of Okabe and Ito, which differ from greens and greys in any colour
# vision.
FLAT, STEEP, CONTOUR = "b5bf97", "a89272", "6d6250"
COLORS = {"obstacle": "6b6f73", "water": "4f86b0", "body": "d55e00", "top": "e69f00", "wheel": "2b2b2e"}
ZENITH, HORIZON = "8fb4d9", "e6edf2"
SUN, SKY, BOUNCE = np.array([2.3, 2.15, 1.9]), np.array([0.62, 0.68, 0.78]), np.array([0.16, 0.15, 0.13])
STEEPEST = math.radians(35)  # from this slope on, the ground has the colour STEEP
SKY_RAYS = 4  # for each sample of a pixel
BATCH = 16000  # rays; pybullet takes at most 16384


def linear(color):
    """Returns the linear RGB values of a hexadecimal sRGB color."""
    values = np.array([int(color[k:k + 2], 16) for k in (0, 2, 4)]) / 255
    return values**2.2


def spawnfield(program, *arguments):
    """Returns what a command of spawnfield writes to standard output."""
    run = subprocess.run([program, *map(str, arguments), "--quiet"], capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(f"standing.py: {' '.join(map(str, run.args))}: {run.stderr}")
    return run.stdout


def read_surfaces(program, map_folder, folder):
    """Returns the meshes of a map by label (terrain, obstacle, water), z up, in the map's frame."""
    file = folder / "map.glb"
    spawnfield(program, "export", map_folder, "--format", "glb", "-o", file)
    scene = trimesh.load(file)
    z_up = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    meshes = {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        mesh = scene.geometry[geometry]
        label = mesh.visual.material.name
        placed = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).apply_transform(z_up @ transform)
        meshes.setdefault(label, []).append(placed)
    return meshes


def part_mesh(part):
    """Returns a part of a robot, as `spawnfield info --json` lists it, in the robot's frame."""
    shape, size = part["shape"], part.get("size")
    if shape == "box":
        mesh = trimesh.creation.box(size)
    elif shape == "sphere":
        mesh = trimesh.creation.icosphere(4, size[0])
    elif shape == "cylinder":
        mesh = trimesh.creation.cylinder(size[0], size[1], sections=96)
    elif shape == "capsule":
        mesh = trimesh.creation.capsule(size[1], size[0], count=[48, 48])
    else:
        mesh = trimesh.convex.convex_hull(np.array(part["points"]))
    x, y, z, w = part.get("quaternion", [0, 0, 0, 1])
    place = trimesh.transformations.quaternion_matrix([w, x, y, z])
    place[:3, 3] = part.get("position", [0, 0, 0])
    return mesh.apply_transform(place)


def settle(program, map_folder, robot, poses):
    """Returns the rows of `check --settle` for a CSV file of poses."""
    text = spawnfield(program, "check", map_folder, "--robot", robot, "--poses", poses, "--settle")
    return list(csv.DictReader(io.StringIO(text)))


def describe(row):
    """Returns a line about a row of `check --settle`."""
    place, verdict = f"{float(row['x']):.2f},{float(row['y']):.2f}", row["reason"] or row["verdict"]
    if not row["settled_z"]:
        return f"{place}: {verdict}; not drawn: it has no settled pose"
    roll, pitch, tilt = (math.degrees(float(row[key])) for key in ("settled_roll", "settled_pitch", "tilt"))
    return (f"{place}: {verdict}, roll {roll:.1f}, pitch {pitch:.1f}, "
            f"tilt {tilt:.1f} degrees, margin {float(row['margin']):.3f} m, belly {float(row['belly']):.3f} m")


def robot_meshes(program, robot, rows):
    """Returns the meshes of all robots: wheel for round parts, body for the first other part, top for the rest."""
    parts = json.loads(spawnfield(program, "info", robot, "--json"))["parts"]
    is_round = [part["shape"] in ("cylinder", "sphere", "capsule") for part in parts]
    body = is_round.index(False) if False in is_round else -1
    kinds = ["wheel" if is_round[k] else "body" if k == body else "top" for k in range(len(parts))]
    meshes = {kind: [] for kind in kinds}
    for row in rows:
        place = trimesh.transformations.euler_matrix(float(row["settled_roll"]), float(row["settled_pitch"]),
                                                     float(row.get("yaw") or 0))
        place[:3, 3] = [float(row[key]) for key in ("x", "y", "settled_z")]
        for part, kind in zip(parts, kinds):
            meshes[kind].append(part_mesh(part).apply_transform(place))
    return meshes


def build_world(meshes, origin, folder):
    """Puts the meshes into pybullet, relative to origin. Returns the kind of each body: terrain, body and so on."""
    kinds = {}
    for kind, pieces in meshes.items():
        if not pieces:
            continue
        mesh = trimesh.util.concatenate(pieces)
        file = folder / f"{kind}.obj"
        with file.open("w") as out:
            out.writelines("v %.6f %.6f %.6f\n" % tuple(point) for point in (mesh.vertices - origin).tolist())
            out.writelines("f %d %d %d\n" % tuple(face) for face in (mesh.faces + 1).tolist())
        shape = pybullet.createCollisionShape(pybullet.GEOM_MESH, fileName=str(file),
                                              flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH)
        kinds[pybullet.createMultiBody(0, shape)] = kind
    return kinds


def cast(starts, ends):
    """Returns the body (-1: none), position and normal of the first hit of each ray."""
    body, position, normal = [], [], []
    for first in range(0, len(starts), BATCH):
        hits = pybullet.rayTestBatch(starts[first:first + BATCH].tolist(), ends[first:first + BATCH].tolist())
        body += [hit[0] for hit in hits]
        position += [hit[3] for hit in hits]
        normal += [hit[4] for hit in hits]
    return np.array(body, int), np.array(position).reshape(-1, 3), np.array(normal).reshape(-1, 3)


def is_lit(points, direction, length=500):
    """Returns for each point whether nothing is between it and a light in the direction."""
    return cast(points, points + length * direction)[0] < 0


def unit(vector):
    return vector / np.linalg.norm(vector, axis=-1, keepdims=True)


def sky_directions(count):
    """Returns directions that are spread evenly over the upper half of a sphere."""
    index = np.arange(count)
    z = (index + 0.5) / count
    angle = index * math.pi * (3 - math.sqrt(5))
    around = np.sqrt(1 - z**2)
    return np.stack([around * np.cos(angle), around * np.sin(angle), z], axis=1)


def sun_directions(azimuth, elevation, count, radius=math.radians(1.2)):
    """Returns directions towards points of the sun's disc, which is larger than the real one for softer shadows."""
    center = np.array([math.cos(azimuth) * math.cos(elevation), math.sin(azimuth) * math.cos(elevation),
                       math.sin(elevation)])
    side = unit(np.cross(center, [0, 0, 1]))
    up = np.cross(side, center)
    index = np.arange(count)
    distance = radius * np.sqrt((index + 0.5) / count)
    angle = index * math.pi * (3 - math.sqrt(5))
    return unit(center + np.outer(distance * np.cos(angle), side) + np.outer(distance * np.sin(angle), up))


def pixel_rays(options, column_shift, row_shift):
    """Returns the direction of the ray through each pixel. The shifts are parts of a pixel."""
    forward = unit(options.target - options.camera)
    right = unit(np.cross(forward, [0, 0, 1]))
    up = np.cross(right, forward)
    width, height = options.size
    scale = 2 * math.tan(math.radians(options.field_of_view) / 2) / width
    across = (np.arange(width) + column_shift - width / 2) * scale
    down = (np.arange(height) + row_shift - height / 2) * scale
    rays = forward + across[None, :, None] * right - down[:, None, None] * up
    return unit(rays.reshape(-1, 3))


def sky_color(rays):
    share = np.clip(rays[:, 2:] * 2.2, 0, 1)**0.7
    return linear(HORIZON) * (1 - share) + linear(ZENITH) * share


def ground_color(position, normal, distance, options):
    """Returns the color of terrain: by slope, with a contour line every --contours metres."""
    slope = np.arccos(np.clip(normal[:, 2], -1, 1))
    share = np.clip(slope / STEEPEST, 0, 1)[:, None]
    color = linear(FLAT) * (1 - share) + linear(STEEP) * share
    if options.contours:
        height = position[:, 2] + options.target[2]
        vertical = np.abs(height / options.contours - np.round(height / options.contours)) * options.contours
        line = 0.002 + 0.0008 * distance  # half of the width, m
        on_line = (vertical < line * np.tan(slope)) & (slope > 0.01) & (slope < 1.2)
        color[on_line] = 0.55 * color[on_line] + 0.45 * linear(CONTOUR)
    return color


def shade(rays, suns, skies, kinds, options):
    """Returns the linear RGB color that the camera sees along each ray."""
    camera = options.camera - options.target
    body, position, normal = cast(np.broadcast_to(camera, rays.shape), camera + options.far * rays)
    image = sky_color(rays)
    seen = np.flatnonzero(body >= 0)
    if not len(seen):
        return image
    body, position, normal, rays = body[seen], position[seen], normal[seen], rays[seen]
    normal = np.where((normal * rays).sum(1, keepdims=True) > 0, -normal, normal)
    distance = np.linalg.norm(position - camera, axis=1)
    color = np.zeros_like(position)
    for number, kind in kinds.items():
        mine = body == number
        color[mine] = ground_color(position[mine], normal[mine], distance[mine], options) if kind == "terrain" \
            else linear(COLORS[kind])
        if kind == "water":
            mirror = np.clip(1 + rays[mine, 2:], 0, 1)**4
            color[mine] = color[mine] * (1 - mirror) + 0.5 * linear(HORIZON) * mirror
    starts = position + 1e-3 * normal
    light = BOUNCE * (1.5 - normal[:, 2:])
    for sun in suns:
        facing = np.clip(normal @ sun, 0, None)
        lit = np.flatnonzero(facing)
        lit = lit[is_lit(starts[lit], sun)]
        light[lit] += SUN * facing[lit, None] / len(suns)
    for sky in skies:
        facing = np.clip(normal @ sky, 0, None)
        lit = np.flatnonzero(facing)
        lit = lit[is_lit(starts[lit], sky, 60)]
        light[lit] += SKY * 2 * facing[lit, None] / len(skies)
    haze = (1 - np.exp(-distance / options.haze))[:, None] if options.haze else 0
    image[seen] = color * light * 0.5 * (1 - haze) + linear(HORIZON) * haze
    return image


def draw(kinds, options):
    """Returns the picture. Each pixel is the mean of samples x samples rays."""
    count = options.samples**2
    suns = sun_directions(*np.radians(options.sun), count)
    skies = sky_directions(count * SKY_RAYS)
    width, height = options.size
    total = np.zeros((width * height, 3))
    for index in range(count):
        row, column = divmod(index, options.samples)
        rays = pixel_rays(options, (column + 0.5) / options.samples, (row + 0.5) / options.samples)
        color = shade(rays, suns[index:index + 1], skies[index::count], kinds, options)
        total += np.clip(color, 0, 1)**(1 / 2.2)
    return Image.fromarray(np.round(255 * total / count).astype(np.uint8).reshape(height, width, 3))


def numbers(count):
    """Returns a function that reads `count` numbers with commas between them."""
    def read(text):
        values = np.array([float(value) for value in text.split(",")])
        if len(values) != count:
            raise argparse.ArgumentTypeError(f"'{text}' has {len(values)} numbers, {count} are needed")
        return values
    return read


def size(text):
    return [int(value) for value in text.split("x")]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map", help="map folder that `spawnfield bake` made")
    parser.add_argument("--robot", required=True, help="robot as for `spawnfield check`")
    parser.add_argument("--poses", required=True, help="CSV file of poses, for example from `spawnfield sample`")
    parser.add_argument("--camera", type=numbers(3), required=True, metavar="X,Y,Z", help="place of the camera, m")
    parser.add_argument("--target", type=numbers(3), required=True, metavar="X,Y,Z",
                        help="point in the middle of the picture, m")
    parser.add_argument("--field-of-view", type=float, default=40, metavar="DEG",
                        help="horizontal angle of view (default 40)")
    parser.add_argument("--size", type=size, default="1000x560", metavar="WxH", help="pixels (default 1000x560)")
    parser.add_argument("--samples", type=int, default=3, help="rays across each pixel, and down (default 3)")
    parser.add_argument("--sun", type=numbers(2), default="200,40", metavar="AZIMUTH,ELEVATION",
                        help="direction of the sun, degrees; azimuth from x to y (default 200,40)")
    parser.add_argument("--contours", type=float, default=0, metavar="M",
                        help="height between contour lines (default: no lines)")
    parser.add_argument("--haze", type=float, default=600, metavar="M",
                        help="distance at which two thirds of the light come from the haze; 0: no haze (default 600)")
    parser.add_argument("--far", type=float, default=1000, metavar="M", help="end of the view (default 1000)")
    parser.add_argument("--spawnfield", default="spawnfield", metavar="PROGRAM",
                        help="the program (default: spawnfield, from PATH)")
    parser.add_argument("-o", "--out", required=True, help="PNG file to write")
    return parser.parse_args()


def main():
    options = arguments()
    rows = settle(options.spawnfield, options.map, options.robot, options.poses)
    for row in rows:
        print(describe(row), flush=True)
    rows = [row for row in rows if row["settled_z"]]
    pybullet.connect(pybullet.DIRECT)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        meshes = read_surfaces(options.spawnfield, options.map, folder)
        meshes.update(robot_meshes(options.spawnfield, options.robot, rows))
        kinds = build_world(meshes, options.target, folder)
    draw(kinds, options).save(options.out, optimize=True)


if __name__ == "__main__":
    main()
