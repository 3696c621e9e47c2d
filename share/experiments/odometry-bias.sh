#!/bin/sh
# Odometry with a wrong scale and a yaw bias that its covariances do not know: errors, and whether they fit
# the covariances of the poses, with and without calibration on the way.
# Usage: share/experiments/odometry-bias.sh OUT [FIRST [WORLDS]]
#   OUT    gets maps, drives, runs, result.json and table.txt
#   FIRST  first world, 801 unless given; WORLDS: their number, 4 unless given
# Simulated streets of 600 m, an HDL-32E, the map of one day, two drives on another day, one per direction.
# Poles are drawn by the model of share/models/hdl32e.json. Odometry is the truth with 2 % noise of each
# component and these sigmas ("noise"), or wheel ticks and a gyroscope ("wheels", simulation.md), both with
# the errors of the first columns. Programs: build/bin, or POLEMCL_BIN. Needs jq; five minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
out=$1
first=${2:-801}
last=$((first + ${3:-4} - 1))
settings=$top/config/hdl32e.ini
find_programs pole-simulate pole-map pole-localize pole-eval
find_tools jq
mkdir -p "$out"

# score ODOMETRY SCALE YAW CALIBRATED DIRECTION: all worlds; adds a line to OUT/results.
score() {
  truth='' runs='' worst=0 sum=0
  for world in $(seq "$first" "$last"); do
    name=$world-$5
    "$bin/pole-localize" --quiet --config "$out/$name.ini" --input "$out/$name.rawlog" \
      --map "$out/$world.polemap" --truth "$out/$name.tum" --output "$out/$name" --seed "$world" \
      --set "odometry_calibration.enabled=$4"
    truth="$truth $out/$name.tum"
    runs="$runs $out/$name/run_00_cov.csv"
    mean=$(awk -F , 'FNR > 1 { sum += $3; n++ } END { printf "%.6f", sum / n }' "$out/$name/run_00_errors.csv")
    sum=$(echo "$sum $mean" | awk '{ print $1 + $2 }')
    worst=$(echo "$worst $mean" | awk '{ print ($1 > $2 ? $1 : $2) }')
  done
  # shellcheck disable=SC2086 # lists of files
  "$bin/pole-eval" consistency --json "$out/score.json" --truth $truth --cov $runs >/dev/null
  jq --arg odometry "$1" --argjson scale "$2" --argjson yaw "$3" --argjson calibrated "$4" \
    --arg direction "$5" --argjson mean "$(echo "$sum $((last - first + 1))" | awk '{ print $1 / $2 }')" \
    --argjson worst "$worst" '{odometry: $odometry, scale: $scale, yaw_deg_m: $yaw,
      calibrated: $calibrated, direction: $direction, mean_m: $mean, worst_world_mean_m: $worst,
      nees: .nees_mean, coverage_95: .coverage_95, not_ok: .not_ok}' "$out/score.json" >>"$out/results"
}

: >"$out/results"
for world in $(seq "$first" "$last"); do
  draw_drive "$out/$world-map" "$settings" "$world" 0 "simulation.drive_seed=$world" world.length_m=600
  "$bin/pole-map" build --quiet --config "$out/$world-map.ini" --input "$out/$world-map.rawlog" \
    --truth "$out/$world-map.tum" --output "$out/$world.polemap"
done
for odometry in noise wheels; do
  for errors in "0 0" "0.01 0.01" "0.05 0.05"; do
    scale=${errors% *} yaw=${errors#* }
    for world in $(seq "$first" "$last"); do
      for direction in forward reverse; do
        [ $direction = reverse ] && back=true || back=false
        draw_drive "$out/$world-$direction" "$settings" "$world" 1 "simulation.reverse=$back" \
          "simulation.drive_seed=$world" world.length_m=600 "simulation.odometry=$odometry" \
          "simulation.odometry_scale=$scale" "simulation.odometry_yaw_deg_m=$yaw"
      done
    done
    for calibrated in true false; do
      for direction in forward reverse; do score $odometry "$scale" "$yaw" $calibrated $direction; done
    done
  done
done
jq -s . "$out/results" >"$out/result.json"
rm "$out/results" "$out/score.json"
jq -r '.[] | [.odometry, .scale, .yaw_deg_m, .calibrated, .direction, .mean_m, .worst_world_mean_m, .nees,
    .coverage_95] | @tsv' "$out/result.json" |
  awk -F '\t' 'BEGIN {
      format = "%-8s %6s %9s %10s %9s %8s %8s %8s %9s\n"
      printf format, "odometry", "scale", "yaw deg/m", "calibrated", "direction", "mean m", "worst m", "NEES",
        "coverage" }
    { printf "%-8s %6g %9g %10s %9s %8.4f %8.4f %8.2f %9.3f\n", $1, $2, $3, $4, $5, $6, $7, $8, $9 }
  ' >"$out/table.txt"
cat "$out/table.txt"
