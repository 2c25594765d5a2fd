"""Checks the arrays for Isaac Lab, as numpy reads them."""
import sys

from truth import FOLDER, ROBOTS, check_pose, from_quaternion

try:
    import numpy
except ImportError:
    print('skipped: numpy is not installed; tools/test-python.sh installs it')
    sys.exit(77)

for name in ('wxyz', 'xyzw'):
    poses = numpy.load(FOLDER / (name + '.npy'), allow_pickle=False)
    assert poses.shape == (len(ROBOTS), 7) and poses.dtype == numpy.float64 and poses.flags['C_CONTIGUOUS']
    for robot, row in zip(ROBOTS, poses.tolist()):
        x, y, z, w = row[3:] if name == 'xyzw' else row[4:] + row[3:4]
        check_pose(robot, row[:3], from_quaternion(w, x, y, z))
assert numpy.load(FOLDER / 'none.npy').shape == (0, 7)

patches = numpy.load(FOLDER / 'flat_patches.npy', allow_pickle=False)
origins = numpy.load(FOLDER / 'terrain_origins.npy', allow_pickle=False)
assert patches.dtype == numpy.float32 and origins.dtype == numpy.float32
assert patches.shape[:2] == (2, 3) and patches.shape[3] == 3 and origins.shape == (2, 3, 3)
tiles = {}
for robot in ROBOTS:
    x, y, _ = robot['position']
    tiles.setdefault((int(x >= 0), 0 if y < -500 / 3 else 1 if y < 500 / 3 else 2), []).append(robot['position'])
assert patches.shape[2] == max(len(tile) for tile in tiles.values())
for (row, col), tile in tiles.items():
    expected = numpy.array([tile[i % len(tile)] for i in range(patches.shape[2])], dtype=numpy.float32)
    assert (patches[row, col] == expected).all()
    assert (origins[row, col] == expected[0]).all()
