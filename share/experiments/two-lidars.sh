#!/bin/sh
# Two LiDARs on one vehicle against each of them alone, and with a wrong pose or clock of one.
# Usage: share/experiments/two-lidars.sh OUT [FIRST [WORLDS [LENGTH]]]
#   OUT     gets drives, maps, runs, result.json and table.txt
#   FIRST   first world, 861 unless given; WORLDS: their number, 3 unless given
#   LENGTH  of the streets, 200 m unless given
# Cast scans of simulated streets by two VLP-16, 1.2 m ahead and behind and 0.5 m aside, 10 m/s, ten turns a
# second, scans distorted by the motion. The map is that of both LiDARs on one day, the localization that of
# another day in the opposite direction. Odometry of wheels, 1 % too long and 0.01 deg/m off, start within 2.5 m
# and 5 degrees, filter seeds 1 to 5.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; five minutes of two cores and 2 GB of disk.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 4 "$@"
make_out "$1"
first=${2:-861}
last=$((first + ${3:-3} - 1))
length=${4:-200}
find_programs pole-simulate pole-import pole-map pole-localize pole-eval
find_tools jq python3

front="1.2 0.5 0"
stern="-1.2 -0.5 0"

# cast DAY LIDAR ORIGIN: scans of one LiDAR, $here/LIDAR-dayN.rawlog.
cast() {
  reverse=false
  [ "$1" = 0 ] || reverse=true
  # shellcheck disable=SC2086 # several words
  copy_settings "$top/config/vlp16.ini" "$here/$2.ini" $wheels simulation.speed_m_s=10 \
    simulation.spacing_m=1 simulation.motion_distortion=true "simulation.reverse=$reverse" \
    "world.length_m=$length" "world.seed=$world" "world.day=$1" "sensor.origin=$3"
  "$bin/pole-simulate" --quiet --config "$here/$2.ini" --output "$here/$2-day$1"
  "$bin/pole-import" folder --quiet --input "$here/$2-day$1" --output "$here/$2-day$1.rawlog"
}

# score NAME INI [OPTION...]: localizes with these LiDARs; adds a line to $out/results.
score() {
  name=$1
  ini=$2
  shift 2
  "$bin/pole-localize" --quiet --config "$here/$ini.ini" --input "$here/day1.rawlog" --map "$here/map.polemap" \
    --truth "$here/front-day1.tum" --output "$here/$name" --runs 5 --seed 1 "$@"
  jq --arg name "$name" --arg world "$world" \
    '{name: $name, world: $world, pos_mean, ang_mean_deg, poles_per_scan, apart_m: .lidars[-1].apart_m,
      apart_sigmas: .lidars[-1].apart_sigmas}' "$here/$name/summary.json" >>"$out/results"
}

for world in $(seq "$first" "$last"); do
  here=$out/$world
  mkdir -p "$here"
  for day in 0 1; do
    cast "$day" front "$front"
    cast "$day" stern "$stern"
    "$top/share/experiments/join_lidars.py" "$here/front-day$day.rawlog" "$here/stern-day$day.rawlog" \
      "$here/day$day.rawlog"
  done
  copy_settings "$top/config/vlp16.ini" "$here/two.ini" "vehicle.lidars=front stern" \
    "sensor:front.origin=$front" "sensor:stern.origin=$stern"
  "$bin/pole-map" build --quiet --config "$here/two.ini" --input "$here/day0.rawlog" \
    --truth "$here/front-day0.tum" --output "$here/map.polemap"
  copy_settings "$top/config/vlp16.ini" "$here/front.ini" vehicle.lidars=front "sensor:front.origin=$front"
  copy_settings "$top/config/vlp16.ini" "$here/stern.ini" vehicle.lidars=stern "sensor:stern.origin=$stern"
  score front front
  score stern stern
  score both two
  score stern-moved-0.1-m two --set "sensor:stern.pose=0 0.1 0 0 0 0"
  score stern-turned-1-deg two --set "sensor:stern.pose=0 0 0 1 0 0"
  score stern-clock-0.05-s two --set sensor:stern.clock_offset_s=0.05
done
collect_results 'group_by(.name) | map({name: .[0].name, worlds: length, pos_mean: (map(.pos_mean) | add / length),
  worst_world_m: (map(.pos_mean) | max), ang_mean_deg: (map(.ang_mean_deg) | add / length),
  poles_per_scan: (map(.poles_per_scan) | add / length), apart_m: (map(.apart_m) | add / length),
  apart_sigmas: (map(.apart_sigmas) | add / length)})'
table "$out/result.json" '.[] | [.name, .pos_mean, .worst_world_m, .ang_mean_deg, .poles_per_scan, .apart_m, .apart_sigmas]' \
  LiDARs "mean m:4" "worst world:4" "mean deg:4" "poles/scan:1" "apart m:3" "apart sigma:1" | tee "$out/table.txt"
