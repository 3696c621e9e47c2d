#!/bin/sh
# Poles from one accumulated cloud of the real kilometre, seen by a virtual LiDAR along the path.
# Usage: share/experiments/accumulated-cloud.sh DATA_DIR KILOMETRE OUT
#   DATA_DIR   has kitti_odom_00_km/ with truth_20m.csv and truth_40m.csv
#   KILOMETRE  its scans as a folder (real-drives.sh)
#   OUT        gets result.json
# Maps at several thresholds. One to one within 1 m: precision against the labels within 40 m of the path, recall of
# those within 20 m.
# Programs: build/bin, or POLEMCL_BIN. Needs jq, Python with NumPy; some minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

kilometre_arguments "$@"
find_programs pole-import pole-extract pole-map pole-eval
find_tools jq

/usr/bin/python3 "$top/share/experiments/virtual_scans.py" "$kilometre" "$out/views"
settings=$out/views/settings.ini
"$bin/pole-import" folder --quiet --input "$out/views" --output "$out/scans.rawlog" --turn compensated
"$bin/pole-extract" --quiet --config "$settings" --set scan_line.min_confidence=0.3 --input "$out/scans.rawlog" \
  --output "$out/poles.rawlog"
for confidence in 0.3 0.5 0.65; do
  "$bin/pole-map" build --quiet --config "$settings" --set map.min_confidence=$confidence --input "$out/poles.rawlog" \
    --truth "$out/scans.tum" --output "$out/map.polemap" 2>/dev/null
  score_near 1 "$labels/truth_40m.csv" "$labels/truth_20m.csv" "$out/map.polemap" |
    jq --argjson confidence $confidence '{min_confidence: $confidence, precision, recall}'
done | jq -s . >"$out/result.json"
rm -r "$out/views" "$out"/*.rawlog
cat "$out/result.json"
