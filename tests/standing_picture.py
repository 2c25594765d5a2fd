"""Checks tools/pictures/standing.py up to the camera: the rows that it reads, its words, and where it puts the parts.

standing_picture.py SPAWNFIELD WORK_FOLDER. The ray tracer and the image file are left out, and so are their packages.
"""
import pathlib
import subprocess
import sys
import types

try:
    import numpy as np
    import trimesh  # noqa: F401 (standing.py needs it)
except ImportError as error:
    print(f"skipped: {sys.executable} has no {error.name}; tools/test-python.sh installs it")
    sys.exit(77)

PROGRAM, WORK = sys.argv[1], pathlib.Path(sys.argv[2])
SOURCE = pathlib.Path(__file__).resolve().parent.parent
ROBOT = SOURCE / "maps/robots/husky_wheels.yaml"

for name, parts in (("pybullet", []), ("PIL", ["Image"])):
    sys.modules[name] = types.ModuleType(name)
    for part in parts:
        setattr(sys.modules[name], part, None)
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tools/pictures"))
import standing  # noqa: E402


def rows_of(*poses):
    file = WORK / "poses.csv"
    file.write_text("x,y,z,yaw\n" + "".join(pose + "\n" for pose in poses))
    return standing.settle(PROGRAM, WORK / "map", ROBOT, file)


WORK.mkdir(parents=True, exist_ok=True)
subprocess.run([PROGRAM, "bake", SOURCE / "maps/training/scene.yaml", "-o", WORK / "map", "--resolution", "0.5", "-q"],
               check=True)

# On the floor, whose height is -0.05 m, on the ramp, and in a wall.
floor, ramp, wall = rows_of("0,3,0.1,0.5", "1.65,6,1,0", "-6.5,-5,0.1,0")
words = standing.describe(floor)
assert words.startswith("0.00,3.00: valid, roll 0.0, pitch 0.0, tilt 0.0 degrees, margin 0."), words
assert "pitch 10.0, tilt 10.0 degrees" in standing.describe(ramp), standing.describe(ramp)
assert standing.describe(wall) == (
    "-6.50,-5.00: collision: it has no room to settle, because of thin_wall; not drawn: it has no settled pose"
), standing.describe(wall)

meshes = standing.robot_meshes(PROGRAM, ROBOT, [floor])
assert set(meshes) == {"wheel", "body", "top"}, set(meshes)
assert len(meshes["wheel"]) == 4
for wheel in meshes["wheel"]:  # drawn as a prism of 96 sides
    assert abs(wheel.bounds[0][2] + 0.05) < 1e-3, wheel.bounds
for body in meshes["body"] + meshes["top"]:
    assert body.bounds[0][2] > 0

# On the ramp, each point of a wheel is above the plane on which the wheels stand, and some are on it.
wheels = standing.robot_meshes(PROGRAM, ROBOT, [ramp])["wheel"]
pitch = float(ramp["settled_pitch"])
up = np.array([np.sin(pitch), 0, np.cos(pitch)])
lowest = [float((wheel.vertices @ up).min()) for wheel in wheels]
assert max(lowest) - min(lowest) < 1e-3, lowest

surfaces = standing.read_surfaces(PROGRAM, WORK / "map", WORK)
assert {"terrain", "obstacle", "water"} <= set(surfaces), set(surfaces)
highest = max(float(mesh.bounds[1][2]) for mesh in surfaces["terrain"])
assert 0.9 < highest < 3, highest  # z is up again: the platform, and what stands above it

directions = standing.sun_directions(0.3, 0.7, 9)
assert np.allclose(np.linalg.norm(directions, axis=1), 1) and (directions[:, 2] > 0).all()
