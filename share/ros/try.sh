#!/bin/sh
# Builds the node polemcl_ros, plays it a bag of a simulated drive, and compares its poses with those of pole-localize
# on the same bag. Then again with the global search and a start pose on the way. Nothing leaves this machine.
# Usage: share/ros/try.sh ROS OUT
#   ROS  where ROS 2 is installed, such as /opt/ros/jazzy
#   OUT  gets bag, build and results
# Programs: build/bin, or POLEMCL_BIN; the library: build/, or POLEMCL_BUILD.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 2 "$@"
ros=$(cd "$1" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
find_programs pole-simulate pole-import pole-map pole-localize
rm -rf "$out/bag" "$out/runs"
mkdir -p "$out/bag" "$out/node"

echo "1/4 Simulating a drive on the map's day and another; a bag of the other"
# The LiDAR stands turned by 90 deg: its cut, at the back of the robot, is at 90 deg in its frame.
for day in 0 1; do
  copy_settings "$top/config/demo.ini" "$out/day$day.ini" world.length_m=120 "world.day=$day" \
    simulation.motion_distortion=true
  rm -rf "$out/scans$day"
  "$bin/pole-simulate" --quiet --config "$out/day$day.ini" --output "$out/scans$day"
  "$bin/pole-import" folder --quiet --input "$out/scans$day" --output "$out/day$day.rawlog"
done
"$bin/pole-map" build --quiet --config "$out/day0.ini" --input "$out/day0.rawlog" --truth "$out/day0.tum" \
  --output "$out/map.polemap"
"$top/share/experiments/write_rosbag2.py" "$out/scans1" "$out/bag/drive_0.db3" "$out/drive_0.mcap" 90
rm "$out/drive_0.mcap"

echo "2/4 pole-localize on the bag"
copy_settings "$top/config/demo.ini" "$out/robot.ini" sensor.turn=clockwise sensor.turn_s=0.1 sensor.cut_deg=90 \
  sensor.stamp_turn=0.5
start=$(awk '{ print $2 "," $3 "," 2 * atan2($7, $8) * 57.29577951 ",0.5,3"; exit }' "$out/day1.tum")
"$bin/pole-import" rosbag2 --quiet --input "$out/bag" --output "$out/bag.rawlog"
"$bin/pole-localize" --quiet --config "$out/robot.ini" --input "$out/bag.rawlog" --map "$out/map.polemap" \
  --start "$start" --output "$out/runs" --runs 1

echo "3/4 Building the node"
# setup.sh of ROS reads variables that may not be set.
set +u
# shellcheck source=/dev/null
if [ -e "$ros/setup.sh" ]; then . "$ros/setup.sh"; fi
set -u
for part in library dev; do
  cmake --install "${POLEMCL_BUILD:-$top/build}" --component $part --prefix "$out/polemcl" >/dev/null
done
export AMENT_PREFIX_PATH="$out/installed:$ros" CMAKE_PREFIX_PATH="$out/polemcl:$ros"
library=$(dirname "$(find "$out/polemcl" -name libpolemcl.so)")
export LD_LIBRARY_PATH="$out/installed/lib:$library:$ros/lib"
for packages in "$ros"/lib/python3*/site-packages "$ros"/local/lib/python3*/dist-packages; do
  [ ! -d "$packages" ] || export PYTHONPATH="$packages${PYTHONPATH:+:$PYTHONPATH}"
done
{
  cmake -S "$top/share/ros/polemcl_ros" -B "$out/node" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_INSTALL_PREFIX="$out/installed" -DPOLEMCL_ROS_BAG_PLAYER=ON
  cmake --build "$out/node" --target install
} >"$out/build.log" 2>&1 || {
  cat "$out/build.log" >&2
  die "the node was not built"
}

echo "4/4 The bag to the node"
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_LOG_DIR="$out/log" CYCLONEDDS_URI='<CycloneDDS><Domain><General>
<Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces><AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="localhost"/></Peers></Discovery>
</Domain></CycloneDDS>'
# Reliable, so that no message is lost on the way: the poses must be those of pole-localize.
cat >"$out/parameters.yaml" <<END
polemcl:
  ros__parameters:
    settings: $out/runs/config.ini
    map: $out/map.polemap
    qos_overrides:
      /points: {subscription: {reliability: reliable}}
      /odom: {subscription: {reliability: reliable}}
END
node=
trap '[ -z "$node" ] || kill "$node" 2>/dev/null || :' EXIT
# start_node ARGUMENT...: the node, in the place of the one before.
start_node() {
  if [ -n "$node" ]; then
    kill "$node"
    wait "$node" || :
  fi
  "$out/installed/lib/polemcl_ros/localizer" --ros-args --params-file "$out/parameters.yaml" "$@" >"$out/node.log" 2>&1 &
  node=$!
}

# play NAME [ACTION...]: the whole bag; the poses go to NAME.tum.
play() {
  name=$1
  shift
  "$out/node/bag_player" "$out/bag/drive_0.db3" "$out/$name.tum" "$@" || {
    cat "$out/node.log" >&2
    die "the node did not answer as it should"
  }
}
# compare NAME MOST LAST: differences of the poses that both have. At most MOST m is allowed, for the last one LAST m.
compare() {
  awk -v name="$1" -v most="$2" -v least="$3" '
    NR == FNR { x[$1] = $2; y[$1] = $3; yaw[$1] = 2 * atan2($7, $8); all++; last = $1; next }
    $1 in x {
      both++
      d = sqrt(($2 - x[$1]) ^ 2 + ($3 - y[$1]) ^ 2)
      a = 2 * atan2($7, $8) - yaw[$1]
      a = atan2(sin(a), cos(a)) * 57.29577951
      a = a < 0 ? -a : a
      if (d > m) m = d
      if (a > r) r = a
      time = $1
    }
    END {
      printf "%s: %d of %d poses; largest difference %.9f m, %.9f deg; of the last pose %.9f m\n", name, both, all, m, r, d
      exit time != last || m > most || d > least
    }' "$out/runs/run_00.tum" "$out/$1.tum" || die "$1: the poses are not those of pole-localize"
}
start_node
play plain
compare plain 2e-9 2e-9 # the last digit of the files
play search 40
compare search 0.1 0.01
play start 40 42
compare start 1 0.01
# Keys of the INI are parameters; the turn is learnt from the times of the first points.
start_node -p sensor.turn:=auto
play auto
compare auto 0.1 0.01
