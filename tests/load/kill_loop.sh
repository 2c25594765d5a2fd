#!/usr/bin/env bash
# Kills and interrupts runs at random times, fills a small disk, and bakes twice at once, and checks each time that the
# result is absent, the complete old one or a complete new one, and that the next run leaves nothing beside it.
#
#     tests/load/kill_loop.sh PROGRAM [KILLS] [INTERRUPTS]
#
# Prints a table of counts. Status 1 if a check fails. Parts that need root or unshare are skipped, with a line.
set -uo pipefail
source_folder=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:?usage: kill_loop.sh PROGRAM [KILLS] [INTERRUPTS]}")
kills=${2:-200}
interrupts=${3:-50}
scene=$source_folder/maps/training/scene.yaml
robot=$source_folder/maps/robots/husky.yaml
RANDOM=1

work=$(mktemp -d)
disk=
trap '[[ -z $disk ]] || umount "$disk"; rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
declare -A counts=()

count() { counts[$1]=$((${counts[$1]:-0} + 1)); }
failed() {
  echo "FAILED: $*" >&2
  failures=$((failures + 1))
}
run() { "$program" "$@" >run.out 2>run.err; }

# Milliseconds that a command takes.
duration() {
  local start
  start=$(date +%s%N)
  run "$@"
  echo $((($(date +%s%N) - start) / 1000000 + 1))
}

# stop SIGNAL MILLISECONDS ARGUMENTS...: sends the signal at a random time. Prints the status.
stop() {
  local signal=$1 most=$2 status
  shift 2
  # An interactive shell's background jobs react to SIGINT; those of a script do not, so env sets it back.
  env --default-signal=INT "$program" "$@" >run.out 2>run.err &
  local process=$!
  sleep "$(awk -v ms=$((RANDOM * most / 32768)) 'BEGIN { printf "%.3f", ms / 1000 }')"
  kill -"$signal" "$process" 2>/dev/null
  wait "$process" 2>/dev/null
  status=$?
  echo "$status"
}

# The state of the map: absent, old, new or damaged.
state_of_map() {
  if [[ ! -e results/map ]]; then
    echo absent
  elif ! run info results/map --verify -q; then
    echo damaged
  elif cmp -s results/map/map.yaml old/map/map.yaml; then
    echo old
  else
    echo new
  fi
}

# The state of a file: absent, old, new, interrupted (the first lines of the new one) or damaged.
state_of_file() {
  local size
  if [[ ! -e results/$1 ]]; then
    echo absent
  elif cmp -s "results/$1" "old/$1"; then
    echo old
  elif cmp -s "results/$1" "new/$1"; then
    echo new
  else
    size=$(stat -c %s "results/$1")
    if [[ $(tail -c 1 "results/$1" | od -An -tx1 | tr -d ' ') == 0a ]] && cmp -s -n "$size" "results/$1" "new/$1"; then
      echo interrupted
    else
      echo damaged
    fi
  fi
}

# only NAME...: the folder `results` contains these names and nothing else.
only() { [[ "$(ls -A results | sort | tr '\n' ' ')" == "$(printf '%s\n' "$@" | sort | tr '\n' ' ')" ]]; }

# note LABEL STATUS STATE: counts what happened in one run.
note() {
  local label=$1 status=$2 state=$3
  count "$label: runs"
  case $status in
  0) count "$label: done before the signal" ;;
  130 | 137) count "$label: stopped" ;;
  *) failed "$label ended with status $status: $(cat run.err)" ;;
  esac
  [[ $state != damaged && ($state != interrupted || $status == 130) ]] || failed "$label left a damaged result"
  count "$label: result $state"
  [[ -z "$(ls -A results | grep -E '\.(tmp|old)-')" ]] || count "$label: something was left"
}

mkdir results old new
bake=(bake "$scene" -o results/map --resolution 0.05 -q)
run bake "$scene" -o base --resolution 0.2 -q || failed "the first bake: $(cat run.err)"
sample=(sample base --robot "$robot" -n 200000 --stance level -q -o results/spawns.csv)
raster=(raster base --robot "$robot" --dims 2 --step 0.02 -q -o results/raster.csv)
bake_time=$(duration "${bake[@]}")
sample_time=$(duration "${sample[@]}")
raster_time=$(duration "${raster[@]}")
cp -a results/. new
cp -a base old/map
run sample base --robot "$robot" -n 1000 --seed 1 -q -o old/spawns.csv || failed "the old spawns: $(cat run.err)"
run raster base --robot "$robot" --dims 2 --step 1 -q -o old/raster.csv || failed "the old raster: $(cat run.err)"

# Puts the old results there: those of other options, so that they differ from the new ones.
put_old() {
  rm -rf results/map results/*.csv
  [[ $1 == none ]] || cp -a old/. results
}

stopped_runs() { # SIGNAL NAME NUMBER
  local signal=$1 name=$2 number=$3 i status
  for ((i = 0; i < number; ++i)); do
    if ((i % 3 == 0)); then put_old none; else put_old all; fi
    status=$(stop "$signal" $((bake_time * 5 / 4)) "${bake[@]}")
    note "$name of bake" "$status" "$(state_of_map)"
    status=$(stop "$signal" $((sample_time * 5 / 4)) "${sample[@]}")
    note "$name of sample" "$status" "$(state_of_file spawns.csv)"
    status=$(stop "$signal" $((raster_time * 5 / 4)) "${raster[@]}")
    note "$name of raster" "$status" "$(state_of_file raster.csv)"
    if ((i % 10 == 9 || i == number - 1)); then # the next normal runs
      run "${bake[@]}" && run "${sample[@]}" && run "${raster[@]}" || failed "a normal run: $(cat run.err)"
      count "$name: normal runs afterwards"
      if only map spawns.csv raster.csv; then
        count "$name: nothing left after them"
      else
        failed "left after normal runs: $(ls -A results)"
      fi
    fi
  done
}

full_disk() {
  mkdir full
  if ! mount -t tmpfs -o size=2m tmpfs full 2>/dev/null; then
    echo "skipped: a full disk (mount needs root)"
    return
  fi
  disk=$work/full
  local status name
  run bake "$scene" -o full/map --resolution 0.5 -q || failed "a bake on the small disk: $(cat run.err)"
  run sample base --robot "$robot" -n 5 --stance level -q -o full/spawns.csv
  local before
  before=$(cd full && find . -type f -exec sha256sum {} + | sort)
  for name in bake sample raster; do
    case $name in
    bake) run bake "$scene" -o full/map --resolution 0.02 -q ;;
    sample) run sample base --robot "$robot" -n 200000 --stance level -q -o full/spawns.csv ;;
    raster) run raster base --robot "$robot" --dims 2 --step 0.02 -q -o full/spawns.csv ;;
    esac
    status=$?
    count "full disk: runs"
    [[ $status == 1 ]] || failed "$name on a full disk ended with status $status: $(cat run.err)"
    if [[ "$(cd full && find . -type f -exec sha256sum {} + | sort)" == "$before" ]]; then
      count "full disk: status 1 and the old result"
    else
      failed "$name on a full disk changed the folder: $(ls -A full)"
    fi
  done
}

two_at_once() {
  if ! unshare --pid --fork true 2>/dev/null; then
    echo "skipped: two bakes in process namespaces (unshare needs root)"
    return
  fi
  local i first second
  for ((i = 0; i < 20; ++i)); do
    if ((i % 4 == 0)); then rm -rf results/map; fi
    unshare --pid --fork "$program" "${bake[@]}" 2>first.err &
    first=$!
    unshare --pid --fork "$program" "${bake[@]}" 2>second.err &
    second=$!
    count "two bakes at once: pairs"
    wait "$first" || failed "the first of two bakes: $(cat first.err)"
    wait "$second" || failed "the second of two bakes: $(cat second.err)"
    [[ $(state_of_map) == new ]] || failed "two bakes at once: the map is $(state_of_map)"
    if only map spawns.csv raster.csv; then
      count "two bakes at once: one complete new map and nothing else"
    else
      failed "two bakes at once left $(ls -A results)"
    fi
  done
}

stopped_runs KILL kill "$kills"
stopped_runs INT interrupt "$interrupts"
full_disk
two_at_once

printf '%-60s %s\n' "bake, sample, raster without a signal" "$bake_time, $sample_time, $raster_time ms"
for key in "${!counts[@]}"; do printf '%-60s %d\n' "$key" "${counts[$key]}"; done | sort
echo "failed checks: $failures"
((failures == 0))
