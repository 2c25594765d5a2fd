"""A Gymnasium environment in MuJoCo whose robot starts at verified poses on a river bank.

spawnfield and MuJoCo get the ground from the same array, and the robot from the same URDF, so the robot rests in MuJoCo
where spawnfield has put it. To use your own world, replace `read_heights` and `make_world`; to use your own robot,
replace ROBOT and WHEELS.

    pip install gymnasium mujoco
    python python/examples/gym_river.py

The elevation model is docs/source/tutorials/river_flow_dynamics/DEM-kootenai_37x50_1x1.asc of landlab (MIT). It must be
in the folder dem/river of SPAWNFIELD_SCENES, or of shared/scenes beside the project.
"""

import os
from pathlib import Path

import gymnasium
import mujoco
import numpy as np

import spawnfield as sf

PROJECT = Path(__file__).resolve().parents[2]
SCENES = Path(os.environ.get("SPAWNFIELD_SCENES", PROJECT.parent / "shared/scenes"))
HEIGHTS = SCENES / "dem/river/DEM-kootenai_37x50_1x1.asc"
ROBOT = PROJECT / "maps/robots/rover.urdf"
WHEELS = ("front_left", "rear_left", "front_right", "rear_right")
WATER = 1.44  # m above the lowest place
TO_QPOS = [0, 1, 2, 6, 3, 4, 5]  # a pool has quaternions x, y, z, w, MuJoCo has w, x, y, z


def read_heights():
    """Returns (rows, cols) heights above the lowest place, m, 1 m apart; row 0 is the largest y."""
    values = np.loadtxt(HEIGHTS, skiprows=6)
    return values - values.min()


def make_world(heights):
    """Returns spawnfield's world: the ground, with the middle of the grid at the origin, and the river."""
    rows, cols = heights.shape
    scene = sf.Scene("river")
    scene.add_heights(heights, (1, 0, -cols / 2, 0, -1, rows / 2))
    corners = [[x * cols / 2, y * rows / 2, WATER] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    scene.add_mesh(corners, [[0, 1, 2], [0, 2, 3]], label="water", name="river")
    return sf.bake(scene)


def make_pool(world, size=10_000, seed=0):
    """Returns starts with some safety: away from the edge of the world, and not at the limit of tipping over."""
    (x0, y0, _), (x1, y1, _) = world.lower, world.upper
    region = (x0 + 1.5, y0 + 1.5, x1 - 1.5, y1 - 1.5)
    return sf.Pool(world, sf.Robot(ROBOT), size, seed=seed, region=region, max_slope=25, min_stability=0.02)


def make_model(heights):
    """Returns MuJoCo's model: the same ground, and the robot with a motor at each wheel."""
    rows, cols = heights.shape
    spec = mujoco.MjSpec.from_file(str(ROBOT))
    spec.option.timestep = 0.005
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST  # for the strong motors
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10  # contacts slip less
    spec.add_hfield(
        name="ground",
        nrow=rows,
        ncol=cols,
        size=[(cols - 1) / 2, (rows - 1) / 2, heights.max(), 1],  # half lengths; heights are 0 .. 1 times the third one
        userdata=heights[::-1].ravel(),  # row 0 is the smallest y
    )
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_HFIELD, hfieldname="ground", rgba=[0.55, 0.5, 0.4, 1])
    spec.body("base").add_freejoint()
    for wheel in WHEELS:
        motor = spec.add_actuator(name=wheel, target=wheel, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_velocity(kv=500)  # N m s/rad: at speed 0, it is a brake
    return spec.compile()


class RiverEnv(gymnasium.Env):
    """A rover that gets a reward for driving ahead. An episode ends when it tips over or leaves the ground.

    Observation, in the robot's frame: the direction of gravity, the velocity (m/s) and the angular velocity (rad/s).
    Action: speeds of the wheels on the left and on the right, -1 .. 1 times 6 rad/s; 0 brakes.

    Args:
        pool: where episodes start; several environments can share it. Default: a new one.
        heights: of the ground; see `read_heights`.
    """

    metadata = {"render_modes": []}
    observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (9,), np.float64)
    action_space = gymnasium.spaces.Box(-1, 1, (2,), np.float32)

    def __init__(self, pool=None, heights=None):
        heights = read_heights() if heights is None else heights
        self.pool = make_pool(make_world(heights)) if pool is None else pool
        self.model = make_model(heights)
        self.data = mujoco.MjData(self.model)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        if seed is not None:
            self.pool.restart(seed)
        mujoco.mj_resetData(self.model, self.data)
        start = self.pool.draw(1).pose[0]
        self.data.qpos[:7] = start[TO_QPOS]
        mujoco.mj_forward(self.model, self.data)
        return self._observation(), {"start": start}

    def step(self, action):
        self.data.ctrl[:] = 6 * np.repeat(action, 2)
        mujoco.mj_step(self.model, self.data, nstep=10)
        observation = self._observation()
        has_fallen = observation[2] > -0.5 or self.data.qpos[2] < -0.5
        return observation, float(observation[3]), bool(has_fallen), False, {}

    def _observation(self):
        rotation = self.data.body("base").xmat.reshape(3, 3)
        velocity, turning = self.data.qvel[:3], self.data.qvel[3:6]  # MuJoCo: in the world; in the robot's frame
        return np.concatenate([-rotation[2], velocity @ rotation, turning])


gymnasium.register("River-v0", RiverEnv, max_episode_steps=400)  # of 20 s


def main():
    environment = gymnasium.make("River-v0")
    for episode in range(5):
        _, info = environment.reset(seed=1 if episode == 0 else None)
        reward, is_over, steps = 0.0, False, 0
        while not is_over:
            _, gain, has_fallen, is_late, _ = environment.step(np.array([0.5, 0.5], np.float32))
            reward, is_over, steps = reward + gain, has_fallen or is_late, steps + 1
        print(f"episode {episode}: from {np.round(info['start'][:3], 2)}, {steps} steps, reward {reward:.1f}")


if __name__ == "__main__":
    main()
