#!/usr/bin/env python3
"""Measures the time and the memory of large work: many samples, poses, columns, triangles and parts.

    tests/load/load.py PROGRAM [--scale S] [--only NAME ...] [--folder FOLDER]

Prints a row of Markdown for each run: what it does, how much, seconds, processor time, and the memory of its largest
process. --scale 0.01 does a hundredth of the work. All of it needs 30 GB of disk. The inputs are made in FOLDER
(default: a temporary folder), and removed at the end. The exit status is 1 if a run fails.
"""
import argparse
import math
import os
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
HUSKY = str(ROOT / "maps/robots/husky.yaml")


def measured(command, out=None):
    """Runs a command. Returns (wall-clock seconds, processor seconds, megabytes of its largest process)."""
    start = time.monotonic()
    with open(out or os.devnull, "wb") as stdout:
        child = subprocess.Popen(command, stdout=stdout, stderr=subprocess.PIPE)
        text = child.stderr.read()
        _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} ended with status {child.returncode}: {text.decode(errors='replace')}")
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1000


def write_scene(file, parts):
    lines = ["format: spawnfield-scene/1", f"name: {file.stem}", "parts:"]
    file.write_text("\n".join(lines + [f"- {{{part}}}" for part in parts]) + "\n")
    return str(file)


def hills(file, cells):
    """Writes a binary STL of about so many triangles: hills of 100 x 100 m."""
    side = int(math.sqrt(cells / 2))
    step = 100 / side
    heights = [[2 * math.sin(0.1 * i * step) * math.cos(0.13 * j * step) for i in range(side + 1)]
               for j in range(side + 1)]
    with open(file, "wb") as out:
        out.write(b"\0" * 80 + struct.pack("<I", 2 * side * side))
        for j in range(side):
            row = bytearray()
            for i in range(side):
                corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                a, b, c, d = [(x * step - 50, y * step - 50, heights[y][x]) for x, y in corners]
                row += struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) + struct.pack("<12fH", 0, 0, 0, *a, *c, *d, 0)
            out.write(row)
    return 2 * side * side


class Load:
    """The runs. Each returns what was done, and how much of it."""

    def __init__(self, program, folder, scale):
        self.program, self.folder, self.scale = program, folder, scale

    def path(self, name):
        return str(self.folder / name)

    def spawnfield(self, *words, out=None):
        return measured([self.program, *[str(word) for word in words], "--quiet"], out)

    def training(self):
        if not Path(self.path("training")).exists():
            self.spawnfield("bake", ROOT / "maps/training/scene.yaml", "-o", self.path("training"))
        return self.path("training")

    def samples(self):
        count = int(1e6 * self.scale)
        run = self.spawnfield("sample", self.training(), "--robot", HUSKY, "-n", count, "--stance", "level", "-o",
                              self.path("samples.csv"))
        return "sample, level", f"{count:,} spawns", run

    def settled(self):
        count = int(1e6 * self.scale)
        run = self.spawnfield("sample", self.training(), "--robot", HUSKY, "-n", count, "-o", self.path("settled.csv"))
        return "sample, settled", f"{count:,} spawns", run

    def raster(self):
        step = 0.00206 / math.sqrt(self.scale)
        run = self.spawnfield("raster", self.training(), "--robot", HUSKY, "--dims", 2, "--step", step, "--offset", 0.1,
                              "-o", self.path("raster.csv"))
        return "raster -o FILE", f"{self.lines('raster.csv'):,} poses", run

    def check(self):
        if not Path(self.path("raster.csv")).exists():
            self.raster()
        run = self.spawnfield("check", self.training(), "--robot", HUSKY, "--poses", self.path("raster.csv"), "-o",
                              self.path("checked.csv"))
        return "check -o FILE", f"{self.lines('raster.csv'):,} poses", run

    def lines(self, name):
        with open(self.path(name), "rb") as file:
            return sum(piece.count(b"\n") for piece in iter(lambda: file.read(1 << 24), b"")) - 1

    def columns(self):
        side = 1000 * math.sqrt(self.scale)
        scene = write_scene(self.folder / "large.yaml",
                            [f"name: floor, label: terrain, box: [{side}, {side}, 1]",
                             "name: crate, label: obstacle, box: [1, 1, 3]"])
        run = self.spawnfield("bake", scene, "-o", self.path("large"), "--resolution", 0.1)
        return "bake, a floor", f"{round(side / 0.1) ** 2:,} columns", run

    def triangles(self):
        count = hills(self.folder / "hills.stl", 1e7 * self.scale)
        run = self.spawnfield("bake", self.path("hills.stl"), "-o", self.path("hills"), "--label", "*=terrain")
        return "bake, one mesh", f"{count:,} triangles", run

    def parts(self):
        side = round(math.sqrt(1e4 * self.scale))
        boxes = [f"name: crate_{i}_{j}, label: obstacle, box: [1, 1, 1], xyz: [{3 * i}, {3 * j}, 0.5]"
                 for i in range(side) for j in range(side)]
        floor = f"name: floor, label: terrain, box: [{9 * side}, {9 * side}, 1], xyz: [0, 0, -0.5]"
        scene = write_scene(self.folder / "crates.yaml", [floor] + boxes)
        run = self.spawnfield("bake", scene, "-o", self.path("crates"))
        return "bake, many parts", f"{side * side + 1:,} parts", run

    def robot(self):
        count = max(2, int(1000 * self.scale))
        rows = [f"  - {{box: [0.02, 0.02, 0.02], xyz: [{0.03 * (i % 32)}, {0.03 * (i // 32)}, 0.01]}}"
                for i in range(count)]
        robot = self.folder / "robot.yaml"
        robot.write_text("format: spawnfield-robot/1\nname: many\nparts:\n" + "\n".join(rows) + "\n")
        run = self.spawnfield("sample", self.training(), "--robot", robot, "-n", 100, "--stance", "level", "-o",
                              self.path("robot.csv"))
        return "sample -n 100, level", f"a robot of {count:,} parts", run


RUNS = ("samples", "settled", "raster", "check", "columns", "triangles", "parts", "robot")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--scale", type=float, default=1, help="share of the work, > 0 to 1 (default 1)")
    parser.add_argument("--only", nargs="+", choices=RUNS, default=RUNS)
    parser.add_argument("--folder", help="where the inputs and results are made")
    args = parser.parse_args()
    if not 0 < args.scale <= 1:
        parser.error(f"--scale is {args.scale}, needs more than 0, at most 1")
    print("| work | how much | s | processor s | MB |\n|---|---|---|---|---|")
    failed = False
    with tempfile.TemporaryDirectory(dir=args.folder) as folder:
        load = Load(os.path.abspath(args.program), Path(folder), args.scale)
        for name in args.only:
            try:
                work, amount, (seconds, processor, megabytes) = getattr(load, name)()
                print(f"| {work} | {amount} | {seconds:.1f} | {processor:.1f} | {megabytes:.0f} |", flush=True)
            except RuntimeError as error:
                print(error, file=sys.stderr)
                failed = True
    return failed


if __name__ == "__main__":
    sys.exit(main())
