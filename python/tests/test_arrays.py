"""Arrays in and out: shapes, types, memory, errors."""

import gc
import logging
import os
import signal
import tempfile
import threading
import time

import numpy as np
import pytest

import spawnfield as sf


def test_spawns(world, robot):
    spawns = world.sample(robot, 50, min_distance=0.5, yaw="random", seed=1)
    assert len(spawns) == 50
    assert spawns.pose.shape == (50, 7) and spawns.pose.dtype == np.float64
    assert np.allclose(np.linalg.norm(spawns.pose[:, 3:], axis=1), 1)
    qx, qy, qz, qw = spawns.pose[:, 3:].T
    assert np.allclose(np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy**2 + qz**2)), spawns.yaw)
    assert np.allclose(np.arcsin(2 * (qw * qy - qz * qx)), spawns.pitch)
    assert np.allclose(np.arctan2(2 * (qw * qx + qy * qz), 1 - 2 * (qx**2 + qy**2)), spawns.roll)
    gaps = np.linalg.norm(spawns.position[:, None] - spawns.position[None], axis=-1)
    assert gaps[~np.eye(50, dtype=bool)].min() >= 0.5
    assert spawns.tilt.shape == spawns.margin.shape == (50,)
    assert (spawns.verdict == sf.VALID).all()
    assert world.check(robot, spawns).valid.all()


@pytest.mark.parametrize("width", [3, 4, 6, 7])
def test_forms_of_poses(world, robot, width):
    full = [[0, 0, 0.1, 0, 0, 0, 1], [7, 7, 0.1, 0, 0, 0, 1]]
    rows = {3: [r[:3] for r in full], 4: [[*r[:3], 0] for r in full], 6: [[*r[:3], 0, 0, 0] for r in full], 7: full}
    verdicts = world.check(robot, np.array(rows[width], np.float32))
    assert verdicts.name == world.check(robot, np.array(full)).name
    assert verdicts.code.dtype == np.uint8


def test_one_pose(world, robot):
    assert len(world.check(robot, [0, 0, 0.1])) == 1


def test_settled_contacts(world, robot):
    spawn = world.sample(robot, 1, seed=3)
    verdicts = world.check(robot, spawn, settle=True)
    assert verdicts.valid.all() and verdicts.settled.shape == (1, 7)
    contacts = verdicts.contacts[0]
    assert contacts.point.shape == contacts.normal.shape and len(contacts.point) >= 3
    assert np.allclose(np.linalg.norm(contacts.normal, axis=1), 1)
    assert np.linalg.norm(contacts.point - spawn.position, axis=1).max() < 1


def test_contacts_of_spawns(world, robot):
    limits = {"lift": 0.05, "max_slope": 20, "seed": 3}
    spawns = world.sample(robot, 50, stance="settled", **limits)
    contacts = spawns.contacts
    assert len(contacts) == 50 and contacts.point.shape == contacts.normal.shape == (contacts.first[-1], 3)
    for i, position in enumerate(spawns.position):
        below = contacts[i].point - (position - [0, 0, limits["lift"]])  # the spawn is raised
        assert len(below) >= 3 and np.linalg.norm(below, axis=1).max() < 1
        # The mass, here the middle of the box, is inside the polygon of the contacts.
        middle = below.mean(axis=0)
        assert np.linalg.norm(middle[:2]) < 0.5 and abs(middle[2]) < 0.5
    assert len(world.check(robot, spawns).contacts.point) == 0  # not let down
    assert len(world.sample(robot, 2, seed=1).contacts) == 2


def test_hit_and_reason():
    scene = sf.Scene("one_wall").add_box((20, 20, 1), (0, 0, -0.5), label="terrain", name="floor")
    scene.add_box((0.2, 4, 2), (3, 0, 1), name="wall")
    world = sf.bake(scene)
    verdicts = world.check("box:1,0.6,0.4", [[0, 0, 0.3], [2.6, 0, 0.3], [2.3, 0, 0.3], [50, 0, 0.3]])
    assert verdicts.name == ["valid", "collision", "valid", "outside"]
    assert verdicts.hit == ["", "wall", "", ""]
    assert verdicts.reason[1] == "collision with wall"
    assert verdicts.ground[0] == pytest.approx(0) and np.isnan(verdicts.ground[3])
    with pytest.raises(AttributeError, match="has no 'repair'; it has code, ground"):
        verdicts.repair
    repaired = world.check("box:1,0.6,0.4", [[2.6, 0, 0.3]], repair=1.0)
    assert repaired.repair.shape == (1, 7) and 0 < repaired.repair_distance[0] < 0.4


def test_raster_image(world, robot):
    raster = world.raster(robot, 0.5)
    image = raster.image()
    assert image.dtype == np.uint8 and image.shape[1:] == (raster.grid["rows"], raster.grid["cols"])
    assert (image == sf.VALID).sum() == raster.counts["valid"]
    heights = raster.image("z")
    assert np.isnan(heights[image == 255]).all() and not np.isnan(heights[image != 255]).any()
    top = image[0]
    for row, col, code in zip(raster.row[::7], raster.col[::7], raster.verdict[::7]):
        assert code in image[:, row, col]
    assert top.shape == (raster.grid["rows"], raster.grid["cols"])


def test_raster_3d(world, robot):
    raster = world.raster(robot, 1.0, dims=3, step_z=0.5)
    image = raster.image(fill=255)
    assert image.shape[0] == raster.grid["heights"]
    assert (image != 255).sum() == len(raster)


def test_xarray(world, robot):
    xarray = pytest.importorskip("xarray")
    data = world.raster(robot, 0.5, stance="settled").to_xarray()
    assert isinstance(data, xarray.Dataset)
    assert data.verdict.dims == ("level", "y", "x") and data.tilt.attrs["units"] == "rad"
    assert data.x.attrs["units"] == "m" and float(data.x[1] - data.x[0]) == pytest.approx(0.5)
    assert int((data.verdict == sf.VALID).sum()) == world.raster(robot, 0.5, stance="settled").counts["valid"]


def test_dlpack(world, robot):
    class Foreign:  # as a tensor of another library
        def __init__(self, values):
            self.values = values

        def __dlpack__(self, **options):
            return self.values.__dlpack__(**options)

        def __dlpack_device__(self):
            return self.values.__dlpack_device__()

    poses = np.array([[0, 0, 0.1, 0.0]])
    assert world.check(robot, Foreign(poses)).name == world.check(robot, poses).name


def test_scene_from_mesh():
    trimesh = pytest.importorskip("trimesh")
    floor = trimesh.creation.box((10, 10, 0.2))
    world = sf.bake(floor)
    assert world.upper[2] == pytest.approx(0.1)
    scene = sf.Scene("room").add_trimesh(floor, "terrain", "floor")
    scene.add_trimesh(trimesh.creation.icosphere(radius=0.5).apply_translation([2, 0, 0.4]), name="ball")
    verdicts = sf.bake(scene).check("box:0.5,0.5,0.2", [[2, 0, 0.3], [-2, 0, 0.3]])
    assert verdicts.hit == ["ball", ""]


def test_labels_of_faces():
    vertices = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [8, 0, 0], [8, 4, 0]]
    faces = [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]
    scene = sf.Scene().add_mesh(vertices, faces, ["terrain", "terrain", "water", "ignore"], "ground", solid="no")
    assert scene.part_names == ["ground.terrain", "ground.water"]
    with pytest.raises(sf.ArgumentError, match="'grass'"):
        sf.Scene().add_mesh(vertices, faces, ["grass"] * 4)
    with pytest.raises(sf.ArgumentError, match="row 0 has the vertex 9, but there are 6 vertices"):
        sf.Scene().add_mesh(vertices, [[0, 1, 9]])


def test_heights():
    rows, cols = 21, 31
    x, y = np.meshgrid(np.arange(cols) * 0.5 + 10.25, 20.25 - np.arange(rows) * 0.5 - 0.5)
    heights = 0.1 * x
    heights[3, 4] = np.nan
    scene = sf.Scene().add_heights(heights, (0.5, 0, 10, 0, -0.5, 20.0))
    world = sf.bake(scene)
    assert world.lower[:2] == pytest.approx((10.25, 9.75)) and world.upper[:2] == pytest.approx((25.25, 19.75))
    verdicts = world.check("box:0.4,0.4,0.2", [[20, 15, 2.4], [12.25, 18.25, 2.0]])
    assert verdicts.ground[0] == pytest.approx(2.0)
    assert np.isnan(verdicts.ground[1])


def test_errors(world, robot):
    with pytest.raises(sf.ArgumentError, match="did you mean min_distance") as caught:
        world.sample(robot, 5, min_distanc=1)
    with pytest.raises(sf.ArgumentError, match="--min-distance is -1, needs >= 0 m") as caught:
        world.sample(robot, 5, min_distance=-1)
    assert caught.value.field == "min_distance" and isinstance(caught.value, ValueError)
    with pytest.raises(sf.FileError, match="nowhere: does not exist"):
        sf.open("nowhere")
    with pytest.raises(sf.FileError, match="nothing.urdf"):
        sf.Robot("nothing.urdf")
    with pytest.raises(sf.ArgumentError, match="row 1 has a number that is not finite"):
        world.check(robot, [[0, 0, 0], [0, np.nan, 0]])
    with pytest.raises(sf.ArgumentError, match="array of shape"):
        world.check(robot, np.zeros((2, 5)))
    with pytest.raises(sf.ArgumentError, match="--poses is not an array of numbers"):
        world.check(robot, [[0, 0, 0.1], [0, 0, 0.1, 1.57]])
    with pytest.raises(sf.ArgumentError, match="quaternion of length 0"):
        world.check(robot, np.zeros((2, 7)))
    with pytest.raises(sf.NotValid, match="1 of 2 poses is not valid:\n  pose 1: aerial") as caught:
        world.check(robot, [[0, 0, -0.1], [0, 0, 0.1]], require_valid=True)
    assert caught.value.verdicts.name[1] == "valid"
    with pytest.raises(sf.ArgumentError, match="give labels and lengths to the Scene"):
        sf.bake(sf.Scene().add_box((1, 1, 1), label="terrain"), scale=2)
    with pytest.raises(sf.FileError, match="no terrain"):
        sf.bake(sf.Scene().add_box((1, 1, 1)))


def test_notices_are_logged_as_warnings_once(world, robot, caplog):
    for level in ("WARNING", "INFO", "INFO"):
        with caplog.at_level(logging.INFO, "spawnfield"):
            assert len(world.sample(robot, 5003, min_distance=3.1)) < 5003
        assert [record.levelname for record in caplog.records if "min-distance" in record.message] == [level]
        caplog.clear()
    world.sample(robot, 5000, min_distance=3, quiet=True)
    assert not caplog.records or "spawns were found" in caplog.text


def test_progress(world, robot, monkeypatch):
    shares = []
    from spawnfield import commands

    class Bar:
        def __call__(self, label, share):
            shares.append((label, share))

        def close(self):
            shares.append("closed")

    monkeypatch.setattr(commands, "progress_bar", lambda wanted: Bar())
    world.raster(robot, 0.02)
    assert shares[-1] == "closed" and all(0 <= share <= 1 for _, share in shares[:-1]) and len(shares) > 1


def test_ctrl_c(world, robot):
    begun = time.monotonic()
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        world.raster(robot, 0.02, stance="settled", exhaustive=True)  # a million poses, some minutes
    assert time.monotonic() - begun < 3  # 0.5 s on a machine that does nothing else
    assert len(world.sample(robot, 5)) == 5


def test_threads_agree(world, robot):
    expected = world.sample(robot, 200, min_distance=0.3, seed=5).to_csv()
    results = []

    def work():
        for _ in range(5):
            results.append(world.sample(robot, 200, min_distance=0.3, seed=5).to_csv())

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 20 and set(results) == {expected}


def test_arrays_outlive_results(world, robot):
    pose = world.sample(robot, 20, seed=9).pose
    copy = pose.copy()
    gc.collect()
    world.raster(robot, 0.2)
    assert (pose == copy).all()


def test_review_is_a_page_that_a_notebook_frames(world, robot, tmp_path):
    spawns = world.sample(robot, 3, seed=1)
    try:
        page = world.review(robot, raster=1, spawns=spawns, out=tmp_path / "review.html")
    except RuntimeError as error:
        assert "without the review page" in str(error)
        pytest.skip(str(error))
    assert page.html.lower().startswith("<!doctype html>")
    assert (tmp_path / "review.html").read_text() == page.html
    frame = page._repr_html_()
    assert frame.startswith("<iframe") and "<!doctype" not in frame
    assert page.summary["counts"]["valid"] > 0
    with pytest.raises(sf.ArgumentError, match="--serve is only for the program"):
        world.review(robot, serve=True)


def test_picture(world, robot, tmp_path):
    picture = world.heatmap(robot, size=400)
    assert picture._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
    picture.save(tmp_path / "map.png")
    assert (tmp_path / "map.png").read_bytes() == picture.data
    svg = world.heatmap(robot, size=400, format="svg")
    assert svg._repr_png_() is None and svg._repr_svg_().lstrip().startswith("<")
    for options in ({"format": "html"}, {"html": True}, {"out": tmp_path / "map.html"}):
        with pytest.raises(sf.ArgumentError, match="World.review"):
            world.heatmap(robot, **options)


def test_picture_on_desktop(monkeypatch, tmp_path):
    """With a desktop, `xdg-open` gets a file with the picture."""
    opener = tmp_path / "xdg-open"
    opener.write_text(f'#!/bin/sh\ncp "$1" {tmp_path}/part.svg && mv {tmp_path}/part.svg {tmp_path}/shown.svg\n')
    opener.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    sf.Picture(b"<svg/>", "svg", {}).show()
    for _ in range(500):
        if (tmp_path / "shown.svg").exists():
            break
        time.sleep(0.02)
    assert (tmp_path / "shown.svg").read_bytes() == b"<svg/>"


def test_picture_on_axis(world, robot):
    with pytest.raises(sf.ArgumentError, match='--format is "svg", needs png'):
        sf.Picture(b"<svg/>", "svg", {}).axis()
    pytest.importorskip("matplotlib").use("agg")
    axis = world.heatmap(robot, size=400, yaw=0).axis()
    assert axis.images[0].get_array().shape[1] == 400 and axis.figure.axes == [axis]


def test_options_text():
    text = sf.options("sample")
    assert "min_distance" in text and "\n  settle (True)\n" in text
    with pytest.raises(sf.ArgumentError, match="there is no function clean; .*experiment$"):
        sf.options("clean")
    with pytest.raises(sf.ArgumentError, match="there is no function smaple"):
        sf.options("smaple")


def test_files_appear_complete_or_not_at_all(world, robot, tmp_path):
    spawns = world.sample(robot, 3, seed=1)
    target = tmp_path / "spawns.csv"
    planted = tmp_path / f".spawns.csv.{os.getpid()}.part"
    victim = tmp_path / "victim"
    victim.write_text("precious")
    planted.symlink_to(victim)
    assert spawns.to_csv(target) == target.read_bytes()
    assert victim.read_text() == "precious"
    assert {file.name for file in tmp_path.iterdir()} == {target.name, planted.name, victim.name}
    with pytest.raises(sf.FileError, match="none/spawns.csv: cannot be written: No such file"):
        spawns.to_csv(tmp_path / "none" / "spawns.csv")


def test_outputs_never_destroy_inputs(world, robot, tmp_path):
    poses = tmp_path / "poses.csv"
    before = world.sample(robot, 3, seed=1).to_csv(poses)
    with pytest.raises(sf.ArgumentError, match="--out is .*poses.csv, the same file as --avoid, which is read"):
        world.sample(robot, 3, avoid=poses, out=poses)
    assert poses.read_bytes() == before


def test_csv_of_poses_in_memory(world, robot, tmp_path):
    spawns = world.sample(robot, 5, seed=2)
    for poses in (spawns, [[0, 0, 0.2], [7, 7, 0.1]], np.array([[0, 0, 0.2, 0.5]])):
        for options in ({}, {"settle": True}):
            text = world.check(robot, poses, **options).to_csv()
            world.check(robot, poses, out=tmp_path / "verdicts.csv", **options)
            assert text == (tmp_path / "verdicts.csv").read_bytes()
            assert len({line.count(b",") for line in text.splitlines()}) == 1


def test_verdicts_in_pandas(world, robot):
    pandas = pytest.importorskip("pandas")
    verdicts = world.check(robot, [[0, 0, 0.2], [500, 0, 1]])
    frame = verdicts.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns[:3]) == ["verdict", "hit", "reason"]
    assert list(frame["verdict"]) == verdicts.name and list(frame["reason"]) == verdicts.reason


def test_formats_of_pictures(world, robot, tmp_path):
    world.heatmap(robot, step=1, out=tmp_path / "a.svg")
    assert b"<svg" in (tmp_path / "a.svg").read_bytes()
    picture = world.heatmap(robot, step=1)
    picture.save(tmp_path / "a.png")
    with pytest.raises(sf.ArgumentError, match='make one with format="pdf"'):
        picture.save(tmp_path / "a.pdf")


def test_avoid_poses_in_memory(world, robot, tmp_path):
    others = world.sample(robot, 5, seed=1)
    others.to_csv(tmp_path / "others.csv")
    expected = world.sample(robot, 20, seed=2, avoid=tmp_path / "others.csv", avoid_distance=2).pose
    for avoid in (others, others.pose, [others], others.pose[:, :3].tolist(), [others, tmp_path / "others.csv"]):
        assert (world.sample(robot, 20, seed=2, avoid=avoid, avoid_distance=2).pose == expected).all()

    def least_gap(poses):
        return np.linalg.norm(poses[:, None, :3] - others.pose[None, :, :3], axis=2).min()

    assert least_gap(world.sample(robot, 20, seed=2).pose) < 2 <= least_gap(expected)


def test_values_in_the_wrong_place(world, robot):
    spawns = world.sample(robot, 5)
    for value in (spawns, spawns.pose):
        with pytest.raises(sf.ArgumentError, match=r"--region needs the name of a file, not \w+; write it with to_csv"):
            world.sample(robot, 5, region=value)
    with pytest.raises(sf.ArgumentError, match=r"one value is a tuple, \(-5, -5, 5, 5\)"):
        world.sample(robot, 5, region=[-5, -5, 5, 5])


def test_islands_of_pairs(world, robot):
    pairs = world.sample(robot, pairs=5, reach_step=0.5, seed=1)
    islands = world.info(robot, islands=True, reach_step=0.5)["reach"]["islands"]
    assert set(pairs.island) <= {island["island"] for island in islands}
    largest = world.sample(robot, pairs=5, reach_step=0.5, seed=1, island="largest")
    assert (largest.island == 0).all()


def test_names_of_objects(world, robot):
    assert repr(sf.Scene("shop").add_box((1, 1, 1))) == "Scene('shop': 1 parts)"
    assert repr(sf.Pool(world, robot, 9, seed=1).draw(3)).startswith("Draw(3: pose, ")


def test_rows(world, robot):
    spawns = world.sample(robot, 4, seed=3)
    assert [row.yaw for row in spawns] == spawns.yaw.tolist() and (spawns[-1].pose == spawns.pose[3]).all()
    verdicts = world.check(robot, [[0, 0, 0.2], [500, 0, 1]])
    assert [(row.name, row.hit, row.reason) for row in verdicts] == list(
        zip(verdicts.name, verdicts.hit, verdicts.reason)
    )
    with pytest.raises(IndexError):
        spawns[4]
    with pytest.raises(TypeError):
        spawns[1:2]
