"""The examples for reinforcement learning: robots that start from a pool stand, and others are seen falling.

They need mujoco, gymnasium and the shared scenes (SPAWNFIELD_SCENES, or shared/scenes beside the project).
"""

import importlib
import os
import py_compile
import subprocess
import sys
import types

import numpy as np
import pytest

import spawnfield as sf

EXAMPLES = os.path.join(os.path.dirname(__file__), "../examples")


@pytest.fixture(scope="module")
def river():
    """What the modules gym_river and batch_rollout contain."""
    for package in ("mujoco", "gymnasium"):
        pytest.importorskip(package, reason=f"{package} is not installed (tests/requirements.txt)")
    sys.path.insert(0, EXAMPLES)
    try:
        gym_river, batch_rollout = map(importlib.import_module, ("gym_river", "batch_rollout"))
    finally:
        sys.path.remove(EXAMPLES)
    if not gym_river.HEIGHTS.is_file():
        pytest.skip(f"no shared scenes at {gym_river.SCENES}; set SPAWNFIELD_SCENES to their folder")
    return types.SimpleNamespace(**{**vars(gym_river), **vars(batch_rollout)})


@pytest.fixture(scope="module")
def heights(river):
    return river.read_heights()


@pytest.fixture(scope="module")
def land(river, heights):
    return river.make_world(heights)


@pytest.fixture(scope="module")
def starts(river, land):
    return river.make_pool(land, size=1000, seed=3).wait()


@pytest.fixture
def environment(river, heights, starts):
    return river.RiverEnv(pool=sf.Pool.from_columns(starts.columns), heights=heights)


def pose_of(environment):
    """Returns where the robot of an environment is, as a row of a pool: x, y, z, qx, qy, qz, qw."""
    return environment.data.qpos[[0, 1, 2, 4, 5, 6, 3]][None].copy()


def without_control(environment, river, seconds=2.5):
    """Returns what happens to a robot without control: whether it stands, whether it falls, and by how many degrees it
    turns."""
    environment.reset()
    start = pose_of(environment)
    has_fallen = False
    while environment.data.time < seconds:
        has_fallen |= environment.step(np.zeros(2, np.float32))[2]
    end = pose_of(environment)
    turned = np.degrees(2 * np.arccos(min(1, abs((start[0, 3:] * end[0, 3:]).sum()))))
    return bool(river.stand(start, end)[0]) and not has_fallen, has_fallen, turned


def product(a, b):
    """Returns the product of quaternions x, y, z, w."""
    return np.array([*(a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])), a[3] * b[3] - a[:3] @ b[:3]])


def test_both_worlds_have_the_same_ground(river, heights, land):
    mujoco = river.mujoco
    model = river.make_model(heights)
    data = mujoco.MjData(model)
    data.qpos[2] = -100  # the robot is out of the way
    mujoco.mj_forward(model, data)
    half = np.array(heights.shape[::-1]) / 2 - 0.6
    places = np.random.default_rng(2).uniform(-half, half, (300, 2))
    hit = np.zeros(1, np.int32)
    down = np.array([0.0, 0, -1])
    far = [mujoco.mj_ray(model, data, np.array([x, y, 50.0]), down, None, 1, -1, hit) for x, y in places]
    ground = land.check(river.ROBOT, np.column_stack([places, np.full(300, 30.0)]), max_height=100).ground
    assert np.abs(50 - np.array(far) - ground).max() < 1e-4


@pytest.mark.filterwarnings("ignore:.*Box observation space")
def test_environment_keeps_the_rules_of_gymnasium(river, environment):
    from gymnasium.utils.env_checker import check_env

    check_env(environment, skip_render_check=True)
    first, info = environment.reset(seed=8)
    again, same = environment.reset(seed=8)
    other, another = environment.reset(seed=9)
    assert (first == again).all() and (info["start"] == same["start"]).all()
    assert (info["start"] != another["start"]).any() and (first != other).any()


def test_episode_starts_from_the_pool_on_dry_land(river, environment, land):
    started = np.array([environment.reset()[1]["start"] for _ in range(200)])
    assert len(np.unique(started, axis=0)) == 200 and (started[:, 2] > river.WATER).all()
    assert land.check(river.ROBOT, started).valid.all()
    assert np.degrees(2 * np.arcsin(np.hypot(started[:, 3], started[:, 4]))).max() > 15  # not only on level ground


def test_robot_drives_where_it_is_told(river, environment):
    environment.reset(seed=1)
    rewards = [environment.step(np.ones(2, np.float32))[1] for _ in range(40)]
    assert sum(rewards[20:]) / 20 > 0.6  # m/s; the wheels turn with 0.99 m/s
    assert environment.step(np.ones(2, np.float32) * 0)[1] < rewards[-1]


def test_robot_stands_where_the_pool_has_put_it(river, environment):
    for _ in range(30):
        stands, has_fallen, turned = without_control(environment, river)
        assert stands and not has_fallen and turned < 3


def test_robot_with_a_wrong_heading_is_seen_tilting(river, environment, starts):
    poses = starts.columns["pose"]
    tilt = np.degrees(2 * np.arcsin(np.hypot(poses[:, 3], poses[:, 4])))
    wrong = poses[tilt > 12][:10] + [0, 0, 0.3, 0, 0, 0, 0]
    wrong[:, 3:] = [product(np.array([0, 0, 1, 0]), pose[3:]) for pose in wrong]  # turned by 180 degrees
    environment.pool = sf.Pool.from_columns({"pose": wrong})
    for _ in wrong:
        stands, _, turned = without_control(environment, river)
        assert not stands and turned > 10


def test_robot_on_its_side_is_seen_falling(river, environment, starts):
    wrong = starts.columns["pose"][:10] + [0, 0, 0.4, 0, 0, 0, 0]
    half = np.sqrt(0.5)
    wrong[:, 3:] = [product(pose[3:], np.array([half, 0, 0, half])) for pose in wrong]
    environment.pool = sf.Pool.from_columns({"pose": wrong})
    for _ in wrong:
        stands, has_fallen, _ = without_control(environment, river)
        assert has_fallen and not stands


def test_robots_in_unchecked_poses_are_seen_moving(river, environment, heights):
    environment.pool = sf.Pool.from_columns({"pose": river.unchecked_poses(heights, 60)})
    stands, _, turned = np.array([without_control(environment, river) for _ in range(60)]).T
    assert stands.sum() < 30 and (turned > 10).sum() > 10


def test_batch_of_256_stands(river, heights, starts):
    model = river.make_model(heights)
    poses = sf.Pool.from_columns(starts.columns).draw(256).pose
    ends = river.simulate(model, poses, threads=1)
    assert river.stand(poses, ends).all()
    assert (ends[:, 2] < poses[:, 2]).all()  # they were raised a little, and have come down
    unchecked = river.unchecked_poses(heights, 256)
    assert river.stand(unchecked, river.simulate(model, unchecked, threads=1)).sum() < 128


@pytest.mark.parametrize("words", [["gym_river.py"], ["batch_rollout.py", "32"]])
def test_examples_run(river, words):
    done = subprocess.run([sys.executable, "-B", os.path.join(EXAMPLES, words[0]), *words[1:]],
                          capture_output=True, text=True, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "32 of 32 stand" in done.stdout or done.stdout.count("episode") == 5


class Robot2:
    """A robot of Isaac Lab 2, as far as the recipe uses it."""

    def write_root_pose_to_sim(self, pose, env_ids):
        self.pose, self.env_ids = pose, env_ids

    def write_root_velocity_to_sim(self, velocity, env_ids):
        self.velocity = velocity


class Robot3:
    """The same of Isaac Lab 3."""

    def write_root_pose_to_sim_index(self, *, root_pose, env_ids):
        self.pose, self.env_ids = root_pose, env_ids

    def write_root_velocity_to_sim_index(self, *, root_velocity, env_ids):
        self.velocity = root_velocity


@pytest.mark.parametrize("robot, order", [(Robot2(), [3, 0, 1, 2]), (Robot3(), [0, 1, 2, 3])])
def test_isaac_lab_recipe(monkeypatch, tmp_path, robot, order):
    """The recipe compiles, and does what it says with stand-ins for torch and Isaac Lab, which are not installed."""
    file = os.path.join(EXAMPLES, "isaac_lab_reset.py")
    py_compile.compile(file, cfile=str(tmp_path / "compiled"), doraise=True)

    class Term:
        def __init__(self, cfg, env):
            pass

    zeros = lambda *shape, dtype=float, device=None: np.zeros(shape, dtype)  # noqa: E731
    managers = types.SimpleNamespace(EventTermCfg=object, ManagerTermBase=Term, SceneEntityCfg=object)
    monkeypatch.setitem(sys.modules, "torch", types.SimpleNamespace(zeros=zeros, bool=bool))
    monkeypatch.setitem(sys.modules, "isaaclab", types.SimpleNamespace(managers=managers))
    monkeypatch.setitem(sys.modules, "isaaclab.managers", managers)
    spec = importlib.util.spec_from_file_location("isaac_lab_reset", file)
    recipe = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(recipe)

    poses = np.random.default_rng(0).normal(size=(50, 7))
    sf.Pool.from_columns({"pose": poses}).save(tmp_path / "starts.npz")
    origins = np.arange(24.0).reshape(8, 3)
    env = types.SimpleNamespace(num_envs=8, device=None, cfg=types.SimpleNamespace(seed=4), scene=Scene(robot, origins))
    params = {"asset_cfg": types.SimpleNamespace(name="robot"), "file": str(tmp_path / "starts.npz")}
    term = recipe.ResetToSpawn(types.SimpleNamespace(params=params), env)
    wanted = sf.Pool.from_columns({"pose": poses}, seed=4).draw(6).pose
    for is_tiled, ids, rows in ((False, np.array([1, 2, 5]), wanted[:3]), (True, np.array([0, 5, 7]), wanted[3:])):
        term(env, ids, **params, is_tiled=is_tiled)
        assert (robot.env_ids == ids).all() and (robot.velocity == np.zeros((3, 6))).all()
        assert np.allclose(robot.pose[:, :3], rows[:, :3] + origins[ids] * is_tiled)
        assert (robot.pose[:, 3:] == rows[:, 3:][:, order]).all()


class Scene(dict):
    """A scene of Isaac Lab with one robot."""

    def __init__(self, robot, env_origins):
        super().__init__(robot=robot)
        self.env_origins = env_origins
