#!/usr/bin/env bash
# Makes the Debian package build/package/spawnfield_VERSION_ARCHITECTURE.deb. Installs missing packages first. Time
# stamps in the package are that of the last commit, or SOURCE_DATE_EPOCH, if one of them is known.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/install-dependencies.sh --package
tools/build-web.sh || echo "package.sh: there is no review page (see above), so \`spawnfield review\` only says so" >&2
if [ -z "${SOURCE_DATE_EPOCH:-}" ] && SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null); then
  export SOURCE_DATE_EPOCH
fi
echo "building the package (some minutes the first time)" >&2
tools/build.sh package
rm -f build/package/*.deb
cpack --config build/package/CPackConfig.cmake -B build/package >build/package/cpack.log 2>&1 ||
  { tail -n 40 build/package/cpack.log >&2; exit 1; }
ls build/package/*.deb
