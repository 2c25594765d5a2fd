#!/usr/bin/env bash
# Compares the files that a build writes with digests.txt, for some numbers of threads (1, 2 and 8 if none is given):
#   check.sh BIN_FOLDER SOURCE_FOLDER WORK_FOLDER [THREADS...]
# If a commit is meant to change results, write the digests again, and give the reason in the commit message:
#   tests/golden/run.sh $PWD/build/release/bin $PWD /tmp/golden 1 > tests/golden/digests.txt
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=$1 source=$2 work=$3
shift 3
[ $# -gt 0 ] || set -- 1 2 8

for threads; do
  "$here/run.sh" "$bin" "$source" "$work/$threads" "$threads" >"$work-$threads.txt"
  if ! diff "$here/digests.txt" "$work-$threads.txt"; then
    echo "check.sh: with --threads $threads the files above differ from tests/golden/digests.txt;" \
      "see $work/$threads/results" >&2
    exit 1
  fi
done
echo "$(wc -l <"$here/digests.txt") files have the digests of tests/golden/digests.txt with --threads $*"
