#!/usr/bin/env bash
# Installs a Debian package of spawnfield with apt and tries what it contains: check.sh DEB. For an empty Debian 12, as
# root: a container or a chroot. At the end it removes the package again.
set -euo pipefail
deb=$(realpath "$1")
fail() { echo "check.sh: $*" >&2; exit 1; }

! command -v g++ cmake >/dev/null || fail "this system has a compiler; use an empty one, without build dependencies"
before=$(dpkg-query -W | wc -l)
apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$deb" >/dev/null
echo "installed $(($(dpkg-query -W | wc -l) - before)) packages"

cd "$(mktemp -d)"
maps=/usr/share/spawnfield/maps
[ "$(spawnfield --version | head -n 1)" = "$(dpkg-query -W -f '${Version}' spawnfield)" ] || fail "wrong version"
spawnfield bake $maps/training/scene.yaml -o map
spawnfield sample map --robot $maps/robots/husky.yaml -n 10 --min-distance 2 --yaw random --seed 1 -o spawns.csv
[ "$(wc -l <spawns.csv)" = 11 ] || fail "sample wrote no 10 spawns"
spawnfield check map --robot $maps/robots/husky.yaml --poses spawns.csv --require-valid -o verdicts.csv
spawnfield heatmap map --robot $maps/robots/husky.yaml -o map.png
spawnfield bake $maps/standing/scene.yaml -o standing  # meshes
spawnfield bake $maps/yard/yard.sdf -o yard            # SDF, with a model of the package
spawnfield info $maps/robots/cart.urdf >/dev/null
for module in $(dpkg -L spawnfield | grep 'libspawnfield_.*\.so$'); do
  ! ldd "$module" | grep 'not found' || fail "$module lacks libraries"
done

[ -s /usr/share/doc/spawnfield/spawnfield.cdx.json ] || fail "the list of libraries is missing"

# The shells and man find what the package has for them.
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends bash-completion fish man-db zsh >/dev/null
bash -c 'source /usr/share/bash-completion/bash_completion && _completion_loader spawnfield; complete -p spawnfield' |
  grep -q -- '-F _spawnfield' || fail "bash does not complete the program"
[ "$(zsh -f -c "autoload -U compinit; compinit -D -u; print \$_comps[spawnfield]")" = _spawnfield ] ||
  fail "zsh does not complete the program"
[ "$(fish -c 'complete -C "spawnfield bake --unknown bl"' | cut -f 1)" = blocked ] ||
  fail "fish does not complete the program"
man spawnfield >page.txt
grep -q '^SPAWNFIELD(1)' page.txt || fail "man does not show the page"

DEBIAN_FRONTEND=noninteractive apt-get purge -y -qq spawnfield >/dev/null
[ -z "$(find /usr -name '*spawnfield*')" ] || fail "files remain after the package was removed"
echo "check.sh: the package installs, runs and is removed"
