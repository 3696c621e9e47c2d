#!/bin/sh
# What each deviation of [realism] costs the extraction: precision, recall and F1 of single scans with each one
# alone, with none, and with all at their usual rates.
# Usage: share/experiments/realism.sh OUT [SENSOR [SEED...]]
#   OUT     gets result.json and table.txt
#   SENSOR  hdl64e, hdl32e, os1_64 or vlp16; hdl32e unless given
#   SEED    of the worlds, 321 and 322 unless given; not fitted on
# Streets of 160 m, a scan every 10 m. Alone, half of the poles are crooked, tapered, leaning, beside a hedge,
# ...; the LiDAR's deviations have their usual rates, rain 10 mm/h. "multiple": each post is a pole of its own.
# Programs: build/bin, or POLEMCL_BIN. Needs jq, 5 minutes on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=share/experiments/extraction-parts.sh
. "$top/share/experiments/extraction-parts.sh"

check_arguments 1 any "$@"
out=$1
sensor=${2-hdl32e}
shift
[ $# = 0 ] || shift
seeds=${*:-321 322}
find_tools jq
find_programs pole-simulate pole-eval
mkdir -p "$out"
: >"$out/scores"

objects="crooked tapered leaning multiple boxes ivy hedges"
lidar="range_bias_m range_walk_m dark_dropout rain_mm_h spray"

# score NAME OPTION...: one line in $out/scores for each world.
score() {
  name=$1
  shift
  for seed in $seeds; do
    rm -rf "$out/scans"
    "$bin/pole-simulate" --quiet --config "$(scan_line_settings "$sensor")" --output "$out/scans" \
      --poles "$out/poles.rawlog" --seed "$seed" --length 162 --set simulation.spacing_m=10 "$@"
    "$bin/pole-eval" detections --quiet --scans "$out/scans" --poles "$out/poles.rawlog" --json "$out/score.json"
    jq -c --arg name "$name" '{name: $name, detections, right, visible, found}' "$out/score.json" >>"$out/scores"
  done
}

score none
off=
for key in $objects $lidar; do off="$off --set realism.$key=0"; done
for key in $objects; do
  # shellcheck disable=SC2086 # several words
  score "$key" --set realism.scale=1 $off --set "realism.$key=0.5"
done
for key in $lidar; do
  kept=
  for other in $objects $lidar; do [ "$other" = "$key" ] || kept="$kept --set realism.$other=0"; done
  [ "$key" != rain_mm_h ] || kept="$kept --set realism.rain_mm_h=10"
  # shellcheck disable=SC2086
  score "$key" --set realism.scale=1 $kept
done
score all --set realism.scale=1
rm -rf "$out/scans" "$out/poles.rawlog" "$out/score.json" "$out"/poles*

jq -s --arg sensor "$sensor" --arg worlds "$seeds" '
  def digits: . * 10000 | round / 10000;
  def total(key): map(.[key]) | add;
  . as $all | (reduce .[].name as $n ([]; if index($n) then . else . + [$n] end)) as $names
  | {sensor: $sensor, worlds: ($worlds | split(" ") | map(tonumber)), spacing_m: 10,
     deviations: ($names | map(. as $n | [$all[] | select(.name == $n)]
       | (total("right") / total("detections")) as $p | (total("found") / total("visible")) as $r
       | {name: $n, detections: total("detections"), visible: total("visible"), precision: ($p | digits),
          recall: ($r | digits), f1: (2 * $p * $r / ($p + $r) | digits)}))}' "$out/scores" >"$out/result.json"
rm "$out/scores"
jq -r '["deviation", "precision", "recall", "F1"], (.deviations[] | [.name, .precision, .recall, .f1]) | @tsv' \
  "$out/result.json" | awk -F '\t' '{ printf "%-14s %10s %8s %8s\n", $1, $2, $3, $4 }' >"$out/table.txt"
cat "$out/table.txt"
