#!/usr/bin/env bash
# Builds the page of spawnfield review: build/web/review.html, from web/. Needs Debian's packages nodejs and npm. The
# exit status is 77 if they, or npm's registry, are missing.
set -euo pipefail
cd "$(dirname "$0")/.."

for program in node npm; do
  if ! command -v "$program" >/dev/null; then
    echo "build-web.sh: $program is missing; install the packages nodejs and npm" >&2
    exit 77
  fi
done

# The libraries are installed anew only if the lock file changed.
installed=web/node_modules/.spawnfield-lock
if ! cmp --silent web/package-lock.json "$installed"; then
  mkdir -p build/web
  log=build/web/npm.log
  if ! (cd web && npm ci --ignore-scripts) >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "build-web.sh: npm ci failed; the whole log is $log" >&2
    exit 77
  fi
  cp web/package-lock.json "$installed"
fi
(cd web && node build.mjs)
