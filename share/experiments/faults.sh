#!/bin/sh
# Checks whether the localization notices faults, and recovers. Drives are simulated at 10 Hz and 7 m/s
# along a 6 km road (poles drawn by the model of share/models/hdl32e.json, another day and another
# drive than the map's, odometry of wheels, 1 % too long). 200 trials each on five worlds: kidnapped, wrong
# map, blind; odometry stuck, slipping, jumping, of another clock; a LiDAR moved; half of the poles gone; false
# poles; scans that come late, in another order. Also: whole drives with half of the poles gone and twice the
# false detections, and healthy drives of 10 h.
# Usage: share/experiments/faults.sh [--quick] OUT [FIRST [TRACK]]
#   OUT      gets maps, drives, one JSON and one text for each fault, table.txt and faults.json
#   FIRST    first of the five worlds; 521 unless given
#   TRACK    the road as poses, 12 numbers a line, plain or gzip; $POLEMCL_DATA/tracks/kaist01.txt.gz unless
#            given; without either, the simulator's own street of 3 km
#   --quick  one world, 20 trials each, one healthy drive
# Faults are seeded 501.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; half an hour on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

worlds=5
trials=40
healthy=9 # drives of each world; 45 of 0.24 h are 10.9 h
if [ "${1:-}" = --quick ]; then
  worlds=1
  trials=20
  healthy=1
  shift
fi
check_arguments 1 3 "$@"
make_out "$1"
first=${2:-521}
track=${3:-${POLEMCL_DATA:+$POLEMCL_DATA/tracks/kaist01.txt.gz}}
road=world.length_m=3000
[ -z "$track" ] || road=world.track=$track
find_programs pole-simulate pole-map pole-eval
find_tools jq

# drive NAME WORLD DAY DRIVE [SECTION.KEY=VALUE...]: NAME.rawlog, NAME.tum, with the settings NAME.ini.
drive() {
  path=$out/$1 town=$2 day=$3 number=$4
  shift 4
  draw_drive "$path" "$top/config/hdl32e.ini" "$town" "$day" simulation.spacing_m=0.7 \
    simulation.speed_m_s=7 "simulation.drive_seed=$number" "$road" "$@"
}

# map_of WORLD: the map of day 0, mapWORLD.polemap.
map_of() {
  drive "map$1" "$1" 0 1
  map_drive "$out/map$1" "$out/map$1.polemap"
}

# faults WORLD DRIVE FAULT TRIALS SEED OPTIONS...: appends to FAULT.txt, writes FAULT_WORLD_DRIVE.json.
faults() {
  world=$1 drive=$2 fault=$3 count=$4 from=$5
  shift 5
  name=$drive.$fault
  echo "world $world" >>"$out/$fault.txt"
  "$bin/pole-eval" faults --config "$top/config/hdl32e.ini" --map "$out/map$world.polemap" \
    --input "$out/$drive.rawlog" --truth "$out/$drive.tum" --fault "$fault" --trials "$count" \
    --seed "$from" --json "$out/$name.json" "$@" >>"$out/$fault.txt"
}

kinds="kidnap wrong-map $lasting"
for fault in $kinds none; do rm -f "$out"/*."$fault.json" "$out/$fault.txt"; done

map_of 599 # the wrong map: another town on the same road
seed=501
for world in $(seq "$first" $((first + worlds - 1))); do
  map_of "$world"
  drive "day$world" "$world" 1 2
  for fault in kidnap $lasting; do
    faults "$world" "day$world" "$fault" "$trials" "$seed"
  done
  faults "$world" "day$world" wrong-map "$trials" "$seed" --other-map "$out/map599.polemap" --tail 60
  # Half of the poles gone, twice the false detections.
  drive "half$world" "$world" 1 2 world.removed_share=0.5 simulation.false_factor=2
  faults "$world" "half$world" none 1 "$seed"
  i=0
  while [ "$i" -lt "$healthy" ]; do
    i=$((i + 1))
    drive "healthy" "$world" "$i" $((10 + i))
    faults "$world" "healthy" none 1 $((seed + i))
    mv "$out/healthy.none.json" "$out/healthy$world-$i.none.json"
    rm "$out"/healthy.*
  done
  seed=$((seed + 1000))
done

{
  for fault in $kinds; do fault_results "$fault" "$out"/*."$fault".json; done
  fault_results healthy "$out"/healthy*.none.json
  fault_results half "$out"/half*.none.json
} | jq -s add >"$out/faults.json"
{
  fault_table "$out/faults.json"
  echo
  table "$out/faults.json" 'def mean(f): (map(f * .scans) | add) / (map(.scans) | add);
    {healthy, half} | to_entries[] | [.key] + (.value | [(map(.hours) | add), (map(.scans) | add),
    (map(.lost_times) | add), (map(.degraded_times) | add), mean(.ok_share), (map(.longest_not_ok_s) | max),
    (map(.ok_with_wrong_pose) | add), mean(.error_mean_m), (map(.error_max_m) | max),
    (map(.ok_beyond_5_sigma_max_s) | max)])' drives hours:2 scans lost degraded "ok share:5" "longest s:1" "wrong ok" \
    "mean m:4" "max m:3" "beyond 5 sigma max s:1"
} | tee "$out/table.txt"
