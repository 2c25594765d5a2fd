"""Many worlds on a local Dask cluster: a world that crashes its reader, a worker that is killed, and a second run."""

import os
import signal
import threading
import time
from pathlib import Path

import pytest

import spawnfield as sf

pytest.importorskip("distributed")

COUNT = 200


def free_area(scene, step, calls):
    """Bakes a world and counts valid poses. The world "crash" ends the process, as a fault in a mesh reader would."""
    with open(calls, "a") as file:
        file.write(scene + "\n")
    if "crash" in scene:
        os.abort()
    world = sf.bake(scene, threads=1, resolution=0.2, quiet=True)
    raster = world.raster("box:0.5,0.5,0.3", step, stance="level", threads=1, quiet=True)
    return {"name": world.name, "valid": raster.counts["valid"], "share": raster.counts["valid"] / len(raster)}


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worlds")
    names = []
    for k in range(COUNT):
        name = "crash" if k == 70 else "broken" if k == 130 else f"world_{k:03}"
        text = (
            "format: spawnfield-scene/1\nparts:\n"
            "- {name: floor, label: terrain, box: [4, 4, 0.2], xyz: [0, 0, -0.1]}\n"
            f"- {{name: box, label: obstacle, box: [{0.2 + k % 7 * 0.3}, 1, 1], xyz: [{k % 5 - 2}, 0, 0.5]}}\n"
        )
        (folder / f"{name}.yaml").write_text("parts: 3\n" if name == "broken" else text)
        names.append(str(folder / f"{name}.yaml"))
    return names


def calls_in(file):
    return Path(file).read_text().splitlines() if Path(file).exists() else []


def test_two_workers_equal_one(scenes, tmp_path):
    from distributed import Client, LocalCluster

    def work(store, calls, **options):
        given = {"step": 0.5, "calls": str(calls)}
        return sf.batch(free_area, scenes, store=tmp_path / store, arguments=given, **options)

    calls = tmp_path / "calls"
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:

        def kill_one():  # when some worlds are done
            while len(calls_in(calls)) < 40:
                time.sleep(0.02)
            os.kill(cluster.workers[0].pid, signal.SIGKILL)

        killer = threading.Thread(target=kill_one)
        killer.start()
        two = work("store", calls, scheduler=client)
        killer.join()
    assert len(two) == COUNT and [row["scene"] for row in two] == scenes
    assert [Path(row["scene"]).stem for row in two.failed] == ["crash", "broken"]
    assert "it crashed, or was killed" in two.failed[0]["error"]
    assert "FileError" in two.failed[1]["error"] and "broken.yaml" in two.failed[1]["error"]
    assert len(set(calls_in(calls))) == COUNT

    before = len(calls_in(calls))
    again = work("store", calls, workers=1)  # only the two that failed are repeated
    assert again.done_before == COUNT - 2 and again.to_csv() == two.to_csv()
    assert {Path(scene).stem for scene in calls_in(calls)[before:]} == {"crash", "broken"}

    some = [scene for scene in scenes[::5] if "crash" not in scene]
    one = sf.batch(free_area, some, scheduler="inline", arguments={"step": 0.5, "calls": str(tmp_path / "other")})
    assert one.rows == [row for row in two if row["scene"] in some]


def test_store_knows_what_changed(scenes, tmp_path):
    some = [scene for scene in scenes[:6]]
    calls = str(tmp_path / "calls")

    def work(**arguments):
        return sf.batch(
            free_area, some, scheduler="inline", store=tmp_path / "store", arguments={"calls": calls, **arguments}
        )

    first = work(step=0.5)
    assert first.done_before == 0 and work(step=0.5).done_before == 6
    assert work(step=1.0).done_before == 0
    text = Path(some[2]).read_text()
    Path(some[2]).write_text(text.replace("[4, 4, 0.2]", "[3, 3, 0.2]"))
    changed = work(step=0.5)
    assert changed.done_before == 5 and changed[2]["valid"] < first[2]["valid"]
    Path(some[2]).write_text(text)
    assert work(step=0.5).to_csv() == first.to_csv()


def test_faults(scenes):
    with pytest.raises(sf.ArgumentError, match="a scene twice"):
        sf.batch(free_area, [scenes[0], scenes[0]])
    with pytest.raises(sf.ArgumentError, match="numbers and texts"):
        sf.batch(free_area, scenes, arguments={"step": object()})
    assert len(sf.batch(free_area, [])) == 0
    row = sf.batch(free_area, ["nowhere.yaml"], scheduler="inline", arguments={"step": 1, "calls": os.devnull})[0]
    assert row["error"].startswith("FileError: nowhere.yaml")
