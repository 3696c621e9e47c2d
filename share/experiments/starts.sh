#!/bin/sh
# A start pose known roughly (2.5 m, 5 degrees): random starts on simulated streets of 600 m, a year after their
# map, in which none and half of the poles have been replaced, with a scan every 0.5 m and every 8 m, each with
# all outliers alike (likelihood.far_outlier = 1) and as the settings have it.
# Usage: share/experiments/starts.sh OUT [FIRST [WORLDS [TRIALS]]]
#   OUT     gets maps, drives, a JSON file for each case and world, table.txt and result.json
#   FIRST   first world, 771 unless given; WORLDS: their number, 4 unless given
#   TRIALS  starts of each case and world, 100 unless given; 60 m each
# The pose given is drawn as the particles are, so the true one is not in the middle. Poles are drawn from
# share/models/hdl32e.json; odometry is that of wheels. Programs: build/bin, or POLEMCL_BIN. Needs jq.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 4 "$@"
make_out "$1"
first=${2:-771}
worlds=${3:-4}
trials=${4:-100}
find_programs pole-simulate pole-map pole-localize pole-eval
find_tools jq

# try_starts WORLD REPLACED SPACING FAR_OUTLIER: adds a line to OUT/results.
try_starts() {
  name=$1-$2-$3
  "$bin/pole-eval" starts --quiet --config "$out/$name.ini" --set "likelihood.far_outlier=$4" \
    --map "$out/$1.polemap" --input "$out/$name.rawlog" --truth "$out/$name.tum" --trials "$trials" \
    --seed "$1" --json "$out/$name-$4.json"
  jq -c --argjson world "$1" --argjson replaced "$2" --argjson spacing "$3" --argjson far "$4" \
    '{world: $world, replaced: $replaced, spacing_m: $spacing, far_outlier: $far} + .' \
    "$out/$name-$4.json" >>"$out/results"
}

usual=$("$bin/pole-localize" --print-config --all --config "$top/config/hdl32e.ini" |
  sed -n 's/^far_outlier = \([0-9.]*\).*/\1/p')
for world in $(seq "$first" $((first + worlds - 1))); do
  draw_drive "$out/$world" "$top/config/hdl32e.ini" "$world" 0 world.length_m=600
  map_drive "$out/$world" "$out/$world.polemap"
  for replaced in 0 0.5; do
    for spacing in 0.5 8; do
      draw_drive "$out/$world-$replaced-$spacing" "$top/config/hdl32e.ini" "$world" 365 \
        world.length_m=600 "world.replaced_per_year=$replaced" "simulation.spacing_m=$spacing" \
        "simulation.drive_seed=$world"
      for far in 1 "$usual"; do try_starts "$world" "$replaced" "$spacing" "$far"; done
    done
  done
done

collect_results 'group_by([.replaced, .spacing_m, -.far_outlier]) | map({replaced: .[0].replaced, spacing_m: .[0].spacing_m,
    far_outlier: .[0].far_outlier, trials: (map(.trials) | add), right: (map(.right) | add),
    ok_wrong: (map(.ok_wrong) | add), mean_m: (map(.mean_m) | add / length),
    worst_world_m: (map(.mean_m) | max), right_metres_p95: (map(.right_metres_p95) | max),
    right_metres_max: (map(.right_metres_max) | max), worlds: .})'
table "$out/result.json" '.[] | [.replaced, .spacing_m, .far_outlier, .trials, .right, .ok_wrong, .mean_m, .worst_world_m,
  .right_metres_p95, .right_metres_max]' replaced "spacing m" far_outlier starts right "ok wrong" "mean m:4" \
  "worst world:4" "right after m, 95 %:1" "worst:1" | tee "$out/table.txt"
