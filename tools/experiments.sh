#!/usr/bin/env bash
# Runs the eight experiments of the thesis: experiments.sh [FOLDER] [--quick]. Installs missing packages, builds a
# release, makes and bakes the environments, runs the tests and writes FOLDER/experiments.md with plots. The default of
# FOLDER is out/experiments.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=out/experiments
quick=()
for argument in "$@"; do
  case "$argument" in
    --quick) quick=(--quick) ;;
    -*) echo "experiments.sh: unknown option $argument; usage: tools/experiments.sh [FOLDER] [--quick]" >&2; exit 2 ;;
    *) folder=$argument ;;
  esac
done

tools/install-dependencies.sh --experiments
echo "building (some minutes the first time)" >&2
tools/build.sh release -DSPAWNFIELD_TESTS=AUTO spawnfield_experiments
build/release/bin/spawnfield_experiments -o "$folder" "${quick[@]}" --command "tools/experiments.sh${quick:+ --quick}"
/usr/bin/python3 tools/experiments/plot.py "$folder"
