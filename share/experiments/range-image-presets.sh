#!/bin/sh
# Poles that the paper's method finds on simulated streets of each LiDAR: with the settings of config/paper/kitti.ini
# and the geometry of its image set by hand (rows, field of view; heights counted from the ground, 1.73 m more), and with no more than
# `[extraction] method = range_image`, where the image follows `[sensor]`. A scan each 2 m, each turn standing still.
# Usage: share/experiments/range-image-presets.sh OUT FIRST COUNT LENGTH
#   OUT     gets result.json and table.txt
#   FIRST   number of the first world, COUNT of them, LENGTH m each
# Programs: build/bin, or POLEMCL_BIN. Needs jq.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 4 4 "$@"
make_out "$1"
first=$2
count=$3
length=$4
find_tools jq
find_programs pole-simulate pole-import pole-extract pole-eval
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# extracted NAME: extracts the scans with the settings NAME.ini, and adds their score to NAME.scores.
extracted() {
  "$bin/pole-extract" --quiet --config "$work/$1.ini" --input "$work/scans.rawlog" --output "$work/poles.rawlog"
  "$bin/pole-eval" detections --quiet --scans "$work/scans" --poles "$work/poles.rawlog" --json "$work/score.json" \
    >/dev/null
  jq -c . "$work/score.json" >>"$work/$1.scores"
}

# Rows and field of view by the data sheets; half a gap beyond the outer rings, as for KITTI.
while read -r lidar height rows up down; do
  rm -f "$work"/*.scores
  copy_settings "$top/config/paper/kitti.ini" "$work/hand.ini" "sensor.model=$lidar" "sensor.height_m=$height" \
    "range_image.rows=$rows" "range_image.fov_up_deg=$up" "range_image.fov_down_deg=$down" \
    range_image.heights_above_ground=true range_image.min_z_m=0.43 range_image.max_z_m=7.73 \
    range_image.max_bottom_m=3.23 range_image.min_top_m=2.43 range_image.fit_max_z_m=4.73
  printf '[sensor]\nmodel = %s\nheight_m = %s\n[extraction]\nmethod = range_image\n' "$lidar" "$height" \
    >"$work/own.ini"
  for world in $(seq "$first" $((first + count - 1))); do
    copy_settings "$work/own.ini" "$work/street.ini" simulation.spacing_m=2 "world.seed=$world" \
      "world.length_m=$length"
    "$bin/pole-simulate" --quiet --config "$work/street.ini" --output "$work/scans"
    "$bin/pole-import" folder --quiet --input "$work/scans" --output "$work/scans.rawlog"
    extracted hand
    extracted own
  done
  jq -n --arg lidar "$lidar" --slurpfile hand "$work/hand.scores" --slurpfile own "$work/own.scores" '
    def sums: {found: (map(.detections) | add), right: (map(.right) | add), visible: (map(.visible) | add)};
    {lidar: $lidar, hand: ($hand | sums), own: ($own | sums)}' >>"$out/results"
done <<END
vlp16 1.8 16 16 -16
hdl32e 1.8 32 11.3 -31.3
hdl64e 1.73 64 3 -25
os1_64 1.8 64 16.9 -16.9
END
collect_results .
table "$out/result.json" '.[] | [.lidar, (.hand, .own | .found, .right, .right / .found), .hand.visible]' \
  LiDAR "found by hand" right share:3 "found by itself" right share:3 visible | tee "$out/table.txt"
