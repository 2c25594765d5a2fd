#!/usr/bin/env bash
# Installs the Debian/Ubuntu packages that are missing: install-dependencies.sh [--tests] [--experiments] [--package]
# [--web]. Without an option it installs what the build of spawnfield needs. --tests adds the packages that only tests
# and benchmarks need, --experiments those of the plots, --package those that make a Debian package, --web those that
# make the review page. It needs root or sudo only if a package is missing.
set -euo pipefail
cd "$(dirname "$0")/.."

# ccache is in the list because installing it later changes every compile command, so that everything is built again.
packages=(
  ccache cmake g++ ninja-build pkg-config
  libassimp-dev libccd-dev libcli11-dev libcpp-httplib-dev libdeflate-dev libeigen3-dev libfcl-dev libhpdf-dev
  libmeshoptimizer-dev liboctomap-dev libopencv-core-dev libopencv-imgproc-dev libpng-dev libproj-dev libqhull-dev
  libsdformat-dev libtbb-dev libtiff-dev libtinyxml2-dev liburdfdom-dev libxxhash-dev libyaml-cpp-dev
  nlohmann-json3-dev zlib1g-dev
  python3-dev python3-venv
)
# Node.js of another source than Debian serves, too.
web=()
command -v npm >/dev/null || web=(nodejs npm)
for argument in "$@"; do
  case "$argument" in
    --tests)
      packages+=(catch2 clang clang-format dpkg-dev file groff-base libclang-rt-dev libembree-dev)
      packages+=(libopencv-imgcodecs-dev librecast-dev)
      packages+=(python3-matplotlib python3-roslaunch)
      packages+=(chromium fonts-dejavu-core "${web[@]}")
      ;;
    --experiments) packages+=(python3-matplotlib) ;;
    --package) packages+=(dpkg-dev file "${web[@]}") ;;
    --web) packages+=("${web[@]}") ;;
    *)
      echo "install-dependencies.sh: unknown argument $argument" >&2
      echo "usage: tools/install-dependencies.sh [--tests] [--experiments] [--package] [--web]" >&2
      exit 2
      ;;
  esac
done

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }
missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install-dependencies.sh: run as root or install sudo; missing packages: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
# One of the packages needs the package ca-certificates, which replaces a list of certificates that somebody copied to
# its place, as on many containers behind a company's proxy. tools/pip-settings.sh still needs that list.
certificates=/etc/ssl/certs/ca-certificates.crt
if [ -r "$certificates" ] && ! is_installed ca-certificates; then
  mkdir -p build
  cp "$certificates" build/certificates.crt
fi
echo "installing ${missing[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
