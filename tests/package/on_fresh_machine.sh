#!/usr/bin/env bash
# Runs check.sh on an empty Debian: on_fresh_machine.sh FRESH_MACHINE [DEB]. Without DEB, makes the package first.
# `FRESH_MACHINE REPOSITORY COMMAND...` must clone a repository into an empty Debian 12 and run a command in the clone
# there, as root. The repository that it gets contains only the package and check.sh.
set -euo pipefail
machine=$(realpath "$1")
deb=${2:-$("$(dirname "$0")/../../tools/package.sh" | xargs realpath)}
deb=$(realpath "$deb")
check=$(realpath "$(dirname "$0")/check.sh")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git init -q "$work/package"
cd "$work/package"
cp "$check" .
cp "$deb" spawnfield.deb
git add .
git -c user.name=check -c user.email=check@localhost commit -q -m "the package and its check"
"$machine" "$work/package" ./check.sh ./spawnfield.deb
