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
make_out "$1"
seed=${2:-1}
settings=${3:-$top/config/hdl32e.ini}
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
find_tools jq

simulate_day "$settings" "$out" "$seed" 1500 0
simulate_day "$settings" "$out" "$seed" 1500 1

map_drive "$out/day0" "$out/map.polemap" --csv "$out/map.csv"
score_map 1.0 "$out/poles_day0.csv" "$out/map.polemap" "$out/map.json"
localize_drive "$out/day1" "$out/map.polemap" "$out/runs" --particles 1000 --runs 5 --seed 1
evaluate_runs "$out/runs" "$out/day1.tum"
cp "$out/runs/errors.txt" "$out/errors.txt"
jq -s --argjson seed "$seed" '{world_seed: $seed, map: .[0], localization: .[1]}' "$out/map.json" "$out/runs/errors.json" \
  >"$out/result.json"

echo "Simulated street of 1.5 km, world $seed, day 1 in the map of day 0; settings: $settings"
printf 'map, one to one at 1 m: precision %.3f, recall %.3f, F1 %.3f\n' \
  "$(json_value "$out/map.json" precision)" "$(json_value "$out/map.json" recall)" \
  "$(json_value "$out/map.json" f1)"
cat "$out/errors.txt"
