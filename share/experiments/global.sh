#!/bin/sh
# No start pose: random starts in simulated cities of 6 km, on the map of another day.
# Usage: share/experiments/global.sh TRACKS OUT [--dense] [--quick]
#   TRACKS   folder of the roads kaist01.txt.gz and kaist02.txt.gz (sensor poses, 12 numbers a line)
#   OUT      gets maps, drives, one JSON file a city and result.json
#   --dense  2.6 times as many poles as the simulator's default
#   --quick  one city, 40 starts
# The poles of each scan are drawn from share/models/hdl32e.json; odometry is that of wheels. Worlds 601 to 604; settings
# were chosen on other worlds. Programs: build/bin, or POLEMCL_BIN. Needs jq.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 any "$@"
tracks=$1
make_out "$2"
shift 2
cities="601:kaist01 602:kaist02 603:kaist01 604:kaist02" trials=50 density=
for option in "$@"; do
  case $option in
    --dense) density="world.tree_share=1 world.tree_spacing_m=4 world.lamp_spacing_m=9 world.sign_spacing_m=8" ;;
    --quick) cities=602:kaist02 trials=40 ;;
    *) usage ;;
  esac
done
find_programs pole-simulate pole-map pole-eval
find_tools jq

# drive CITY DAY TRACK: OUT/CITY-DAY.ini .rawlog .tum
drive() {
  # shellcheck disable=SC2086 # several words
  draw_drive "$out/$1-$2" "$top/config/hdl32e.ini" "$1" "$2" simulation.speed_m_s=5 \
    "world.track=$tracks/$3.txt.gz" $density
}

for city in $cities; do
  seed=${city%%:*}
  for day in 0 1; do drive "$seed" "$day" "${city#*:}"; done
  map_drive "$out/$seed-0" "$out/$seed.polemap"
  "$bin/pole-eval" global --quiet --config "$out/$seed-1.ini" --map "$out/$seed.polemap" \
    --input "$out/$seed-1.rawlog" --truth "$out/$seed-1.tum" --trials "$trials" --seed "$seed" \
    --json "$out/$seed.json"
  jq -s add "$out/$seed.json" "$out/${seed}_timings.json" >>"$out/results"
done
collect_results '{cities: ., starts: (map(.trials) | add), right: (map(.right) | add),
  wrong: (map(.wrong) | add), undecided: (map(.undecided) | add), ok_wrong: (map(.ok_wrong) | add),
  query_max_ms: (map(.query_max_ms) | max)}
  | .right_share = .right / .starts | .wrong_share = .wrong / .starts'
table "$out/result.json" '.cities | to_entries[] | [.key + 1] + (.value | [.map_poles, .trials, .right, .wrong,
  .undecided, .metres_median, .metres_p95, .error_median_m, .query_max_ms])' city "map poles" starts right wrong \
  undecided metres:1 "95 %:1" "error m:3" "query ms:1"
jq -r '"\(.starts) starts: right \(.right), wrong \(.wrong), undecided \(.undecided); "
  + "ok said of a wrong pose \(.ok_wrong); longest step with a search \(.query_max_ms * 10 | round / 10) ms"' \
  "$out/result.json"
