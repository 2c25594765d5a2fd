#!/usr/bin/env python3
"""Writes the software bill of materials of spawnfield: a list of all libraries that it uses, in CycloneDX 1.5 JSON.

    sbom.py --version VERSION --libraries FILE [--page LOCK] -o OUT BINARY...

BINARY: the program, the library and its modules. What they link, directly or through other libraries, comes from the
files themselves (objdump, ldd). dpkg says which package each library is from, with its version, and Debian's copyright
file says the licence. FILE is libraries.json of the build (cmake/libraries.cmake): the libraries that spawnfield uses
by name, also those that are only headers. LOCK is web/package-lock.json, if the library contains the review page: the
JavaScript libraries in that page are from npm.

The same binaries on the same system give the same bytes. There is a time stamp only if SOURCE_DATE_EPOCH is set.
"""

import argparse
import datetime
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import uuid
from pathlib import Path
from urllib.parse import quote

# Names of licences in Debian's copyright files, in lower case, and their SPDX identifiers.
SPDX = {
    "apache-2": "Apache-2.0", "apache-2.0": "Apache-2.0", "bsd-2-clause": "BSD-2-Clause", "bsd-3": "BSD-3-Clause",
    "bsd-3-clause": "BSD-3-Clause", "bsd-4-clause": "BSD-4-Clause", "curl": "curl", "expat": "MIT",
    "gpl-2": "GPL-2.0-only", "gpl-2+": "GPL-2.0-or-later", "gpl-3+": "GPL-3.0-or-later", "isc": "ISC",
    "lgpl-2+": "LGPL-2.0-or-later", "lgpl-2.1": "LGPL-2.1-only", "lgpl-2.1+": "LGPL-2.1-or-later",
    "lgpl-3+": "LGPL-3.0-or-later", "mit": "MIT", "mpl-2": "MPL-2.0", "mpl-2.0": "MPL-2.0",
    "openldap-2.8": "OLDAP-2.8", "zlib": "Zlib", "zlib/libpng": "Zlib",
}
# Licences of source packages whose copyright files no program can read.
OF_SOURCE = {"glibc": "LGPL-2.1-or-later", "gcc": "GPL-3.0-or-later WITH GCC-exception-3.1"}


def output_of(*command):
    """Returns what a command prints; nothing if it fails or does not exist."""
    if shutil.which(command[0]) is None:
        return ""
    return subprocess.run(command, capture_output=True, text=True).stdout


# ---- What the binaries link ----


def needed_by(file):
    """Returns the names of the libraries that a program or library links directly, in its order."""
    return re.findall(r"^ +NEEDED +(\S+)$", output_of("objdump", "-p", str(file)), re.MULTILINE)


def loaded_by(file):
    """Returns the file of each library that the loader loads for a program or library, by its name."""
    text = output_of("ldd", str(file))
    missing = re.findall(r"(\S+) => not found", text)
    if missing:
        sys.exit(f"sbom.py: {file} needs {', '.join(missing)}, which the loader does not find")
    files = dict(re.findall(r"^\s*(\S+) => (/\S+) \(", text, re.MULTILINE))
    files |= {Path(name).name: name for name in re.findall(r"^\s*(/\S+) \(", text, re.MULTILINE)}
    return {name: os.path.realpath(path) for name, path in files.items()}


# ---- What dpkg knows ----


def packages_of(files):
    """Returns the name of the Debian package of each file that is from one."""
    other = {}  # dpkg knows /lib/x/libz.so as such, and others as /usr/lib/x/libz.so, although both are one folder
    for file in files:
        other[file] = file
        other[file.removeprefix("/usr") if file.startswith("/usr/lib") else "/usr" + file] = file
    out = {}
    for line in output_of("dpkg-query", "--search", *sorted(other)).splitlines():
        package, separator, file = line.partition(": ")
        if separator and file in other and not line.startswith("diversion by"):
            out[other[file]] = package.split(",")[0]
    return out


FIELDS = ["binary:Package", "Package", "Version", "Architecture", "source:Package", "source:Version", "Homepage"]


def facts_of(packages):
    """Returns dpkg's fields of each package, as a dict."""
    if not packages:
        return {}
    layout = "\\t".join(f"${{{field}}}" for field in FIELDS) + "\\n"
    rows = output_of("dpkg-query", "--show", f"--showformat={layout}", *sorted(packages)).splitlines()
    return {row.split("\t")[0]: dict(zip(FIELDS, row.split("\t"))) for row in rows}


def debian_licence(package):
    """Returns the licence of most files of a package, as its copyright file names it; empty if it does not."""
    file = Path("/usr/share/doc", package, "copyright")
    text = file.read_text(errors="replace") if file.exists() else ""
    if not re.match(r"Format: \S+/copyright-format/1.0/?", text):
        return ""
    for paragraph in re.split(r"\n\s*\n", text):
        files = re.search(r"^Files:\s*(\S+)", paragraph, re.MULTILINE)
        licence = re.search(r"^License:\s*(\S.*)$", paragraph, re.MULTILINE)
        if files and files[1] in ("*", "./*") and licence:
            return licence[1].strip()
    return ""


def distribution():
    """Returns the name and version of this system, for example ("debian", "12")."""
    file = Path("/etc/os-release")
    text = file.read_text() if file.exists() else ""
    values = dict(re.findall(r'^(\w+)="?([^"\n]*)"?$', text, re.MULTILINE))
    return values.get("ID", "linux"), values.get("VERSION_ID", "")


# ---- The document ----


def licences(own, facts):
    """Returns the licences of a component: of the table of libraries, else of its Debian package."""
    if own:
        return [{"license": {"id": own}}]
    source = re.sub("-[0-9]+$", "", facts["source:Package"]) if facts else ""
    if source in OF_SOURCE:
        return [{"expression": OF_SOURCE[source]}]
    name = debian_licence(facts["Package"]) if facts else ""
    if not name:
        return []
    return [{"license": {"id": SPDX[name.lower()]} if name.lower() in SPDX else {"name": name}}]


def package_component(facts):
    """Returns the component of a Debian package, without the parts that other sources say."""
    name, number = distribution()
    version = facts["Version"]
    qualifiers = {"arch": facts["Architecture"], "distro": f"{name}-{number}"}
    if facts["source:Package"] != facts["Package"] or facts["source:Version"] != version:
        qualifiers["upstream"] = f"{facts['source:Package']}@{facts['source:Version']}"
    text = "&".join(f"{key}={quote(value, safe='.-_~:')}" for key, value in sorted(qualifiers.items()))
    purl = f"pkg:deb/{name}/{quote(facts['Package'])}@{quote(version, safe='.-_~:')}?{text}"
    return {"type": "library", "bom-ref": purl, "name": facts["Package"], "version": version, "purl": purl}


def other_component(file, library):
    """Returns the component of a library that is not in a Debian package."""
    name = library["name"] if library else Path(file).name.split(".so")[0]
    number = re.search(r"\.so\.([0-9.]+)$", file)
    version = library["version"] if library else number[1] if number else "unknown"
    purl = f"pkg:generic/{quote(name)}@{quote(version)}"
    return {"type": "library", "bom-ref": purl, "name": name, "version": version, "purl": purl}


class Bill:
    """All components, by reference, and what depends on what."""

    def __init__(self, files, libraries):
        """files: those of all libraries; libraries: the rows of libraries.json."""
        self.by_file = {os.path.realpath(row["file"]): row for row in libraries}
        owners = packages_of(sorted({*files, *self.by_file}))
        facts = facts_of(set(owners.values()))
        self.components, self.depends, self.reference = {}, {}, {}
        for file in sorted({*files, *(name for name, row in self.by_file.items() if ".so" not in Path(name).name)}):
            row = self.by_file.get(file)
            found = facts.get(owners.get(file))
            self.add(file, row, package_component(found) if found else other_component(file, row), found)

    def add(self, file, row, component, facts):
        reference = component["bom-ref"]
        component = self.components.setdefault(reference, component)
        self.reference[file] = reference
        own = (row or {}).get("licence", "")
        if own or "licenses" not in component:
            found = licences(own, facts)
            component |= {"licenses": found} if found else {}
        website = (row or {}).get("website") or (facts or {}).get("Homepage")
        if website and (row or "externalReferences" not in component):
            component["externalReferences"] = [{"type": "website", "url": website}]
        properties = component.setdefault("properties", [])
        if row:
            properties.append({"name": "spawnfield:library", "value": row["name"]})
        is_header = ".so" not in Path(file).name
        properties.append({"name": "spawnfield:header" if is_header else "spawnfield:file", "value": Path(file).name})

    def name_file(self, soname, file):
        """Adds the name by which binaries link a file, if it is not the file's own."""
        entry = {"name": "spawnfield:file", "value": soname}
        properties = self.components[self.reference[file]]["properties"]
        if entry not in properties:
            properties.append(entry)

    def add_page(self, lock):
        """Adds the libraries of the review page. Returns their references."""
        packages = json.loads(Path(lock).read_text())["packages"]
        added = set()
        for name in packages[""]["dependencies"]:
            package = packages[f"node_modules/{name}"]
            purl = f"pkg:npm/{quote(name)}@{package['version']}"
            self.components[purl] = {"type": "library", "bom-ref": purl, "name": name, "version": package["version"],
                                     "purl": purl, "licenses": [{"license": {"id": package["license"]}}],
                                     "properties": [{"name": "spawnfield:page", "value": "review"}]}
            added.add(purl)
        return added

    def depend(self, reference, references):
        self.depends.setdefault(reference, set()).update(set(references) - {reference})


def bill_of_materials(version, libraries, binaries, page):
    """Returns the document, without serial number."""
    own = {Path(file).name for file in binaries}

    def own_name(name):
        """Returns libspawnfield.so for libspawnfield.so.0.2, and nothing for a library of others."""
        return next((file for file in own if name == file or name.startswith(file + ".")), None)

    files = {}
    for binary in binaries:
        files |= {name: file for name, file in loaded_by(binary).items() if not own_name(name)}
    bill = Bill(set(files.values()), libraries)
    for name, file in files.items():
        bill.name_file(name, file)
        bill.depend(bill.reference[file], {bill.reference[files[n]] for n in needed_by(file) if n in files})
    parts = []
    for binary in sorted(binaries, key=lambda file: Path(file).name):
        name = Path(binary).name
        part = f"spawnfield/{name}"
        parts.append({"type": "library" if ".so" in name else "application", "bom-ref": part, "name": name,
                      "version": version})
        bill.depend(part, {bill.reference[files[n]] for n in needed_by(binary) if n in files})
        bill.depend(part, {f"spawnfield/{own_name(n)}" for n in needed_by(binary) if own_name(n)})
        bill.depend("spawnfield", {part})
    # Headers are compiled into the binaries.
    bill.depend("spawnfield", {reference for file, reference in bill.reference.items() if file not in files.values()})
    if page:
        bill.depend("spawnfield", bill.add_page(page))
    for component in bill.components.values():
        component["properties"].sort(key=lambda entry: (entry["name"], entry["value"]))
    root = {"type": "application", "bom-ref": "spawnfield", "name": "spawnfield", "version": version,
            "description": "Where can this robot stand in this world?",
            "licenses": [{"license": {"id": "BSD-3-Clause"}}], "purl": f"pkg:generic/spawnfield@{version}",
            "components": parts}
    references = sorted({*bill.components, *bill.depends})
    return {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
            "metadata": {"component": root,
                         "properties": [{"name": "spawnfield:system", "value": "-".join(distribution())},
                                        {"name": "spawnfield:machine", "value": platform.machine()}]},
            "components": [bill.components[name] for name in sorted(bill.components)],
            "dependencies": [{"ref": name, "dependsOn": sorted(bill.depends.get(name, ()))} for name in references]}


def stamped(bill):
    """Returns the document with a serial number, which its content decides, and a time if SOURCE_DATE_EPOCH is set."""
    content = json.dumps(bill, sort_keys=True)
    serial = f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, content)}"
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    if epoch:
        time = datetime.datetime.fromtimestamp(int(epoch), datetime.timezone.utc)
        bill = bill | {"metadata": {"timestamp": time.strftime("%Y-%m-%dT%H:%M:%SZ")} | bill["metadata"]}
    return {"bomFormat": bill["bomFormat"], "specVersion": bill["specVersion"], "serialNumber": serial} | bill


def main():
    parser = argparse.ArgumentParser(description="Writes a software bill of materials in CycloneDX 1.5 JSON.")
    parser.add_argument("--version", required=True, help="version of spawnfield")
    parser.add_argument("--libraries", required=True, help="libraries.json of the build")
    parser.add_argument("--page", help="lock file of the libraries of the review page")
    parser.add_argument("-o", "--out", required=True, help="file to write")
    parser.add_argument("binaries", nargs="+", help="the program, the library and its modules")
    arguments = parser.parse_args()
    libraries = json.loads(Path(arguments.libraries).read_text())
    bill = stamped(bill_of_materials(arguments.version, libraries, arguments.binaries, arguments.page))
    Path(arguments.out).write_text(json.dumps(bill, indent=2) + "\n")


main()
