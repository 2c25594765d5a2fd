#!/usr/bin/env bash
# Runs the checks of .ci/run from a fresh clone: the format, the layers, the golden digests of debug and clang builds,
# 20 seconds of fuzzing for each reader, the tests under the address, undefined behaviour and thread sanitizers, and at
# last all tests of the release. Each step prints its time. The script stops at the first step that fails and prints the
# end and the faults of its log. All logs are in build/ci.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p build/ci
# All clones share the compiler cache, although debug information names folders.
export CCACHE_NOHASHDIR=1 CCACHE_BASEDIR=$PWD

step() {
  local name=$1 log=build/ci/$1.log began=$SECONDS
  shift
  if ! "$@" >"$log" 2>&1; then
    tail -n 60 "$log"
    echo "ci.sh: what failed in it:"
    grep -A 12 -E '(FAILED|error|ERROR|SUMMARY|WARNING):|^spawnfield .*ended with status' "$log" | tail -n 80 || true
    echo "ci.sh: step $name failed after $((SECONDS - began)) s; the whole log is $log"
    exit 1
  fi
  echo "ci.sh: $name passed in $((SECONDS - began)) s"
}

# The files that the program of a build writes have the committed digests.
golden() {
  tools/build.sh "$@" spawnfield_cli spawnfield_worlds &&
    tests/golden/check.sh "$PWD/build/$1/bin" "$PWD" "$PWD/build/$1/golden"
}

asan() {
  tools/build.sh asan -DSPAWNFIELD_PYTHON=ON "-DPython_EXECUTABLE=$PWD/build/python/bin/python" &&
    ctest --preset asan -j "$(nproc)" --no-label-summary
}

tsan() {
  tools/build.sh tsan spawnfield_tests spawnfield_worlds && ctest --preset tsan -j "$(nproc)" --label-regex threads
}

step dependencies tools/install-dependencies.sh --tests
step python tools/test-python.sh
step web tools/build-web.sh
step format tools/format.sh --check
step layers tools/check-layers.py
step dev golden dev -DCMAKE_CXX_FLAGS_DEBUG=  # without debug information, to save time
step clang golden clang
step fuzz tests/fuzz/readers.sh 20  # always the same random numbers
step asan asan
step tsan tsan
# The last step prints its own output, which ends with the summary of ctest.
tools/test.sh --no-skips
