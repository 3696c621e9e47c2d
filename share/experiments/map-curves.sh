#!/bin/sh
# Precision and recall of maps of the real kilometre as thresholds change, ours and the paper's method.
# Usage: share/experiments/map-curves.sh DATA_DIR KILOMETRE OUT
#   DATA_DIR   has kitti_odom_00_km/ with truth_20m.csv and truth_40m.csv
#   KILOMETRE  its scans as a folder (real-drives.sh)
#   OUT        gets result.json and table.txt
# Maps of all scans from true poses, both methods corrected for motion. Ours (config/kitti.ini): [map]
# min_confidence and min_count; the paper's method (config/paper/kitti-mended.ini and kitti.ini): min_count. One to
# one within 1 m: precision against the labels within 40 m of the path, recall of those within 20 m. F1 is that of
# these two. The best thresholds are chosen on these labels, for each method alike.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; one minute.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

kilometre_arguments "$@"
find_programs pole-import pole-extract pole-map pole-eval
find_tools jq

# score METHOD CONFIG [SECTION.KEY=VALUE...]: a map; adds a line to $out/results.
score() {
  method=$1 config=$2
  shift 2
  thresholds=$*
  for assignment in "$@"; do
    set -- "$@" --set "$assignment"
    shift
  done
  "$bin/pole-map" build --quiet --config "$config" --set sensor.turn=auto "$@" --input "$out/$method.rawlog" \
    --truth "$out/scans.tum" --output "$out/map.polemap" 2>/dev/null
  score_near 1 "$labels/truth_40m.csv" "$labels/truth_20m.csv" "$out/map.polemap" |
    jq --arg method "$method" --arg thresholds "$thresholds" '{method: $method, thresholds: $thresholds} + .' \
      >>"$out/results"
}

# extract METHOD CONFIG [OPTION...]
extract() {
  method=$1 config=$2
  shift 2
  "$bin/pole-extract" --quiet --config "$config" --set sensor.turn=auto "$@" --input "$out/scans.rawlog" \
    --output "$out/$method.rawlog"
}

# shellcheck disable=SC2086 # several words
"$bin/pole-import" folder --quiet --input "$kilometre" --output "$out/scans.rawlog" $clockwise
extract ours "$top/config/kitti.ini" --set scan_line.min_confidence=0.3
for confidence in 0.3 0.5 0.65 0.8 0.9; do
  for count in 1.5 2 3 4 6 8; do
    score ours "$top/config/kitti.ini" map.min_confidence=$confidence map.min_count=$count
  done
done
for name in kitti kitti-mended; do
  extract paper-$name "$top/config/paper/$name.ini"
  for count in 1 2 3 4 5 6 7 8 9 10 12; do score paper-$name "$top/config/paper/$name.ini" map.min_count=$count; done
done
rm "$out"/*.rawlog
collect_results .
table "$out/result.json" '(group_by(.method) | map(max_by(.f1))) +
  map(select(.thresholds == "map.min_confidence=0.65 map.min_count=3" or .thresholds == "map.min_count=1"))
  | .[] | [.method, .thresholds, .precision, .recall, .f1]' \
  method thresholds precision:3 recall:3 F1:3 | tee "$out/table.txt"
