#!/bin/sh
# Imports a ROS 2 bag without ROS: a simulated street of 60 m (world 512), scanned while driving, is
# written as bags in SQLite and MCAP by Python alone, and imported from the bags and from the folder.
# Usage: share/experiments/rosbag2.sh OUT
# Programs: build/bin, or POLEMCL_BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 1 "$@"
out=$1
find_programs pole-simulate pole-import pole-extract
mkdir -p "$out/bag" "$out/mcap"
rm -f "$out/bag/street_0.db3"

config=$out/street.ini
copy_settings "$top/config/hdl32e.ini" "$config" simulation.spacing_m=1 simulation.motion_distortion=true \
  world.length_m=60 world.seed=512
"$bin/pole-simulate" --quiet --config "$config" --output "$out/scans"
"$bin/pole-import" folder --quiet --input "$out/scans" --output "$out/direct.rawlog"

# Clouds as a driver sends them, with ring and time since the stamp; odometry at the stamps.
python3 "$top/share/experiments/write_rosbag2.py" "$out/scans" "$out/bag/street_0.db3" "$out/mcap/street_0.mcap"

for way in bag mcap; do
  "$bin/pole-import" rosbag2 --input "$out/$way" --output "$out/$way.rawlog"
done
for way in direct bag mcap; do
  "$bin/pole-extract" --quiet --config "$config" --input "$out/$way.rawlog" \
    --output "$out/$way-poles.rawlog" --csv "$out/$way.csv"
  cut -d, -f1,3- "$out/$way.csv" >"$out/$way.cut" # without the times, which differ by 1.5e9 s
done
for way in bag mcap; do
  cmp "$out/$way.cut" "$out/direct.cut"
  echo "$way: poles of all scans: the same"
done
