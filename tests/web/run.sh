#!/usr/bin/env bash
# Tests the page of spawnfield review in a headless Chromium: run.sh [--name-pattern PATTERN]. Needs Debian's packages
# nodejs, npm and chromium. Screenshots are in build/web/screenshots.
set -euo pipefail
cd "$(dirname "$0")/../.."

if ! browser=$(command -v chromium); then
  echo "run.sh: chromium is missing; install the package chromium" >&2
  exit 1
fi
tools/build-web.sh
pattern=()
if [[ ${1:-} == --name-pattern ]]; then
  pattern=(--test-name-pattern "$2")
fi
mkdir -p build/web/screenshots
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
TMPDIR=$work CHROMIUM=$browser node --test "${pattern[@]}" tests/web/*.test.mjs
