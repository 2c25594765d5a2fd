#!/usr/bin/env bash
# Prints the SHA-256 of every file that a dozen commands write: run.sh BIN_FOLDER SOURCE_FOLDER WORK_FOLDER THREADS.
# BIN_FOLDER contains spawnfield and spawnfield_worlds. Every build must print the lines of tests/golden/digests.txt.
set -euo pipefail
bin=$1
source=$2
work=$3
threads=$4

rm -rf "$work"
mkdir -p "$work/results"
cd "$work"
# The results must not depend on the folders of a machine, so all inputs have paths relative to the work folder.
cp -r "$source/maps" maps
"$bin/spawnfield_worlds" low-complexity -o low --seed 1 >/dev/null
"$bin/spawnfield_worlds" complex -o district --seed 1 >/dev/null

robot=maps/robots/husky.yaml
spawnfield() { "$bin/spawnfield" "$@" --threads "$threads" --quiet; }

# Every kind of map: primitives, generated meshes with water and slopes, boxes in a district, a Gazebo world, storeys.
spawnfield bake maps/training/scene.yaml -o results/training
spawnfield bake low/scene.yaml -o results/low --resolution 0.5 --bounds=270,180,0,330,240,200
spawnfield bake district/scene.yaml -o results/district --resolution 0.25 --bounds=10,390,-5,70,450,30
spawnfield bake maps/yard/yard.sdf -o results/yard
spawnfield bake maps/storeys/scene.yaml -o results/storeys --z=-1:4

spawnfield raster results/training --robot $robot --dims 2 --step 0.5 --max-slope 15 -o results/training_2d.csv
spawnfield raster results/training --robot $robot --dims 3 --step 1 --snap -o results/training_3d.csv
spawnfield raster results/low --robot box:0.99,0.67,0.39 --dims 2 --step 1 --offset 1 --yaw 30deg -o results/low_2d.csv
spawnfield raster results/district --robot maps/robots/cart.urdf --dims 2 --step 1 -o results/district_2d.csv
spawnfield sample results/training --robot $robot -n 50 --min-distance 1 --yaw random --seed 7 --stance level \
  -o results/training_sample.csv
spawnfield sample results/yard --robot maps/robots/cart.urdf -n 1000 --min-distance 3 --stance level \
  -o results/yard_full.json ||
  [ $? = 3 ]  # 3: fewer than 1000 spawns fit; this line tests that case
spawnfield sample results/storeys --robot $robot -n 40 --min-distance 1 --floor 1 --stance level \
  -o results/storeys_sample.csv
spawnfield sample results/storeys --robot $robot -n 40 --min-distance 1 -o results/storeys_sample_settled.csv
spawnfield sample results/training --robot maps/robots/cart.urdf -n 60 --min-distance 0.5 --yaw random --settle \
  -o results/training_settled.csv
spawnfield search results/low --robot box:0.99,0.67,0.39 -n 40 --min-distance 2 --yaw random --seed 3 \
  -o results/low_search.csv
spawnfield check results/low --robot $robot --poses results/low_search.csv --max-slope 20 -o results/low_check.csv
spawnfield check results/training --robot $robot --poses results/training_3d.csv --format json \
  -o results/training_check.json
spawnfield check results/district --robot box:2,2,1 --poses results/district_2d.csv -o results/district_check.csv
spawnfield check results/low --robot $robot --poses results/low_2d.csv --settle -o results/low_settled.csv
spawnfield raster results/training --robot maps/robots/cart.urdf --dims 2 --step 0.5 --settle --yaw 30deg \
  -o results/training_raster_settled.csv
spawnfield check results/training --robot maps/robots/cart.urdf --poses results/training_2d.csv --settle --drop 1 \
  --format json -o results/training_settled.json
poses="--robot maps/robots/cart.urdf --poses results/training_sample.csv"
spawnfield export results/yard --format ros2-launch-py $poses --topic robot_description -o results/yard_launch.py
spawnfield export results/yard --format sdf $poses --robot-uri model://cart -o results/yard.sdf
spawnfield export results/yard --format mujoco $poses -o results/yard_mujoco.xml
spawnfield export results/yard --format unity $poses -o results/yard_unity.csv
spawnfield export results/training --format nav2 --robot $robot --stance level -o results/training_nav2.yaml
spawnfield export results/training --format geotiff --robot $robot --stance level --resolution 0.5 \
  -o results/training.tiff
spawnfield export results/yard --format ply --robot $robot --stance level --step 1 -o results/yard.ply
spawnfield export results/training --format nav2 --robot $robot --resolution 0.5 -o results/training_nav2_settled.yaml
spawnfield export results/training --format geotiff --robot $robot --resolution 0.5 -o results/training_settled.tiff
spawnfield export results/yard --format ply --robot $robot --step 1 -o results/yard_settled.ply
spawnfield export results/yard --format glb --robot $robot --poses results/training_sample.csv -o results/yard.glb

cd results
find . -type f -printf '%P\n' | LC_ALL=C sort | xargs sha256sum
