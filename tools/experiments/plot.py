#!/usr/bin/env python3
"""Draws plots of the experiments from the tables that spawnfield_experiments writes.

plot.py FOLDER reads FOLDER/{runs,thesis,milestones,column_finds}.csv and writes FOLDER/experiments/*.png and *.svg.
Colours: Okabe, Ito, Color Universal Design, 2008.
"""
import csv
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams["svg.hashsalt"] = "spawnfield"  # gives the same bytes for the same tables
import matplotlib.pyplot as plt
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

BLUE, ORANGE, GREEN, GREY, BLACK = "#0072B2", "#D55E00", "#009E73", "#BBBBBB", "#000000"
ENVIRONMENTS = ("low-complexity", "complex")
BREAK_EVEN = 1.8  # m; step at which 2D and 3D rasters of the thesis take the same time


def read(file):
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


def save(figure, folder, name, room_below=0.0):
    figure.tight_layout(rect=(0, room_below, 1, 1))
    figure.savefig(folder / f"{name}.png", dpi=100, metadata={"Software": None})
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    plt.close(figure)


def mean_seconds(rows):
    """Returns (step, positions, mean seconds) for each step, in ascending order."""
    groups = {}
    for row in rows:
        groups.setdefault((float(row["step"]), int(row["positions"])), []).append(float(row["seconds"]))
    return [(step, positions, statistics.mean(seconds)) for (step, positions), seconds in sorted(groups.items())]


def plot_steps(runs, thesis, folder):
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.5), sharey=True)
    for column, environment in enumerate(ENVIRONMENTS):
        for dims, test, colour in (("3D", 3 + column, BLUE), ("2D", 5 + column, ORANGE)):
            box_runs = [r for r in runs if int(r["test"]) == test and r["robot"] == "box"]
            ours = mean_seconds([r for r in box_runs if r["mode"] == "mask"])
            fcl = mean_seconds([r for r in box_runs if r["mode"] == "fcl"])
            theirs = mean_seconds([r for r in thesis if int(r["test"]) == test])
            for points, style, name in ((ours, "o-", "spawnfield"), (fcl, "x:", "FCL at every position"),
                                        (theirs, "s--", "thesis")):
                seconds, label = [p[2] for p in points], f"{dims}, {name}"
                axes[0][column].plot([p[1] for p in points], seconds, style, color=colour, label=label)
                axes[1][column].plot([p[0] for p in points], seconds, style, color=colour, label=label)
        axes[0][column].set(xscale="log", yscale="log", xlabel="positions checked", title=environment)
        axes[1][column].axvline(BREAK_EVEN, color=GREY, linestyle="-.", label="the thesis's break-even of 2D and 3D")
        axes[1][column].set(yscale="log", xlabel="step, m")
        for row in (0, 1):
            axes[row][column].grid(True, which="major", color="#DDDDDD")
            axes[row][column].set_ylabel("time, s")
    figure.legend(*axes[1][0].get_legend_handles_labels(), fontsize=8, loc="lower center", ncol=4, frameon=False)
    save(figure, folder, "time_against_steps", room_below=0.06)


def plot_milestones(milestones, thesis, folder):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.5))
    for axis, environment, test in zip(axes, ENVIRONMENTS, (7, 8)):
        for with_distance, colour, label in (("1", BLUE, "2.5 m from all checked positions"),
                                             ("0", ORANGE, "no distance check")):
            rows = [m for m in milestones if m["environment"] == environment and m["distance_check"] == with_distance]
            for number, repetition in enumerate(sorted({row["repetition"] for row in rows}, key=int)):
                points = [(int(row["found"]), 1e3 * float(row["seconds"]))
                          for row in rows if row["repetition"] == repetition]
                axis.plot(*zip(*sorted(points)), ".-", color=colour, linewidth=0.9,
                          label=label if number == 0 else None)
        theirs = next(float(row["seconds"]) for row in thesis if int(row["test"]) == test)
        axis.plot([2000], [1e3 * theirs], "s", color=BLACK, label=f"thesis, mean: {theirs:g} s")
        axis.set(yscale="log", xlabel="spawns found", ylabel="time, ms", title=environment)
        axis.grid(True, which="major", color="#DDDDDD")
        axis.legend(fontsize=8)
    save(figure, folder, "time_against_spawns")


def plot_columns(finds, folder):
    """Draws side by side in which columns each raster finds a place to stand."""
    xs, ys = sorted({float(f["x"]) for f in finds}), sorted({float(f["y"]) for f in finds})
    col, row = {x: i for i, x in enumerate(xs)}, {y: i for i, y in enumerate(ys)}
    names = (("in_2d", "2D"), ("in_3d", "3D"), ("in_3d_snapped", "3D, --snap"))
    colours = ListedColormap(["#FFFFFF", GREY, GREEN, ORANGE])
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.6), sharey=True)
    for axis, (key, title) in zip(axes, names):
        image = [[0] * len(xs) for _ in ys]
        for f in finds:
            missed = f["in_2d"] == "1" and f[key] == "0"
            image[row[float(f["y"])]][col[float(f["x"])]] = 3 if missed else 2 if f[key] == "1" else 1
        axis.imshow(image, origin="lower", cmap=colours, vmin=0, vmax=3, interpolation="nearest",
                    extent=(xs[0], xs[-1], ys[0], ys[-1]))
        axis.set(title=title, xlabel="x, m")
    axes[0].set_ylabel("y, m")
    figure.legend(handles=[Patch(color=GREEN, label="a place to stand"),
                           Patch(color=ORANGE, label="missed: 2D finds one"), Patch(color=GREY, label="none")],
                  loc="lower center", ncol=3, fontsize=9, frameon=False)
    save(figure, folder, "columns_2d_3d", room_below=0.07)


def main():
    folder = pathlib.Path(sys.argv[1])
    pictures = folder / "experiments"
    runs, thesis = read(folder / "runs.csv"), read(folder / "thesis.csv")
    plot_steps(runs, thesis, pictures)
    plot_milestones(read(folder / "milestones.csv"), thesis, pictures)
    plot_columns(read(folder / "column_finds.csv"), pictures)


if __name__ == "__main__":
    main()
