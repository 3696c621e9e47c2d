#!/bin/sh
# Measures how sigma, outlier share, gate and model of the likelihood change the accuracy: one setting at
# a time, on simulated HDL-32E streets (odometry with 2 % noise) and on the real KITTI drive split. Writes a table
# and its data as JSON.
# Usage: share/experiments/likelihood-sweep.sh DATA_DIR OUT [LENGTH [WORLD...]]
#   DATA_DIR  a folder of real scans with poses (kitti_raw_0005)
#   OUT       gets the poles of the drives (used again if they exist), table.txt, sweep.json
#   LENGTH    of each street, 400 m unless given; WORLD: seeds, 21 22 unless given
# Programs: build/bin, or POLEMCL_BIN. Needs jq. 10 minutes on 2 cores, half of it simulation.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 any "$@"
data=$1
make_out "$2"
length=${3:-400}
shift 2
[ $# = 0 ] || shift
[ $# != 0 ] || set -- 21 22
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
find_tools jq

for world in "$@"; do
  folder=$out/world$world
  [ -f "$folder/map.polemap" ] && continue
  # shellcheck disable=SC2086,SC2154 # several words
  for day in 0 1; do
    simulate_day "$top/config/hdl32e.ini" "$folder" "$world" "$length" $day $noise
  done
  map_drive "$folder/day0" "$folder/map.polemap"
done
"$top/share/experiments/kitti-split.sh" "$data" "$out/split" >/dev/null
"$bin/pole-extract" --quiet --config "$top/config/kitti.ini" --input "$out/split/odd.rawlog" \
  --output "$out/split/poles.rawlog"

# localize FOLDER CONFIG POLES TRUTH: mean errors of 3 runs, as JSON.
localize() {
  "$bin/pole-localize" --quiet --config "$2" --input "$1/$3" --map "$1/map.polemap" \
    --truth "$1/$4" --output "$1/sweep" --particles 1000 --runs 3 --seed 1
  evaluate_runs "$1/sweep" "$1/$4"
  jq .mean "$1/sweep/errors.json"
}

# try_setting KEY VALUE WORLD...: adds a line to $out/results.
try_setting() {
  key=$1
  value=$2
  shift 2
  for config in hdl32e kitti; do
    cp "$top/config/$config.ini" "$out/$config.ini"
    [ "$key" = default ] || copy_settings "$top/config/$config.ini" "$out/$config.ini" "likelihood.$key=$value"
  done
  {
    for world in "$@"; do localize "$out/world$world" "$out/hdl32e.ini" day1.rawlog day1.tum; done
    localize "$out/split" "$out/kitti.ini" poles.rawlog odd.tum
  } | jq -s --arg key "$key" --arg value "$value" 'def mean(f): .[:-1] | map(f) | add / length * 100000 | round / 100000;
    {key: $key, value: $value, street_m: mean(.pos_mean), street_deg: mean(.ang_mean_deg), split_m: .[-1].pos_mean,
      split_deg: .[-1].ang_mean_deg}' >>"$out/results"
}

try_setting default - "$@"
for value in 0.01 0.02 0.03 0.05 0.08 0.15 0.3; do try_setting sigma_m $value "$@"; done
for value in 0.01 0.02 0.05 0.1 0.2 0.4; do try_setting outlier $value "$@"; done
for value in 0.3 0.5 1 2; do try_setting gate_m $value "$@"; done
try_setting weighted false "$@"
try_setting model paper "$@"

jq -s . "$out/results" >"$out/sweep.json"
rm "$out/results"
echo "One setting changed at a time; streets of $length m, worlds $*; 3 runs each"
table "$out/sweep.json" '.[] | [.key, .value, .street_m, .street_deg, .split_m, .split_deg]' \
  setting value "streets m:4" "streets deg:3" "KITTI split m:4" "KITTI split deg:3" | tee "$out/table.txt"
