"""Many worlds on many machines, with Dask."""

from __future__ import annotations

import contextlib
import csv
import hashlib
import inspect
import io
import json
import os
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from .commands import logger, progress_bar
from .errors import ArgumentError
from .results import write_bytes
from .world import File

Row = dict[str, Any]

_CRASHED = "the process ended while it worked on this world: it crashed, or was killed"


class Batch(Sequence[Row]):
    """The rows of `batch`, in the order of the scenes.

    It is a sequence of dictionaries. Each row has ``scene``, the name; ``error``, "" if there is none; and what the
    function returned.

    Attributes:
        rows: the rows as a list.
        done_before: number of rows that were taken from the store.
    """

    def __init__(self, rows: list[Row], done_before: int) -> None:
        self.rows = rows
        self.done_before = done_before

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, index: Any) -> Any:
        return self.rows[index]

    def __repr__(self) -> str:
        return f"Batch({len(self)} worlds, {len(self.failed)} failed, {self.done_before} were done before)"

    @property
    def failed(self) -> list[Row]:
        """The rows with an error."""
        return [row for row in self.rows if row["error"]]

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame. Needs pandas."""
        import pandas as pd

        return pd.DataFrame(self.rows)

    def to_csv(self, file: File | None = None) -> bytes:
        """Returns the table as CSV, and writes it to `file` if that is given. The bytes do not depend on how, where and
        in which order the rows were computed."""
        names = list(dict.fromkeys(name for row in self.rows for name in row))
        text = io.StringIO(newline="")
        writer = csv.DictWriter(text, names, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(self.rows)
        return write_bytes(text.getvalue().encode(), file)

    def to_parquet(self, file: File) -> None:
        """Writes a parquet file. Needs pandas and pyarrow."""
        data = io.BytesIO()
        self.to_pandas().to_parquet(data)
        write_bytes(data.getvalue(), file)


def batch(
    function: Callable[..., Mapping[str, Any]], scenes: Iterable[File], *, scheduler: Any = None,
    workers: int | None = None, store: File | None = None, arguments: Mapping[str, Any] | None = None,
    depends: Iterable[File] = (), progress: bool | None = None,
) -> Batch:  # fmt: skip
    """Calls a function for each of many worlds, on Dask. Needs ``dask[distributed]``, except with
    ``scheduler="inline"``.

    A world for which the function raises an exception, or whose process crashes, becomes a row with an error, and the
    others go on. A world whose process was killed is tried again.

    Args:
        function: ``function(scene, **arguments)`` returns a dictionary of numbers and texts. It runs in other
            processes, so it must be defined in a module or a script, or be one that cloudpickle can send. Queries in it
            should have ``threads=1``, because each core has a process of its own.
        scenes: names of scene files, model folders or map folders.
        scheduler: None: processes on this machine; "inline": this process, one world after the other; the address of a
            Dask scheduler, for example "tcp://host:8786"; or a dask.distributed.Client.
        workers: number of processes on this machine; None: one for each core.
        store: a folder for finished rows. A later call does not repeat a world whose files, function, arguments and
            version of spawnfield are the same. Rows with an error are repeated.
        arguments: passed to the function by their names; numbers and texts.
        depends: further files whose change repeats all worlds, for example robots. A scene's own files are: the file
            itself, or all files in it if it is a folder.
        progress: True: show progress with tqdm; None: only on a terminal, if tqdm is installed.

    Returns:
        The rows.

    Raises:
        ArgumentError: a scene is named twice, or `arguments` are not numbers and texts.
    """
    names = [os.fspath(scene) for scene in scenes]
    if len(set(names)) != len(names):
        raise ArgumentError("--scenes has a scene twice")
    given = dict(arguments or {})
    about = _hash_of_work(function, given, depends)
    folder = Path(store) if store is not None else None
    if folder:
        folder.mkdir(parents=True, exist_ok=True)
    rows: dict[str, Row] = {}
    files: dict[str, Path] = {}
    for name in names:
        if folder:
            files[name] = folder / f"{_hash_of_files([name], about)}.json"
            if files[name].exists():
                rows[name] = json.loads(files[name].read_text())
    done_before = len(rows)
    missing = [name for name in names if name not in rows]
    bar = progress_bar(progress)
    with contextlib.closing(_results(function, missing, given, scheduler, workers)) as results:
        for name, result, error in results:
            rows[name] = {"scene": name, "error": error, **result}
            if error:
                logger.warning("%s: %s", name, error)
            elif folder:
                write_bytes(json.dumps(rows[name]).encode(), files[name])
            if bar:
                bar("batch", len(rows) / len(names))
    if bar:
        bar.close()
    return Batch([rows[name] for name in names], done_before)


Result = tuple[str, dict[str, Any], str]


def _call(function: Callable[..., Mapping[str, Any]], name: str, arguments: Mapping[str, Any]) -> Result:
    """Runs in the worker. The result is one that JSON keeps, so that a stored row is the same as a new one."""
    try:
        return name, json.loads(json.dumps(dict(function(name, **arguments)))), ""
    except Exception as error:  # noqa: BLE001, a failed world must not stop the others
        return name, {}, f"{type(error).__name__}: {error}"


def _results(
    function: Callable[..., Mapping[str, Any]], names: list[str], arguments: Mapping[str, Any], scheduler: Any,
    workers: int | None,
) -> Generator[Result, None, None]:  # fmt: skip
    if not names:
        return
    if scheduler == "inline":
        for name in names:
            yield _call(function, name, arguments)
        return
    from distributed import Client, LocalCluster

    with contextlib.ExitStack() as stack:
        if scheduler is None:
            count = min(workers or os.cpu_count() or 1, len(names))
            cluster = LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None)
            client = stack.enter_context(Client(stack.enter_context(cluster)))
        elif isinstance(scheduler, str):
            client = stack.enter_context(Client(scheduler))
        else:
            client = scheduler
        killed = []
        for name, result, error in _on_dask(client, function, names, arguments):
            if error == _CRASHED:
                killed.append(name)
            else:
                yield name, result, error
        # Dask gives up a task after some of its workers have died, also if another task was the cause. So each of these
        # is tried alone.
        for name in killed:
            yield from _on_dask(client, function, [name], arguments)


def _on_dask(
    client: Any, function: Any, names: list[str], arguments: Mapping[str, Any]
) -> Generator[Result, None, None]:
    from distributed import KilledWorker, as_completed

    name_of = {}
    waiting = list(reversed(names))

    def submitted() -> Any:
        name = waiting.pop()
        future = client.submit(_call, function, name, dict(arguments), pure=False)
        name_of[future.key] = name
        return future

    # Few at a time: a result is lost with its worker until it has been fetched.
    ahead = min(2 * max(1, len(client.ncores())), len(names))
    completed = as_completed([submitted() for _ in range(ahead)])
    for future in completed:
        name = name_of.pop(future.key)
        if waiting:
            completed.add(submitted())
        try:
            yield future.result()
        except KilledWorker:
            yield name, {}, _CRASHED
        except Exception as error:  # noqa: BLE001, for example a result that cannot be sent
            yield name, {}, f"{type(error).__name__}: {error}"
        future.release()


def _hash_of_work(function: Any, arguments: Mapping[str, Any], depends: Iterable[File]) -> str:
    """Returns a hash of all that the rows of a batch have in common."""
    from ._core import version

    try:
        source = inspect.getsource(function)
    except (OSError, TypeError):
        source = getattr(function, "__qualname__", repr(function))
    try:
        text = json.dumps([source, arguments, version()], sort_keys=True)
    except TypeError as error:
        raise ArgumentError(f"--arguments must be numbers and texts: {error}") from None
    return _hash_of_files(depends, text)


def _hash_of_files(names: Iterable[File], text: str) -> str:
    """Returns a hash of a text and of the contents of files, and of all files in folders. A missing file counts as
    such: the function will report it."""
    out = hashlib.sha256(text.encode())
    for name in names:
        path = Path(name)
        for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if file.is_file():
                content = hashlib.sha256(file.read_bytes()).hexdigest()
                out.update(f"\n{file.relative_to(path) if file != path else file.name} {content}".encode())
    return out.hexdigest()[:32]
