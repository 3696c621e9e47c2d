#!/bin/sh
# Makes a pole map from a ROS 1 bag, with MRPT's own rosbag2rawlog: a simulated street of 60 m (world
# 512) is written as a bag, converted, extracted and mapped, and then mapped without the bag.
# Usage: share/experiments/rosbag.sh OUT
# Needs the Debian packages mrpt-apps, python3-rosbag, python3-sensor-msgs, python3-nav-msgs.
# Programs: build/bin, or POLEMCL_BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 1 "$@"
out=$1
find_programs pole-simulate pole-import pole-extract pole-map
command -v rosbag2rawlog >/dev/null || die "no rosbag2rawlog: install mrpt-apps"
/usr/bin/python3 -c 'import rosbag, sensor_msgs.msg, nav_msgs.msg' 2>/dev/null ||
  die "no rosbag for Python: install python3-rosbag python3-sensor-msgs python3-nav-msgs"
mkdir -p "$out"

config=$out/street.ini
copy_settings "$top/config/hdl32e.ini" "$config" simulation.spacing_m=1 world.length_m=60 world.seed=512
"$bin/pole-simulate" --quiet --config "$config" --output "$out/scans"
"$bin/pole-import" folder --quiet --input "$out/scans" --output "$out/direct.rawlog"

# Clouds as a Velodyne driver sends them, with ring and time; odometry beside.
/usr/bin/python3 - "$out/scans" "$out/street.bag" <<'PYTHON'
import struct, sys
from pathlib import Path
import genpy, rosbag
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2, PointField

folder, bag = Path(sys.argv[1]), rosbag.Bag(sys.argv[2], "w")
times = [float(t) for t in (folder / "times.txt").read_text().split()]
for seq, (time, scan) in enumerate(zip(times, sorted((folder / "velodyne").glob("*.bin")))):
    stamp = genpy.Time.from_sec(1.5e9 + time)
    points = list(struct.iter_unpack("<4f", scan.read_bytes()))
    cloud = PointCloud2(height=1, width=len(points), point_step=22, row_step=22 * len(points))
    cloud.header.seq, cloud.header.stamp, cloud.header.frame_id = seq, stamp, "velodyne"
    for name, offset, kind in (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7),
                               ("ring", 16, 4), ("time", 18, 7)):
        cloud.fields.append(PointField(name=name, offset=offset, datatype=kind, count=1))
    cloud.data = b"".join(struct.pack("<4fHf", *p, i % 32, 0.0) for i, p in enumerate(points))
    bag.write("/velodyne_points", cloud, stamp)
    odometry = Odometry()
    odometry.header.stamp, odometry.pose.pose.position.x = stamp, float(seq)
    odometry.pose.pose.orientation.w = 1
    bag.write("/odom", odometry, stamp)
bag.close()
PYTHON

rosbag2rawlog -w -f map -c "$top/share/ros/pointcloud2.yml" -o "$out/bag.rawlog" "$out/street.bag"
awk '{ $1 = sprintf("%.9f", $1 + 1.5e9); print }' "$out/direct.tum" >"$out/bag.tum"
for way in direct bag; do
  "$bin/pole-extract" --quiet --config "$config" --input "$out/$way.rawlog" \
    --output "$out/$way-poles.rawlog" --csv "$out/$way.csv"
  "$bin/pole-map" build --config "$config" --input "$out/$way.rawlog" --truth "$out/$way.tum" \
    --output "$out/$way.polemap" --csv "$out/$way-map.csv"
done
# Without the times, which differ by 1.5e9 s, and the dates made from them.
cut -d, -f1,3- "$out/direct.csv" >"$out/direct.cut"
cut -d, -f1,3- "$out/bag.csv" | cmp - "$out/direct.cut"
echo "poles of all scans: the same"
cut -d, -f1-13 "$out/direct-map.csv" >"$out/direct-map.cut"
cut -d, -f1-13 "$out/bag-map.csv" | cmp - "$out/direct-map.cut"
echo "map: the same"
