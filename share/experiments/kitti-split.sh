#!/bin/sh
# A real drive, split: map from the even scans, localization on the odd ones.
# Odometry is the true motion with 2 % noise (seed 7); 1000 particles, filter seeds 1 to 5.
# Usage: share/experiments/kitti-split.sh DATA_DIR OUT [CONFIG [ODOMETRY]]
#   DATA_DIR  a folder of scans with poses (velodyne/, times.txt, poses.txt)
#   OUT       gets the map, the trajectories, errors.txt and result.json. OUT/odometry/ gets the same for
#             odometry alone: from the true start with a likelihood that no pole can change
#   CONFIG    settings, config/kitti.ini unless given
#   ODOMETRY  "visual": DATA_DIR/odometry.txt instead of the noisy truth
# Programs: build/bin, or POLEMCL_BIN. Needs jq.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 4 "$@"
data=$1
make_out "$2"
config=${3:-$top/config/kitti.ini}
case ${4:-noisy} in
  noisy) odometry="--odometry-noise 0.02 --seed 7" ;;
  visual) odometry="" ;;
  *) die "odometry must be noisy or visual, not $4" ;;
esac
find_programs pole-import pole-map pole-localize pole-eval
find_tools jq
[ -d "$data/velodyne" ] || die "no scans in $data/velodyne"

"$bin/pole-import" folder --quiet --input "$data" --output "$out/even.rawlog" --every 2 --offset 0
# shellcheck disable=SC2086
"$bin/pole-import" folder --quiet --input "$data" --output "$out/odd.rawlog" --every 2 --offset 1 \
  $odometry # options: several words
cp "$config" "$out/even.ini"
cp "$config" "$out/odd.ini"
map_drive "$out/even" "$out/map.polemap" --csv "$out/map.csv"
localize_drive "$out/odd" "$out/map.polemap" "$out/runs" --particles 1000 --runs 5 --seed 1

first=$(awk '!/^#/ { printf "%.9g,%.9g,%.9g", $2, $3,
  atan2(2 * ($8 * $7 + $5 * $6), 1 - 2 * ($6 * $6 + $7 * $7)) * 57.29577951308232; exit }' "$out/odd.tum")
localize_drive "$out/odd" "$out/map.polemap" "$out/odometry" --start "$first,0,0" --particles 1000 --seed 1 \
  --set likelihood.gate_m=1e-9 --set search.recover=false --set odometry_monitor.enabled=false

evaluate_runs "$out/odometry" "$out/odd.tum"
evaluate_runs "$out/runs" "$out/odd.tum"
cp "$out/runs/errors.txt" "$out/errors.txt"
cp "$out/runs/errors.json" "$out/result.json"
echo "Map from the even scans, localized on the odd ones; settings: $config"
cat "$out/errors.txt"
sed -n '$s/^mean /alone/p' "$out/odometry/errors.txt"
