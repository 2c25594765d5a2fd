#!/usr/bin/env bash
# Configures and builds a preset: build.sh PRESET [-DNAME=VALUE...] [TARGET...]. Prints the log only if a step fails.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=$1
shift
settings=()
while [[ ${1:-} == -D* ]]; do
  settings+=("$1")
  shift
done
mkdir -p "build/$preset"
log=build/$preset/build.log
configure_and_build() {
  cmake --preset "$preset" "${settings[@]}" && cmake --build --preset "$preset" ${1:+--target "$@"}
}
if ! configure_and_build "$@" >"$log" 2>&1; then
  tail -n 60 "$log" >&2
  echo "build.sh: the build of preset $preset failed; the whole log is $log" >&2
  exit 1
fi
