#!/bin/sh
# The year of config/batches/year.ini, and its maps against the true poles.
# Usage: share/experiments/year.sh OUT [WORLD [RUNS]]
#   OUT    gets the batch, result.json and table.txt; an unfinished batch there is resumed
#   WORLD  seed of the street, 500 unless given
#   RUNS   runs of the filter, 10 unless given
# The batch keeps a map up by the localizer's own poses, and localizes in the never changed map as well. Here
# the same map is also kept up with true poses. Each month's map is compared with the poles of the world on
# that day, within 0.5 m, one to one: precision against all of them; recall against those within 20 m of the main
# street, as the side streets of the detours are on no map (recall_all counts these, too).
# Programs: build/bin, or POLEMCL_BIN. Needs jq; ten minutes on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
make_out "$1"
world=${2:-500}
runs=${3:-10}
find_programs pole-batch pole-map pole-eval
find_tools jq
batch=$out/batch
tasks=$batch/tasks
config=$top/config/hdl32e.ini

sed "s/world\.seed=500/world.seed=$world/" "$top/config/batches/year.ini" >"$out/year.ini"
for key in config input; do sed -i "s#^$key = config/#$key = $top/config/#" "$out/year.ini"; done
cp "$top/share/models/hdl32e.json" "$out/"
sed -i 's#detections=hdl32e.json#detections={here}/hdl32e.json#' "$out/year.ini"
resume=
[ ! -d "$batch" ] || resume=--resume
"$bin/pole-batch" "$out/year.ini" --quiet --output "$batch" --set "batch.runs=$runs" $resume

# near POLES PATH: the poles of the table within 20 m of the trajectory
near() {
  awk 'NR == FNR { split($0, row, " "); if (row[1] != "#") { x[++n] = row[2]; y[n] = row[3] }; next }
    FNR == 1 { print; next }
    { split($0, pole, ","); for (i = 1; i <= n; i += 4)
        if ((pole[2] - x[i]) ^ 2 + (pole[3] - y[i]) ^ 2 < 400) { print; next } }' "$2" "$1"
}

# score SETTING MONTH MAP: adds a line to OUT/maps
score() {
  poles=$tasks/poles.$2/$2_poles_gt.csv
  near "$poles" "$tasks/poles.may/may.tum" >"$out/near.csv"
  score_map 0.5 "$poles" "$3" "$out/all.json"
  score_map 0.5 "$out/near.csv" "$3" "$out/near.json"
  jq -n --arg setting "$1" --arg month "$2" --slurpfile all "$out/all.json" --slurpfile near "$out/near.json" \
    '$all[0] as $a | $near[0] as $n | {setting: $setting, month: $month, poles: $a.map_poles,
      precision: $a.precision, recall: $n.recall, f1: (2 * $a.precision * $n.recall / ($a.precision + $n.recall)),
      recall_all: $a.recall, f1_all: $a.f1, shift_m: ([$n.shift_x_m, $n.shift_y_m] | map(. * .) | add | sqrt),
      rotation_deg: $n.rotation_deg}' >>"$out/maps"
}

: >"$out/maps"
map=$tasks/map.upkeep.may/map.polemap
for month in may june july august september october november december january february march april; do
  score upkeep $month "$tasks/map.upkeep.$month/map.polemap"
  score never $month "$tasks/map.never.may/map.polemap"
  if [ $month != may ]; then
    date=$(sed -n "/^\[session $month\]/,/^date/s/^date = //p" "$out/year.ini")
    "$bin/pole-map" update --quiet --config "$config" --map "$map" --input "$tasks/poles.$month/$month.rawlog" \
      --truth "$tasks/poles.$month/$month.tum" --date "$date" --output "$out/truth.polemap"
    map=$out/truth.polemap
  fi
  score truth $month "$map"
done
jq -s --argjson world "$world" --argjson runs "$runs" '{world: $world, runs: $runs, maps: .}' \
  "$out/maps" >"$out/maps.json"
# sessions.csv: setting, session, mean error of the position, shares of the health
awk -F , 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
  $(at["pos_mean"]) != "" {
    printf "{\"setting\": \"%s\", \"session\": \"%s\", ", $(at["setting"]), $(at["session"])
    printf "\"pos_mean_m\": %s, \"ok\": %s, \"lost_runs\": %s}\n",
      $(at["pos_mean"]), $(at["ok_share"]), $(at["lost"]) }' "$batch/sessions.csv" |
  jq -s '{sessions: ., mean: (group_by(.setting) | map({setting: .[0].setting,
    pos_mean_m: (map(.pos_mean_m) | add / length), last_to_first: (.[-1].pos_mean_m / .[0].pos_mean_m)}))}' \
    >"$out/errors.json"
jq -s '.[0] + .[1]' "$out/maps.json" "$out/errors.json" >"$out/result.json"
rm "$out/maps" "$out/maps.json" "$out/errors.json" "$out/all.json" "$out/near.json" "$out/near.csv" "$out/truth.polemap"
{
  table "$out/result.json" '.maps | sort_by(.setting)[] | [.setting, .month, .poles, .precision, .recall, .f1, .f1_all,
    .shift_m, .rotation_deg]' map month poles precision:4 recall:4 F1:4 "F1 all:4" "shift m:4" "turn deg:5"
  jq -r '.mean[] | "\(.setting): mean error \(.pos_mean_m) m, last session to first \(.last_to_first)"' \
    "$out/result.json"
} | tee "$out/table.txt"
