#!/bin/sh
# A city's inventory as a map: localization in it, and the map that drives make of it.
# Usage: share/experiments/inventory.sh OUT [FIRST [WORLDS]]
#   OUT     gets inventories, drives, maps, result.json and table.txt
#   FIRST   first world, 941 unless given; WORLDS: their number, 4 unless given
# Simulated streets of 600 m, poles drawn from the model of an HDL-32E, odometry of wheels, 1 % too long and
# 0.01 deg/m off. The inventory (erring-inventory.awk) is off by 0.3 to 1 m, misses 20 % of the poles and
# invents 10 %. Starts within 2.5 m and 5 degrees of the true pose.
#   inventory   the first drive, in the inventory
#   one drive   drives 2 (against) and 3 (along), in the map that pole-map build --inventory made of drive 1
#   four        drive 5, in the map of drives 1 to 4
#   truth       drives 2 and 3, in the map of drive 1 at its true poses: what the LiDAR can do
# "local" is the error within 60 m, after the best rigid motion (local_error.py); sigma what the program says of
# its own map. Programs: build/bin, or POLEMCL_BIN. Needs jq and python3-numpy; three minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
make_out "$1"
first=${2:-941}
last=$((first + ${3:-4} - 1))
find_programs pole-simulate pole-map pole-localize pole-eval
find_tools jq
find_modules numpy

# score NAME WORLD DRIVE FOLDER SIGMA: adds a line to OUT/results
score() {
  "$bin/pole-eval" trajectory --quiet --truth "$3.tum" --estimate "$4/run_00.tum" --json "$4/error.json" >/dev/null
  "$bin/pole-eval" consistency --quiet --truth "$3.tum" --cov "$4/run_00_cov.csv" --truth-sigma-m "$5" \
    --json "$4/consistency.json" >/dev/null
  jq -n --arg name "$1" --argjson world "$2" --argjson sigma "$5" --slurpfile error "$4/error.json" \
    --slurpfile consistency "$4/consistency.json" \
    --argjson local "$(/usr/bin/python3 "$top/share/experiments/local_error.py" "$3.tum" "$4/run_00.tum")" \
    '{map: $name, world: $world, mean_m: $error[0].pos_mean, worst_m: $error[0].pos_max,
      mean_deg: $error[0].ang_mean_deg, local_m: $local, sigma_m: $sigma,
      nees_position: $consistency[0].nees_position_mean}' >>"$out/results"
}

# sharpen WORLD MAP DRIVES...: the map that drives make of the inventory; sets $sigma
sharpen() {
  here=$out/$1
  made=$2
  shift 2
  inputs='' estimates=''
  for drive in "$@"; do
    inputs="$inputs $here/$drive.rawlog"
    estimates="$estimates $here/in-inventory-$drive/run_00.tum"
  done
  # shellcheck disable=SC2086 # lists of files
  "$bin/pole-map" build --config "$here/1.ini" --input $inputs --estimate $estimates \
    --inventory "$here/inventory.polemap" --output "$made" >"$made.txt" 2>/dev/null
  sigma=$(sed -n 's/.*poses are certain to \([0-9.]*\) m.*/\1/p' "$made.txt")
}

map_score() { # WORLD NAME MAP
  score_map 0.25 "$out/$1/1_poles_gt.csv" "$3" "$3.json"
  jq --arg name "$2" --argjson world "$1" '{map_of: $name, world: $world, precision, recall, f1}' "$3.json" \
    >>"$out/maps"
}

: >"$out/maps"
for world in $(seq "$first" "$last"); do
  here=$out/$world
  mkdir -p "$here"
  for drive in 1 2 3 4 5; do
    reverse=false
    [ $((drive % 2)) = 1 ] || reverse=true
    draw_drive "$here/$drive" "$top/config/hdl32e.ini" "$world" "$drive" world.length_m=600 \
      "simulation.drive_seed=$drive" "simulation.reverse=$reverse"
  done
  awk -v seed="$world" -f "$top/share/experiments/erring-inventory.awk" "$here/1_poles_gt.csv" >"$here/inventory.csv"
  # The map's plane: an orthographic projection round the datum.
  "$bin/pole-map" import --quiet --input "$here/inventory.csv" --datum 52,13 --sigma-m 0.5 \
    --crs "+proj=ortho +lat_0=52 +lon_0=13 +ellps=WGS84" --output "$here/inventory.polemap"
  map_score "$world" inventory "$here/inventory.polemap"
  for drive in 1 2 3 4; do
    localize_drive "$here/$drive" "$here/inventory.polemap" "$here/in-inventory-$drive" --seed 1
  done
  score inventory "$world" "$here/1" "$here/in-inventory-1" 0
  sharpen "$world" "$here/one.polemap" 1
  map_score "$world" "one drive" "$here/one.polemap"
  for drive in 2 3; do
    localize_drive "$here/$drive" "$here/one.polemap" "$here/in-one-$drive" --seed 1
    score "one drive" "$world" "$here/$drive" "$here/in-one-$drive" "$sigma"
  done
  sharpen "$world" "$here/four.polemap" 1 2 3 4
  map_score "$world" four "$here/four.polemap"
  localize_drive "$here/5" "$here/four.polemap" "$here/in-four-5" --seed 1
  score four "$world" "$here/5" "$here/in-four-5" "$sigma"
  map_drive "$here/1" "$here/true.polemap"
  map_score "$world" truth "$here/true.polemap"
  for drive in 2 3; do
    localize_drive "$here/$drive" "$here/true.polemap" "$here/in-true-$drive" --seed 1
    score truth "$world" "$here/$drive" "$here/in-true-$drive" 0
  done
done
jq -s --slurpfile maps "$out/maps" '{drives: ., maps: $maps, mean: (group_by(.map) | map({map: .[0].map, drives: length,
    mean_m: (map(.mean_m) | add / length), worst_drive_m: (map(.mean_m) | max), worst_m: (map(.worst_m) | max),
    mean_deg: (map(.mean_deg) | add / length), local_m: (map(.local_m) | add / length),
    worst_local_m: (map(.local_m) | max), sigma_m: (map(.sigma_m) | add / length),
    nees_position: (map(.nees_position) | add / length)}))
  | map(. as $m | . + {f1: ([$maps[] | select(.map_of == $m.map) | .f1] | add / length)})}' \
  "$out/results" >"$out/result.json"
rm "$out/results" "$out/maps"
table "$out/result.json" '.mean[] | [.map, .f1, .mean_m, .worst_drive_m, .worst_m, .mean_deg, .local_m, .worst_local_m,
  .sigma_m, .nees_position]' map F1:3 "mean m:4" "worst mean:4" "worst m:3" "mean deg:4" "local m:4" "worst local:4" \
  "sigma m:3" "NEES position:2" | tee "$out/table.txt"
