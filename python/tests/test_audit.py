"""Reports on worlds, and the assertion about start poses."""

import json

import pytest

import spawnfield as sf
from spawnfield.pytest_plugin import spawn_ok  # noqa: F401, as the entry point of an installed package does

BOX = "box:0.99,0.67,0.39"


def test_same_as_program(world, robot, program):
    options = ["--reach-step", 0.5, "--format", "json"]
    expected = program("audit", world.folder, "--robot", BOX, *options)
    audit = sf.audit(world, robot, reach_step=0.5)
    assert audit.text.encode() == expected and audit.report == json.loads(expected)
    assert audit.ok and audit.broken == []


def test_rules(world, robot, tmp_path):
    rules = {"min_free_area": 1e5, "max_floating": 0, "require": "all"}
    starts = [[0, 0, 0.1], [2.6, 3.0, 100.0]]
    audit = sf.audit(world, robot, poses=starts, rules=rules, reach_step=0.5)
    assert not audit.ok and "min_free_area" in audit.broken[0] and len(audit.broken) == 2
    page = tmp_path / "audit.html"
    assert sf.audit(world, robot, reach_step=0.5, out=page, format="html").report == {}
    assert page.read_text().startswith("<!DOCTYPE html>")


def test_scene_in_memory():
    scene = sf.Scene("shop").add_box((10, 10, 0.2), (0, 0, -0.1), label="terrain", name="floor")
    scene.add_box((1, 1, 1), (3, 0, 2.5), name="lamp")
    audit = sf.audit(scene, ["box:0.5,0.5,0.5", "box:1,1,1"], rules={"max_floating": 0}, reach_step=0.5)
    assert [one["robot"] for one in audit.report["robots"]] == ["box:0.5,0.5,0.5", "box:1,1,1"]
    assert audit.broken == ["max_floating: 1 floating prop, at most 0 are allowed: lamp"]
    assert [finding["props"] for finding in audit.report["floating"]] == [["lamp"]]


def test_spawn_ok(world, robot):
    spawn = world.sample(robot, 3, seed=1)
    sf.spawn_ok(world, robot, spawn)
    with pytest.raises(AssertionError, match="1 of 2 poses is not valid:\n  pose 2: outside"):
        sf.spawn_ok(world, robot, [spawn.position[0], [500, 0, 1]])


def test_fixture(spawn_ok):  # noqa: F811
    assert spawn_ok is sf.spawn_ok
