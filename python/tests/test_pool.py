"""The pool: no repetition, distances, weights, worlds, files, and the same draws for the same seed."""

import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import spawnfield as sf


@pytest.fixture(scope="module")
def pool(world, robot):
    return sf.Pool(world, robot, 2000, seed=4, background=False)


def fresh(pool, **options):
    return sf.Pool.from_columns(pool.columns, **options)


def test_rows_are_valid(pool, world, robot):
    assert len(pool) == 2000 and world.check(robot, pool.columns["pose"]).valid.all()
    assert len(np.unique(pool.columns["pose"], axis=0)) == 2000


def test_no_repetition_until_exhausted(pool):
    pool = fresh(pool)
    drawn = np.concatenate([pool.draw(300).index for _ in range(6)])
    assert len(np.unique(drawn)) == 1800 and pool.epoch.tolist() == [0]
    over = pool.draw(300).index  # the last 200, and 100 of the next epoch
    assert len(np.unique(over)) == 300 and pool.epoch.tolist() == [1]
    assert set(over[:200]) == set(range(2000)) - set(drawn)
    rest = np.concatenate([over[200:], *(pool.draw(380).index for _ in range(5))])
    assert len(np.unique(rest)) == 2000


def test_same_seed_same_draws(world, robot):
    slow = sf.Pool(world, robot, 40000, seed=9)
    first = [slow.draw(251).pose for _ in range(20)]  # while the pool is being made
    full = sf.Pool(world, robot, 40000, seed=9, background=False, threads=1)
    assert all((full.draw(251).pose == poses).all() for poses in first)
    assert (sf.Pool(world, robot, 40000, seed=10, background=False).draw(251).pose != first[0]).any()


def test_mask_fills_rows(pool):
    pool = fresh(pool)
    poses = np.zeros((4096, 7))
    mask = np.zeros(4096, bool)
    mask[5::16] = True
    drawn = pool.draw(mask, out=poses)
    assert (poses[mask] == drawn.pose).all() and (poses[~mask] == 0).all()
    with pytest.raises(sf.ArgumentError, match="of bool"):
        pool.draw(np.zeros(10))


def test_order_of_quaternions(pool, world, robot, tmp_path):
    pool.save(tmp_path / "pool.npz")
    columns = pool.columns["pose"]
    wxyz = sf.Pool.load(tmp_path / "pool.npz", quaternion="wxyz")
    assert (wxyz.columns["pose"] == columns).all()
    poses = np.zeros((8, 7))
    drawn = wxyz.draw(8, out=poses)
    x, y, z, qw, qx, qy, qz = drawn.pose.T
    assert (np.stack([x, y, z, qx, qy, qz, qw], axis=1) == columns[:8]).all() and (poses == drawn.pose).all()
    pairs = sf.Pool(world, robot, 20, pairs=True, quaternion="wxyz", background=False)
    drawn = pairs.draw(20)
    assert (drawn.goal[:, 3] == pairs.columns["goal"][:, 6]).all() and (drawn.start[:, 4:] != 0).any()
    assert drawn.path_length.shape == (20,)
    with pytest.raises(sf.ArgumentError, match="--quaternion is 'zyx', needs one of xyzw, wxyz"):
        fresh(pool, quaternion="zyx")


def test_an_empty_first_draw_has_all_columns(world, robot):
    pool = sf.Pool(world, robot, 3000)
    drawn = pool.draw(np.zeros(16, bool))  # nothing resets, while no row is there yet
    assert drawn.pose.shape == (0, 7) and drawn.tilt.shape == (0,)


def test_arguments_that_make_no_sense(pool, world, robot, tmp_path):
    for options, message in (
        ({"min_distance": 1.0}, "--min-distance: the rows of a pool keep no distance"),
        ({"count": 7}, "--count is not an option of a pool"),
        ({"min_distanc": 1.0}, "did you mean min_distance"),
    ):
        with pytest.raises(sf.ArgumentError, match=message):
            sf.Pool(world, robot, 10, **options)
    with pytest.raises(sf.ArgumentError, match="no column 'tild'; it has pose"):
        pool.weigh("tild")
    with pytest.raises(sf.ArgumentError, match=r"--out has the shape \(8, 6\)"):
        fresh(pool).draw(8, out=np.zeros((8, 6)))
    with pytest.raises(sf.FileError, match="nope.npz: the pool cannot be read"):
        sf.Pool.load(tmp_path / "nope.npz")
    np.savez(tmp_path / "other.npz", a=[1])
    with pytest.raises(sf.FileError, match="not the file of a pool"):
        sf.Pool.load(tmp_path / "other.npz")


def test_tensors(pool, world, robot):
    """Needs torch, which is not one of the packages of the tests because of its size."""
    torch = pytest.importorskip("torch", reason="torch is not installed")
    mask = torch.arange(4096) % 16 == 5
    for one in (fresh(pool), sf.Pool(world, robot, 200_000)):  # complete; still being made
        poses = torch.zeros(4096, 7)
        drawn = one.draw(mask, out=poses)
        assert (poses[mask].numpy() == drawn.pose.astype(np.float32)).all() and (poses[~mask] == 0).all()
    low = sf.Pool.from_columns({"pose": np.arange(70.0).reshape(10, 7), "world": np.arange(10) // 5})
    poses = torch.zeros(3, 7, dtype=torch.float64)
    drawn = low.draw(torch.tensor([True, False, True]), out=poses, world=torch.tensor([1, 0, 0]))
    assert poses[:, 0].tolist() == [35, 0, 0] and drawn.world.tolist() == [1, 0]


def test_min_distance(pool):
    pool = fresh(pool)
    seen = []
    for _ in range(12):
        drawn = pool.draw(20, min_distance=2.0)
        gaps = np.linalg.norm(drawn.pose[:, None, :3] - drawn.pose[None, :, :3], axis=-1)
        assert gaps[~np.eye(20, dtype=bool)].min() >= 2.0
        seen.append(drawn.index)
    assert len(np.unique(np.concatenate(seen))) == 240  # rows that were left out come later, once
    rest = pool.draw(2000 - 240).index
    assert len(np.unique(np.concatenate([*seen, rest]))) == 2000
    with pytest.raises(sf.ArgumentError, match="only .* are that far apart"):
        fresh(pool).draw(500, min_distance=5.0)


def test_weights(pool):
    columns = pool.columns
    pool = fresh(pool)
    pool.weigh(lambda rows: (rows["pose"][:, 0] > 0) * 9.0 + 1.0)
    right = pool.draw(200).pose[:, 0] > 0
    share = (columns["pose"][:, 0] > 0).mean()
    expected = 9 * share * 10 / 9 / (10 * share + 1 - share)
    assert right.mean() == pytest.approx(expected, abs=0.1)
    pool.weigh((columns["pose"][:, 0] > 0).astype(float))
    assert (pool.draw(200).pose[:, 0] > 0).all()
    pool.weigh(None)
    assert len(np.unique(np.concatenate([pool.draw(800).index, pool.draw(800).index]))) == 1600
    with pytest.raises(sf.ArgumentError, match="numbers >= 0"):
        pool.weigh(-columns["pose"][:, 0])


def test_several_worlds(world, robot):
    low = sf.bake(sf.Scene("low").add_box((10, 10, 1), (0, 0, -100.5), label="terrain"))
    pool = sf.Pool([world, low], robot, 300, background=False)
    number = np.arange(100) % 2
    drawn = pool.draw(100, world=number)
    assert ((drawn.pose[:, 2] < -99) == (number == 1)).all() and (drawn.world == number).all()
    poses = np.zeros((100, 7))
    pool.draw(number == 1, poses, world=number)
    assert (poses[number == 1, 2] < -99).all() and (poses[number == 0] == 0).all()
    assert len(pool.columns["pose"]) == 600 and set(pool.columns["world"]) == {0, 1}
    with pytest.raises(sf.ArgumentError, match="there are 2 worlds"):
        pool.draw(3, world=2)


def test_save_and_load(pool, tmp_path):
    pool.save(tmp_path / "pool.npz")
    again = sf.Pool.load(tmp_path / "pool.npz")
    assert (again.draw(50).pose == fresh(pool).draw(50).pose).all()
    assert again.columns.keys() == pool.columns.keys()


class SlowWorld:
    """Gives rows at one place, and when it is released, rows that are 1 m apart."""

    name = "slow"

    def __init__(self):
        self.released = threading.Event()
        self.chunks = 0

    def sample(self, robot, count, **options):
        self.chunks += 1
        poses = np.zeros((count, 7))
        if self.chunks > 1:
            self.released.wait()
            poses[:, 0] = np.arange(count)
        return Rows(poses)


class Rows:
    def __init__(self, poses):
        self.columns = {"pose": poses}

    def __len__(self):
        return len(self.columns["pose"])


def test_min_distance_waits_for_rows(robot):
    world = SlowWorld()
    pool = sf.Pool([world], robot, 10_000)
    threading.Timer(0.3, world.released.set).start()
    assert len(pool.draw(3, min_distance=0.9)) == 3


def test_close_before_all_rows_are_there(robot):
    world = SlowWorld()
    pool = sf.Pool([world], robot, 10_000)
    pool.draw(1, min_distance=1.0)
    pool.close()
    world.released.set()
    pool.wait()
    rows = len(pool)
    assert rows < 10_000
    drawn = np.concatenate([pool.draw(rows - 10).index for _ in range(2)])  # over the end of the epoch
    assert drawn.max() < rows and len(np.unique(drawn[: rows - 1])) == rows - 1


def test_python_can_end_while_a_pool_is_made(source):
    code = """import spawnfield as sf
world = sf.bake("maps/training/scene.yaml")
print(sf.Pool(world, "maps/robots/husky.yaml", 10_000_000).draw(3).pose.shape)"""
    done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=False, cwd=source)
    assert done.returncode == 0 and done.stdout == "(3, 7)\n", done.stderr


def test_restart_repeats_draws(pool, tmp_path):
    pool = fresh(pool)
    pool.draw(1500)
    pool.restart(5)
    first = [pool.draw(900).index for _ in range(3)]
    assert len(np.unique(np.concatenate(first[:2]))) == 1800 and pool.epoch.tolist() == [1]
    pool.restart(5)
    assert pool.epoch.tolist() == [0] and all((pool.draw(900).index == rows).all() for rows in first)
    pool.restart(6)
    assert (pool.draw(900).index != first[0]).any()
    pool.save(tmp_path / "pool.npz")  # processes that read one file
    seeds = [sf.Pool.load(tmp_path / "pool.npz", seed=seed).draw(900).index for seed in (5, 5, 6)]
    assert (seeds[0] == first[0]).all() and (seeds[1] == first[0]).all() and (seeds[2] != first[0]).any()


def test_restart_keeps_weights(pool):
    right = (pool.columns["pose"][:, 0] > 0).astype(float)
    pool = fresh(pool)
    pool.weigh(right)
    pool.restart(3)
    assert (pool.draw(200).pose[:, 0] > 0).all()


def test_pairs(world, robot):
    pool = sf.Pool(world, robot, 50, pairs=True, min_path=2, reach_step=0.4, background=False)
    drawn = pool.draw(20)
    assert drawn.start.shape == drawn.goal.shape == (20, 7) and (drawn.path_length >= 2).all()


def test_faults(world, robot):
    scene = sf.Scene().add_box((2, 2, 1), label="terrain").add_box((4, 4, 1), (0, 0, 1))  # covered by an obstacle
    nothing = sf.bake(scene)
    with pytest.raises(sf.ArgumentError, match="no valid pose was found"):
        sf.Pool(nothing, robot, 10).draw(1)
    with pytest.raises(sf.ArgumentError, match="--min-path"):
        sf.Pool(world, robot, 10, min_path=3).draw(1)
    with pytest.raises(sf.ArgumentError, match="has 2000 rows"):
        sf.Pool.from_columns({"pose": np.zeros((2000, 7))}).draw(2001)


def test_draws_are_quick(pool):
    pool = fresh(pool)
    poses = np.zeros((4096, 7))
    mask = np.zeros(4096, bool)
    mask[::17] = True
    times = []
    for _ in range(7):
        begun = time.perf_counter()
        pool.draw(mask, out=poses)
        times.append(time.perf_counter() - begun)
    assert min(times) < 0.005  # about 30 us; the limit only finds work that grows with the pool
