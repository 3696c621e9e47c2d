#!/bin/sh
# Localization in one table: a simulated HDL-32E street of 1.5 km with odometry of wheels, the real KITTI drive split with
# true odometry + 2 %, and the same with the independent visual odometry that comes with it.
# Usage: share/experiments/localization.sh DATA_DIR OUT [SEED]
#   DATA_DIR  a folder of real scans with poses and odometry.txt (kitti_raw_0005)
#   OUT       gets street/, split/, visual/, table.txt and result.json
#   SEED      of the street's world, 7 unless given
# Programs: build/bin, or POLEMCL_BIN. Needs jq and 8 GB of disk while it runs; 15 minutes on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 3 "$@"
data=$1
make_out "$2"
seed=${3:-7}
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
find_tools jq
[ -f "$data/odometry.txt" ] || die "no odometry in $data/odometry.txt"

"$top/share/experiments/hdl32-street.sh" "$out/street" "$seed" >/dev/null
"$top/share/experiments/kitti-split.sh" "$data" "$out/split" >/dev/null
"$top/share/experiments/kitti-split.sh" "$data" "$out/visual" "$top/config/kitti.ini" visual \
  >/dev/null

jq -n --slurpfile street "$out/street/result.json" --slurpfile split "$out/split/result.json" \
  --slurpfile visual "$out/visual/result.json" \
  '{street: ($street[0].localization + {world_seed: $street[0].world_seed, map: $street[0].map}),
    split: $split[0], visual: $visual[0]}' >"$out/result.json"
echo "Localization, mean of 5 runs of 1000 particles each"
table "$out/result.json" "([\"street, world $seed, 1.5 km\", .street], [\"KITTI split, truth + 2 %\", .split],
  [\"KITTI split, visual odometry\", .visual]) | [.[0], (.[1].mean | .pos_mean, .pos_rmse, .ang_mean_deg, .ang_rmse_deg,
  .pos_max)]" drive "position m:4" "RMSE m:4" "heading deg:3" "RMSE deg:3" "largest m:3" | tee "$out/table.txt"
