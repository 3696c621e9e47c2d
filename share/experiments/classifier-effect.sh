#!/bin/sh
# What the shipped weights of the method scan_line do to maps and poses of drives that they were not fitted to.
# Usage: share/experiments/classifier-effect.sh DATA_DIR OUT [KILOMETRE]
#   DATA_DIR   folder with kitti_raw_0005/, kitti_odom_00_long/ and kitti_odom_00_km/
#   OUT        gets result.json and table.txt; simulated scans in OUT/scans are used again
#   KILOMETRE  the scans of kitti_odom_00_km as a folder (228 of Jichao-Peng/multi-sensor_fusion_learning)
# Simulated worlds 501 and 511 ([realism] scale = 1) of four LiDARs, 120 m, a scan a metre; the scans 40 to 79 of
# kitti_raw_0005; the kilometre: map of the even scans, localized on the odd ones, odometry with 2 % noise,
# 5 runs of 1000 particles. Maps hold all scans; one to one with the true poles, within 0.5 m in simulated worlds
# and 1 m in real ones. Recall in real drives counts the labelled poles within 20 m of the path.
# To compare two sets of weights, run it with the programs of two builds.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; 10 minutes on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=share/experiments/extraction-parts.sh
. "$top/share/experiments/extraction-parts.sh"

check_arguments 2 3 "$@"
data=$(cd "$1" && pwd)
make_out "$2"
kilometre=${3-}
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
find_tools jq
work=$out/work
rm -rf "$work"
mkdir -p "$out/scans" "$work"

# import NAME FOLDER OPTION...: $work/NAME.rawlog of poles, NAME.tum, NAME.ini, which is $config.
import() {
  name=$1
  folder=$2
  shift 2
  cp "$config" "$work/$name.ini"
  find_poles "$folder" "$work/$name" "$config" --odometry-noise 0.02 --seed 7 "$@"
}

# map_scores RADIUS WHOLE NEAR: precision by the poles WHOLE, recall by the poles NEAR, as JSON.
map_scores() {
  map_drive "$work/all" "$work/all.polemap"
  score_near "$1" "$2" "$3" "$work/all.polemap" | jq '{map: .}'
}

# poses FOLDER OPTION...: errors of the odd scans in the map of the even ones, as JSON.
poses() {
  folder=$1
  shift
  import even "$folder" --every 2 --offset 0 "$@"
  import odd "$folder" --every 2 --offset 1 "$@"
  map_drive "$work/even" "$work/even.polemap"
  rm -rf "$work/runs"
  localize_drive "$work/odd" "$work/even.polemap" "$work/runs" --particles 1000 --runs 5 --seed 1
  evaluate_runs "$work/runs" "$work/odd.tum"
  jq '{poses: (.mean | {pos_mean, lat_mean, lon_mean, ang_mean_deg, pos_max})}' "$work/runs/errors.json"
}

# simulated SENSOR SEED SCALE: SENSOR-SEED.json.
simulated() {
  config=$(scan_line_settings "$1")
  scans=$out/scans/$1-$2
  [ -d "$scans" ] || {
    "$bin/pole-simulate" --quiet --config "$config" --output "$scans.part" --seed "$2" --length 120 \
      --set simulation.spacing_m=1 --set realism.scale="$3"
    mv "$scans.part" "$scans"
  }
  import all "$scans"
  "$bin/pole-eval" detections --quiet --scans "$scans" --poles "$work/all.rawlog" \
    --json "$work/detections.json" --visible "$work/visible.csv" --min-scans 3 >/dev/null
  {
    map_scores 0.5 "$scans/poles_gt.csv" "$work/visible.csv"
    jq '{detections: {precision, recall, nees_mean, nees_median}}' "$work/detections.json"
    poses "$scans"
  } | jq -s --arg drive "$1-$2" '{drive: $drive} + add' >"$out/$1-$2.json"
}

# real NAME FOLDER WHOLE NEAR: NAME.json. Without true poles (WHOLE), poses only.
real() {
  config=$top/config/kitti.ini
  {
    if [ -n "$3" ]; then
      # shellcheck disable=SC2086 # several words
      import all "$2" $turning
      map_scores 1 "$3" "$4"
    fi
    # shellcheck disable=SC2086
    [ "$1" = kitti_odom_00_long ] || poses "$2" $turning
  } | jq -s --arg drive "$1" '{drive: $drive} + add' >"$out/$1.json"
}

for sensor in hdl64e hdl32e os1_64 vlp16; do
  simulated $sensor 501 0
  simulated $sensor 511 1
done

second=$work/second
link_scans "$data/kitti_raw_0005" "$second" 41 80
turning=$clockwise
real kitti_raw_0005-second "$second" "" ""
turning=
real kitti_odom_00_long "$data/kitti_odom_00_long" "$data/published/kitti_truth_00.npz" \
  "$data/kitti_odom_00_long/truth_20m.csv"
if [ -n "$kilometre" ]; then
  turning=$clockwise
  real kilometre "$kilometre" "$data/kitti_odom_00_km/truth_40m.csv" "$data/kitti_odom_00_km/truth_20m.csv"
fi
rm -r "$work"

jq -s . "$out"/*-[0-9]*.json "$out"/k*.json >"$out/result.json"
table "$out/result.json" '.[] | [.drive, .map.precision, .map.recall, .map.f1, .detections.nees_median, .poses.pos_mean,
  .poses.ang_mean_deg, .poses.pos_max]' drive precision:4 recall:4 F1:4 "median NEES:4" "mean m:4" "mean deg:4" \
  "worst m:4" | tee "$out/table.txt"
