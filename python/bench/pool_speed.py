"""Times a pool: resets of 4,096 environments of which 251 reset, and making the spawns. Prints a table.

python python/bench/pool_speed.py [MAP]: of a baked map, or of the training arena.
"""

import sys
import time
from pathlib import Path

import numpy as np

import spawnfield as sf


def median_time(work, times=2000):
    """Returns the median of the times that the work takes, s."""
    taken = []
    for _ in range(times):
        begun = time.perf_counter()
        work()
        taken.append(time.perf_counter() - begun)
    return float(np.median(taken))


def main() -> None:
    source = Path(__file__).resolve().parents[2]
    world = sf.open(sys.argv[1]) if len(sys.argv) > 1 else sf.bake(source / "maps/training/scene.yaml")
    robot = sf.Robot("box:0.99,0.67,0.39")
    rows = []
    pools = {}
    for stance in ("level", "settled"):
        begun = time.perf_counter()
        pools[stance] = sf.Pool(world, robot, 200_000, stance=stance, background=False)
        rows.append((f"making {stance} spawns", f"{200_000 / (time.perf_counter() - begun):,.0f} per second"))
    pool = pools["settled"]
    mask = np.zeros(4096, bool)
    mask[np.random.default_rng(0).permutation(4096)[:251]] = True
    poses = np.zeros((4096, 7))
    draw = lambda: pool.draw(mask, out=poses)  # noqa: E731
    rows.append(("draw for 251 of 4,096 environments", f"{median_time(draw) * 1e6:.0f} us"))
    pool.weigh("tilt")
    rows.append(("the same with weights", f"{median_time(draw) * 1e6:.0f} us"))
    for what, figure in rows:
        print(f"| {what} | {figure} |")


if __name__ == "__main__":
    main()
