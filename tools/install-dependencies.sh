#!/usr/bin/env bash
# Installs the Debian/Ubuntu packages that spawnfield is built from and that are missing. Needs root or sudo only then.
set -euo pipefail

packages=(
  cmake ninja-build ccache g++ pkg-config
  catch2 libassimp-dev libccd-dev libcli11-dev libdeflate-dev libeigen3-dev libembree-dev libfcl-dev libhpdf-dev liboctomap-dev
  libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev
  libpng-dev libproj-dev libqhull-dev librecast-dev libsdformat-dev libtbb-dev libtiff-dev libtinyxml2-dev liburdfdom-dev libxxhash-dev libyaml-cpp-dev nlohmann-json3-dev python3-matplotlib zlib1g-dev
)

missing=()
for package in "${packages[@]}"; do
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install-dependencies.sh: run as root or install sudo; missing: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "installing ${missing[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
