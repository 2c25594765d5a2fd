"""Calls the commands of spawnfield with arguments of Python.

All functions of the package go through `run`. It writes the arguments as words of a command line, so that both have the
same options, defaults, limits and messages. Things in memory (maps, robots, scenes, poses) stand in place of files.
"""

from __future__ import annotations

import difflib
import functools
import json
import logging
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from . import _core
from .errors import ArgumentError, translated

logger = logging.getLogger("spawnfield")

_known_notices: set[str] = set()


def log_notice(text: str) -> None:
    """Logs a notice as a warning. The same notice again is only information, so that loops do not repeat it."""
    logger.log(logging.INFO if text in _known_notices else logging.WARNING, "%s", text)
    if len(_known_notices) >= 1000:  # notices with ever new numbers
        _known_notices.clear()
    _known_notices.add(text)


@functools.cache
def options_of(command: str) -> dict[str, dict[str, Any]]:
    """Returns the options of a command by their names in Python: ``min_distance`` for ``--min-distance``."""
    options = {}
    for option in _core.commands()[command]["options"]:
        for name in option["names"]:
            options[name.replace("-", "_")] = option
    return options


def text_of(value: Any, separator: str = ",") -> str:
    """Returns a value as a word of a command line; sequences with the separator between their items."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return separator.join(f"{key}={text_of(item)}" for key, item in value.items())
    if isinstance(value, Iterable):
        return separator.join(text_of(item) for item in value)
    number = value.item() if hasattr(value, "item") else value
    return repr(number)


def words_of(name: str, option: Mapping[str, Any], value: Any) -> list[str]:
    """Returns an option with its value as words of a command line.

    True stands for an option without a value; None and False leave it out. A list repeats the option. A tuple is one
    value: ``(1, 2)`` is ``1,2``. Where the program reads LOW:HIGH, a tuple of two numbers is such a range, for example
    ``z=(0, 2.5)`` or ``near=("shelf*", (0.5, 1))``.
    """
    flag = "--" + name.replace("_", "-")
    if value is None or value is False:
        return []
    if option["values"] == 0:
        if value is True:
            return [flag]
        raise ArgumentError(f"{flag} needs True or False, not {value!r}")
    if value is True:
        raise ArgumentError(f"{flag} needs a value, not True")
    if hasattr(value, "to_csv") or getattr(value, "ndim", 0) > 1:
        raise ArgumentError(f"{flag} needs the name of a file, not {type(value).__name__}; write it with to_csv()")
    if isinstance(value, list) and option["repeatable"]:
        if value and all(isinstance(item, (int, float)) for item in value):
            raise ArgumentError(f"{flag}: a list repeats the option; one value is a tuple, {tuple(value)}")
        return [word for item in value for word in words_of(name, option, item)]
    if option["values"] == 2:  # NAME LOW:HIGH
        if isinstance(value, str) or len(value) != 2:
            raise ArgumentError(f"{flag} needs two values, not {value!r}")
        return [flag, text_of(value[0]), text_of(value[1], ":")]
    return [f"{flag}={text_of(value, ':' if name == 'z' else ',')}"]


def arguments(command: str, options: Mapping[str, Any]) -> list[str]:
    """Returns the words of all options of a command. Raises ArgumentError for an unknown one."""
    known = options_of(command)
    words: list[str] = []
    for given, value in options.items():
        name = given.removesuffix("_")  # `with_`, because `with` is a word of Python
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            raise ArgumentError(
                f"{command} has no argument --{name.replace('_', '-')}"
                + (f"; did you mean {near[0]}?" if near else f"; it has {', '.join(sorted(known))}")
            )
        words += words_of(name, known[name], value)
    return words


@dataclass(frozen=True)
class Outcome:
    """How a command ended: its exit status, its summary (as of ``--summary``), its text and its result."""

    status: int
    summary: dict[str, Any]
    text: str
    result: Any
    complaint: str


class ProgressBar:
    """Shows progress with tqdm, one bar for each kind of work."""

    def __init__(self) -> None:
        from tqdm.auto import tqdm

        self._make = functools.partial(tqdm, total=100, unit="%", leave=False)
        self._bar: Any = None

    def __call__(self, label: str, share: float) -> None:
        if self._bar is None or self._bar.desc != label + ": ":
            self.close()
            self._bar = self._make(desc=label)
        self._bar.update(100 * share - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        self._bar = None


def progress_bar(wanted: bool | None) -> ProgressBar | None:
    """Returns a progress bar if it is wanted (True), or by default (None) if tqdm is installed and standard error is a
    terminal."""
    if wanted is None and not os.isatty(2):
        return None
    if wanted is False:
        return None
    try:
        return ProgressBar()
    except ImportError:
        if wanted:
            raise
        return None


def run(
    command: str,
    words: Iterable[str],
    options: Mapping[str, Any],
    inputs: Mapping[str, Any] | None = None,
    wants_text: bool = False,
    progress: bool | None = None,
) -> Outcome:
    """Runs a command. Notices are logged to the logger ``spawnfield``, see `log_notice`.

    Args:
        command: its name.
        words: its arguments that have no name, and the words of some options.
        options: all other options, by their names in Python.
        inputs: things in memory, by the names that stand in place of their files.
        wants_text: whether the text of standard output is returned.
        progress: True shows progress with tqdm, False does not, None does so on a terminal if tqdm is installed.
    """
    complaints: list[str] = []

    def on_message(kind: str, text: str) -> None:
        if kind == "complaint":
            complaints.append(text)
        else:
            log_notice(text)

    bar = progress_bar(progress)
    try:
        ended = _core.run(
            [command, *words, *arguments(command, options)], dict(inputs or {}), wants_text, on_message, bar
        )
    except (_core.ArgumentError, _core.FileError, _core.OutputError, _core.NothingFits) as error:
        raise translated(error) from None
    finally:
        if bar is not None:
            bar.close()
    return Outcome(
        status=ended["status"],
        summary=json.loads(ended["summary"]) if ended["summary"] else {},
        text=ended["text"],
        result=ended["result"],
        complaint="\n".join(complaints),
    )
