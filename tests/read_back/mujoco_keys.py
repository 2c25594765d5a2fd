"""Checks the files for MuJoCo: bodies must have the poses of the robots, by keys or by themselves."""
import sys

from truth import FOLDER, ROBOTS, check_pose

try:
    import mujoco
except ImportError:
    print('skipped: mujoco is not installed; tools/test-python.sh installs it')
    sys.exit(77)

ARM = '<body><joint name="a{0}" type="hinge"/><joint name="b{0}" type="hinge" axis="0 1 0"/><geom size="0.1"/></body>'


def load(keys, bodies, arms):
    text = '<mujoco><include file="{}"/><worldbody>'.format(FOLDER / keys)
    for i in range(bodies):
        text += '<body name="r{0}"><freejoint/><geom size="0.1"/>{1}</body>'.format(i, ARM.format(i) if arms else '')
    return mujoco.MjModel.from_xml_string(text + '</worldbody></mujoco>')


def check_body(model, data, body, robot):
    mujoco.mj_forward(model, data)
    check_pose(robot, data.body(body).xpos, data.body(body).xmat.reshape(3, 3))


model = load('each.xml', 1, True)
data = mujoco.MjData(model)
assert model.nkey == len(ROBOTS) and model.nq == 9
for i, robot in enumerate(ROBOTS):
    assert model.key(i).name == robot['name']
    mujoco.mj_resetDataKeyframe(model, data, i)
    assert list(data.qpos[7:]) == [0.25, -1e-9]
    check_body(model, data, 'r0', robot)

model = load('together.xml', len(ROBOTS), False)
data = mujoco.MjData(model)
assert model.nkey == 1 and model.key(0).name == 'spawns'
mujoco.mj_resetDataKeyframe(model, data, 0)
for i, robot in enumerate(ROBOTS):
    check_body(model, data, 'r{}'.format(i), robot)

# A fleet: two kinds of robots with their own shapes, in a model of its own.
model = mujoco.MjModel.from_xml_path(str(FOLDER / 'bodies.xml'))
data = mujoco.MjData(model)
assert model.nbody == len(ROBOTS) + 1 and model.nq == 7 * len(ROBOTS) and model.nmesh == 1
assert model.ngeom == 5 * len(ROBOTS) // 2
for _ in range(2):  # as the bodies are, and with the key
    for robot in ROBOTS:
        check_body(model, data, robot['name'], robot)
    data.qpos[:] = 0
    mujoco.mj_resetDataKeyframe(model, data, model.key('spawns').id)
first = model.body(ROBOTS[0]['name'])
box, ball, cylinder, capsule = range(first.geomadr[0], first.geomadr[0] + 4)
assert list(model.geom_type[[box, ball, cylinder, capsule]]) == [
    getattr(mujoco.mjtGeom, 'mjGEOM_' + name) for name in ('BOX', 'SPHERE', 'CYLINDER', 'CAPSULE')]
assert list(model.geom_size[box]) == [0.5, 0.3, 0.2] and model.geom_size[ball][0] == 0.2
assert list(model.geom_size[cylinder][:2]) == [0.1, 0.25] == list(model.geom_size[capsule][:2])
# The corners of the hull are where the robot has them.
cart = ROBOTS[1]
geom = model.body(cart['name']).geomadr[0]
mujoco.mj_forward(model, data)
mesh = model.geom_dataid[geom]
vertices = model.mesh_vert[model.mesh_vertadr[mesh]:model.mesh_vertadr[mesh] + model.mesh_vertnum[mesh]]
seen = vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
for corner in ([0, 0, 0], [0.6, 0, 0], [0, 0.4, 0], [0, 0, 0.5], [0.6, 0.4, 0.5]):
    expected = [sum(r * c for r, c in zip(row, corner)) + p for row, p in zip(cart['rotation'], cart['position'])]
    assert abs(seen - expected).max(axis=1).min() < 1e-5, (corner, expected)  # MuJoCo has float vertices
print('mujoco', mujoco.__version__)
