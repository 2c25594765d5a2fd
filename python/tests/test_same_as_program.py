"""Python and the program give the same bytes for the same question."""

import json
from pathlib import Path

import pytest

import spawnfield as sf

BOX = "box:0.99,0.67,0.39"


@pytest.mark.parametrize(
    ("words", "options"),
    [
        ("--min-distance 1 --yaw random --seed 7", dict(min_distance=1.0, yaw="random", seed=7)),
        ("--stance level --offset 0.3", dict(stance="level", offset=0.3)),
        ("--settle --drop 0.1 --max-slope 10", dict(settle=True, drop=0.1, max_slope=10)),
        ("--region -5,-5,5,5 --z -1:1", dict(region=(-5, -5, 5, 5), z=(-1, 1))),
        (
            "--near cube* 0.5:1 --columns clearance,view --view-range 3",
            dict(near=("cube*", (0.5, 1)), columns=("clearance", "view"), view_range=3),
        ),
        ("--layers top --threads 1 --exhaustive", dict(layers="top", threads=1, exhaustive=True)),
        ("--without cube* --without thin_wall", dict(without=["cube*", "thin_wall"])),
        ("--with box:0.5,0.5,1@3,3,0", dict(with_="box:0.5,0.5,1@3,3,0")),
        ("--yaw best:8 --island largest --reach-step 0.4", dict(yaw="best:8", island="largest", reach_step=0.4)),
    ],
)
def test_sample(world, robot, program, words, options):
    found = world.sample(robot, 40, **options)
    assert len(found) == 40
    assert found.to_csv() == program("sample", world.folder, "--robot", BOX, "-n", 40, *words.split())


def test_search(world, robot, program):
    options = dict(min_distance=1.5, max_failures=10000, seed=3)
    words = ["--min-distance", 1.5, "--max-failures", 10000, "--seed", 3]
    expected = program("search", world.folder, "--robot", BOX, "-n", 20, *words)
    assert world.search(robot, 20, **options).to_csv() == expected


@pytest.mark.parametrize("stance", ["level", "settled"])
@pytest.mark.parametrize("repair", [None, 1.0])
def test_check(world, robot, program, tmp_path, stance, repair):
    poses = tmp_path / "poses.csv"
    rows = [f"{x},{y},0.1,{x * 0.3}" for x in range(-9, 10, 3) for y in range(-9, 10, 3)]
    poses.write_text("x,y,z,yaw\n" + "\n".join(rows) + "\n")
    words = ["--repair", repair] if repair else []
    expected = program("check", world.folder, "--robot", BOX, "--poses", poses, "--stance", stance, *words)
    found = world.check(robot, poses, stance=stance, repair=repair)
    assert found.to_csv() == expected
    from_array = world.check(
        robot, [[float(number) for number in row.split(",")] for row in rows], stance=stance, repair=repair
    )
    assert (from_array.code == found.code).all()
    assert from_array.name == [line.split(",")[4] for line in expected.decode().splitlines()[1:]]


@pytest.mark.parametrize(
    ("words", "options"),
    [
        ("--dims 2", dict()),
        ("--dims 2 --stance settled --yaw any:4", dict(stance="settled", yaw="any:4")),
        ("--dims 3 --step-z 0.5", dict(dims=3, step_z=0.5)),
    ],
)
def test_raster(world, robot, program, words, options):
    expected = program("raster", world.folder, "--robot", BOX, "--step", 0.5, *words.split())
    assert world.raster(robot, 0.5, **options).to_csv() == expected


@pytest.mark.parametrize("format", ["png", "svg"])
def test_heatmap(world, robot, program, tmp_path, format):
    file = tmp_path / f"map.{format}"
    program("heatmap", world.folder, "--robot", BOX, "--quantity", "clearance", "--size", 500, "-o", file)
    picture = world.heatmap(robot, quantity="clearance", size=500, format=format)
    assert picture.data == file.read_bytes()


def test_pairs(world, robot, program, tmp_path):
    options = ["--pairs", 10, "--min-path", 3, "--reach-step", 0.4]
    expected = program("sample", world.folder, "--robot", BOX, *options)
    file = tmp_path / "pairs.csv"
    pairs = world.sample(robot, pairs=10, min_path=3, reach_step=0.4, out=file)
    assert file.read_bytes() == expected
    rows = [line.split(",") for line in expected.decode().splitlines()]
    lengths = [float(row[rows[0].index("path_length")]) for row in rows[1:]]
    assert pairs.path_length.tolist() == lengths
    judged = world.check(robot, pairs=str(file), reach_step=0.4)
    assert judged.encode() == program("check", world.folder, "--robot", BOX, "--pairs", file, "--reach-step", 0.4)


def test_fleet(world, program, tmp_path):
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(
        "format: spawnfield-fleet/1\nrobots:\n- {name: box, robot: 'box:0.99,0.67,0.39', count: 4}\n"
        "- {name: small, robot: 'box:0.3,0.3,0.2', count: 3, yaw: random}\n"
    )
    expected = program("sample", world.folder, "--fleet", fleet)
    file = tmp_path / "fleet.csv"
    found = world.sample(fleet=fleet, out=file)
    assert file.read_bytes() == expected
    rows = [line.split(",") for line in expected.decode().splitlines()[1:]]
    assert found.names == [row[0] for row in rows]
    assert [found.kinds[kind] for kind in found.kind] == [row[1] for row in rows]
    assert found.pose[:, 0].tolist() == [float(row[2]) for row in rows]


def test_info(world, robot, program):
    assert world.info() == json.loads(program("info", world.folder, "--json"))


def test_export(world, robot, program, tmp_path):
    poses = tmp_path / "poses.csv"
    spawns = world.sample(robot, 5, seed=2, out=poses)
    expected = program("export", world.folder, "--format", "unreal", "--robot", BOX, "--poses", poses)
    assert world.export(robot, format="unreal", poses=poses).encode() == expected
    rows = world.export(robot, format="unreal", poses=spawns).splitlines()
    assert len(rows) == 6


def test_bake(world, source, tmp_path, program):
    program("bake", source / "maps/training/scene.yaml", "-o", tmp_path / "map")
    again = sf.bake(source / "maps/training/scene.yaml", tmp_path / "again", model_path=source / "maps")
    assert again.hash == world.hash
    for file in sorted(Path(world.folder).iterdir()):
        if not file.name.startswith("reach-"):
            assert file.read_bytes() == (tmp_path / "map" / file.name).read_bytes(), file.name
