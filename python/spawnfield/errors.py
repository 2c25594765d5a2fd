"""The exceptions of spawnfield. Their messages are those of the command line program."""

from __future__ import annotations

import re

from . import _core


class SpawnfieldError(Exception):
    """Base of all exceptions that this package defines."""


class ArgumentError(SpawnfieldError, ValueError):
    """An argument is wrong.

    Attributes:
        field: name of the argument, for example ``"min_distance"``; None if no single one is wrong.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        first = re.search(r"--([a-z][a-z0-9-]*)", message)
        self.field = first.group(1).replace("-", "_") if first else None


class FileError(SpawnfieldError, OSError):
    """A file that is read is missing or wrong, or a file cannot be written."""


class NothingFits(SpawnfieldError, ValueError):
    """No pose can be valid, for the reason in the message."""


class NotValid(SpawnfieldError, AssertionError):
    """``check(..., require_valid=True)``: a pose or a pair is not valid.

    Attributes:
        verdicts: what ``check`` would have returned.
    """

    def __init__(self, message: str, verdicts: object) -> None:
        super().__init__(message)
        self.verdicts = verdicts


def translated(error: Exception) -> Exception:
    """Returns the exception of this package for one of the module ``_core``; others stay as they are."""
    for kind, ours in (
        (_core.ArgumentError, ArgumentError),
        (_core.FileError, FileError),
        (_core.OutputError, FileError),
        (_core.NothingFits, NothingFits),
    ):
        if isinstance(error, kind):
            return ours(str(error))
    return error
