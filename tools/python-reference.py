#!/usr/bin/env python3
"""Writes docs/python-api.md from the docstrings of the Python package: python-reference.py [--check].

Needs the package `spawnfield`, for example after tools/test.sh:
PYTHONPATH=build/release/python build/python/bin/python tools/python-reference.py
With --check it changes nothing, and fails if the file is not current.
"""

import inspect
import re
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import spawnfield

FILE = Path(__file__).resolve().parents[1] / "docs" / "python-api.md"

#: The modules with public names, in the order in which they are read, and their headings.
HEADINGS = {
    "world": "Maps and queries",
    "robot": "Robots",
    "scene": "Worlds in memory",
    "results": "Results",
    "pool": "Pools",
    "audits": "Audits",
    "batches": "Many worlds",
    "options": "Options",
    "errors": "Errors",
}

INTRODUCTION = """\
# Python: reference

<!-- Made from the docstrings by tools/python-reference.py; do not edit. -->

All public names of `import spawnfield as sf`. [python.md](python.md) introduces them.

- Lengths are in metres and angles in radians, except where an option of the program has degrees; x is forward, y left
  and z up (REP-103).
- `File` is a name of a file or folder: a text or a path (`os.PathLike`).
- `**options` are the options of the program, with `_` in place of `-`; [python.md](python.md#options) has the rules,
  and `sf.options("sample")` the list. `np` is numpy.
- Notices go to the logger `spawnfield` of the module `logging`, as warnings.
"""

SECTION = re.compile(r"^(Args|Returns|Raises|Attributes):$", re.MULTILINE)


def module_of(name: str) -> ModuleType:
    """Returns the module of the package that defines a public name."""
    thing = getattr(spawnfield, name)
    if inspect.isclass(thing) or inspect.isfunction(thing):
        return sys.modules[thing.__module__]
    return next(m for m in (sys.modules[f"spawnfield.{k}"] for k in HEADINGS) if f"\n{name} = " in inspect.getsource(m))


def members_of(kind: type) -> Iterator[tuple[str, Any]]:
    """Returns the public methods and properties that a class itself defines, in the order of its source."""
    for name, member in vars(kind).items():
        if not name.startswith("_") and (callable(member) or isinstance(member, (property, classmethod))):
            yield name, member


def anchor(name: str) -> str:
    """Returns the anchor that the heading of a public name gets."""
    is_class = "." in name or inspect.isclass(getattr(spawnfield, name))
    return (name if is_class else f"sf.{name}").lower().replace(".", "")


class Page:
    """The lines of the reference, and the names that can be linked."""

    def __init__(self) -> None:
        self.names = set(spawnfield.__all__)
        for name in spawnfield.__all__:
            thing = getattr(spawnfield, name)
            if inspect.isclass(thing):
                self.names |= {f"{name}.{member}" for member, _ in members_of(thing)}
        self.pieces = [INTRODUCTION]

    def linked(self, text: str, owner: str = "") -> str:
        """Returns text of a docstring as Markdown: code in backticks, and links to names and to pages."""
        text = re.sub(r"``(.+?)``", r"`\1`", text)
        text = re.sub(r"\bdocs/([a-z0-9-]+\.md)", r"[\1](\1)", text)

        def link(match: re.Match[str]) -> str:
            name = match.group(1).split("(")[0]
            for full in (f"{owner}.{name}", name):
                if full in self.names:
                    return f"[`{match.group(1)}`](#{anchor(full)})"
            return match.group(0)

        return re.sub(r"`([A-Za-z_.]+(?:\([^`]*\))?)`", link, text)

    def add(self, text: str) -> None:
        self.pieces.append(text + "\n")

    def add_code(self, text: str) -> None:
        self.add(f"```python\n{text}\n```")

    def add_docstring(self, thing: Any, owner: str) -> None:
        """Adds a docstring, its sections as lists."""
        parts = SECTION.split(inspect.getdoc(thing) or "")
        self.add_prose(parts[0], owner)
        for title, body in zip(parts[1::2], parts[2::2]):
            body = textwrap.dedent(body.strip("\n"))
            self.add("**Arguments**" if title == "Args" else f"**{title}**")
            if title == "Returns":
                self.add_prose(body, owner)
            else:
                self.add("\n".join(self.entries(body, owner)))

    def add_prose(self, text: str, owner: str) -> None:
        """Adds paragraphs; indented ones are code."""
        for paragraph in text.strip("\n").split("\n\n"):
            if paragraph.startswith("    "):
                self.add_code(textwrap.dedent(paragraph))
            elif paragraph:
                self.add(wrapped(self.linked(" ".join(paragraph.split()), owner)))

    def entries(self, body: str, owner: str) -> Iterator[str]:
        """Returns the entries of a section, `name: text`, as items of a list."""
        for block in re.split(r"\n(?=\S)", body):
            names, _, text = " ".join(block.split()).partition(": ")
            shown = ", ".join(f"`{name}`" for name in names.split(", "))
            yield wrapped(f"- {self.linked(shown)}: {self.linked(text, owner)}", "  ")

    def add_function(self, name: str, thing: Any, owner: str = "") -> None:
        self.add(f"#### {owner}.{name}" if owner else f"### sf.{name}")
        if isinstance(thing, property):
            self.add_code(f"{name}: {inspect.signature(thing.fget).return_annotation}")
            self.add_docstring(thing, owner)
            return
        is_class_method = isinstance(thing, classmethod)
        function = thing.__func__ if is_class_method else thing
        prefix = f"sf.{owner}." if is_class_method else "" if owner else "sf."
        self.add_code(signature(prefix + name, function, bool(owner)))
        self.add_docstring(function, owner)

    def add_class(self, name: str, kind: type) -> None:
        self.add(f"### {name}")
        bases = [base.__name__ for base in kind.__bases__ if base is not object]
        if "Args:" in (inspect.getdoc(kind) or "") and "__init__" in vars(kind):
            self.add_code(signature(f"sf.{name}", kind.__init__, True).removesuffix(" -> None"))
        elif bases:
            self.add_code(f"class {name}({', '.join(bases)})")
        else:
            self.add_code(f"class {name}")
        self.add_docstring(kind, name)
        for base in kind.__bases__:
            if base.__name__ in self.names and any(members_of(base)):
                self.add(f"It also has the attributes and methods of [`{base.__name__}`](#{anchor(base.__name__)}).")
        for member, thing in members_of(kind):
            self.add_function(member, thing, name)

    def add_constant(self, name: str, module: ModuleType) -> None:
        self.add(f"### sf.{name}")
        comment = re.search(rf"^((?:#: .*\n)+){name} = ", inspect.getsource(module), re.MULTILINE)
        assert comment, f"{name} has no comment that begins with #:"
        self.add_prose(" ".join(line.removeprefix("#: ") for line in comment.group(1).splitlines()), "")
        value = repr(getattr(spawnfield, name)).replace("'", '"').replace(": ", ":\u00a0")  # no line ends there
        self.add_code(wrapped(f"{name} = {value}", "    ").replace("\u00a0", " "))


def signature(name: str, function: Any, is_method: bool) -> str:
    """Returns a signature; one that is too long for a line has one parameter on each."""
    found = inspect.signature(function)
    words = []
    for parameter in list(found.parameters.values())[is_method:]:
        if parameter.kind is parameter.KEYWORD_ONLY and "*" not in words:
            words.append("*")
        stars = "**" if parameter.kind is parameter.VAR_KEYWORD else ""
        word = f"{stars}{parameter.name}: {parameter.annotation}"
        if parameter.default is not parameter.empty:
            word += f" = {parameter.default!r}".replace("'", '"')
        words.append(word)
    result = found.return_annotation
    text = f"{name}({', '.join(words)}) -> {result}"
    return text if len(text) <= 100 else f"{name}(\n" + "".join(f"    {word},\n" for word in words) + f") -> {result}"


def wrapped(text: str, indent: str = "") -> str:
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def reference() -> str:
    """Returns the text of the reference."""
    page = Page()
    names = [(module_of(name).__name__.removeprefix("spawnfield."), name) for name in spawnfield.__all__]
    for key, heading in HEADINGS.items():
        page.add(f"## {heading}")
        module = sys.modules[f"spawnfield.{key}"]
        order = inspect.getsource(module)
        own = [name for found, name in names if found == key]
        for name in sorted(own, key=lambda name: re.search(rf"^(?:class |def |){name}\b", order, re.M).start()):
            thing = getattr(spawnfield, name)
            if inspect.isclass(thing):
                page.add_class(name, thing)
            elif inspect.isfunction(thing):
                page.add_function(name, thing)
            else:
                page.add_constant(name, module)
    return "\n".join(page.pieces)


def main() -> int:
    text = reference()
    if sys.argv[1:] == ["--check"]:
        if FILE.read_text(encoding="utf-8") == text:
            return 0
        print("docs/python-api.md is not current; run tools/python-reference.py", file=sys.stderr)
        return 1
    if sys.argv[1:]:
        print(f"python-reference.py: unknown argument {sys.argv[1]}; usage: tools/python-reference.py [--check]",
              file=sys.stderr)
        return 2
    FILE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
