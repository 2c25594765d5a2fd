"""A pool of verified poses, from which the environments of a training loop draw when they reset."""

from __future__ import annotations

import atexit
import os
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from . import commands
from .errors import ArgumentError, FileError
from .robot import Robot
from .world import World

#: Spawns that are made at once: few at first, so that the first draw waits for little, then twice as many each time.
_FIRST_CHUNK, _LAST_CHUNK = 1 << 11, 1 << 15

#: Columns of a pose for each order of its quaternion.
_QUATERNIONS: dict[str, list[int] | None] = {"xyzw": None, "wxyz": [0, 1, 2, 6, 3, 4, 5]}

_in_work: set[Pool] = set()


def _order_of(quaternion: str) -> list[int] | None:
    if quaternion not in _QUATERNIONS:
        raise ArgumentError(f"--quaternion is {quaternion!r}, needs one of {', '.join(_QUATERNIONS)}")
    return _QUATERNIONS[quaternion]


@atexit.register
def _end_work() -> None:
    """Waits for the threads of pools, because a thread that is in a command when Python ends aborts the process."""
    pools = list(_in_work)
    for pool in pools:
        pool.close()
    for pool in pools:
        pool._thread.join()


class Pool:
    """Verified spawns, or pairs of a start and a goal, that are kept as arrays. ``len()`` is the number of rows.

    They are made in the background. A draw waits only until the rows that it needs are there. Draws depend on nothing
    but the seed and the order of the calls. No row is drawn twice until all have been drawn; then all rows are drawn
    again, in another order (`epoch` counts that).

    Args:
        world: a World, or a list of worlds; then each environment may have its own (see `draw`).
        robot: the robot, or a list with one for each world.
        size: number of spawns of each world.
        seed: of the spawns and of the draws.
        pairs: the rows are pairs with columns ``start`` and ``goal`` in place of ``pose``.
        background: False: the constructor returns when all spawns are there.
        quaternion: "xyzw" or "wxyz" (as of MuJoCo and Isaac Lab 2): the order in the poses of draws. `columns` and
            files always have x, y, z, w.
        **options: those of ``World.sample``, for example ``columns="clearance"``. The default of ``yaw`` is "random".
            Rows keep no distance from each other; `draw` has a ``min_distance``. Pairs need the drivable graph of the
            world, which may take minutes when it is made first; ``reach_step`` makes it coarser (docs/reach.md).

    Raises:
        ArgumentError: an argument is wrong, or a world has no valid pose. Faults of the background are raised by the
            next call that needs its rows.
    """

    def __init__(
        self, world: World | Sequence[World], robot: Robot | Sequence[Robot], size: int, *, seed: int = 0,
        pairs: bool = False, background: bool = True, quaternion: str = "xyzw", **options: Any,
    ) -> None:  # fmt: skip
        self._order = _order_of(quaternion)
        worlds = [world] if isinstance(world, World) else list(world)
        robots = list(robot) if isinstance(robot, (list, tuple)) else [robot] * len(worlds)
        if len(robots) != len(worlds):
            raise ArgumentError(f"--robot: there are {len(robots)} robots for {len(worlds)} worlds")
        if size < 1:
            raise ArgumentError(f"--size is {size}, needs >= 1")
        if given := [name for name in ("count", "pairs", "fill", "fleet") if name in options]:
            raise ArgumentError(f"--{given[0]} is not an option of a pool, which has a size")
        if options.get("min_distance"):
            raise ArgumentError("--min-distance: the rows of a pool keep no distance; give it to draw()")
        options = {"yaw": "random", **options}
        commands.arguments("sample", options)  # raises here, not in the background, if it has no such option
        self._pose = "start" if pairs else "pose"
        self._decks = [_Deck(size, seed, k) for k in range(len(worlds))]
        self._changed = threading.Condition()
        self._failure: BaseException | None = None
        self._is_closed = False
        self._tensors: dict[Any, Any] = {}
        work = list(zip(self._decks, worlds, robots))
        self._thread = threading.Thread(target=self._make, args=(work, size, pairs, options), daemon=True)
        _in_work.add(self)
        self._thread.start()
        if not background:
            self.wait()

    @classmethod
    def from_columns(
        cls, columns: Mapping[str, np.ndarray], *, seed: int | None = None, quaternion: str = "xyzw"
    ) -> Pool:
        """Returns a pool of given rows, for example those of `save`.

        Args:
            columns: arrays of equal length, as of `columns`: ``pose``, or ``start`` and ``goal``, of shape (n, 7), and
                any others. ``world`` is optional.
            seed: the rows are drawn in the given order, or with a seed in the order of `restart`.
            quaternion: of draws, as for a new pool.
        """
        pool = cls.__new__(cls)
        pool._order = _order_of(quaternion)
        pool._pose = "pose" if "pose" in columns else "start"
        world = np.asarray(columns.get("world", np.zeros(len(columns[pool._pose]), np.int64)))
        pool._decks = []
        for k in range(int(world.max(initial=0)) + 1):
            deck = _Deck(int((world == k).sum()), seed or 0, k)
            deck.append({n: np.asarray(v)[world == k] for n, v in columns.items() if n != "world"})
            deck.close()
            pool._decks.append(deck)
        pool._changed = threading.Condition()
        pool._failure, pool._is_closed, pool._tensors = None, True, {}
        if seed is not None:
            pool.restart(seed)
        return pool

    def __len__(self) -> int:
        return sum(deck.size for deck in self._decks)

    def __repr__(self) -> str:
        return f"Pool({sum(deck.made for deck in self._decks)} of {len(self)}, {len(self._decks)} worlds)"

    @property
    def epoch(self) -> np.ndarray:
        """(worlds,) int64: how often all rows of each world have been drawn."""
        return np.array([deck.epoch for deck in self._decks])

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """All rows that are there so far: the columns of Spawns or Pairs, and ``world``, the index of the world."""
        with self._changed:
            parts = [{**deck.rows(), "world": np.full(deck.made, k)} for k, deck in enumerate(self._decks)]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def wait(self) -> Pool:
        """Waits until all rows are there. Returns the pool."""
        with self._changed:
            while not self._failure and not all(deck.is_complete for deck in self._decks):
                self._changed.wait(0.1)  # so that Ctrl-C is noticed
            self._raise_failure()
        return self

    def close(self) -> None:
        """Ends the work in the background, after the spawns that are being made now (at most 32,768). The pool keeps
        the rows that it has. When Python ends, it closes all pools, and waits for these spawns."""
        self._is_closed = True

    def restart(self, seed: int) -> None:
        """Begins anew: all rows can be drawn again, in a random order that depends only on the seed and the weights.

        So environments repeat their starts, for example in ``reset(seed=...)`` of Gymnasium. Waits until all rows are
        there.
        """
        self.wait()
        for k, deck in enumerate(self._decks):
            deck.restart(seed, k)

    def weigh(self, weights: str | np.ndarray | Callable[[dict[str, np.ndarray]], np.ndarray] | None) -> None:
        """Sets the probability of each row in later draws. Waits until all rows are there.

        The rows that have not been drawn yet in this epoch are drawn one after the other, each time with probabilities
        in proportion to their weights (Efraimidis, Spirakis, Weighted random sampling with a reservoir, 2006). Rows of
        weight 0 come last.

        Args:
            weights: the name of a column; an array of numbers >= 0, one for each row of `columns`; a function that
                makes it of `columns`; or None for equal weights.

        Raises:
            ArgumentError: the weights have another length, or one of them is negative or not finite.
        """
        self.wait()
        if weights is not None and not isinstance(weights, np.ndarray):
            columns = self.columns  # copies of all rows
            if isinstance(weights, str) and weights not in columns:
                raise ArgumentError(f"--weights: the pool has no column {weights!r}; it has {', '.join(columns)}")
            weights = columns[weights] if isinstance(weights, str) else np.asarray(weights(columns))
        if weights is not None and (
            weights.shape != (len(self),) or not (np.isfinite(weights) & (weights >= 0)).all()
        ):
            raise ArgumentError(f"--weights needs {len(self)} finite numbers >= 0, one for each row")
        first = 0
        for deck in self._decks:
            deck.weigh(None if weights is None else np.asarray(weights[first : first + deck.size], float))
            first += deck.size

    def draw(
        self, which: int | Any, out: Any = None, *, world: Any = None, min_distance: float = 0.0
    ) -> Draw:  # fmt: skip
        """Draws rows.

        Args:
            which: how many; or a mask, (environments,) bool, of the environments that reset.
            out: (environments, 7) array or torch tensor on any device, in which the rows of the mask get their pose:
                x, y, z (m) and a quaternion in the pool's order; of pairs, the start. With a tensor, the pool keeps a
                copy of the poses on its device.
            world: index of the world; with a mask, one for each environment; otherwise one for each row. Default: 0.
            min_distance: m between any two poses of this draw in the same world. Rows that are too near are not lost;
                they stay for later draws.

        Returns:
            The drawn rows, with all columns.

        Raises:
            ArgumentError: a world has fewer rows than are drawn at once; not enough of them are apart; or an argument
                is wrong.
        """
        rows = None
        if isinstance(which, (int, np.integer)):
            count = int(which)
        else:
            mask = which.detach().cpu().numpy() if hasattr(which, "detach") else np.asarray(which)
            if mask.ndim != 1 or mask.dtype != bool:
                raise ArgumentError("--mask needs an array of shape (environments,) of bool")
            rows = np.flatnonzero(mask)
            count = len(rows)
        if out is not None:
            rows = np.arange(count) if rows is None else rows
            if out.ndim != 2 or out.shape[1] != 7:
                raise ArgumentError(f"--out has the shape {tuple(out.shape)}, needs (environments, 7)")
        if len(self._decks) == 1 or world is None or isinstance(world, (int, np.integer)):
            k = int(world) if isinstance(world, (int, np.integer)) else 0
            number = np.full(count, k) if k else np.zeros(count, np.int64)
            index = self._take(k, count, min_distance)
        else:
            number = np.asarray(world.cpu() if hasattr(world, "cpu") else world)
            if not isinstance(which, (int, np.integer)):
                number = number[rows]
            index = np.empty(count, np.int64)
            for k in np.unique(number):
                index[number == k] = self._take(int(k), int((number == k).sum()), min_distance)
        drawn = Draw(self._decks, number, index, self._order)
        if out is not None:
            self._fill(out, rows, drawn)
        return drawn

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes all rows to a .npz file, which `load` reads. Waits until they are there."""
        from .results import write_bytes
        from io import BytesIO

        self.wait()
        data = BytesIO()
        np.savez(data, **self.columns)  # type: ignore[arg-type]
        write_bytes(data.getvalue(), file)

    @classmethod
    def load(cls, file: str | os.PathLike[str], *, seed: int | None = None, quaternion: str = "xyzw") -> Pool:
        """Returns the pool of a file that `save` has written. Draws begin anew, in the order of the rows, or with a
        seed in that of `restart`. `quaternion` is that of draws, as for a new pool.

        Processes that read the same file draw different rows if they have different seeds.

        Raises:
            FileError: the file is missing, or is not the file of a pool.
        """
        try:
            with np.load(file, allow_pickle=False) as columns:
                rows = dict(columns)
        except (OSError, ValueError, AttributeError) as error:  # also if it is another kind of file
            raise FileError(f"{os.fspath(file)}: the pool cannot be read: {error}") from None
        if not ("pose" in rows or {"start", "goal"} <= rows.keys()):
            raise FileError(f"{os.fspath(file)}: is not the file of a pool; it has no array pose, or start and goal")
        return cls.from_columns(rows, seed=seed, quaternion=quaternion)

    def _take(self, k: int, count: int, min_distance: float) -> np.ndarray:
        if not 0 <= k < len(self._decks):
            raise ArgumentError(f"--world is {k}; there are {len(self._decks)} worlds")
        deck = self._decks[k]
        if count > deck.size:
            raise ArgumentError(f"--count is {count}, but world {k} has {deck.size} rows; make a larger pool")
        if not deck.can_take(count):  # in the usual case, there is no lock
            with self._changed:
                while not self._failure and not deck.can_take(count):
                    self._changed.wait(0.1)
                self._raise_failure()
            return self._take(k, count, min_distance)  # the world may have fewer rows than it was asked for
        if min_distance <= 0:
            return deck.take(count)
        is_complete = deck.is_complete
        try:
            return deck.take_apart(count, min_distance, self._pose)
        except ArgumentError:
            if is_complete:
                raise
        self.wait()  # rows that are not made yet may be far enough apart
        return deck.take_apart(count, min_distance, self._pose)

    def _fill(self, out: Any, rows: np.ndarray | None, drawn: "Draw") -> None:
        if not hasattr(out, "device") or isinstance(out, np.ndarray):
            out[rows] = drawn.column(self._pose)
            return
        import torch

        places = torch.as_tensor(rows).to(out.device)
        if not all(deck.is_complete for deck in self._decks):  # there is no copy on the device yet
            out[places] = torch.as_tensor(drawn.column(self._pose)).to(out.device, out.dtype)
            return
        key = (out.device, out.dtype)
        if key not in self._tensors:
            poses = np.concatenate([deck.rows()[self._pose] for deck in self._decks])
            poses = poses if self._order is None else poses[:, self._order]
            self._tensors[key] = torch.as_tensor(poses).to(out.device, out.dtype)
        first = np.cumsum([0, *(deck.size for deck in self._decks)])
        out[places] = self._tensors[key][torch.as_tensor(first[drawn.world] + drawn.index).to(out.device)]

    def _raise_failure(self) -> None:
        if self._failure is not None:
            raise self._failure

    def _make(self, work: list[tuple["_Deck", World, Robot]], size: int, pairs: bool, options: dict[str, Any]) -> None:
        try:
            for deck, world, robot in work:
                chunk = _FIRST_CHUNK
                while not self._is_closed and deck.made < size:
                    wanted = min(chunk, size - deck.made)
                    chunk = min(2 * chunk, _LAST_CHUNK)
                    seed = deck.next_seed()
                    number = {"pairs" if pairs else "count": wanted}
                    found = world.sample(robot, **number, seed=seed, progress=False, **options)
                    with self._changed:
                        if len(found) == 0:
                            raise ArgumentError(f"no valid pose was found in {world.name} for the pool")
                        deck.append(found.columns)
                        self._changed.notify_all()
                with self._changed:
                    deck.close()
                    self._changed.notify_all()
        except BaseException as error:  # the next draw raises it
            with self._changed:
                self._failure = error
                self._changed.notify_all()
        finally:
            _in_work.discard(self)


class Draw:
    """The rows of ``Pool.draw``. Each column is an attribute, for example ``draw.pose``; it is copied when it is read.

    Attributes:
        world: (n,) int64, index of the world.
        index: (n,) int64, row of the pool in this world.
    """

    def __init__(
        self, decks: Sequence["_Deck"], world: np.ndarray, index: np.ndarray, order: list[int] | None = None
    ) -> None:
        self._decks = decks
        self._order = order
        self.world = world
        self.index = index

    def __len__(self) -> int:
        return len(self.index)

    def __repr__(self) -> str:
        return f"Draw({len(self)}: {', '.join(self._decks[0].buffers)})"

    def column(self, name: str) -> np.ndarray:
        """Returns a column of these rows, for example "pose"."""
        values = self._values(name)
        return values[:, self._order] if self._order and name in ("pose", "start", "goal") else values

    def _values(self, name: str) -> np.ndarray:
        if len(self._decks) == 1:
            return self._decks[0].buffers[name].take(self.index, axis=0)  # which is quicker than an index in brackets
        first = self._decks[0].buffers[name]
        out = np.empty((len(self.index), *first.shape[1:]), first.dtype)
        for k in np.unique(self.world):
            out[self.world == k] = self._decks[k].buffers[name].take(self.index[self.world == k], axis=0)
        return out

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_") or name not in self._decks[0].buffers:
            raise AttributeError(f"a draw has no {name!r}; it has {', '.join(self._decks[0].buffers)}")
        return self.column(name)


class _Deck:
    """The rows of one world, and the order in which they are drawn."""

    def __init__(self, size: int, seed: int, number: int) -> None:
        self.size = size  # of all rows, also of those that are not made yet
        self.made = 0
        self.is_complete = False
        self.epoch = 0
        self.buffers: dict[str, np.ndarray] = {}
        self._seeds = np.random.default_rng([seed, number, 0])
        self._random = np.random.default_rng([seed, number, 1])
        self._weights: np.ndarray | None = None
        self._order: np.ndarray | None = None  # None: that in which the rows were made, which is random already
        self._next = 0

    def next_seed(self) -> int:
        return int(self._seeds.integers(1 << 62))

    def append(self, columns: Mapping[str, np.ndarray]) -> None:
        count = len(next(iter(columns.values())))
        for name, values in columns.items():
            if name not in self.buffers:
                self.buffers[name] = np.empty((self.size, *values.shape[1:]), values.dtype)
            self.buffers[name][self.made : self.made + count] = values
        self.made += count

    def close(self) -> None:
        """There will be no more rows."""
        self.size = self.made
        self.buffers = {name: buffer[: self.size] for name, buffer in self.buffers.items()}
        if self._order is not None:
            self._order = self._order[: self.size]
        self.is_complete = True

    def rows(self) -> dict[str, np.ndarray]:
        return {name: buffer[: self.made] for name, buffer in self.buffers.items()}

    def can_take(self, count: int) -> bool:
        return 0 < self.made >= self._next + count or self.is_complete

    def restart(self, seed: int, number: int) -> None:
        self._random = np.random.default_rng([seed, number, 1])
        self.epoch = 0
        self._next = 0
        self._order = self._mixed(np.arange(self.size))

    def weigh(self, weights: np.ndarray | None) -> None:
        self._weights = weights
        order = self._order if self._order is not None else np.arange(self.size)
        self._order = np.concatenate([order[: self._next], self._mixed(order[self._next :])])

    def take(self, count: int) -> np.ndarray:
        begin = self._next
        if begin + count > self.size:
            return self._take_over_end(count)
        self._next = begin + count
        if self._order is None:
            return np.arange(begin, begin + count)
        return self._order[begin : begin + count].copy()

    def take_apart(self, count: int, distance: float, pose: str) -> np.ndarray:
        """The same for rows whose positions are `distance` apart. Rows that were left out come next."""
        if self.size - self._next < count:
            self._begin_epoch()
        order = self._order if self._order is not None else np.arange(self.size)
        positions = self.buffers[pose][:, :3]
        limit = self.size if self.is_complete else self.made
        chosen: list[int] = []
        left: list[int] = []
        kept = np.empty((count, 3))
        at = self._next
        while len(chosen) < count and at < limit:
            index = int(order[at])
            at += 1
            gaps = kept[: len(chosen)] - positions[index]
            if len(chosen) == 0 or (gaps * gaps).sum(axis=1).min() >= distance * distance:
                kept[len(chosen)] = positions[index]
                chosen.append(index)
            else:
                left.append(index)
        if len(chosen) < count:
            raise ArgumentError(
                f"--min-distance is {distance:g} m: only {len(chosen)} of the {count} rows to draw are that far apart "
                "among those that have not been drawn; use a smaller distance, or a larger pool"
            )
        order = order.copy() if self._order is None else order
        order[self._next : at] = chosen + left
        self._order = order
        self._next += count
        return np.array(chosen, np.int64)

    def _take_over_end(self, count: int) -> np.ndarray:
        """Takes the last rows of this epoch, and the first of the next one, of which none is among them."""
        order = self._order if self._order is not None else np.arange(self.size)
        last = order[self._next :].copy()
        self._begin_epoch()
        assert self._order is not None
        again = np.isin(self._order, last)
        self._order = np.concatenate([self._order[~again], self._order[again]])
        missing = count - len(last)
        self._next = missing
        return np.concatenate([last, self._order[:missing]])

    def _begin_epoch(self) -> None:
        self.epoch += 1
        self._next = 0
        self._order = self._mixed(np.arange(self.size))

    def _mixed(self, rows: np.ndarray) -> np.ndarray:
        """Returns the rows in a random order in which rows of large weight tend to come first."""
        if self._weights is None:
            return self._random.permutation(rows)
        with np.errstate(divide="ignore"):
            keys = self._random.exponential(size=len(rows)) / self._weights[rows]
        return rows[np.argsort(keys, kind="stable")]
