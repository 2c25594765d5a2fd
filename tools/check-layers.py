#!/usr/bin/env python3
"""Checks that the folders of src/ depend on each other without a circle, and prints them as layers, lowest first.

    tools/check-layers.py                        dependencies by #include lines
    tools/check-layers.py --symbols build/dev    dependencies by the linked symbols of a build

A public header include/spawnfield/X.h belongs to the folder that has X.cpp, or else to the folder in OWNERS. The check
fails if a header belongs to no folder, or if folders form a circle; then it lists the includes that form the circle.
It also fails if two types of the namespace spawnfield have one name.
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OWNERS = {  # public headers that have no .cpp file of the same name
    "error": "base",
    "export": "base",
    "map": "map",
    "map_export": "export",
    "place_quantities": "query",
    "query": "query",
    "reach": "reach",
    "review": "review",
    "settled_pose": "settle",
    "simulators": "simulators",
    "spawn_file": "poses",
}
INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"/]+)/[^"]+"|<spawnfield/(\w+)\.h>)', re.MULTILINE)

UNNAMED_NAMESPACE = re.compile(r"^namespace \{$.*?^\}  // namespace$", re.DOTALL | re.MULTILINE)
INNER_NAMESPACE = re.compile(r"^namespace (?!spawnfield \{)[\w:]+ \{$.*?^\}  // namespace", re.DOTALL | re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|enum class)(?: SPAWNFIELD_API)? (\w+)(?!::)\b[^;{]*\{", re.MULTILINE)


def fail(message):
    sys.exit(f"check-layers.py: {message}")


def owners_of_headers():
    """Returns the folder of each public header."""
    owners, folders_of_src = {}, {folder.name for folder in (ROOT / "src").iterdir() if folder.is_dir()}
    for header in sorted((ROOT / "include/spawnfield").glob("*.h")):
        folders = [source.parent.name for source in (ROOT / "src").glob(f"*/{header.stem}.cpp")]
        if len(folders) > 1:
            fail(f"{header.name} may belong to {' or '.join(sorted(folders))}: several folders have {header.stem}.cpp")
        owners[header.stem] = folders[0] if folders else OWNERS.get(header.stem, "")
        if owners[header.stem] not in folders_of_src:
            fail(f"{header.name} belongs to no folder of src/; add it to OWNERS")
    return owners


def by_includes():
    """Returns the reasons of each dependency, {folder: {other folder: [reason, ..]}}."""
    owners = owners_of_headers()
    found = {folder.name: {} for folder in (ROOT / "src").iterdir() if folder.is_dir()}
    files = {file: file.parent.name for file in (ROOT / "src").glob("*/*") if file.suffix in (".h", ".cpp")}
    files |= {file: owners[file.stem] for file in (ROOT / "include/spawnfield").glob("*.h")}
    for file, folder in sorted(files.items()):
        for include in INCLUDE.finditer(file.read_text(encoding="utf-8")):
            other = include[1] if include[1] in found else owners.get(include[2])
            if other and other != folder:
                found[folder].setdefault(other, []).append(f"{file.relative_to(ROOT)}: {include[0].strip()}")
    return found


def by_symbols(build):
    """The same from the object files of a Ninja build. Symbols that several folders define are inline: left out."""
    if not (build / "build.ninja").exists():
        fail(f"{build} is not a build folder of Ninja")
    listed = (build / "build.ninja").read_text(encoding="utf-8")  # objects src/FOLDER/X.cpp.o, unity_FOLDER_cxx.cxx.o
    objects = re.findall(r"^build (\S+/(?:src/|unity_)(\w+?)(?:/\w+\.cpp|_cxx\.cxx)\.o): ", listed, re.MULTILINE)
    folders = {name: folder for name, folder in objects if (ROOT / "src" / folder).is_dir()}
    if missing := [name for name in folders if not (build / name).exists()]:
        fail(f"{build / missing[0]} is missing; build the library first")
    nm = subprocess.run(["nm", "-A", "-C", "-P", "-g", *folders], cwd=build, capture_output=True, text=True, check=True)
    defined, undefined = {}, {}
    for name, symbol, kind in re.findall(r"^(\S+): (.*?) ([A-Za-z])(?: [0-9a-f]+)*\s*$", nm.stdout, re.MULTILINE):
        if "spawnfield" in symbol:
            table = undefined if kind == "U" else defined
            table.setdefault(symbol, set()).add(name)
    found = {folder: {} for folder in folders.values()}
    for symbol, users in sorted(undefined.items()):
        owners = {folders[name] for name in defined.get(symbol, ())}
        for name in sorted(users):
            if len(owners) == 1 and folders[name] not in owners:
                found[folders[name]].setdefault(*owners, []).append(f"{name}: {symbol}")
    return found


def check_type_names():
    """Fails if two types of the namespace spawnfield have one name. Their inline functions would be mixed up."""
    files = [file for file in (ROOT / "src").glob("*/*") if file.suffix in (".h", ".cpp")]
    places = {}
    for file in sorted(files + list((ROOT / "include/spawnfield").glob("*.h"))):
        text = UNNAMED_NAMESPACE.sub("", file.read_text(encoding="utf-8"))
        text = INNER_NAMESPACE.sub("", text)
        for name in TYPE.findall(text):
            places.setdefault(name, []).append(str(file.relative_to(ROOT)))
    for name, where in sorted(places.items()):
        if len(where) > 1:
            fail(f"{' and '.join(where)} define {name}; rename one of them")


def layers_of(found):
    """Returns lists of folders that depend only on earlier lists, and the folders in or above a circle."""
    layers, rest = [], {folder: set(others) for folder, others in found.items()}
    while ready := sorted(folder for folder, others in rest.items() if not others & rest.keys()):
        layers.append(ready)
        for folder in ready:
            del rest[folder]
    return layers, rest


def circle_in(rest):
    """Returns folders of which each depends on the next, and the last on the first."""
    path = [min(rest)]
    while (following := min(rest[path[-1]] & rest.keys())) not in path:
        path.append(following)
    return path[path.index(following):]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--symbols", metavar="BUILD_FOLDER", type=Path, help="by linked symbols instead of includes")
    build = parser.parse_args().symbols
    check_type_names()
    found = by_symbols(build) if build else by_includes()
    layers, rest = layers_of(found)
    for number, layer in enumerate(layers, 1):
        print(f"{number}: " + "; ".join(f"{folder} ({', '.join(sorted(found[folder])) or '-'})" for folder in layer))
    if rest:
        circle = circle_in(rest)
        for folder, other in zip(circle, circle[1:] + circle[:1]):
            print(f"{folder} needs {other}:", *found[folder][other], sep="\n  ", file=sys.stderr)
        fail(f"circle of folders: {' -> '.join(circle + circle[:1])}")


main()
