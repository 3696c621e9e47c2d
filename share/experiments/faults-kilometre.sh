#!/bin/sh
# Checks on a real drive whether the localization notices faults, and recovers: those of faults.sh, put into the first
# half of the real kilometre. Map of the even key frames and localization on the odd ones, and the other way round
# (3.5 m apart, 1.8 scans a second), with a real laser odometry. 100 trials each; since the drive has 400 m, they overlap.
# Usage: share/experiments/faults-kilometre.sh DATA_DIR KILOMETRE OUT
#   DATA_DIR   folder with kitti_odom_00_km/ and kitti_raw_0005/, whose map is the wrong one
#   KILOMETRE  the scans of DATA_DIR/kitti_odom_00_km as a folder (228 of Jichao-Peng/multi-sensor_fusion_learning)
#   OUT        gets maps, drives, one JSON and one text for each fault, table.txt and faults.json
# 8 s before each fault, 10 s of it, 100 m after it; kidnapped by 20 m and more. Seeds 501 and 502.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; three minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

kilometre_arguments "$@"
data=$(cd "$1" && pwd)
find_programs pole-import pole-extract pole-map pole-eval
find_tools jq
config=$top/config/kitti.ini
cd "$out"
rm -f ./*.json ./*.txt

# poles_of FOLDER NAME [OPTION...]: NAME.rawlog with the poles, NAME.tum, NAME.polemap.
poles_of() {
  folder=$1 name=$2
  shift 2
  # shellcheck disable=SC2086 # several words
  find_poles "$folder" "$name" "$config" $clockwise "$@"
  cp "$config" "$name.ini"
  map_drive "$name" "$name.polemap"
}

# faults SCANS MAP SEED FAULT [OPTION...]
faults() {
  scans=$1 map=$2 seed=$3 fault=$4
  shift 4
  "$bin/pole-eval" faults --config "$config" --map "$map.polemap" --input "$scans.rawlog" --truth "$scans.tum" \
    --fault "$fault" --trials 100 --seed "$seed" --lead 8 --duration 10 --json "$scans.$fault.json" \
    "$@" >>"$fault.txt"
}

link_scans "$kilometre" "$out/drive" 1 228
/usr/bin/python3 "$top/share/experiments/planar_odometry.py" "$labels/laser_odometry.txt" drive/times.txt odometry.tum
poles_of drive even --every 2 --offset 0 --odometry odometry.tum
poles_of drive odd --every 2 --offset 1 --odometry odometry.tum
rm -r drive
poles_of "$data/kitti_raw_0005" wrong --odometry-noise 0.02 --seed 7
for fault in kidnap $lasting; do
  faults odd even 501 "$fault" --tail 100
  faults even odd 502 "$fault" --tail 100
done
faults odd even 501 wrong-map --other-map wrong.polemap --tail 60
faults even odd 502 wrong-map --other-map wrong.polemap --tail 60

for fault in kidnap wrong-map $lasting; do fault_results "$fault" ./*."$fault.json"; done | jq -s add >faults.json
fault_table faults.json | tee table.txt
