#!/usr/bin/env bash
# Compares the files that a build writes with 1, 2 and 8 threads with digests.txt:
#   check.sh BIN_FOLDER SOURCE_FOLDER WORK_FOLDER
# If a commit is meant to change results, write the digests again, and give the reason in the commit message:
#   tests/golden/run.sh $PWD/build/release/bin $PWD /tmp/golden 1 > tests/golden/digests.txt
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

for threads in 1 2 8; do
  "$here/run.sh" "$1" "$2" "$3/$threads" "$threads" >"$3-$threads.txt"
  if ! diff "$here/digests.txt" "$3-$threads.txt"; then
    echo "check.sh: with --threads $threads the files above differ from tests/golden/digests.txt;" \
      "see $3/$threads/results" >&2
    exit 1
  fi
done
echo "$(wc -l <"$here/digests.txt") files have the digests of tests/golden/digests.txt with 1, 2 and 8 threads"
