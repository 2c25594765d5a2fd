#!/usr/bin/env bash
# From a fresh clone to passed tests: installs what is missing, builds a release and runs every test. The last line is
# ctest's own.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/install-dependencies.sh --tests
echo "building (some minutes the first time)" >&2
tools/build.sh release
ctest --preset release -j "$(nproc)"
