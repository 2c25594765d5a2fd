#!/usr/bin/env bash
# Runs all tests from a fresh clone on: test.sh [--no-skips]. Installs missing packages, builds a release and runs every
# test. With --no-skips, which CI uses, a test that ctest reports as skipped is a failure.
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
tools/build-web.sh || {
  [ $? = 77 ] || exit 1
  echo "test.sh: there is no review page (see above), so its tests are skipped" >&2
}
echo "building (some minutes the first time)" >&2
python=$PWD/build/python/bin/python
with_python=OFF
"$python" -m nanobind --version >/dev/null 2>&1 && with_python=ON
tools/build.sh release "-DSPAWNFIELD_PYTHON=$with_python" "-DPython_EXECUTABLE=$python"
results=$PWD/build/release/tests.xml
ctest --preset release -j "$(nproc)" --no-label-summary --output-junit "$results"
if [ -n "$no_skips" ] && grep -q '<skipped' "$results"; then
  echo "test.sh: some tests were skipped (see above), which --no-skips does not allow" >&2
  exit 1
fi
