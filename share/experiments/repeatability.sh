#!/bin/sh
# How often poles of a scan are found again in the next scans, by the distance to which poles are looked for.
# Usage: share/experiments/repeatability.sh DATA_DIR OUT
#   DATA_DIR  folder with kitti_raw_0005/
#   OUT       gets result.json and table.txt
# Scans 40 to 79 of the drive, which took no part in the fit of the pole classifier, corrected for motion;
# config/kitti.ini with [scan_line] max_range_m and min_confidence as named. A pole is found again if 3 of the next 5
# scans have one within the tolerance of pole-eval repeatability.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; half a minute.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 2 "$@"
find_programs pole-import pole-extract pole-eval
find_tools jq
make_out "$2"

link_scans "$1/kitti_raw_0005" "$out/part" 41 80
# shellcheck disable=SC2086 # several words
"$bin/pole-import" folder --quiet --input "$out/part" --output "$out/scans.rawlog" $clockwise
for range in 20 30 40 50; do
  for confidence in 0.5 0.6 0.7; do
    "$bin/pole-extract" --quiet --config "$top/config/kitti.ini" --set scan_line.max_range_m=$range \
      --set scan_line.min_confidence=$confidence --input "$out/scans.rawlog" --output "$out/poles.rawlog"
    "$bin/pole-eval" repeatability --quiet --poles "$out/poles.rawlog" --truth "$out/scans.tum" \
      --json "$out/again.json" >/dev/null
    jq --argjson range $range --argjson confidence $confidence \
      '{max_range_m: $range, min_confidence: $confidence, poles_per_scan: .per_scan, share, build}' "$out/again.json" \
      >>"$out/results"
  done
done
rm -r "$out/part" "$out"/*.rawlog "$out/again.json"
collect_results .
table "$out/result.json" '.[] | [.max_range_m, .min_confidence, .poles_per_scan, .share]' \
  "max range m" "min confidence" "poles per scan:1" "found again:3" | tee "$out/table.txt"
