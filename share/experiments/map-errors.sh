#!/bin/sh
# Why the map of the real kilometre misses labelled poles, and what no judge of its candidates could gain.
# Usage: share/experiments/map-errors.sh DATA_DIR KILOMETRE OUT
#   DATA_DIR   has kitti_odom_00_km/ with truth_20m.csv and truth_40m.csv
#   KILOMETRE  its scans as a folder (real-drives.sh)
#   OUT        gets missed.csv, false.csv and ceiling.csv
# Map of all scans from true poses, config/kitti.ini. Detections are those down to confidence 0. ceiling.csv: labels
# within 20 m that have a candidate of the map within 1 m, one to one, when each candidate is one that counts and
# no other is wrong: the recall of a perfect judge, by the least confidence of a detection. What stands at each
# label is told by share/reports/kilometre-judged.csv. map-errors.py tells the columns.
# Programs: build/bin, or POLEMCL_BIN. Needs python3-numpy; half a minute.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

kilometre_arguments "$@"
find_programs pole-import pole-extract pole-map
find_modules numpy
config=$top/config/kitti.ini

# build NAME [OPTION...]: NAME.csv.
build() {
  name=$1
  shift
  "$bin/pole-map" build --quiet --config "$config" --set sensor.turn=auto "$@" --input "$out/poles.rawlog" \
    --truth "$out/scans.tum" --output "$out/$name.polemap" --csv "$out/$name.csv" 2>/dev/null
}

# shellcheck disable=SC2086 # several words
"$bin/pole-import" folder --quiet --input "$kilometre" --output "$out/scans.rawlog" $clockwise
"$bin/pole-extract" --quiet --config "$config" --set sensor.turn=auto --set scan_line.min_confidence=0 \
  --input "$out/scans.rawlog" --output "$out/poles.rawlog" --csv "$out/poles.csv"
build map
for confidence in 0.001 0.05 0.15 0.3 0.5 0.65; do
  build candidates-$confidence --set map.min_confidence=$confidence --set map.min_count=0.01 --set map.min_share=0
done
/usr/bin/python3 "$top/share/experiments/map-errors.py" "$labels" "$top/share/reports/kilometre-judged.csv" "$out"
rm "$out"/*.rawlog "$out"/*.polemap
cat "$out/ceiling.csv"
