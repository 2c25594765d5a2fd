"""Times `sf.batch` with one and with two processes, on rooms with random boxes. Prints a table.

python python/bench/batch_speed.py [WORLDS]: 100 worlds by default.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import spawnfield as sf


def free_area(scene):
    """Bakes a world and returns where a robot stands in it."""
    world = sf.bake(scene, threads=1, quiet=True)
    raster = world.raster("box:0.5,0.4,0.3", 0.1, stance="settled", threads=1, quiet=True)
    return {"valid": raster.counts["valid"], "share": raster.counts["valid"] / len(raster)}


def make_rooms(folder, count):
    """Writes scenes of 8 x 8 m with 30 boxes on the floor, and returns their names."""
    random = np.random.default_rng(0)
    names = []
    for k in range(count):
        lines = ["format: spawnfield-scene/1", "parts:",
                 "- {name: floor, label: terrain, box: [8, 8, 0.2], xyz: [0, 0, -0.1]}"]  # fmt: skip
        for n in range(30):
            x, y = random.uniform(-4, 4, 2)
            size = random.uniform(0.1, 0.8, 3)
            lines.append(f"- {{name: box_{n}, label: obstacle, box: {size.tolist()}, xyz: [{x}, {y}, {size[2] / 2}]}}")
        file = folder / f"room_{k:04}.yaml"
        file.write_text("\n".join(lines) + "\n")
        names.append(str(file))
    return names


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    with tempfile.TemporaryDirectory(prefix="spawnfield-") as folder:
        scenes = make_rooms(Path(folder), count)
        seconds, tables = {}, set()
        for workers in (1, 2):
            begun = time.perf_counter()
            table = sf.batch(free_area, scenes, workers=workers, progress=False)
            seconds[workers] = time.perf_counter() - begun
            tables.add(table.to_csv())
            print(f"| {workers} | {seconds[workers]:.1f} s |", flush=True)
        assert len(tables) == 1, "the tables differ"
        print(f"2 processes are {seconds[1] / seconds[2]:.2f} times as fast; both times have the start of Dask")


if __name__ == "__main__":
    main()
