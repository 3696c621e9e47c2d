#!/bin/sh
# What the deviations of [realism] cost the extraction: precision, recall and F1 of single scans without them, at half
# of their usual rates, at the usual ones, and at twice as much.
# Usage: share/experiments/realism.sh OUT [SENSOR [SEED...]]
#   OUT     gets result.json and table.txt
#   SENSOR  hdl64e, hdl32e, os1_64 or vlp16; hdl32e unless given
#   SEED    of the worlds, 321 and 322 unless given; not fitted on
# Streets of 160 m, a scan every 10 m. A post of a pole that has several counts as a pole of its own.
# Programs: build/bin, or POLEMCL_BIN. Needs jq, 5 minutes on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=share/experiments/extraction-parts.sh
. "$top/share/experiments/extraction-parts.sh"

check_arguments 1 any "$@"
make_out "$1"
sensor=${2-hdl32e}
shift
[ $# = 0 ] || shift
seeds=${*:-321 322}
find_tools jq
find_programs pole-simulate pole-eval
: >"$out/scores"

for scale in 0 0.5 1 2; do
  for seed in $seeds; do
    rm -rf "$out/scans"
    "$bin/pole-simulate" --quiet --config "$(scan_line_settings "$sensor")" --output "$out/scans" \
      --poles "$out/poles.rawlog" --seed "$seed" --length 162 --set simulation.spacing_m=10 \
      --set "realism.scale=$scale"
    "$bin/pole-eval" detections --quiet --scans "$out/scans" --poles "$out/poles.rawlog" --json "$out/score.json"
    jq -c --argjson scale "$scale" '{scale: $scale, detections, right, visible, found}' "$out/score.json" \
      >>"$out/scores"
  done
done
rm -rf "$out/scans" "$out/poles.rawlog" "$out/score.json" "$out"/poles*

jq -s --arg sensor "$sensor" --arg worlds "$seeds" '
  def digits: . * 10000 | round / 10000;
  {sensor: $sensor, worlds: ($worlds | split(" ") | map(tonumber)), spacing_m: 10,
   scales: (group_by(.scale) | map((map(.right) | add) as $right | (map(.detections) | add) as $detections
     | (map(.found) | add) as $found | (map(.visible) | add) as $visible
     | ($right / $detections) as $p | ($found / $visible) as $r
     | {scale: .[0].scale, detections: $detections, visible: $visible, precision: ($p | digits),
        recall: ($r | digits), f1: (2 * $p * $r / ($p + $r) | digits)}))}' "$out/scores" >"$out/result.json"
rm "$out/scores"
table "$out/result.json" '.scales[] | [.scale, .precision, .recall, .f1]' scale precision:4 recall:4 F1:4 |
  tee "$out/table.txt"
