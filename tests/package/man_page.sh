#!/usr/bin/env bash
# Formats the man page with all warnings of groff: man_page.sh PROGRAM. Fails on any warning, or if parts are missing.
set -euo pipefail
program=$1
warnings=$("$program" man | groff -man -ww -Tascii -P-c -P-b -P-u 2>&1 >/dev/null)
page=$("$program" man | groff -man -Tascii -P-c -P-b -P-u)
if [ -n "$warnings" ]; then
  echo "man_page.sh: groff warns about the man page: $warnings" >&2
  exit 1
fi
for text in 'SPAWNFIELD(1)' 'spawnfield bake scene --out FILE' "'GLOB=LABEL'" 'EXIT STATUS' '--unknown free|blocked' \
  'NAME.tmp-...' 'spawnfield bake maps/training/scene.yaml -o /tmp/training'; do
  if [[ $page != *"$text"* ]]; then
    echo "man_page.sh: the formatted man page lacks: $text" >&2
    exit 1
  fi
done
