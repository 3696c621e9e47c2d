#!/usr/bin/env python3
"""Reads captures of Ouster and Hesai LiDARs apart from the program, and compares with what their owners state.

Usage: share/experiments/lidar_packets.py ouster CAPTURE...   CAPTURE.pcap, .json, _digest.json; tests/pcaps of
                                                             ouster-lidar/ouster-sdk
       share/experiments/lidar_packets.py hesai MODEL...      MODEL.db3, .pcd, .csv of the models below;
                                                             decoder_ground_truth and calibration of tier4/nebula
Ouster: the checksum of the range image is one of the digest. Hesai: each point of the cloud was decoded, to 0.01 mm.
Prints returns and sums of ranges of each packet with --packets: the values in test_LidarPackets.cpp. Needs SciPy.
"""
import hashlib
import json
import sqlite3
import struct
import sys

import numpy as np
from scipy.spatial import cKDTree

# Bytes of a pixel, bits of a range, their shift, whether a second range follows
PROFILES = {"LEGACY": (12, 20, 0, False), "RNG19_RFL8_SIG16_NIR16": (12, 19, 0, False),
            "RNG19_RFL8_SIG16_NIR16_DUAL": (16, 19, 0, True), "RNG15_RFL8_NIR8": (4, 15, 3, False),
            "FUSA_RNG15_RFL8_NIR8_DUAL": (8, 15, 3, True)}
# Channels, blocks; bytes of the header, place of the unit in it, bytes before an azimuth, of a return, of the tail
MODELS = {"xt16": (16, 8, 12, 9, 0, 4, 24), "xt32": (32, 8, 12, 9, 0, 4, 24), "xt32m": (32, 6, 12, 9, 0, 4, 24),
          "qt64": (64, 4, 12, 9, 0, 4, 24), "64": (64, 6, 8, 5, 0, 3, 22), "40p": (40, 10, 0, None, 2, 3, 22)}


def udp(name):
    """Packets of an Ethernet capture without fragments."""
    raw, place = open(name, "rb").read(), 24
    while place < len(raw):
        size = struct.unpack_from("<I", raw, place + 8)[0]
        packet = raw[place + 16:place + 16 + size]
        place += 16 + size
        if packet[12:14] == b"\x08\0" and packet[23] == 17:
            yield packet[42:14 + struct.unpack_from(">H", packet, 16)[0]]


def ouster(name, each):
    metadata = json.load(open(name + ".json"))
    form = metadata.get("data_format") or metadata["lidar_data_format"]
    profile = form.get("udp_profile_lidar", "LEGACY")
    pixel, bits, shift, dual = PROFILES[profile]
    rows, columns, count = (form[key] for key in ("pixels_per_column", "columns_per_frame", "columns_per_packet"))
    legacy = profile == "LEGACY"
    header, head, tail = (0, 16, 4) if legacy else (32, 12, 0)
    column_size = head + rows * pixel + tail
    image = np.zeros((rows, columns), np.uint32)
    for packet in udp(name + ".pcap"):
        if len(packet) != 2 * header + count * column_size:
            continue
        returns = total = 0
        for begin in range(header, header + count * column_size, column_size):
            valid = (packet[begin + column_size - 4:begin + column_size] == b"\xff" * 4 if legacy
                     else packet[begin + 10] & 1)
            if not valid:
                continue
            pixels = np.frombuffer(packet, np.uint8, rows * pixel, begin + head).reshape(rows, pixel)
            first, second = ((pixels[:, i:i + 4].copy().view("<u4")[:, 0] & ((1 << bits) - 1)) << shift
                             for i in ((0, 4) if dual else (0, 0)))
            image[:, struct.unpack_from("<H", packet, begin + 8)[0]] = first
            more = second[(second != first) & (second > 0)]
            returns += int((first > 0).sum()) + len(more)
            total += int(first.sum()) + int(more.sum())
        if each:
            print(f"  {returns} returns, {total / 1000:.3f} m")
    try:
        stated = [scan["RANGE"] for scan in json.load(open(name + "_digest.json"))["scans"]]
    except OSError:
        return "no digest"
    return "equal" if hashlib.md5(image.tobytes()).hexdigest() in stated else "NOT EQUAL"


def recorded(name):
    """Packets of a bag of pandar_msgs/PandarScan: an array of 1500 bytes and the size for each."""
    for (data,) in sqlite3.connect(name).execute("select data from messages order by timestamp"):
        place = 16 + struct.unpack_from("<I", data, 12)[0]
        place = 4 + (place - 1) // 4 * 4
        for i in range(struct.unpack_from("<I", data, place)[0]):
            begin = place + 4 + 1512 * i
            yield data[begin + 8:begin + 8 + struct.unpack_from("<I", data, begin + 1508)[0]]


def hesai(name, each):
    channels, blocks, header, unit_place, mark, pixel, tail = MODELS[name.rsplit("/", 1)[-1]]
    angles = np.radians([[float(word) for word in line.split(",")[1:3]] for line in open(name + ".csv")
                         if line[0].isdigit()])
    block_size = mark + 2 + channels * pixel
    points = []
    for packet in recorded(name + ".db3"):
        if len(packet) - header - blocks * block_size - tail not in (0, 4):
            continue
        unit = 4 if unit_place is None else packet[unit_place]
        returns = total = 0
        before = None
        for begin in range(header, header + blocks * block_size, block_size):
            azimuth = struct.unpack_from("<H", packet, begin + mark)[0]
            pixels = np.frombuffer(packet, np.uint8, channels * pixel, begin + mark + 2).reshape(channels, pixel)
            ranges = pixels[:, :2].copy().view("<u2")[:, 0].astype(int)
            kept = ranges > 0
            if before and before[0] == azimuth:
                kept &= ranges != before[1]
            before = azimuth, ranges
            angle, metres = azimuth * np.pi / 18000 + angles[:, 1], ranges * unit / 1000
            level = metres * np.cos(angles[:, 0])
            points.append(np.stack([level * np.sin(angle), level * np.cos(angle),
                                    metres * np.sin(angles[:, 0])], 1)[kept])
            returns += int(kept.sum())
            total += int(ranges[kept].sum()) * unit
        if each:
            print(f"  {returns} returns, {total / 1000:.3f} m")
    raw = open(name + ".pcd", "rb").read()
    truth = np.frombuffer(raw, "<f4", offset=raw.index(b"DATA binary\n") + 12).reshape(-1, 3)
    farthest = cKDTree(np.concatenate(points)).query(truth[np.isfinite(truth).all(1)])[0].max()
    return f"{'equal' if farthest < 1e-5 else 'NOT EQUAL'}, {len(truth)} points, {farthest * 1000:.4f} mm at most"


def main():
    names = [name for name in sys.argv[2:] if name != "--packets"]
    if not names or sys.argv[1] not in ("ouster", "hesai"):
        sys.exit(__doc__)
    results = {name: globals()[sys.argv[1]](name, "--packets" in sys.argv) for name in names}
    for name, result in results.items():
        print(f"{name.rsplit('/', 1)[-1]}: {result}")
    sys.exit(any(result.startswith("NOT") for result in results.values()))


main()
