#!/bin/sh
# Odometry with a wrong scale and a yaw bias that its covariances do not know: errors, and whether they fit
# the covariances of the poses, with and without calibration on the way.
# Usage: share/experiments/odometry-bias.sh OUT [--cast] [FIRST [WORLDS]]
#   OUT     gets maps, drives, runs, result.json and table.txt
#   --cast  scans are ray-cast and their poles extracted; else poles are drawn by share/models/hdl32e.json
#   FIRST   first world, 801 unless given; WORLDS: their number, 4 unless given
# Simulated streets of 600 m, an HDL-32E, the map of one day, two drives on another day, one per direction.
# Odometry is the truth with 2 % noise of each component and these sigmas ("noise"), or wheel ticks and a
# gyroscope ("wheels", simulation.md), both with the errors of the first columns. "beyond s" is the longest
# time in a row for which a pose called ok was more than five of its own sigmas off.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; a minute a world, two with --cast.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 4 "$@"
make_out "$1"
shift
cast=no
if [ "${1-}" = --cast ]; then
  cast=yes
  shift
fi
[ $# -le 2 ] || usage
first=${1:-801}
last=$((first + ${2:-4} - 1))
settings=$top/config/hdl32e.ini
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
find_tools jq
# Left by a run that was stopped: of another drive.
rm -rf "$out"/scans "$out"/scans.*
all_errors="0,0 0.01,0.01 0.05,0.05"

# drive NAME WORLD DAY REVERSE ODOMETRY SCALE YAW: NAME.ini, NAME.rawlog (poles) and NAME.tum. The scans
# of a cast drive stay in $scans, for other odometry of the same drive.
drive() (
  name=$1 seed=$2 day=$3
  set -- "simulation.reverse=$4" "simulation.drive_seed=$2" world.length_m=600 "simulation.odometry=$5" \
    "simulation.odometry_scale=$6" "simulation.odometry_yaw_deg_m=$7"
  if [ $cast = no ]; then
    draw_drive "$name" "$settings" "$seed" "$day" "$@"
    return
  fi
  copy_settings "$settings" "$name.ini" simulation.spacing_m=0.5 "$@" "world.seed=$seed" "world.day=$day"
  [ -d "$scans" ] || "$bin/pole-simulate" --quiet --config "$name.ini" --output "$scans"
  # The same drive of a LiDAR with hardly any points: only its odometry is used.
  copy_settings "$name.ini" "$scans.ini" sensor.model=uniform sensor.rings=2 sensor.columns=90
  "$bin/pole-simulate" --quiet --config "$scans.ini" --output "$scans.odometry"
  cp "$scans.odometry/odometry.txt" "$scans/odometry.txt"
  find_poles "$scans" "$name" "$name.ini"
  rm -r "$scans.ini" "$scans.odometry"
)

for world in $(seq "$first" "$last"); do
  scans=$out/scans
  drive "$out/$world-map" "$world" 0 false noise 0 0
  map_drive "$out/$world-map" "$out/$world.polemap"
  rm -rf "$scans"
  for direction in forward reverse; do
    [ $direction = reverse ] && back=true || back=false
    for odometry in noise wheels; do
      for errors in $all_errors; do
        name=$out/$world-$direction-$odometry-$errors
        drive "$name" "$world" 1 "$back" "$odometry" "${errors%,*}" "${errors#*,}"
        for calibrated in true false; do
          localize_drive "$name" "$out/$world.polemap" "$name-$calibrated" --seed "$world" \
            --set odometry_calibration.enabled=$calibrated
        done
      done
    done
    rm -rf "$scans"
  done
done

# score ODOMETRY ERRORS CALIBRATED DIRECTION: all worlds; adds a line to OUT/results.
score() {
  truth='' runs='' health='' means=
  for world in $(seq "$first" "$last"); do
    name=$out/$world-$4-$1-$2
    truth="$truth $name.tum"
    runs="$runs $name-$3/run_00_cov.csv"
    health="$health $name-$3/run_00_health.csv"
    means="$means $world:$(awk -F , 'FNR > 1 { sum += $3; n++ } END { printf "%.6f", sum / n }' \
      "$name-$3/run_00_errors.csv")"
  done
  # shellcheck disable=SC2086 # lists of files
  "$bin/pole-eval" consistency --json "$out/score.json" --truth $truth --cov $runs >/dev/null
  # shellcheck disable=SC2086
  "$bin/pole-eval" consistency --json "$out/ok.json" --truth $truth --cov $runs --health $health \
    --skip-metres 0 >/dev/null
  jq -n --arg odometry "$1" --argjson scale "${2%,*}" --argjson yaw "${2#*,}" --argjson calibrated "$3" \
    --arg direction "$4" --arg means "$means" --slurpfile all "$out/score.json" --slurpfile ok "$out/ok.json" '
    ($means | split(" ") | map(select(. != "") | split(":") | {world: .[0], m: (.[1] | tonumber)})) as $worlds
    | {odometry: $odometry, scale: $scale, yaw_deg_m: $yaw, calibrated: $calibrated, direction: $direction,
      mean_m: (($worlds | map(.m) | add) / ($worlds | length)),
      worst_world: ($worlds | max_by(.m).world), worst_world_mean_m: ($worlds | max_by(.m).m),
      nees: $all[0].nees_mean, coverage_95: $all[0].coverage_95, not_ok: $ok[0].not_ok,
      ok_beyond_5_sigma_s: $ok[0].longest_beyond_5_sigma_s}' >>"$out/results"
}

for odometry in noise wheels; do
  for errors in $all_errors; do
    for calibrated in true false; do
      for direction in forward reverse; do score $odometry "$errors" $calibrated $direction; done
    done
  done
done
collect_results .
rm "$out/score.json" "$out/ok.json"
table "$out/result.json" '.[] | [.odometry, .scale, .yaw_deg_m, .calibrated, .direction, .mean_m, .worst_world_mean_m,
  .worst_world, .nees, .coverage_95, .not_ok, .ok_beyond_5_sigma_s]' odometry scale "yaw deg/m" calibrated direction \
  "mean m:4" "worst m:4" world NEES:2 coverage:3 "not ok" "beyond s:1" | tee "$out/table.txt"
