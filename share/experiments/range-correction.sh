#!/bin/sh
# What correcting the ranges of KITTI's LiDAR is worth: the real drives of real-drives.sh with and without
# range_offset_m and range_scale of config/kitti.ini, and the values that pole-extract --inspect finds on each.
# Usage: share/experiments/range-correction.sh DATA_DIR KILOMETRE OUT
#   DATA_DIR   as for real-drives.sh
#   KILOMETRE  the scans of DATA_DIR/kitti_odom_00_km as a folder
#   OUT        gets result.json
# Programs: build/bin, or POLEMCL_BIN. Needs jq and python3-scipy; three minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 3 3 "$@"
data=$(cd "$1" && pwd)
kilometre=$(cd "$2" && pwd)
make_out "$3"
find_programs pole-import pole-extract
find_tools jq

# found NAME FOLDER: offset and scale that fit a drive and its true poses.
found() {
  # shellcheck disable=SC2086 # several words
  "$bin/pole-import" folder --quiet --embed --input "$2" --output "$out/all.rawlog" $clockwise
  "$bin/pole-extract" --inspect "$out/all.rawlog" --truth "$out/all.tum" --write-config "$out/$1.ini" >"$out/$1.txt"
  sed -n 's/^range_offset_m *= *\([-0-9.]*\).*/offset_m \1/p; s/^range_scale *= *\([0-9.]*\).*/scale \1/p' \
    "$out/$1.ini" | jq -R 'split(" ") | {(.[0]): (.[1] | tonumber)}' |
    jq -s --arg drive "$1" '{drive: $drive} + add'
  rm "$out"/all.*
}

# localized WITH ASSIGNMENT...: the drives of an HDL-64E.
localized() {
  with=$1
  shift
  "$top/share/experiments/real-drives.sh" "$data" "$out/short" "$@" >/dev/null
  "$top/share/experiments/real-drives.sh" "$data" "$out/long" --kilometre "$kilometre" "$@" >/dev/null
  jq -s --argjson with "$with" 'add | map(select(.drive | test("kitti|kilometre")) | {drive, corrected: $with,
    pos_mean, ang_mean_deg, pos_max, nees_mean, coverage_95}) | .[]' "$out/short/result.json" "$out/long/result.json"
}

{
  found kitti_raw_0005 "$data/kitti_raw_0005"
  found kilometre "$kilometre"
} | jq -s . >"$out/found.json"
{
  localized false sensor.range_offset_m=0 sensor.range_scale=1
  localized true
} | jq -s . >"$out/localized.json"
jq -n --slurpfile found "$out/found.json" --slurpfile localized "$out/localized.json" \
  '{found: $found[0], localized: $localized[0]}' >"$out/result.json"
cat "$out/result.json"
