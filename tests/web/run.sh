#!/usr/bin/env bash
# Tests the page of spawnfield review in a headless Chromium: run.sh [PROGRAM] [--name-pattern PATTERN]. Needs Debian's
# packages nodejs, npm and chromium; the exit status is 77 if they, or npm's registry, are missing. With PROGRAM, also
# tests the pages that it writes and serves. Screenshots are in build/web/screenshots.
set -euo pipefail
cd "$(dirname "$0")/../.."

if ! browser=$(command -v chromium); then
  echo "run.sh: chromium is missing; install the package chromium" >&2
  exit 77
fi
tools/build-web.sh || { status=$?; exit $((status == 77 ? 77 : 1)); }
if [[ ${1:---} != --* ]]; then
  SPAWNFIELD_PROGRAM=$(realpath "$1")
  export SPAWNFIELD_PROGRAM
  shift
fi
pattern=()
if [[ ${1:-} == --name-pattern ]]; then
  pattern=(--test-name-pattern "$2")
fi
mkdir -p build/web/screenshots
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
TMPDIR=$work CHROMIUM=$browser node --test "${pattern[@]}" tests/web/*.test.mjs
