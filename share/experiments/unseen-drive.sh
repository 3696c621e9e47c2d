#!/bin/sh
# A real drive to which nothing of this project was fitted, with published poses of another origin: 50 scans
# of Apollo-SouthBay's ColumbiaPark (HDL-64E, 10 Hz, 70 m at 14 m/s, corrected for motion).
# Usage: share/experiments/unseen-drive.sh REPOSITORY OUT
#   REPOSITORY  folder of Git of github.com/Akshit21112002/ccndf as of commit 99265f77: a bare one, or .git of a clone
#   OUT         gets scans, maps, trajectories, result.json and table.txt
# Map of the even scans, localized on the odd ones, and the other way round. Odometry is the true motion with 2 % noise,
# seeds 7 to 11 of it; start within 2.5 m and 5 degrees, filter seeds 1 to 5. "ours" has config/kitti.ini without the
# correction of the ranges of KITTI's LiDAR, "kitti.ini" has it; "paper" and "mended" are the paper's mode with and
# without its authors' height test, each with least counts of 1 to 3.
# Programs: build/bin, or POLEMCL_BIN. Needs git and jq; five minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 2 "$@"
repository=$(cd "$1" && pwd)
make_out "$2"
find_programs pole-import pole-map pole-localize pole-eval
find_tools git jq

# The clouds are numbered in the order of their names 0, 1, 10, 11, ...
mkdir -p "$out/scans"
i=0
for scan in $(seq 0 49 | LC_ALL=C sort); do
  git --git-dir="$repository" show "HEAD:data/pcds/$i.pcd" >"$out/scans/$(printf %06d "$scan").pcd"
  i=$((i + 1))
done
# Poses of the LiDAR: number, time, x, y, z and a quaternion. Places count from the first one.
git --git-dir="$repository" show HEAD:data/poses/gt_poses.txt | awk 'NF == 9 {
  if (!n++) { x = $3; y = $4; z = $5 }
  printf "%.6f %.6f %.6f %.6f %s %s %s %s\n", $2, $3 - x, $4 - y, $5 - z, $6, $7, $8, $9 }' >"$out/poses.tum"

# scans NAME OFFSET [OPTION...]: every second scan as NAME.rawlog with NAME.tum.
scans() (
  name=$1
  offset=$2
  shift 2
  "$bin/pole-import" pcd --quiet --input "$out/scans" --poses "$out/poses.tum" --poses-of sensor --every 2 \
    --offset "$offset" --output "$out/$name.rawlog" "$@"
)

# score METHOD SETTINGS [SECTION.KEY=VALUE...]: a map of the scans "map", in which all draws of the others are localized;
# a line of results.
score() {
  method=$1
  from=$2
  shift 2
  here=$out/$method-$direction
  mkdir -p "$here"
  copy_settings "$from" "$out/map.ini" "$@"
  map_drive "$out/map" "$here/map.polemap" --csv "$here/map.csv"
  for draw in $draws; do
    cp "$out/map.ini" "$out/drive-$draw.ini"
    localize_drive "$out/drive-$draw" "$here/map.polemap" "$here/runs-$draw" --runs 5 --seed 1
    evaluate_runs "$here/runs-$draw" "$out/drive-$draw.tum"
  done
  ok=$(awk -F , 'FNR > 1 { n++; ok += $3 == "ok" } END { print ok / n }' "$here"/runs-*/run_*_health.csv)
  jq -c -s --arg method "$method" --arg localized "$direction" --argjson ok "$ok" '[.[].runs[]] | {method: $method,
    localized: $localized, ok: $ok, pos_mean: (map(.pos_mean) | add / length), pos_mean_min: (map(.pos_mean) | min),
    pos_mean_max: (map(.pos_mean) | max), pos_max: (map(.pos_max) | max),
    ang_mean_deg: (map(.ang_mean_deg) | add / length)}' "$here"/runs-*/errors.json >>"$out/results"
}

draws="7 8 9 10 11"
for direction in odd even; do
  [ $direction = odd ] && first=0 || first=1
  scans map "$first"
  for draw in $draws; do scans "drive-$draw" $((1 - first)) --odometry-noise 0.02 --seed "$draw"; done
  score ours "$top/config/kitti.ini" sensor.range_offset_m=0 sensor.range_scale=1
  score kitti.ini "$top/config/kitti.ini"
  for count in 1 2 3; do
    score paper-$count "$top/config/paper/kitti.ini" "map.min_count=$count"
    score mended-$count "$top/config/paper/kitti-mended.ini" "map.min_count=$count"
  done
done
collect_results .
table "$out/result.json" '.[] | [.method, .localized, .ok, .pos_mean, .pos_mean_min, .pos_mean_max, .pos_max,
  .ang_mean_deg]' method localized ok:2 "mean m:4" "least m:4" "most m:4" "largest m:3" "mean deg:3" >"$out/table.txt"
cat "$out/table.txt"
