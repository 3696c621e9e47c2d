#!/usr/bin/python3
"""Writes a drive of pole-simulate as bags of ROS 2, without ROS: one in SQLite, one in MCAP.

Usage: write_rosbag2.py SCANS OUT.db3 OUT.mcap [YAW_DEG]
SCANS is what pole-simulate wrote. /points: clouds as a driver sends them, with ring and time since the stamp, of a
LiDAR that turns clockwise, is cut at the back of the robot and stamped in the middle of the turn. /odom: odometry at the stamps,
with velocity and covariance. /tf_static: the LiDAR stands 1 m above base_link and is turned by YAW_DEG (0 unless given).
"""
import math
import sqlite3
import struct
import sys
import zlib
from pathlib import Path


class Message:
    """Little-endian CDR: numbers are aligned to their size."""

    def __init__(self):
        self.data = b""

    def header(self, time, frame):
        return self.put("i", int(time)).put("I", round(time % 1 * 1e9) % 10**9).text(frame)

    def put(self, kind, *values):
        for value in values:
            self.data += bytes(-len(self.data) % struct.calcsize(kind)) + struct.pack("<" + kind, value)
        return self

    def text(self, text):
        return self.bytes(text.encode() + b"\0")

    def bytes(self, content):
        self.put("I", len(content)).data += content
        return self


def cloud(time, points, yaw):
    message = Message().header(time, "velodyne").put("I", 1, len(points), 6)
    for name, offset, kind in (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7),
                               ("ring", 16, 4), ("time", 18, 7)):
        message.text(name).put("I", offset).put("B", kind).put("I", 1)
    # Clockwise, cut at the back, stamped when facing forward.
    turned = [(0.5 - math.atan2(p[1], p[0]) / (2 * math.pi)) % 1 for p in points]
    c, s = math.cos(yaw), math.sin(yaw)
    points = [(c * x + s * y, c * y - s * x, z, intensity) for x, y, z, intensity in points]
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


def arc(yaw):
    """Chord of an arc of length 1 that turns by yaw."""
    return (1 - yaw * yaw / 6, yaw / 2) if abs(yaw) < 1e-6 else (math.sin(yaw) / yaw, (1 - math.cos(yaw)) / yaw)


def velocity(motion, seconds):
    along, aside = arc(motion[2])
    scale = seconds * (along * along + aside * aside)
    return ((along * motion[0] + aside * motion[1]) / scale, (along * motion[1] - aside * motion[0]) / scale,
            motion[2] / seconds)


def twist(motion, sigmas, seconds):
    """Content of a geometry_msgs/msg/TwistWithCovariance."""
    covariance = [0] * 36
    for place, sigma in zip((0, 7, 35), sigmas):
        covariance[place] = (sigma / seconds) ** 2
    x, y, yaw = velocity(motion, seconds)
    return [x, y, 0, 0, 0, yaw, *covariance]


def odometry(time, pose, twist_with_covariance):
    message = Message().header(time, "odom").text("base_link").put("d", pose[0], pose[1], 0, 0, 0)
    message.put("d", math.sin(pose[2] / 2), math.cos(pose[2] / 2)).put("d", *[0] * 36)
    return message.put("d", *twist_with_covariance)


def transforms(time, yaw):
    message = Message().put("I", 1).header(time, "base_link").text("velodyne")
    return message.put("d", 0, 0, 1, 0, 0, math.sin(yaw / 2), math.cos(yaw / 2))


folder = Path(sys.argv[1])
mounted = math.radians(float(sys.argv[4])) if len(sys.argv) > 4 else 0
topics = (("/points", "sensor_msgs/msg/PointCloud2"), ("/odom", "nav_msgs/msg/Odometry"),
          ("/tf_static", "tf2_msgs/msg/TFMessage"))
magic = b"\x89MCAP0\r\n"
mcap = open(sys.argv[3], "wb")
mcap.write(magic + record(1, "ros2", ""))
bag = sqlite3.connect(sys.argv[2])
bag.executescript("""
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, offered_qos_profiles TEXT);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);""")
for number, (name, kind) in enumerate(topics, 1):
    mcap.write(mcap_topic(number, name, kind))
    bag.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (number, name, kind))


def write(topic, time, message):
    stamp, content = round(time * 1e9), b"\0\1\0\0" + message.data
    bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", (topic, stamp, content))
    mcap.write(mcap_chunk(record(5, ("HIQQ", topic, 0, stamp, stamp), content)))


x = y = yaw = 0
rows = numbers(folder / "odometry.txt")  # motions with their standard deviations
times = [time + 1.5e9 for (time,) in numbers(folder / "times.txt")]
scans = sorted((folder / "velodyne").glob("*.bin"))
still = [0] * 6
write(3, times[0], transforms(times[0], mounted))
for i, (time, scan) in enumerate(zip(times, scans)):
    motion, after = rows[i - 1] if i > 0 else still, rows[i] if i < len(rows) else still
    c, s = math.cos(yaw), math.sin(yaw)
    x, y, yaw = x + c * motion[0] - s * motion[1], y + s * motion[0] + c * motion[1], yaw + motion[2]
    seconds = times[min(i + 1, len(times) - 1)] - times[min(i, len(times) - 2)]
    # The velocity is that of the way ahead, the covariance that of the way behind.
    write(1, time, cloud(time, list(struct.iter_unpack("<4f", scan.read_bytes())), mounted))
    write(2, time, odometry(time, (x, y, yaw), twist(after, motion[3:], seconds)))
bag.commit()
mcap.write(record(15, ("I", 0)) + record(2, ("QQI", 0, 0, 0)) + magic)
mcap.close()
