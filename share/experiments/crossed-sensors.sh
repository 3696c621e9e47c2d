#!/bin/sh
# Maps of one LiDAR used with another one: errors for each pair.
# Usage: share/experiments/crossed-sensors.sh OUT [KILOMETRE] [SEED...]
#   OUT        gets result.json and table.txt
#   KILOMETRE  the scans of kitti_odom_00_km as a folder (real-drives.sh): odd scans localized in the map of the even
#              ones, each with all 64 rings, with 32 and with 16 (thin_rings.py); truth + 2 %, seed 7
#   SEED       worlds, 604 and 605 unless given: 300 m cast with four LiDARs, the map on day 0, localized on day 1;
#              odometry of wheels, 1 % too long and 0.01 deg/m off
# Start within 2.5 m and 5 degrees, filter seeds 1 to 5. The settings are those of the LiDAR in use.
# Programs: build/bin, or POLEMCL_BIN. Needs jq and python3-numpy; twenty minutes on two cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=share/experiments/extraction-parts.sh
. "$top/share/experiments/extraction-parts.sh"

check_arguments 1 any "$@"
make_out "$1"
shift
kilometre=""
if [ -d "${1-}" ]; then
  kilometre=$(cd "$1" && pwd)
  shift
fi
[ $# -gt 0 ] || set -- 604 605
find_programs pole-simulate pole-import pole-extract pole-map pole-localize
find_tools jq

# score STREET MAP LIDAR: localizes LIDAR/day1 in the map of MAP/day0; adds a line to $out/results.
score() {
  localize_drive "$here/$3/day1" "$here/$2/map.polemap" "$here/runs" --runs 5 --seed 1
  evaluate_runs "$here/runs" "$here/$3/day1.tum"
  jq -s --arg street "$1" --arg map "$2" --arg lidar "$3" '{street: $street, map: $map, lidar: $lidar,
    pos_mean: (map(.pos_mean) | add / length), ang_mean_deg: (map(.ang_mean_deg) | add / length),
    pos_max: (map(.pos_max) | max)}' "$here"/runs/run_0?.json >>"$out/results"
  rm -r "$here/runs"
}

# crossed STREET LIDAR...: maps of all, and each in each.
crossed() {
  street=$1
  shift
  for lidar in "$@"; do map_drive "$here/$lidar/day0" "$here/$lidar/map.polemap"; done
  for map in "$@"; do
    for lidar in "$@"; do score "$street" "$map" "$lidar"; done
  done
}

# thinned EVERY: poles of the even scans as day 0, of the odd ones as day 1, with every EVERY-th ring.
thinned() {
  lidar=$here/rings-$((64 / $1))
  mkdir -p "$lidar"
  "$top/share/experiments/thin_rings.py" "$kilometre" "$lidar/scans" "$1" "$top/config/kitti.ini"
  for day in 0 1; do
    cp "$lidar/scans/settings.ini" "$lidar/day$day.ini"
    # shellcheck disable=SC2086 # several words
    find_poles "$lidar/scans" "$lidar/day$day" "$lidar/day$day.ini" --every 2 --offset $day --odometry-noise 0.02 \
      --seed 7 $clockwise
  done
  rm -r "$lidar/scans"
}

if [ -n "$kilometre" ]; then
  here=$out/kilometre
  for every in 1 2 4; do thinned $every; done
  crossed kilometre rings-64 rings-32 rings-16
fi
for seed in "$@"; do
  here=$out/$seed
  for lidar in hdl64e os1_64 hdl32e vlp16; do
    for day in 0 1; do simulate_day "$(scan_line_settings $lidar)" "$here/$lidar" "$seed" 300 $day; done
  done
  crossed "$seed" hdl64e os1_64 hdl32e vlp16
done

collect_results .
table "$out/result.json" '.[] | [.street, .map, .lidar, .pos_mean, .ang_mean_deg, .pos_max]' \
  street map lidar "mean m:4" "mean deg:4" "worst m:4" | tee "$out/table.txt"
