#!/usr/bin/env bash
# Fuzzes the readers of files with libFuzzer: readers.sh SECONDS [READER...]. Builds the presets `clang`, whose program
# reads files in a process of its own, and `fuzz`. Reads all files of tests/data/fuzz first, then gives each reader
# (default: all) altered seeds for SECONDS, and prints a table. The exit status is 1 if anything was found.
#
# New inputs are kept in build/fuzz/corpus for the next run, findings in build/fuzz/findings. MORE=FOLDER also takes
# the files of this folder as seeds, JOBS=N fuzzes N readers at a time (default: one per core), and SEED=N changes the
# random numbers.
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds=${1:?usage: tests/fuzz/readers.sh SECONDS [READER...]}
shift
export fuzzer=$PWD/build/fuzz/bin/spawnfield_fuzz_readers seconds seed=${SEED:-1}
export corpus=$PWD/build/fuzz/corpus findings=$PWD/build/fuzz/findings logs=$PWD/build/fuzz/logs
# The library and the fuzzer share variables, which is an error for the address sanitizer. Freed memory counts for the
# limit of 1 GB, so little of it is kept.
export ASAN_OPTIONS=detect_odr_violation=0:quarantine_size_mb=32:allocator_may_return_null=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1

tools/build.sh clang spawnfield_cli
tools/build.sh fuzz spawnfield_fuzz_readers
mkdir -p "$corpus" "$findings" "$logs"
# Small files are written and read all the time: in memory, if possible.
scratch=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")")
trap 'rm -rf "$scratch"' EXIT
export TMPDIR=$scratch

known=$("$fuzzer" --write-seeds="$scratch/seeds" ${MORE:+--more="$MORE"} 2>/dev/null)
mv "$scratch/seeds" "$scratch/new"
for reader in $known; do
  mkdir -p "$corpus/$reader"
  cp "$scratch/new/$reader"/* "$corpus/$reader"
  cp "$scratch/new/$reader.dict" "$corpus/$reader.dict"
done
readers=${*:-$known}

# The readers apart_… measure the processor time themselves, so that a busy machine makes no findings.
run() {
  local timeout=20
  [[ $1 == apart_* ]] && timeout=120
  "$fuzzer" --reader="$1" --program="$PWD/build/clang/bin/spawnfield" -timeout=$timeout -rss_limit_mb=1024 "${@:2}"
}

regressions() {
  local files
  files=$(find "tests/data/fuzz/$1" -type f 2>/dev/null || true)
  [ -z "$files" ] || run "$1" $files >"$logs/$1.regressions" 2>&1
}

fuzz() {
  local status=found executions
  if ! regressions "$1"; then
    printf '%-16s a file of tests/data/fuzz fails: see %s\n' "$1" "$logs/$1.regressions"
    return 1
  fi
  run "$1" -max_total_time="$seconds" -seed="$seed" -max_len=65536 -dict="$corpus/$1.dict" -print_final_stats=1 \
    -close_fd_mask=3 -artifact_prefix="$findings/$1-" "$corpus/$1" >"$logs/$1" 2>&1 && status=-
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$logs/$1")
  printf '%-16s %12s %8s %s\n' "$1" "${executions:-?}" "$(find "$corpus/$1" -type f | wc -l)" "$status"
  [ "$status" = - ] && return
  local file
  for file in $(sed -n 's/.*Test unit written to //p' "$logs/$1"); do
    printf '  %s\n' "$file"
    run "$1" "$file" 2>&1 | grep -aE 'what\(\)|runtime error|ERROR:|SUMMARY:|#[0-9]+ .*/src/' | head -n 12 | cut -c1-200
  done
  return 1
}
export -f run regressions fuzz

printf '%-16s %12s %8s %s\n' reader executions corpus finding
# shellcheck disable=SC2086
printf '%s\n' $readers | xargs -P "${JOBS:-$(nproc)}" -I{} bash -c 'fuzz {}'
