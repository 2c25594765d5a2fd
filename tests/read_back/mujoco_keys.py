"""Checks the keys for MuJoCo: in a model that includes them, the bodies must have the poses of the robots."""
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
print('mujoco', mujoco.__version__)
