"""Reports on worlds, and assertions about start poses for tests."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import commands
from .errors import NotValid
from .robot import Robot
from .scene import scene_of
from .world import File, World, bake, poses_word, robot_word


class Audit:
    """The report of `audit`.

    Attributes:
        ok: no rule is broken.
        broken: the broken rules, in words.
        report: the JSON report as a dictionary (docs/audit.md); empty if another format was asked for.
        text: the report as text, in the format that was asked for; empty if it was written to a file.
        summary: the summary of the command, as of ``--summary``.
    """

    def __init__(self, outcome: commands.Outcome, report: Mapping[str, Any]) -> None:
        self.ok = outcome.status == 0
        self.broken = [line.strip() for line in outcome.complaint.splitlines()[1:]]
        self.report = dict(report)
        self.text = outcome.text
        self.summary = outcome.summary

    def __repr__(self) -> str:
        return f"Audit({'ok' if self.ok else '; '.join(self.broken)})"


def audit(
    scene: Any, robot: Robot | File | list[Robot | File], *, poses: Any = None,
    rules: File | Mapping[str, Any] | None = None, progress: bool | None = None, **options: Any,
) -> Audit:  # fmt: skip
    """Reports on a world and its faults, as ``spawnfield audit`` (docs/audit.md).

    Args:
        scene: name of a scene file or map folder; a World; or a scene in memory, as for `bake`.
        robot: a robot, or a list of them.
        poses: start poses that are judged, as for ``World.check``.
        rules: name of a file of rules, or a dictionary, for example ``{"min_free_area": 100, "max_floating": 0}``.
        progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.
        **options: those of the program; with ``out``, a file is written in the ``format`` (default here: "json").

    Returns:
        The report. A broken rule is not an exception; see ``Audit.ok``.

    Raises:
        ArgumentError: an option is wrong.
        FileError: a file is missing or wrong, unless the option ``allow_missing`` reports it.
    """
    inputs: dict[str, Any] = {}
    in_memory = None if isinstance(scene, World) else scene_of(scene)
    if isinstance(scene, World):
        word = scene.folder
        inputs[word] = scene._core
    elif in_memory:
        word = "scene in memory"
        inputs[word] = in_memory._core
    else:
        word = os.fspath(scene)
    words = [word]
    words += [robot_word(one, inputs, options) for one in (robot if isinstance(robot, list) else [robot])]
    if poses is not None:
        poses = poses_word(poses, inputs, has_text=True)
    given = {"format": "json", **options, "poses": poses}
    with tempfile.TemporaryDirectory(prefix="spawnfield-") as folder:
        if isinstance(rules, Mapping):
            file = Path(folder) / "rules.yaml"
            file.write_text(json.dumps(dict(rules)))  # JSON is YAML, too
            rules = file
        given["rules"] = rules
        outcome = commands.run("audit", words, given, inputs, "out" not in options, progress)
    is_json = given["format"] == "json"
    text = Path(options["out"]).read_text() if "out" in options and is_json else outcome.text
    return Audit(outcome, json.loads(text) if is_json else {})


def spawn_ok(world: World | File, robot: Robot | File, poses: Any, **options: Any) -> None:
    """Asserts that a robot can stand at all poses, when it is let down there. For tests; with pytest, the fixture
    ``spawn_ok`` is this function.

    Args:
        world: a World, or the name of a scene file, which is baked first.
        robot: the robot.
        poses: as for ``World.check``.
        **options: of ``World.check``; ``stance="level"`` judges the poses as they are.

    Raises:
        NotValid: an AssertionError that names each pose that is not valid, and the reason.
    """
    __tracebackhide__ = True  # pytest shows the line of the test
    if not isinstance(world, World):
        world = bake(world)
    if "stance" not in options and "settle" not in options:
        options["settle"] = True
    try:
        world.check(robot, poses, require_valid=True, **options)
    except NotValid as error:
        message = str(error).removeprefix("--require-valid: ")
        raise NotValid(message, error.verdicts) from None
