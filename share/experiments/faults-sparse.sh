#!/bin/sh
# Looks for the reason why, after faults of the odometry, `ok` comes back later on the real drive of
# faults-kilometre.sh than in drawn streets. Drives as in faults.sh, at 6.3 m/s, with a scan every 0.7 m and every
# 3.5 m as there, and each with all poles as on the map and with half of them gone and twice the false detections.
# Usage: share/experiments/faults-sparse.sh OUT [FIRST [WORLDS]]
#   OUT     gets maps, drives, one JSON for each fault, table.txt and result.json
#   FIRST   first world, 556 unless given; WORLDS: their number, 2 unless given
# 8 s before each fault, 10 s of it, 100 m after it. 50 trials each, seed 501. POLEMCL_DATA names the folder of data
# for the road, tracks/kaist01.txt.gz; without it, the simulator's own street of 3 km.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; seven minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
make_out "$1"
first=${2:-556}
worlds=${3:-2}
find_programs pole-simulate pole-map pole-eval
find_tools jq
config=$top/config/hdl32e.ini
road=world.length_m=3000
[ -z "${POLEMCL_DATA-}" ] || road=world.track=$POLEMCL_DATA/tracks/kaist01.txt.gz

# drive NAME WORLD DAY DRIVE SPACING [SECTION.KEY=VALUE...]
drive() {
  path=$out/$1 town=$2 day=$3 number=$4 spacing=$5
  shift 5
  draw_drive "$path" "$config" "$town" "$day" simulation.speed_m_s=6.3 "$road" \
    "simulation.drive_seed=$number" "simulation.spacing_m=$spacing" "$@"
}

# faults NAME WORLD SPACING POLES: adds a line to the results for each fault.
faults() {
  for fault in stuck slip jump clock; do
    "$bin/pole-eval" faults --quiet --config "$config" --map "$out/map$2.polemap" --input "$out/$1.rawlog" \
      --truth "$out/$1.tum" --fault "$fault" --trials 50 --seed 501 --lead 8 --duration 10 --tail 100 \
      --json "$out/$1.$fault.json"
    jq -c --argjson world "$2" --argjson spacing "$3" --arg poles "$4" \
      '{world: $world, spacing_m: $spacing, poles: $poles} + del(.failed)' "$out/$1.$fault.json" >>"$out/results"
  done
}

for world in $(seq "$first" $((first + worlds - 1))); do
  drive "map$world" "$world" 0 1 0.7
  map_drive "$out/map$world" "$out/map$world.polemap"
  for spacing in 0.7 3.5; do
    drive all "$world" 1 2 "$spacing"
    faults all "$world" "$spacing" all
    drive half "$world" 1 2 "$spacing" world.removed_share=0.5 simulation.false_factor=2
    faults half "$world" "$spacing" half
  done
done

collect_results .
table "$out/result.json" 'group_by([.spacing_m, .poles, .fault])[] | [.[0].spacing_m, .[0].poles, .[0].fault] +
  [(map(.trials) | add), (map(.passed) | add), (map(.ok.max_m) | max), (map(.ok_beyond_5_sigma_max_s) | max)]' \
  "scan every m:1" poles fault trials "as demanded" "ok max m:1" "beyond 5 sigma max s:1" | tee "$out/table.txt"
