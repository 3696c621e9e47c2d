#!/bin/sh
# A simulated street of 1.5 km, an HDL-32E 1.0 m above the ground, a scan every 0.5 m: the map from
# one day, localization on another day; odometry of wheels, 1000 particles, filter seeds 1 to 5.
# Usage: share/experiments/hdl32-street.sh OUT [SEED [CONFIG]]
#   OUT     gets the map, the trajectories, errors.txt and result.json (the scans are removed again)
#   SEED    of the world, 1 unless given
#   CONFIG  settings, config/hdl32e.ini unless given
# Programs: build/bin, or POLEMCL_BIN. Needs jq, and 8 GB of disk while it runs.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
out=$1
seed=${2:-1}
settings=${3:-$top/config/hdl32e.ini}
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
find_tools jq
mkdir -p "$out"

simulate_day "$settings" "$out" "$seed" 1500 0
simulate_day "$settings" "$out" "$seed" 1500 1

"$bin/pole-map" build --quiet --config "$out/day0.ini" --input "$out/day0.rawlog" \
  --truth "$out/day0.tum" --output "$out/map.polemap" --csv "$out/map.csv"
"$bin/pole-eval" map --quiet --one-to-one --radius 1.0 --truth "$out/poles_day0.csv" \
  --map "$out/map.polemap" --json "$out/map.json" >/dev/null
"$bin/pole-localize" --quiet --config "$out/day1.ini" --input "$out/day1.rawlog" \
  --map "$out/map.polemap" --truth "$out/day1.tum" --output "$out/runs" \
  --particles 1000 --runs 5 --seed 1

evaluate_runs "$out/runs" "$out/day1.tum"
cp "$out/runs/errors.txt" "$out/errors.txt"
jq -s --argjson seed "$seed" '{world_seed: $seed, map: .[0], localization: .[1]}' "$out/map.json" "$out/runs/errors.json" \
  >"$out/result.json"

echo "Simulated street of 1.5 km, world $seed, day 1 in the map of day 0; settings: $settings"
printf 'map, one to one at 1 m: precision %.3f, recall %.3f, F1 %.3f\n' \
  "$(json_value "$out/map.json" precision)" "$(json_value "$out/map.json" recall)" \
  "$(json_value "$out/map.json" f1)"
cat "$out/errors.txt"
