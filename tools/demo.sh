#!/usr/bin/env bash
# Shows spawnfield from a fresh clone on: installs missing packages, builds a release, bakes the training arena, samples
# 50 spawns for a Husky and draws where it can stand. If packages of the tests are missing, it builds without tests.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/install-dependencies.sh
echo "building (some minutes the first time)" >&2
tools/build.sh release -DSPAWNFIELD_TESTS=AUTO spawnfield_cli

spawnfield=build/release/bin/spawnfield
out=out/demo
mkdir -p "$out"
"$spawnfield" bake maps/training/scene.yaml -o "$out/training" --quiet
"$spawnfield" sample "$out/training" --robot maps/robots/husky.yaml -n 50 --min-distance 1 --yaw random \
  -o "$out/spawns.csv" 2>"$out/summary.txt"
"$spawnfield" heatmap "$out/training" --robot maps/robots/husky.yaml --spawns "$out/spawns.csv" \
  -o "$out/heatmap.png" --quiet

echo "map      $out/training"
echo "spawns   $out/spawns.csv"
echo "picture  $out/heatmap.png"
cat "$out/summary.txt"
