#!/bin/sh
# Fits the confidence and the covariance of the method scan_line: libpolemcl/src/core/extraction/classifier.csv
# and covariance.csv, which the next build compiles in.
# Usage: share/experiments/train-classifier.sh [--quick] DATA_DIR OUT
#   DATA_DIR  folder of real drives: kitti_raw_0005/, vlp16_loop/, nuscenes_scene/; missing ones are left
#             out. Nothing else is read: kitti_odom_00*/ and published/ are for tests only.
#   OUT       gets classifier.csv, covariance.csv, report.json (scores of each drive by weights fitted to the
#             others, and of the test worlds) and the tables of candidates; existing tables are used again
#   --quick   one world a kind: a test of the script
# Fitted to worlds 101 to 106 without and 111 to 116 with [realism] scale = 1, 17 scans 10 m apart with each
# of HDL-64E, HDL-32E, OS1-64, VLP-16, labelled by the true poles; and to the real drives, labelled by what all
# their scans together show (pole-eval candidates). Tested on worlds 301 to 303 and 311 to 313, alike.
# To take a result over: cp OUT/classifier.csv OUT/covariance.csv libpolemcl/src/core/extraction/
# Programs: build/bin, or POLEMCL_BIN. Needs 15 minutes on 2 cores.
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
out=$2
find_programs pole-simulate pole-eval
mkdir -p "$out"

# simulated SENSOR SEED SCALE: the table SENSOR-SEED.csv.
simulated() {
  [ ! -f "$out/$1-$2.csv" ] || return 0
  rm -rf "$out/scans"
  "$bin/pole-simulate" --quiet --config "$(scan_line_settings "$1")" --output "$out/scans" --seed "$2" \
    --length 162 --set simulation.spacing_m=10 --set realism.scale="$3"
  "$bin/pole-eval" candidates --quiet --config "$(scan_line_settings "$1")" --scans "$out/scans" \
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

# real DRIVE CONFIG OPTION...: the table DRIVE.csv, when the drive is there.
real() {
  drive=$1
  config=$2
  shift 2
  [ -d "$data/$drive" ] && [ ! -f "$out/$drive.csv" ] || return 0
  echo "$drive:"
  "$bin/pole-eval" candidates --config "$top/config/$config.ini" --scans "$data/$drive" \
    --output "$out/$drive.csv" "$@"
}

# tables SEED...: those of these worlds.
tables() {
  for seed in "$@"; do
    for sensor in hdl64e hdl32e os1_64 vlp16; do echo "$out/$sensor-$seed.csv"; done
  done
}

fit="101 102 103 104 105 106" fit_real="111 112 113 114 115 116" test="301 302 303" test_real="311 312 313"
[ "$quick" = no ] || fit=101 fit_real=111 test=301 test_real=311
# shellcheck disable=SC2086 # several words
worlds 0 $fit $test
# shellcheck disable=SC2086
worlds 1 $fit_real $test_real

# These LiDARs turn clockwise, begin at the back, and are stamped when they face forward.
turning="--set sensor.turn=clockwise --set sensor.cut_deg=180 --set sensor.stamp_turn=0.5"
# shellcheck disable=SC2086
real kitti_raw_0005 kitti $turning
# shellcheck disable=SC2086
real vlp16_loop vlp16 --sensor-pose "0 0 0 0 2.513 0.028" --set sensor.height_m=1.77 $turning
real nuscenes_scene hdl32e --set sensor.height_m=1.84 --set sensor.min_range_m=2.5

drives=
for drive in kitti_raw_0005 vlp16_loop nuscenes_scene; do
  [ ! -f "$out/$drive.csv" ] || drives="$drives $out/$drive.csv"
done
# shellcheck disable=SC2086,SC2046
"$bin/pole-eval" train --candidates $(tables $fit $fit_real) $drives --test $(tables $test $test_real) \
  --classifier "$out/classifier.csv" --covariance "$out/covariance.csv" --json "$out/report.json" |
  tee "$out/table.txt"
