#!/usr/bin/env bash
# From a fresh clone to passed tests: test.sh [--no-skips]. Installs what is missing, builds a release and runs every
# test. With --no-skips a test that ctest reports as skipped is a failure, as CI wants it.
set -euo pipefail
cd "$(dirname "$0")/.."

no_skips=
case "$*" in
  "") ;;
  --no-skips) no_skips=yes ;;
  *) echo "test.sh: unknown argument $*; usage: tools/test.sh [--no-skips]" >&2; exit 2 ;;
esac

tools/install-dependencies.sh --tests
tools/test-python.sh
echo "building (some minutes the first time)" >&2
tools/build.sh release
results=$PWD/build/release/tests.xml
ctest --preset release -j "$(nproc)" --output-junit "$results"
if [ -n "$no_skips" ] && grep -q '<skipped' "$results"; then
  echo "test.sh: --no-skips: some tests were skipped, see above" >&2
  exit 1
fi
