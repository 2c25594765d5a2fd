#!/usr/bin/env bash
# The thesis's eight experiments: experiments.sh [FOLDER] [--quick]. Installs what is missing, builds a release, makes
# and bakes the environments, runs the tests and writes FOLDER/experiments.md with its plots (default: out/experiments).
set -euo pipefail
cd "$(dirname "$0")/.."

folder=out/experiments
quick=()
for argument in "$@"; do
  case "$argument" in
    --quick) quick=(--quick) ;;
    -*) echo "experiments.sh: no such option: $argument; usage: tools/experiments.sh [FOLDER] [--quick]" >&2; exit 2 ;;
    *) folder=$argument ;;
  esac
done

tools/install-dependencies.sh --experiments
echo "building (some minutes the first time)" >&2
tools/build.sh release -DSPAWNFIELD_TESTS=AUTO spawnfield_experiments
build/release/bin/spawnfield_experiments -o "$folder" "${quick[@]}" --command "tools/experiments.sh${quick:+ --quick}"
/usr/bin/python3 tools/experiments/plot.py "$folder"
