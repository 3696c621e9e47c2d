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
python3 - "$out/scans" "$out/bag/street_0.db3" "$out/mcap/street_0.mcap" <<'PYTHON'
import math, sqlite3, struct, sys, zlib
from pathlib import Path


class Message:
    """Little-endian CDR: numbers are aligned to their size."""

    def __init__(self, time, frame):
        self.data = b""
        self.put("i", int(time)).put("I", round(time % 1 * 1e9) % 10**9).text(frame)

    def put(self, kind, *values):
        for value in values:
            self.data += bytes(-len(self.data) % struct.calcsize(kind)) + struct.pack("<" + kind, value)
        return self

    def text(self, text):
        return self.bytes(text.encode() + b"\0")

    def bytes(self, content):
        self.put("I", len(content)).data += content
        return self


def cloud(time, points):
    message = Message(time, "velodyne").put("I", 1, len(points), 6)
    for name, offset, kind in (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7),
                               ("ring", 16, 4), ("time", 18, 7)):
        message.text(name).put("I", offset).put("B", kind).put("I", 1)
    # Clockwise, cut at the back, stamped when facing forward.
    turned = [(0.5 - math.atan2(p[1], p[0]) / (2 * math.pi)) % 1 for p in points]
    data = b"".join(struct.pack("<4fHf", *p, i % 32, 0.1 * (turned[i] - 0.5)) for i, p in enumerate(points))
    return message.put("B", 0).put("I", 22, len(data)).bytes(data).put("B", 1)


def numbers(file):
    lines = (line.split("#")[0].split() for line in file.read_text().splitlines())
    return [[float(word) for word in line] for line in lines if line]


def record(opcode, *parts):
    """A record of MCAP: numbers come with their format, texts with their length."""
    content = b"".join(part if isinstance(part, bytes) else struct.pack("<I", len(part)) + part.encode()
                       if isinstance(part, str) else struct.pack("<" + part[0], *part[1:]) for part in parts)
    return struct.pack("<BQ", opcode, len(content)) + content


def mcap_chunk(records):
    return record(6, ("QQQI", 0, 0, len(records), zlib.crc32(records)), "", ("Q", len(records)), records)


def mcap_topic(number, name, kind):
    return record(3, ("H", number), kind, "ros2msg", "") + record(4, ("HH", number, number), name, "cdr", "")


folder = Path(sys.argv[1])
magic = b"\x89MCAP0\r\n"
mcap = open(sys.argv[3], "wb")
mcap.write(magic + record(1, "ros2", "") + mcap_topic(1, "/points", "sensor_msgs/msg/PointCloud2")
           + mcap_topic(2, "/odom", "nav_msgs/msg/Odometry"))
bag = sqlite3.connect(sys.argv[2])
bag.executescript("""
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, offered_qos_profiles TEXT);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);
INSERT INTO topics VALUES(1, '/points', 'sensor_msgs/msg/PointCloud2', 'cdr', '');
INSERT INTO topics VALUES(2, '/odom', 'nav_msgs/msg/Odometry', 'cdr', '');""")
x = y = yaw = 0
motions = [[0, 0, 0]] + numbers(folder / "odometry.txt")
scans = sorted((folder / "velodyne").glob("*.bin"))
for (time,), motion, scan in zip(numbers(folder / "times.txt"), motions, scans):
    time += 1.5e9
    c, s = math.cos(yaw), math.sin(yaw)
    x, y, yaw = x + c * motion[0] - s * motion[1], y + s * motion[0] + c * motion[1], yaw + motion[2]
    odometry = Message(time, "odom").text("base_link").put("d", x, y, 0, 0, 0)
    odometry.put("d", math.sin(yaw / 2), math.cos(yaw / 2)).put("d", *[0] * 78)
    for topic, message in ((1, cloud(time, list(struct.iter_unpack("<4f", scan.read_bytes())))), (2, odometry)):
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                    (topic, round(time * 1e9), b"\0\1\0\0" + message.data))
        mcap.write(mcap_chunk(record(5, ("HIQQ", topic, 0, round(time * 1e9), round(time * 1e9)),
                                     b"\0\1\0\0" + message.data)))
bag.commit()
mcap.write(record(15, ("I", 0)) + record(2, ("QQI", 0, 0, 0)) + magic)
mcap.close()
PYTHON

for way in bag mcap; do
  "$bin/pole-import" rosbag2 --input "$out/$way" --output "$out/$way.rawlog"
done
for way in direct bag mcap; do
  "$bin/pole-extract" --quiet --config "$config" --input "$out/$way.rawlog" \
    --output "$out/$way-poles.rawlog" --csv "$out/$way.csv"
  cut -d, -f1,3- "$out/$way.csv" >"$out/$way.cut" # without the times, which differ by 1.5e9 s
done
for way in bag mcap; do
  cmp "$out/$way.cut" "$out/direct.cut" && echo "$way: poles of all scans: the same"
done
