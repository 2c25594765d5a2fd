"""4,096 robots in MuJoCo's batch rollout that start from one draw of a pool; counts how many stand after a second.

The same is done with places that no one has checked: random ones, with the robot level above the highest ground below
it.

    pip install gymnasium mujoco
    python python/examples/batch_rollout.py [NUMBER]
"""

import os
import sys
import time

import mujoco
import mujoco.rollout
import numpy as np
from gym_river import TO_QPOS, make_model, make_pool, make_world, read_heights

LIFT = 0.02  # m by which a pool raises its poses, so that they touch nothing


def simulate(model, poses, seconds=1.0, threads=None):
    """Returns where robots that start at poses are after some time without control: (n, 7), as the poses."""
    data = mujoco.MjData(model)
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, state, kind)
    states = np.tile(state, (len(poses), 1))
    states[:, 1:8] = poses[:, TO_QPOS]  # state 0 is the time; the wheels' angles follow
    threads = threads or os.cpu_count()
    workers = [mujoco.MjData(model) for _ in range(threads)]
    steps = round(seconds / model.opt.timestep)
    with mujoco.rollout.Rollout(nthread=threads) as batch:
        ways, _ = batch.rollout(model, workers, states, nstep=steps)  # (n, steps, states)
    out = np.empty((len(poses), 7))
    out[:, TO_QPOS] = ways[:, -1, 1:8]
    return out


def stand(starts, ends):
    """Returns whether each robot still stands at its start: at most 5 cm and 3 degrees from where it was put."""
    moved = np.linalg.norm(ends[:, :3] - starts[:, :3] + [0, 0, LIFT], axis=1)
    turned = 2 * np.arccos(np.clip(np.abs((starts[:, 3:] * ends[:, 3:]).sum(axis=1)), 0, 1))
    return (moved <= 0.05) & (turned <= np.radians(3))


def unchecked_poses(heights, count, seed=0):
    """Returns level poses at random places, LIFT above the highest of nine points of the ground below the robot."""
    random = np.random.default_rng(seed)
    half = (np.array(heights.shape[::-1]) - 1) / 2  # m, of the world
    center = random.uniform(-half + 1, half - 1, (count, 2))
    yaw = random.uniform(-np.pi, np.pi, count)
    ahead = np.stack([np.cos(yaw), np.sin(yaw)], axis=1)
    left = np.stack([-np.sin(yaw), np.cos(yaw)], axis=1)
    below = [center + dx * ahead + dy * left for dx in (-0.42, 0, 0.42) for dy in (-0.34, 0, 0.34)]
    z = LIFT + np.max([height_at(heights, half[0] + at[:, 0], half[1] - at[:, 1]) for at in below], axis=0)
    zero = np.zeros(count)
    return np.stack([*center.T, z, zero, zero, np.sin(yaw / 2), np.cos(yaw / 2)], axis=1)


def height_at(heights, col, row):
    """Returns the heights at places of the grid, interpolated."""
    c, r = col.astype(int), row.astype(int)
    u, v = col - c, row - r
    above = heights[r, c] * (1 - u) + heights[r, c + 1] * u
    return above * (1 - v) + (heights[r + 1, c] * (1 - u) + heights[r + 1, c + 1] * u) * v


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    heights = read_heights()
    model = make_model(heights)
    begun = time.perf_counter()
    pool = make_pool(make_world(heights), size=max(10_000, count)).wait()
    print(f"{len(pool)} spawns made in {time.perf_counter() - begun:.2f} s")
    begun = time.perf_counter()
    starts = pool.draw(count).pose
    print(f"{count} drawn in {1e3 * (time.perf_counter() - begun):.2f} ms")
    for name, poses in (("from the pool", starts), ("unchecked", unchecked_poses(heights, count))):
        begun = time.perf_counter()
        standing = stand(poses, simulate(model, poses)).sum()
        print(f"{name}: {standing} of {count} stand after 1 s (simulated in {time.perf_counter() - begun:.1f} s)")


if __name__ == "__main__":
    main()
