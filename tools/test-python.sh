#!/usr/bin/env bash
# Makes build/python, a virtual environment with the packages of tests/requirements.txt from PyPI. Without access to
# PyPI the script prints one line, the tests that need these packages are skipped, and the next run tries again.
set -euo pipefail
cd "$(dirname "$0")/.."

wanted=tests/requirements.txt
folder=build/python
cmp -s "$wanted" "$folder/requirements.txt" && exit 0

echo "installing Python packages into $folder" >&2
mkdir -p build
log=build/python.log
source tools/pip-settings.sh
pip=("$folder/bin/python" -m pip install --only-binary :all: --retries 1)
/usr/bin/python3 -m venv --clear "$folder" >"$log"
if "${pip[@]}" --requirement "$wanted" >>"$log" 2>&1; then
  cp "$wanted" "$folder/requirements.txt"
else
  echo "test-python.sh: the packages of $wanted could not be installed from PyPI, so the tests that need them are" \
    "skipped; see $log" >&2
fi
