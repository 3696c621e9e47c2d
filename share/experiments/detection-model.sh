#!/bin/sh
# The detection model of an HDL-32E (share/models/hdl32e.json): fitted to ray-cast streets, and compared
# with ray casting on others: streets of 400 m, a scan every 0.5 m, two days each.
# Usage: share/experiments/detection-model.sh OUT [SEED...]
#   OUT   gets hdl32e.json, the drives, result.json and table.txt; existing drives are used again
#   SEED  of the worlds to compare on, 501 to 503 unless given; the model is fitted to 101 to 103
# Per drive: fit_detections.py --summary and pole-eval repeatability. Map of day 0, one to one at 0.5 m
# against all true poles; localization on day 1 in it, 3 runs of 1000 particles, odometry with 2 % noise:
# both cast, or both drawn. Programs: build/bin, or POLEMCL_BIN. Needs jq and python3-scipy, 4 minutes on 2
# cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 any "$@"
make_out "$1"
shift
[ $# -gt 0 ] || set -- 501 502 503
find_tools jq
find_modules scipy
find_programs pole-simulate pole-map pole-localize pole-eval

# drive NAME SEED DAY MODEL: simulates NAME.rawlog, cast when MODEL is empty.
drive() {
  copy_settings "$top/config/hdl32e.ini" "$out/$1.ini" simulation.spacing_m=0.5 \
    "simulation.detections=$4" world.length_m=400 "world.seed=$2" "world.day=$3"
  [ -n "$4" ] || [ ! -f "$out/$1.rawlog" ] || return 0
  "$bin/pole-simulate" --quiet --config "$out/$1.ini" --poles "$out/$1.rawlog"
}

# see NAME: NAME.csv, what the scans of a drive detect.
see() {
  "$bin/pole-eval" sightings --quiet --poles "$out/$1.rawlog" --output "$out/$1.csv" >/dev/null
}

# fit_detections OPTION...: the script that fits models and sums up tables.
fit_detections() {
  /usr/bin/python3 "$top/share/experiments/fit_detections.py" "$@"
}

# judge KIND SEED: metrics of both days' drives, of the map and of the localization, in one object.
judge() {
  for day in 0 1; do
    name=$1-$2-$day
    see "$name"
    fit_detections "$out/$name.csv" --summary "$out/$name.json"
    "$bin/pole-eval" repeatability --quiet --poles "$out/$name.rawlog" --truth "$out/$name.tum" \
      --json "$out/$name-repeated.json"
  done
  map_drive "$out/$1-$2-0" "$out/$1-$2.polemap"
  score_map 0.5 "$out/$1-$2-0_poles_gt.csv" "$out/$1-$2.polemap" "$out/$1-$2-map.json"
  localize_drive "$out/$1-$2-1" "$out/$1-$2.polemap" "$out/$1-$2-runs" --particles 1000 --runs 3 --seed 1
  evaluate_runs "$out/$1-$2-runs" "$out/$1-$2-1.tum"
  jq -n --arg kind "$1" --arg world "$2" \
    --slurpfile sight "$out/$1-$2-0.json" --slurpfile sight1 "$out/$1-$2-1.json" \
    --slurpfile again "$out/$1-$2-0-repeated.json" --slurpfile again1 "$out/$1-$2-1-repeated.json" \
    --slurpfile map "$out/$1-$2-map.json" --slurpfile runs "$out/$1-$2-runs/errors.json" '
    ($sight[0] | keys | map(select(. != "range_edges_m"))) as $keys
    | {kind: $kind, world: ($world | tonumber)}
    + ($keys | map({(.): (if . == "recall" then
          [$sight[0].recall, $sight1[0].recall] | transpose | map(add / length)
        else ($sight[0][.] + $sight1[0][.]) / 2 end)}) | add)
    + {repeated: (($again[0].share + $again1[0].share) / 2),
       map_precision: $map[0].precision, map_recall: $map[0].recall, map_f1: $map[0].f1,
       pos_mean: $runs[0].mean.pos_mean, ang_mean_deg: $runs[0].mean.ang_mean_deg}'
}

fitted=
for seed in 101 102 103; do
  for day in 0 1; do
    drive "cast-$seed-$day" "$seed" "$day" ""
    see "cast-$seed-$day"
    fitted="$fitted $out/cast-$seed-$day.csv"
  done
done
# shellcheck disable=SC2086
fit_detections $fitted --model "$out/hdl32e.json"

for seed in "$@"; do
  for day in 0 1; do
    drive "cast-$seed-$day" "$seed" "$day" ""
    drive "drawn-$seed-$day" "$seed" "$day" "$out/hdl32e.json"
  done
  judge cast "$seed"
  judge drawn "$seed"
done | jq -s . >"$out/result.json"

# shellcheck disable=SC2016,SC2046 # names of jq; a list of words
table "$out/result.json" 'def cell: if . == null then "-" else (. * 1000 | round / 1000 | tostring) end;
  [.[] | select(.kind == "cast")] as $cast | [.[] | select(.kind == "drawn")] as $drawn
  | def row(name; get): [name] + ([$cast, $drawn] | transpose | map(map(get | cell) | join(" / "))
      ) + [([$cast, $drawn] | map(map(get) | add / length | cell) | join(" / "))];
  row("detections per scan"; .per_scan), row("false per scan"; .false_per_scan),
  row("of lasting objects"; .lasting_false_per_scan),
  (range(0; $cast[0].recall | length) as $i | row("found, \($i * 5) to \($i * 5 + 5) m"; .recall[$i])),
  row("centre median, m"; .centre_median_m), row("centre 90 %, m"; .centre_p90_m), row("NEES mean"; .nees_mean),
  row("NEES median"; .nees_median), row("confidence"; .confidence), row("found again"; .repeated),
  row("way found, m"; .found_run_m), row("way missed, m"; .missed_run_m), row("map precision"; .map_precision),
  row("map recall"; .map_recall), row("map F1"; .map_f1), row("position error, m"; .pos_mean),
  row("heading error, deg"; .ang_mean_deg)' "cast / drawn" $(printf 'world-%s ' "$@") mean | tee "$out/table.txt"
