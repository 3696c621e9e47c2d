#!/bin/sh
# A vehicle that leaves the map and comes back: simulated streets of 3 km whose map lacks every second 300 m. Poles
# are drawn by the model of share/models/hdl32e.json, another day, 7 m/s, a scan each 0.7 m and each 5.6 m; odometry
# of wheels, 1 % too long.
# Usage: share/experiments/leaving-the-map.sh OUT [FIRST [WORLDS]]
#   OUT     gets maps, drives and result.json
#   FIRST   first world, 951 unless given; WORLDS: their number, 4 unless given
# Programs: build/bin, or POLEMCL_BIN. Needs jq, python3-scipy.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
make_out "$1"
first=${2:-951}
worlds=${3:-4}
find_programs pole-simulate pole-map pole-localize
find_tools jq
find_modules scipy
metres=300
script=$top/share/experiments/leaving_map.py

for world in $(seq "$first" $((first + worlds - 1))); do
  map=$out/$world.polemap
  draw_drive "$out/$world" "$top/config/hdl32e.ini" "$world" 0 world.length_m=3000
  map_drive "$out/$world" "$out/whole.polemap"
  "$bin/pole-map" convert --quiet "$out/whole.polemap" --output "$out/whole.csv"
  /usr/bin/python3 "$script" cut "$out/$world.tum" $metres "$out/whole.csv" "$out/part.csv"
  "$bin/pole-map" convert --quiet "$out/part.csv" --output "$map"
  for spacing in 0.7 5.6; do
    drive=$out/$world-$spacing
    draw_drive "$drive" "$top/config/hdl32e.ini" "$world" 1 world.length_m=3000 simulation.speed_m_s=7 \
      simulation.drive_seed=2 simulation.spacing_m=$spacing
    localize_drive "$drive" "$map" "$out/runs" --runs 5
    /usr/bin/python3 "$script" score "$drive.tum" $metres "$out/runs" |
      jq -c --argjson world "$world" --argjson spacing $spacing '{world: $world, spacing_m: $spacing} + .' >>"$out/results"
    rm -r "$out/runs"
  done
done
collect_results .
jq -c '.[]' "$out/result.json"
