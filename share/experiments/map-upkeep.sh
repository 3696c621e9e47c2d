#!/bin/sh
# What erring poses do to a map that is kept up.
# Usage: share/experiments/map-upkeep.sh OUT [FIRST [WORLDS [CONFIG]]]
#   OUT     gets maps, drives, result.json and table.txt
#   FIRST   seed of the first world, 811 unless given; WORLDS: their number, 4 unless given
#   CONFIG  settings, config/hdl32e.ini unless given
# Streets of 400 m in which nothing changes but cars, people and leaves: a map of day 0 with true poses, then
# `pole-map update` by six drives of other days. Poles are drawn from share/models/hdl32e.json. The truth of
# the drives is exact, or it errs by 0.15 m and 0.3 deg, correlated over 100 m (erring-truth.awk, smooth and
# rough); with and without the alignment of sessions. Scores: poles within 0.5 m of those of the world, one to
# one.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; two minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 4 "$@"
make_out "$1"
first=${2:-811}
last=$((first + ${3:-4} - 1))
settings=${4:-$top/config/hdl32e.ini}
find_programs pole-simulate pole-map pole-eval
find_tools jq

# drive WORLD DAY: OUT/WORLD-DAY.ini .rawlog .tum, _smooth.tum, _rough.tum
drive() {
  name=$out/$1-$2
  draw_drive "$name" "$settings" "$1" "$2" "simulation.drive_seed=$2" world.length_m=400 \
    world.removed_share=0 world.added_share=0
  for kind in smooth rough; do
    awk -v seed=$((100 * $1 + $2)) -v kind=$kind -f "$top/share/experiments/erring-truth.awk" "$name.tum" \
      >"${name}_$kind.tum"
  done
}

# keep WORLD ERRORS ALIGN_SIGMA: adds a line to OUT/results
keep() {
  ending=
  [ "$2" = none ] || ending=_$2
  inputs='' truths=''
  for day in 1 2 3 4 5 6; do
    inputs="$inputs $out/$1-$day.rawlog"
    truths="$truths $out/$1-$day$ending.tum"
  done
  # shellcheck disable=SC2086 # lists of files
  "$bin/pole-map" update --quiet --config "$out/$1-0.ini" --map "$out/$1.polemap" --input $inputs --truth $truths \
    --output "$out/$1-kept.polemap" --json "$out/update.json" --set "map_update.align_sigma_m=$3" 2>"$out/$1-$2-$3.err"
  score_map 0.5 "$out/$1-0_poles_gt.csv" "$out/$1-kept.polemap" "$out/kept.json"
  jq -n --arg errors "$2" --argjson world "$1" --argjson aligned "$([ "$3" = 0 ] && echo false || echo true)" \
    --slurpfile before "$out/$1-before.json" --slurpfile kept "$out/kept.json" --slurpfile update "$out/update.json" \
    'def scores: {precision, recall, f1, shift_x_m, shift_y_m, rotation_deg};
     {world: $world, errors: $errors, aligned: $aligned, before: ($before[0] | scores), after: ($kept[0] | scores),
      moved_share_max: ([$update[0].sessions[].moved_share] | max), warnings: ($update[0].warnings | length)}' \
    >>"$out/results"
}

for world in $(seq "$first" "$last"); do
  for day in 0 1 2 3 4 5 6; do drive "$world" $day; done
  map_drive "$out/$world-0" "$out/$world.polemap"
  score_map 0.5 "$out/$world-0_poles_gt.csv" "$out/$world.polemap" "$out/$world-before.json"
  for errors in none smooth rough; do
    keep "$world" $errors 0.2
    keep "$world" $errors 0
  done
done
collect_results '{worlds: ., mean: (group_by([.errors, .aligned]) | map({errors: .[0].errors, aligned: .[0].aligned,
    f1_before: (map(.before.f1) | add / length), f1: (map(.after.f1) | add / length),
    f1_worst: (map(.after.f1) | min),
    precision: (map(.after.precision) | add / length), recall: (map(.after.recall) | add / length),
    shift_m_max: (map([.after.shift_x_m, .after.shift_y_m] | map(. * .) | add | sqrt) | max),
    moved_share_max: (map(.moved_share_max) | max), warnings: (map(.warnings) | add)}))}'
rm "$out/kept.json" "$out/update.json"
table "$out/result.json" \
  '.mean[] | [.errors, .aligned, .f1_before, .precision, .recall, .f1, .f1_worst, .shift_m_max, .warnings]' \
  errors aligned "F1 before:4" precision:4 recall:4 F1:4 "worst F1:4" "shift m:4" warnings | tee "$out/table.txt"
