#!/usr/bin/env bash
# Makes build/python, a virtual environment with the packages of tests/requirements.txt from PyPI. Without access to
# PyPI the environment lacks them: one line says so, the tests that need them are skipped, and the next run tries again.
set -euo pipefail
cd "$(dirname "$0")/.."

wanted=tests/requirements.txt
folder=build/python
cmp -s "$wanted" "$folder/requirements.txt" && exit 0

echo "installing Python packages into $folder" >&2
mkdir -p build
log=build/python.log
# pip brings certificates of its own; those of the system are also right behind a company's proxy.
certificates=/etc/ssl/certs/ca-certificates.crt
[ ! -r "$certificates" ] || export PIP_CERT=${PIP_CERT:-$certificates}
pip=("$folder/bin/python" -m pip install --no-input --disable-pip-version-check --only-binary :all: --retries 1)
/usr/bin/python3 -m venv --clear "$folder" >"$log"
if "${pip[@]}" --requirement "$wanted" >>"$log" 2>&1; then
  cp "$wanted" "$folder/requirements.txt"
else
  echo "test-python.sh: PyPI's packages were not installed, so tests that need them are skipped; see $log" >&2
fi
