#!/bin/sh
# Fits the confidence and the covariance of the method scan_line: trees.csv, rough_trees.csv and covariance.csv
# in libpolemcl/src/core/extraction/, which the next build compiles in.
# Usage: share/experiments/train-classifier.sh [--quick] DATA_DIR OUT
#   DATA_DIR  folder of the real drives kitti_raw_0005/ (scans 0 to 39), vlp16_loop/ and nuscenes_scene/.
#             Nothing else is read: kitti_odom_00*/ and published/ are for tests only.
#   OUT       gets these tables, scores.json and the tables of features; existing tables of features are used
#             again
#   --quick   two worlds, without real drives: a test of the script
# Fitted to worlds 101 to 110 and 121 to 150 without, 111 to 120 and 151 to 180 with [realism] scale = 1, 17 scans 10 m apart with each
# of HDL-64E, HDL-32E, OS1-64, VLP-16, labelled by the true poles; and to the real drives, labelled by what all
# their scans together show (pole-eval features). Scored on worlds 401 to 403, 601 to 603, 411 to 413 and 611 to 613, alike, on the scans
# 40 to 79 of kitti_raw_0005, and on each real drive by weights fitted to the others.
# To take a result over: cp OUT/trees.csv OUT/rough_trees.csv OUT/covariance.csv libpolemcl/src/core/extraction/
# Programs: build/bin, or POLEMCL_BIN. Needs python3-sklearn and 10 minutes on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=share/experiments/extraction-parts.sh
. "$top/share/experiments/extraction-parts.sh"

quick=no
[ "${1-}" != --quick ] || {
  quick=yes
  shift
}
check_arguments 2 2 "$@"
data=$1
find_programs pole-simulate pole-eval
find_modules sklearn
make_out "$2"

# The shipped weights were fitted before kitti.ini corrected ranges.
ranges="--set sensor.range_offset_m=0 --set sensor.range_scale=1"

# simulated SENSOR SEED SCALE: the table SENSOR-SEED.csv.
simulated() {
  [ ! -f "$out/$1-$2.csv" ] || return 0
  rm -rf "$out/scans"
  # shellcheck disable=SC2086 # several words
  "$bin/pole-simulate" --quiet --config "$(scan_line_settings "$1")" $ranges --output "$out/scans" --seed "$2" \
    --length 162 --set simulation.spacing_m=10 --set realism.scale="$3"
  # shellcheck disable=SC2086
  "$bin/pole-eval" features --quiet --config "$(scan_line_settings "$1")" $ranges --scans "$out/scans" \
    --poles "$out/scans/poles_gt.csv" --output "$out/$1-$2.csv"
  rm -r "$out/scans"
}

# worlds SCALE SEED...: all sensors.
worlds() {
  scale=$1
  shift
  for seed in "$@"; do
    for sensor in hdl64e hdl32e os1_64 vlp16; do simulated $sensor "$seed" "$scale"; done
  done
}

# real NAME FOLDER CONFIG OPTION...: the table NAME.csv.
real() {
  name=$1
  folder=$2
  config=$3
  shift 3
  # shellcheck disable=SC2086
  [ -f "$out/$name.csv" ] || "$bin/pole-eval" features --quiet --config "$top/config/$config.ini" $ranges \
    --scans "$folder" --output "$out/$name.csv" "$@"
}

# half NAME FIRST LAST: the table of these scans of kitti_raw_0005.
half() {
  link_scans "$data/kitti_raw_0005" "$out/part" "$2" "$3"
  # shellcheck disable=SC2086 # several words
  real "$1" "$out/part" kitti $turning
  rm -r "$out/part"
}

# tables SEED...: those of these worlds.
tables() {
  for seed in "$@"; do
    for sensor in hdl64e hdl32e os1_64 vlp16; do echo "$out/$sensor-$seed.csv"; done
  done
}

fit="$(seq 101 110) $(seq 121 150)" fit_realism="$(seq 111 120) $(seq 151 180)" test="401 402 403 601 602 603" test_realism="411 412 413 611 612 613"
drives="kitti_raw_0005-first vlp16_loop nuscenes_scene" test_drives=$out/kitti_raw_0005-second.csv
[ "$quick" = no ] || fit=101 fit_realism=111 test=401 test_realism="" drives="" test_drives=""
# shellcheck disable=SC2086 # several words
worlds 0 $fit $test
# shellcheck disable=SC2086
worlds 1 $fit_realism $test_realism

if [ "$quick" = no ]; then
  # These LiDARs turn clockwise, begin at the back, and are stamped when they face forward.
  turning="--set sensor.turn=clockwise --set sensor.cut_deg=180 --set sensor.stamp_turn=0.5"
  half kitti_raw_0005-first 1 40
  half kitti_raw_0005-second 41 80
  # shellcheck disable=SC2086
  real vlp16_loop "$data/vlp16_loop" vlp16 --sensor-pose "0 0 0 0 2.513 0.028" --set sensor.height_m=1.77 $turning
  real nuscenes_scene "$data/nuscenes_scene" hdl32e --set sensor.height_m=1.84 --set sensor.min_range_m=2.5
fi

# shellcheck disable=SC2086,SC2046
/usr/bin/python3 "$top/share/experiments/fit_classifier.py" $(tables $fit $fit_realism) \
  $(for drive in $drives; do echo "$out/$drive.csv"; done) --test $(tables $test $test_realism) $test_drives \
  --output "$out" --json "$out/scores.json"
