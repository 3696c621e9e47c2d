#!/bin/sh
# Checks whether errors of poses fit their covariances. Simulated streets of 600 m, an HDL-32E, the map of one
# day, and two drives on another day for each world: one per direction, with own detections, noise and
# seed. Odometry is the truth with 2 % noise.
# Usage: share/experiments/consistency.sh OUT [FIRST [WORLDS]]
#   OUT      gets maps, drives, runs, and result.json: by direction, all, and of all only what is ok
#   FIRST    first world, 701 unless given; WORLDS: their number, 30 unless given
# Poles are drawn by the model of share/models/hdl32e.json. Programs: build/bin, or POLEMCL_BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
out=$1
first=${2:-701}
worlds=${3:-30}
find_programs pole-simulate pole-map pole-localize pole-eval
find_tools jq
mkdir -p "$out"

# drive NAME WORLD DAY REVERSE: NAME.ini .rawlog .tum
drive() {
  # shellcheck disable=SC2086,SC2154 # several words
  draw_drive "$out/$1" "$top/config/hdl32e.ini" "$2" "$3" $noise \
    "simulation.reverse=$4" "simulation.drive_seed=$2" world.length_m=600
}

# localize WORLD DIRECTION: OUT/WORLD-DIRECTION/run_00_cov.csv
localize() {
  "$bin/pole-localize" --quiet --config "$out/$1-$2.ini" --input "$out/$1-$2.rawlog" \
    --map "$out/$1.polemap" --truth "$out/$1-$2.tum" --output "$out/$1-$2" --seed "$1"
}

forward=
reverse=
forward_truth=
reverse_truth=
forward_health=
reverse_health=
world=$first
while [ "$world" -lt $((first + worlds)) ]; do
  drive "$world-map" "$world" 0 false
  drive "$world-forward" "$world" 1 false
  drive "$world-reverse" "$world" 1 true
  "$bin/pole-map" build --quiet --config "$out/$world-map.ini" --input "$out/$world-map.rawlog" \
    --truth "$out/$world-map.tum" --output "$out/$world.polemap"
  localize "$world" forward
  localize "$world" reverse
  forward="$forward $out/$world-forward/run_00_cov.csv"
  reverse="$reverse $out/$world-reverse/run_00_cov.csv"
  forward_truth="$forward_truth $out/$world-forward.tum"
  reverse_truth="$reverse_truth $out/$world-reverse.tum"
  forward_health="$forward_health $out/$world-forward/run_00_health.csv"
  reverse_health="$reverse_health $out/$world-reverse/run_00_health.csv"
  world=$((world + 1))
done

# score NAME TRUTH... --cov CSV...: the last line of the table, and NAME.json
score() {
  name=$1
  shift
  "$bin/pole-eval" consistency --json "$out/$name.json" --truth "$@" >"$out/$name.txt"
  printf '%-8s ' "$name"
  tail -n 1 "$out/$name.txt"
}
# shellcheck disable=SC2086 # word splitting wanted: lists of files
{
  score forward $forward_truth --cov $forward
  score reverse $reverse_truth --cov $reverse
  score all $forward_truth $reverse_truth --cov $forward $reverse
  score all_ok $forward_truth $reverse_truth --cov $forward $reverse --health $forward_health $reverse_health
} >"$out/table.txt"
sed -n 2p "$out/all.txt"
jq -s '{forward: .[0], reverse: .[1], all: .[2], all_ok: .[3]}' "$out/forward.json" "$out/reverse.json" "$out/all.json" \
  "$out/all_ok.json" >"$out/result.json"
cat "$out/table.txt"
