"""The options of all functions, from the definitions of the program."""

from __future__ import annotations

from . import _core
from .errors import ArgumentError


def options(command: str) -> str:
    """Returns the options of a function as text: their names in Python, and what they mean.

    Args:
        command: "bake", "sample", "search", "check", "raster", "heatmap", "export", "experiment", "audit" or "info".

    Raises:
        ArgumentError: there is no such function.
    """
    known = _core.commands()
    known.pop("clean", None)  # only a command of the program
    if command not in known:
        raise ArgumentError(f"there is no function {command}; there are {', '.join(known)}")
    groups: dict[str, list[str]] = {}
    for option in known[command]["options"]:
        if option["positional"]:
            continue
        name = max(option["names"], key=len).replace("-", "_")
        form = " (True)" if option["values"] == 0 else " (repeatable)" if option["repeatable"] else ""
        groups.setdefault(option["group"], []).append(f"  {name}{form}\n      {option['help']}")
    lines = [known[command]["description"]]
    for group, entries in groups.items():
        lines += ["", group or "Options", *entries]
    return "\n".join(lines)
