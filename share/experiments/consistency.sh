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
first=${2:-701}
worlds=${3:-30}
find_programs pole-simulate pole-map pole-localize pole-eval
find_tools jq
make_out "$1"

# drive NAME WORLD DAY REVERSE: NAME.ini .rawlog .tum
drive() {
  # shellcheck disable=SC2086,SC2154 # several words
  draw_drive "$out/$1" "$top/config/hdl32e.ini" "$2" "$3" $noise \
    "simulation.reverse=$4" "simulation.drive_seed=$2" world.length_m=600
}

worlds=$(seq "$first" $((first + worlds - 1)))
for world in $worlds; do
  drive "$world-map" "$world" 0 false
  drive "$world-forward" "$world" 1 false
  drive "$world-reverse" "$world" 1 true
  map_drive "$out/$world-map" "$out/$world.polemap"
  for direction in forward reverse; do
    localize_drive "$out/$world-$direction" "$out/$world.polemap" "$out/$world-$direction" --seed "$world"
  done
done

# files ENDING DIRECTION...: those of all worlds.
files() {
  ending=$1
  shift
  for direction in "$@"; do
    for world in $worlds; do echo "$out/$world-$direction$ending"; done
  done
}

# score NAME DIRECTIONS [OPTION...]: the last line of the table, and NAME.json
# shellcheck disable=SC2046,SC2086 # lists of words
score() {
  name=$1
  directions=$2
  shift 2
  "$bin/pole-eval" consistency --json "$out/$name.json" --truth $(files .tum $directions) \
    --cov $(files /run_00_cov.csv $directions) "$@" >"$out/$name.txt"
  printf '%-8s ' "$name"
  tail -n 1 "$out/$name.txt"
}
{
  score forward forward
  score reverse reverse
  score all "forward reverse"
  # shellcheck disable=SC2046 # a list of files
  score all_ok "forward reverse" --health $(files /run_00_health.csv forward reverse)
} >"$out/table.txt"
sed -n 2p "$out/all.txt"
jq -s '{forward: .[0], reverse: .[1], all: .[2], all_ok: .[3]}' "$out/forward.json" "$out/reverse.json" "$out/all.json" \
  "$out/all_ok.json" >"$out/result.json"
cat "$out/table.txt"
