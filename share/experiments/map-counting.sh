#!/bin/sh
# What becomes a pole of a map: counted sections ([map] counting = run) against summed confidences.
# Usage: share/experiments/map-counting.sh OUT [FIRST [WORLDS]]
#   OUT     gets maps, result.json and table.txt
#   FIRST   seed of the first world, 311 unless given; worlds 301 to 304 chose the defaults
#   WORLDS  number of worlds, 3 unless given
# Streets of 200 m with cast scans, one each metre, for three LiDARs with their settings of config/. Map
# from true poses, against all true poles of the street, one to one within 0.5 m.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; four minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
make_out "$1"
first=${2:-311}
last=$((first + ${3:-3} - 1))
find_programs pole-simulate pole-import pole-extract pole-map pole-eval
find_tools jq

# build SENSOR WORLD RULE SETTINGS: a map, and a line of $out/results.
build() {
  here=$out/$1-$2
  # shellcheck disable=SC2086 # several words
  "$bin/pole-map" build --quiet --config "$here/street.ini" $4 --input "$here/poles.rawlog" \
    --truth "$here/poles.tum" --output "$here/$3.polemap"
  score_map 0.5 "$here/poles.csv" "$here/$3.polemap" "$here/$3.json"
  jq -c --arg sensor "$1" --argjson world "$2" --arg rule "$3" \
    '{sensor: $sensor, world: $world, rule: $rule, precision, recall, f1, matches, map_poles, truth_poles}' \
    "$here/$3.json" >>"$out/results"
}

for sensor in kitti hdl32e vlp16; do
  # The former defaults beside those of today.
  today="--set map.min_confidence=0.5" # what 0 stands for where scans are read
  former="--set map.min_count=5 $today"
  if [ $sensor = kitti ]; then # its own settings
    today="" former="--set map.min_count=3"
  fi
  former="--set map.counting=run --set map.min_share=0.4 $former"
  for world in $(seq "$first" "$last"); do
    here=$out/$sensor-$world
    mkdir -p "$here"
    copy_settings "$top/config/$sensor.ini" "$here/street.ini" simulation.spacing_m=1.0 world.length_m=200 \
      "world.seed=$world"
    "$bin/pole-simulate" --quiet --config "$here/street.ini" --output "$here/scans"
    copy_settings "$here/street.ini" "$here/poles.ini" scan_line.min_confidence=0.3
    find_poles "$here/scans" "$here/poles" "$here/poles.ini"
    mv "$here/scans/poles_gt.csv" "$here/poles.csv"
    rm -r "$here/scans"
    build $sensor "$world" run "$former"
    build $sensor "$world" confidences "$today"
  done
done

collect_results .
table "$out/result.json" 'def share(f): (map(.matches) | add) / (map(f) | add); group_by([.sensor, .rule])[] | [.[0].sensor,
  .[0].rule, share(.map_poles), share(.truth_poles), share((.map_poles + .truth_poles) / 2), (map(.f1) | min)]' \
  config counting precision:3 recall:3 F1:3 "worst F1:3" | tee "$out/table.txt"
