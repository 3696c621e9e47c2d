#!/bin/sh
# Real drives of three sensors, localized in maps of their own other scans, or of the way out.
# Usage: share/experiments/real-drives.sh DATA_DIR OUT [--kilometre SCANS] [--odometry SCALE,YAW] [SECTION.KEY=VALUE...]
#   DATA_DIR    folder with kitti_raw_0005/, vlp16_loop/ and nuscenes_scene/
#   OUT         gets maps, trajectories, result.json and table.txt
#   --kilometre  the scans of DATA_DIR/kitti_odom_00_km as a folder (228 of Jichao-Peng/multi-sensor_fusion_learning).
#               Then this drive alone, odd scans in the map of the even ones: with odometry as in the other
#               drives, and with that of laser_odometry.txt ("kilometre-laser"); and the paper's method
#   --odometry  errors of the odometry that stay: a share of the distance, and degrees per metre
#   SECTION.KEY=VALUE  settings, for all drives
# kitti_raw_0005 and nuscenes_scene: map of the even scans, localized on the odd ones. vlp16_loop: map of
# the turns 0 to 175 (way out), localized on 176 to 203, which come back in the opposite direction.
# Odometry is the true motion with 2 % noise (seed 7) and the errors given; 1000 particles, filter seeds 1 to 5, start within
# 2.5 m and 5 degrees. "raw": detections as they were measured; "deskewed": corrected for the motion of
# the vehicle while the LiDAR turned. "ok" is the share of the scans with this health, "mean ok" and "worst
# ok" the errors of them, over all seeds. NEES (3 where covariances are right) and
# coverage of the 95 % ellipses are those of the poses that are ok, with the standard deviations of the true
# poses (README of the data; for nuScenes plane_adjustment.py) added; "alone" is without these. "nuscenes-planes": the poses of this drive adjusted by the planes
# in its scans (plane_adjustment.py), in which no point of a pole takes part. pole_radii.py OUT then compares
# the radii of the poles with those on the map.
# Programs: build/bin, or POLEMCL_BIN. Needs jq and python3-scipy; three minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 any "$@"
data=$(cd "$1" && pwd)
make_out "$2"
shift 2
common="" truth="" errors=0,0 kilometre=""
if [ "${1-}" = --kilometre ]; then
  [ $# -ge 2 ] || usage
  kilometre=$(cd "$2" && pwd)
  shift 2
fi
if [ "${1-}" = --odometry ]; then
  [ $# -ge 2 ] || usage
  errors=$2
  shift 2
fi
for assignment in "$@"; do common="$common --set $assignment"; done
find_programs pole-import pole-map pole-localize pole-eval
find_tools jq
find_modules scipy

# part FOLDER FIRST LAST: the scans FIRST to LAST (from 0) as a folder of their own, with the poses of the
# drive, or of the file $truth.
part() {
  link_scans "$1" "$out/part" $(($2 + 1)) $(($3 + 1))
  [ -z "$truth" ] || grep -v '^#' "$truth" | sed -n "$(($2 + 1)),$(($3 + 1))p" >"$out/part/poses.txt"
}

# import DRIVE NAME FIRST LAST EVERY OFFSET: $here/NAME.rawlog and $here/NAME.tum, with $turn. Odometry is
# the TUM file $motions, or the true motion with noise.
import() {
  part "$1" "$3" "$4"
  odometry="--odometry-noise 0.02 --seed 7 --odometry-scale ${errors%,*} --odometry-yaw-deg-m ${errors#*,}"
  if [ -n "$motions" ]; then
    odometry="--odometry $motions"
  fi
  # shellcheck disable=SC2086 # several words
  "$bin/pole-import" folder --quiet --embed --input "$out/part" --output "$here/$2.rawlog" \
    --every "$5" --offset "$6" --sensor-pose "$mounting" $turn $odometry
  rm -r "$out/part"
}

# while_ok RUNS: share of the scans that are ok, their mean and greatest errors, m and degrees.
while_ok() {
  for run in "$1"/run_[0-9]*_health.csv; do
    awk -F , 'NR == FNR { ok[$1] = $3 == "ok"; next }
      FNR > 1 { print ok[$1], $3, $6 < 0 ? -$6 : $6 }' "$run" "${run%_health.csv}_errors.csv"
  done | awk '$1 { n++; m += $2; d += $3; if ($2 > far) far = $2; if ($3 > turned) turned = $3 }
    END { if (!n) { print "{\"ok\": 0}"; exit }
      printf "{\"ok\": %.4f, \"mean_ok_m\": %.4f, \"mean_ok_deg\": %.4f, ", n / NR, m / n, d / n
      printf "\"worst_ok_m\": %.4f, \"worst_ok_deg\": %.4f}", far, turned }'
}

# score_consistency NAME SIGMAS: $here/NAME.json, with these standard deviations of the true poses, m and degrees.
score_consistency() {
  "$bin/pole-eval" consistency --quiet --truth "$here/scans.tum" --cov "$here"/runs/run_*_cov.csv \
    --health "$here"/runs/run_*_health.csv --skip-metres 0 --truth-sigma-m "${2%,*}" \
    --truth-sigma-deg "${2#*,}" --json "$here/$1.json" ||
    echo '{}' >"$here/$1.json" # no pose was ok
}

# drive NAME DRIVE CONFIG TURN "MAP SCANS" "SCANS": map and localization, scans as FIRST LAST EVERY OFFSET.
# Uses $mounting and $settings. Adds a line to $out/results.
drive() {
  here=$out/$1
  turn=$4
  mkdir -p "$here"
  # shellcheck disable=SC2086 # several words
  import "$2" map $5
  # shellcheck disable=SC2086
  import "$2" scans $6
  # shellcheck disable=SC2086
  "$bin/pole-map" build --quiet --config "$3" $settings $common --input "$here/map.rawlog" \
    --truth "$here/map.tum" --output "$here/map.polemap" --csv "$here/map.csv"
  # shellcheck disable=SC2086
  "$bin/pole-localize" --quiet --config "$3" $settings $common --input "$here/scans.rawlog" \
    --map "$here/map.polemap" --truth "$here/scans.tum" --output "$here/runs" --particles 1000 \
    --runs 5 --seed 1
  # shellcheck disable=SC2086
  "$bin/pole-extract" --quiet --config "$3" $settings --input "$here/scans.rawlog" \
    --output "$here/scans_poles.rawlog" --csv "$here/scans.csv"
  evaluate_runs "$here/runs" "$here/scans.tum"
  while_ok "$here/runs" >"$here/ok.json"
  score_consistency consistency "$sigmas"
  score_consistency alone 0,0
  jq -s --arg name "$1" --slurpfile ok "$here/ok.json" \
    --slurpfile fit "$here/consistency.json" --slurpfile alone "$here/alone.json" --argjson poles "$(($(wc -l <"$here/map.csv") - 1))" \
    '{drive: $name, map_poles: $poles, pos_mean: (map(.pos_mean) | add / length),
      pos_least: (map(.pos_mean) | min), pos_most: (map(.pos_mean) | max),
      ang_mean_deg: (map(.ang_mean_deg) | add / length), pos_max: (map(.pos_max) | max)} + $ok[0] +
      ($fit[0] | {nees_mean, coverage_95, truth_sigma_m, truth_sigma_deg}) +
      ($alone[0] | {nees_alone: .nees_mean, coverage_95_alone: .coverage_95})' \
    "$here"/runs/run_0?.json >>"$out/results"
  rm "$here"/*.rawlog
}

# adjust_by_planes DRIVE CONFIG: poses by planes as $truth, $out/planes/poses.txt; how far a pole moves
# between two scans with the published and with these poses, $out/planes/spread.txt.
adjust_by_planes() {
  here=$out/planes
  turn="--turn compensated"
  mkdir -p "$here"
  import "$1" published 0 100000 1 0
  # shellcheck disable=SC2086 # several words
  "$bin/pole-extract" --quiet --config "$2" $settings --input "$here/published.rawlog" \
    --output "$here/poles.rawlog" --csv "$here/poles.csv"
  /usr/bin/python3 "$top/share/experiments/plane_adjustment.py" "$1" "$here/poles.csv" \
    "$here/poses.txt" >"$here/adjustment.txt"
  truth=$here/poses.txt
  import "$1" planes 0 100000 1 0
  for poses in published planes; do
    printf '%s: ' "$poses"
    "$bin/pole-extract" --inspect "$here/$poses.rawlog" --truth "$here/$poses.tum" |
      sed -n 's/^significance *//p'
  done >"$here/spread.txt"
  rm "$here"/*.rawlog
}

# both NAME DRIVE CONFIG TURN "MAP SCANS" "SCANS": as measured, and corrected.
both() {
  drive "$1-raw" "$2" "$3" "--turn compensated" "$5" "$6"
  drive "$1-deskewed" "$2" "$3" "$4" "$5" "$6"
}

# The three short drives.
short_drives() {
  mounting="0 0 0 0 0 0" settings="" sigmas=0.01,0.03
  both kitti_raw_0005 "$data/kitti_raw_0005" "$top/config/kitti.ini" "$clockwise" "0 79 2 0" "0 79 2 1"
  mounting="0 0 0 0 2.513 0.028" settings="--set sensor.height_m=1.77" sigmas=0.015,0.03
  both vlp16_loop "$data/vlp16_loop" "$top/config/vlp16.ini" "$clockwise" "0 175 1 0" "176 203 1 0"
  mounting="0 0 0 0 0 0" settings="--set sensor.height_m=1.84 --set sensor.min_range_m=2.5" sigmas=0.08,0.23
  # Its scans are compensated: pole-extract --inspect finds no timing that fits better.
  drive nuscenes "$data/nuscenes_scene" "$top/config/hdl32e.ini" "--turn compensated" "0 38 2 0" "0 38 2 1"
  adjust_by_planes "$data/nuscenes_scene" "$top/config/hdl32e.ini"
  sigmas=0.01,0.03
  drive nuscenes-planes "$data/nuscenes_scene" "$top/config/hdl32e.ini" "--turn compensated" "0 38 2 0" "0 38 2 1"
}

# Ours, and paper mode: as it is, and with its height test corrected, with least counts 1 to 3, without and with
# correction for motion.
half_kilometre() {
  mounting="0 0 0 0 0 0" settings="" sigmas=0.01,0.03
  drive kilometre "$kilometre" "$top/config/kitti.ini" "$clockwise" "0 227 2 0" "0 227 2 1"
  drive kilometre-paper "$kilometre" "$top/config/paper/kitti.ini" "$clockwise" "0 227 2 0" "0 227 2 1"
  for count in 1 2 3; do
    for kind in compensated auto; do
      settings="--set map.min_count=$count --set sensor.turn=$kind"
      drive "kilometre-paper-mended-$count-$kind" "$kilometre" "$top/config/paper/kitti-mended.ini" "$clockwise" \
        "0 227 2 0" "0 227 2 1"
    done
  done
  settings=""
  motions=$out/laser.tum
  /usr/bin/python3 "$top/share/experiments/planar_odometry.py" "$data/kitti_odom_00_km/laser_odometry.txt" \
    "$kilometre/times.txt" "$motions"
  drive kilometre-laser "$kilometre" "$top/config/kitti.ini" "$clockwise" "0 227 2 0" "0 227 2 1"
}

motions=""
if [ -n "$kilometre" ]; then half_kilometre; else short_drives; fi

collect_results .
table "$out/result.json" '.[] | [.drive, .map_poles, .pos_mean, .pos_least, .pos_most, .ang_mean_deg, .pos_max, .ok,
  .mean_ok_m, .mean_ok_deg, .worst_ok_m, .worst_ok_deg, .nees_mean, .coverage_95, .nees_alone, .coverage_95_alone]' \
  drive "map poles" "mean m:4" "least:4" "to most:4" "mean deg:4" "worst m:4" ok:2 "mean ok m:4" "mean ok deg:4" \
  "worst ok m:4" "worst ok deg:4" NEES:2 coverage:3 "NEES alone:2" "coverage:3" | tee "$out/table.txt"
