"""Checks the files for MuJoCo: bodies must have the poses of the robots, by keys or by themselves."""
import sys

from truth import FOLDER, ROBOTS, check_pose

try:
    import mujoco
    import numpy
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

# The mass and the inertia of the robot's file: those of MuJoCo's own model of it, with its joint turned.
robot = mujoco.MjModel.from_xml_path(str(FOLDER / 'robot.urdf'))
state = mujoco.MjData(robot)
state.qpos[0] = 0.7
mujoco.mj_forward(robot, state)
own = [(robot.body_mass[k], state.xipos[k], state.ximat[k].reshape(3, 3), robot.body_inertia[k])
       for k in range(robot.nbody)]
mass = sum(link[0] for link in own)
centre = sum(link[0] * link[1] for link in own) / mass
expected = numpy.zeros((3, 3))
for part, at, turn, moments in own:
    away = at - centre
    expected += turn @ (moments * turn).T + part * (away @ away * numpy.eye(3) - numpy.outer(away, away))
model = mujoco.MjModel.from_xml_path(str(FOLDER / 'masses.xml'))
first, second = (model.body(robot['name']) for robot in ROBOTS[:2])
assert mass == 5 == first.mass[0] and abs(first.ipos - centre).max() < 1e-9, (mass, first.mass, first.ipos, centre)
turn = numpy.zeros(9)
mujoco.mju_quat2Mat(turn, first.iquat)
turn = turn.reshape(3, 3)
assert abs(turn @ (first.inertia * turn).T - expected).max() < 1e-9, (first.inertia, expected)
assert second.mass[0] > 10  # a hull of 24 l, with the default density
print('mujoco', mujoco.__version__)
