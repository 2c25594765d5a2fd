#!/usr/bin/env python3
"""Makes the Debian package of a build, unpacks it, and checks its contents: package_test.py BUILD WORK CPACK.

Checks that the package has all files, that it depends on what its binaries link, that the program runs from where it
was unpacked, and that the software bill of materials is complete and has the shape of CycloneDX 1.5.
"""

import gzip
import json
import os
import re
import shutil
import subprocess
import sys
import uuid
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
FILES = [
    "bin/spawnfield", "include/spawnfield/query.h", "share/doc/spawnfield/copyright",
    "share/doc/spawnfield/README.md", "share/doc/spawnfield/CHANGELOG.md", "share/doc/spawnfield/docs/robots.md",
    "share/doc/spawnfield/spawnfield.cdx.json", "share/bash-completion/completions/spawnfield",
    "share/zsh/site-functions/_spawnfield", "share/zsh/vendor-completions/_spawnfield",
    "share/fish/vendor_completions.d/spawnfield.fish", "share/man/man1/spawnfield.1.gz",
    "share/spawnfield/maps/training/scene.yaml",
]
MODULES = ["crs", "drawing", "mesh_reader", "narrow_phase", "sdf", "serve", "tiff"]


def check(is_true, text):
    if not is_true:
        sys.exit(f"package_test.py: {text}")


def run(*command, **options):
    """Returns what a command prints. It must succeed."""
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    check(result.returncode == 0, f"{command} ended with {result.returncode}: {result.stdout}{result.stderr}")
    return result.stdout


def is_elf(file):
    return file.is_file() and not file.is_symlink() and file.read_bytes()[:4] == b"\x7fELF"


def linked_by(binaries):
    """Returns the names of the libraries of others that the binaries link directly."""
    text = "".join(run("objdump", "-p", file) for file in binaries)
    return {name for name in re.findall(r"NEEDED +(\S+)", text) if not name.startswith("libspawnfield")}


def check_package(package, root, binaries):
    prefix = root / "usr"
    missing = [name for name in FILES if not (prefix / name).exists()]
    check(not missing, f"the package lacks {missing}")
    library = next(prefix.rglob("libspawnfield.so.*")).parent
    for module in MODULES:
        check(library / f"libspawnfield_{module}.so" in binaries, f"the package lacks the module {module}")
    check((library / "spawnfield-models/sun.sdf").exists(), "the package lacks Gazebo's own models")
    check(not list(prefix.rglob("*.py")), "the package contains a part of the Python package")
    for file in binaries:
        paths = re.findall(r"(?:RUNPATH|RPATH) +(\S+)", run("objdump", "-p", file))
        check(all(path.startswith("$ORIGIN") for path in paths), f"{file.name} searches libraries in {paths}")
    manual = gzip.decompress((prefix / "share/man/man1/spawnfield.1.gz").read_bytes())
    check(manual.startswith(b".\\\" `spawnfield man`"), "the man page is not that of `spawnfield man`")
    version = run("dpkg-deb", "--field", package, "Version").strip()
    check(run(prefix / "bin/spawnfield", "--version").split()[0] == version, f"the package has version {version}")


def check_dependencies(package, bill, binaries):
    """Compares what the package depends on with the packages of the libraries that its binaries link."""
    text = run("dpkg-deb", "--field", package, "Depends")
    depends = {re.split(r"[ (]", word.strip())[0] for word in text.split(",")}
    needed = {component_with(bill, "spawnfield:file", name)["name"] for name in linked_by(binaries)}
    check(needed <= depends, f"the package does not depend on {sorted(needed - depends)}")
    check(len(needed) > 20, f"the binaries need only {sorted(needed)}")


def component_with(bill, name, value):
    """Returns the component that has this property; there must be exactly one."""
    entry = {"name": name, "value": value}
    found = [component for component in bill["components"] if entry in component["properties"]]
    check(len(found) == 1, f"{len(found)} components have the property {name} {value}")
    return found[0]


def check_shape(bill):
    """Checks what CycloneDX 1.5 requires of the parts that the document has."""
    check(bill["bomFormat"] == "CycloneDX" and bill["specVersion"] == "1.5" and bill["version"] == 1, "wrong header")
    uuid.UUID(bill["serialNumber"].removeprefix("urn:uuid:"))
    root = bill["metadata"]["component"]
    components = [root, *root["components"], *bill["components"]]
    references = [component["bom-ref"] for component in components]
    check(len(references) == len(set(references)), "a bom-ref occurs twice")
    for component in components:
        check(component["type"] in ("application", "library") and component["name"] and component["version"],
              f"incomplete component {component}")
        for entry in component.get("licenses", []):
            kinds = [*entry, *entry.get("license", {})]
            check(kinds in (["license", "id"], ["license", "name"], ["expression"]), f"wrong licence {entry}")
    for entry in bill["dependencies"]:
        check({entry["ref"], *entry["dependsOn"]} <= set(references), f"{entry['ref']} depends on what is not there")
    reached, waiting = set(), ["spawnfield"]
    depends = {entry["ref"]: entry["dependsOn"] for entry in bill["dependencies"]}
    while waiting:
        reference = waiting.pop()
        waiting += [] if reference in reached else depends[reference]
        reached.add(reference)
    check(reached == set(references), f"nothing depends on {set(references) - reached}")


def check_bill(bill, root, binaries):
    check_shape(bill)
    for name in linked_by(binaries):
        component_with(bill, "spawnfield:file", name)
    for component in bill["components"]:
        if component["purl"].startswith("pkg:deb/"):
            known = run("dpkg-query", "--show", "--showformat=${Version}\n", component["name"]).split()
            check(component["version"] in known, f"dpkg has {component['name']} {known}, not {component['version']}")
    # The review page contains libraries from npm.
    library = next(file for file in binaries if file.name.startswith("libspawnfield.so"))
    has_page = b"three-mesh-bvh" in library.read_bytes()
    of_page = {component["name"] for component in bill["components"] if component["purl"].startswith("pkg:npm/")}
    wanted = {"three", "three-mesh-bvh", "fflate", "meshoptimizer"} if has_page else set()
    check(of_page == wanted, f"the list has the JavaScript libraries {of_page}, not {wanted}")
    # --version knows the same libraries, and each of them has a licence.
    printed = run(root / "usr/bin/spawnfield", "--version")
    libraries = re.findall(r"^  (\S+) (\S+)(?: \(package (\S+)\))?$", printed, re.MULTILINE)
    check(len(libraries) > 20, f"--version prints only {libraries}")
    for name, _, package in libraries:
        component = component_with(bill, "spawnfield:library", name)
        check(not package or component["version"] == package, f"{name} is {package} and {component['version']}")
        check(component.get("licenses"), f"{name} has no licence")


def bill_of(build, work, files, **options):
    out = work / "other.json"
    version = json.loads((build / "share/spawnfield.cdx.json").read_text())["metadata"]["component"]["version"]
    run(sys.executable, "-B", SOURCE / "tools/sbom.py", "--version", version, "--libraries", build / "libraries.json",
        "-o", out, *files, **options)
    return out.read_text()


def check_script(build, work):
    """The script gives the same bytes for any order of files, and knows libraries that no package has."""
    files = [build / "bin/spawnfield", build / "bin/libspawnfield.so",
             *(build / f"bin/libspawnfield_{module}.so" for module in MODULES)]
    first = bill_of(build, work, files)
    check(first == bill_of(build, work, files[::-1]), "the bill of materials depends on the order of the files")
    stamped = bill_of(build, work, files, env=os.environ | {"SOURCE_DATE_EPOCH": "1000000000"})
    check('"timestamp": "2001-09-09T01:46:40Z"' in stamped, "SOURCE_DATE_EPOCH is not used")
    folder = work / "own"
    folder.mkdir()
    png = next(line.split()[2] for line in run("ldd", files[1]).splitlines() if "libpng16" in line)
    shutil.copy(png, folder / "libpng16.so.16.39.0")
    (folder / "libpng16.so.16").symlink_to("libpng16.so.16.39.0")
    bill = json.loads(bill_of(build, work, files, env=os.environ | {"LD_LIBRARY_PATH": str(folder)}))
    check(component_with(bill, "spawnfield:file", "libpng16.so.16")["purl"] == "pkg:generic/libpng16@16.39.0",
          "a library without a package is not listed")


def main():
    build, work, cpack = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    shutil.rmtree(work, ignore_errors=True)
    root = work / "root"
    root.mkdir(parents=True)
    run(cpack, "--config", build / "CPackConfig.cmake", "-G", "DEB", "-B", work)
    package = next(work.glob("*.deb"))
    run("dpkg-deb", "--extract", package, root)
    binaries = [file for file in root.rglob("*") if is_elf(file)]
    bill = json.loads((root / "usr/share/doc/spawnfield/spawnfield.cdx.json").read_text())
    check_package(package, root, binaries)
    check_dependencies(package, bill, binaries)
    check_bill(bill, root, binaries)
    check_script(build, work)
    run(root / "usr/bin/spawnfield", "bake", root / "usr/share/spawnfield/maps/yard/yard.sdf", "-o", work / "map")


main()
