"""Times a pool beside what users write today: making spawns, and resets of 4,096 environments of which 251 reset.

python python/bench/pool_speed.py [MAP]: of a baked map, or of the training arena. `spawnfield_bench --write-maps maps
--scene hills` makes the map of the table in docs/reinforcement-learning.md.

The alternatives need `pip install trimesh scipy embreex python-fcl`; without these packages, only the pool is timed.
Prints a table: the best of three runs for making spawns, the median for resets. Times are processor time on one core,
but elapsed time for "all cores". "valid" is the share of the spawns that `World.check` calls valid; places in water do
not count, because the alternatives do not know water.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import spawnfield as sf

BOX = (0.99, 0.67, 0.39)  # m: side lengths of the robot
ENVIRONMENTS, RESETS = 4096, 251


def times_of(work, rounds, clock=time.process_time):
    """Returns the times that the work takes, s: processor time, or that of another clock."""
    taken = []
    for _ in range(rounds):
        begun = clock()
        work()
        taken.append(clock() - begun)
    return taken


def mask_of_resets():
    mask = np.zeros(ENVIRONMENTS, bool)
    mask[np.random.default_rng(0).permutation(ENVIRONMENTS)[:RESETS]] = True
    return mask


def time_pool(world, robot):
    """Yields rows: what, spawns per second, share of valid ones, seconds of a reset."""
    for stance in ("level", "settled"):
        options = {"stance": stance, "background": False}
        pool = sf.Pool(world, robot, 200_000, **options)  # not timed
        valid = share_valid(world, robot, pool.columns["pose"][:20_000])
        for threads, cores, clock in ((1, "1 core", time.process_time), (0, "all cores", time.perf_counter)):
            taken = times_of(lambda: sf.Pool(world, robot, 200_000, threads=threads, **options), 3, clock)  # noqa: B023
            yield f"pool, {stance}, {cores}", 200_000 / min(taken), valid, None
    mask, poses = mask_of_resets(), np.zeros((ENVIRONMENTS, 7))
    draw = lambda: pool.draw(mask, out=poses)  # noqa: E731
    yield "draw of a pool", None, None, np.median(times_of(draw, 2000))
    pool.weigh("tilt")
    yield "draw with weights", None, None, np.median(times_of(draw, 2000))
    table, random = pool.columns["pose"], np.random.default_rng(0)

    def pick():
        poses[mask] = table[random.integers(len(table), size=RESETS)]

    yield "random rows of an array; rows repeat", None, None, np.median(times_of(pick, 2000))


def time_alternatives(world, robot):
    """Yields rows as time_pool, of level spawns on one core. Their resets make new spawns."""
    import alternatives

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "world.glb"
        world.export(format="glb", out=file)
        mesh = alternatives.mesh_of(file)
    mask, poses = mask_of_resets(), np.zeros((ENVIRONMENTS, 7))
    rays = "Embree" if "embree" in type(mesh.ray).__module__ else "rtree"
    for name, kind in (
        (f"nine rays, trimesh with {rays}", alternatives.RayCasting),
        (f"flat patches of Isaac Lab, trimesh with {rays}", alternatives.FlatPatches),
        (f"rejection with FCL, trimesh with {rays}", alternatives.Fcl),
    ):
        way = kind(mesh, BOX)
        made = way.spawns(20_000)  # this also builds the trees

        def reset():
            poses[mask] = way.spawns(RESETS)  # noqa: B023

        speed = 20_000 / min(times_of(lambda: way.spawns(20_000), 3))  # noqa: B023
        yield name, speed, share_valid(world, robot, made), np.median(times_of(reset, 20))


def share_valid(world, robot, poses):
    """Returns the share of valid poses among those that are not in water."""
    verdicts = world.check(robot, poses)
    return verdicts.valid.sum() / (np.array(verdicts.name) != "submerged").sum()


def main() -> None:
    source = Path(__file__).resolve().parents[2]
    world = sf.open(sys.argv[1]) if len(sys.argv) > 1 else sf.bake(source / "maps/training/scene.yaml")
    robot = sf.Robot("box:" + ",".join(map(str, BOX)))
    print(f"| {world.name} | spawns per second | valid | {RESETS} of {ENVIRONMENTS:,} reset, us |\n|---|---|---|---|")
    for rows in (time_pool, time_alternatives):
        try:
            for name, speed, valid, reset in rows(world, robot):
                made = f"{speed:,.0f}" if speed else ""
                share = f"{100 * valid:.2f} %" if valid else ""
                taken = f"{1e6 * reset:,.0f}" if reset else ""
                print(f"| {name} | {made} | {share} | {taken} |", flush=True)
        except ImportError as error:
            print(f"alternatives are left out: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
