#!/bin/sh
# Scans taken while the LiDAR moves: errors against the same drives of a LiDAR that stands still in each turn.
# Usage: share/experiments/motion-distortion.sh OUT [FIRST [WORLDS [LENGTH]]]
#   OUT     gets drives, maps, runs, result.json and table.txt
#   FIRST   first world, 821 unless given; WORLDS: their number, 2 unless given
#   LENGTH  of the streets, 200 m unless given
# Cast scans of simulated streets: an HDL-32E at 5 m/s and an OS1-64 at 15 m/s, ten turns a second. The map is
# that of one day, the localization that of another day in the opposite direction; both are distorted or both
# are not. Odometry of wheels, 1 % too long and 0.01 deg/m off, start within 2.5 m and 5 degrees, filter seeds
# 1 to 5. "used as they are":
# distorted scans that are taken as compensated.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; ten minutes of two cores and 3 GB of disk.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 4 "$@"
make_out "$1"
first=${2:-821}
last=$((first + ${3:-2} - 1))
length=${4:-200}
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
find_tools jq

# score SENSOR SPEED SPACING SCANS [SECTION.KEY=VALUE...]: all worlds; adds a line to $out/results.
score() {
  sensor=$1 speed=$2 spacing=$3 scans=$4
  shift 4
  runs=
  for world in $(seq "$first" "$last"); do
    here=$out/$sensor-$scans-$world
    for day in 0 1; do
      reverse=false
      [ "$day" = 0 ] || reverse=true
      # shellcheck disable=SC2086 # several words
      simulate_day "$top/config/$sensor.ini" "$here" "$world" "$length" "$day" \
        "simulation.speed_m_s=$speed" "simulation.spacing_m=$spacing" "simulation.reverse=$reverse" "$@"
    done
    map_drive "$here/day0" "$here/map.polemap"
    localize_drive "$here/day1" "$here/map.polemap" "$here/runs" --runs 5 --seed 1
    evaluate_runs "$here/runs" "$here/day1.tum"
    runs="$runs $here/runs/errors.json"
  done
  # shellcheck disable=SC2086 # a list of files
  jq -s --arg sensor "$sensor" --arg speed "$speed" --arg scans "$scans" \
    'map(.runs) | add | {sensor: $sensor, speed_m_s: ($speed | tonumber), scans: $scans,
      pos_mean: (map(.pos_mean) | add / length), ang_mean_deg: (map(.ang_mean_deg) | add / length),
      worst_run_m: (map(.pos_mean) | max)}' $runs >>"$out/results"
}

for drive in "hdl32e 5 0.5" "mulran 15 1.5"; do
  # shellcheck disable=SC2086 # three words
  score $drive still
  # shellcheck disable=SC2086
  score $drive moving simulation.motion_distortion=true
  # shellcheck disable=SC2086
  score $drive moving-used-as-they-are simulation.motion_distortion=true sensor.turn=compensated
done
collect_results .
table "$out/result.json" '.[] | [.sensor, .speed_m_s, .scans, .pos_mean, .ang_mean_deg, .worst_run_m]' \
  config m/s scans "mean m:4" "mean deg:4" "worst run m:4" | tee "$out/table.txt"
