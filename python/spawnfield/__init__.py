"""spawnfield: where can this robot stand in this world?

    import spawnfield as sf

    world = sf.bake("maps/training/scene.yaml")
    robot = sf.Robot("maps/robots/husky.yaml")
    spawns = world.sample(robot, 100, min_distance=1.0, yaw="random", seed=7)
    print(spawns.pose[:3])

Lengths are in metres and angles in radians, x forward, y left, z up (REP-103). Notices go to the logger "spawnfield".
"""

from ._core import version as _version
from .audits import Audit, audit, spawn_ok
from .batches import Batch, batch
from .errors import ArgumentError, FileError, NothingFits, NotValid, SpawnfieldError
from .options import options
from .pool import Draw, Pool
from .results import VALID, VERDICTS, Fleet, Page, Pairs, Picture, Raster, Spawns, Table, Verdicts
from .robot import Robot
from .scene import Scene
from .world import World, bake, info, open

__version__ = _version()
__all__ = [
    "VALID", "VERDICTS", "ArgumentError", "Audit", "Batch", "Draw", "FileError", "Fleet", "NotValid", "NothingFits",
    "Page", "Pairs", "Picture", "Pool", "Raster", "Robot", "Scene", "SpawnfieldError", "Spawns", "Table", "Verdicts",
    "World",
    "audit", "bake", "batch", "info", "open", "options", "spawn_ok",
]  # fmt: skip
