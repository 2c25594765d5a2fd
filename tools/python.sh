#!/usr/bin/env bash
# Builds the Python package, installs it into the virtual environment build/python-package, and runs its first steps.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/install-dependencies.sh
folder=build/python-package
mkdir -p build out
/usr/bin/python3 -m venv --clear "$folder"
source tools/pip-settings.sh
echo "building the Python package (some minutes the first time)" >&2
"$folder/bin/pip" install --quiet .
"$folder/bin/python" python/examples/first_steps.py
echo "$folder/bin/python has the package now: import spawnfield"
