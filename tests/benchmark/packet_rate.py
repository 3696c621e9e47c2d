#!/usr/bin/env python3
"""Sends the packets of a standing LiDAR to pole-localize at full rate; says what was lost.

Usage: tests/benchmark/packet_rate.py BIN [--dual | --ouster HZ] [--lidars N] [--seconds S]
BIN is the folder of the programs. The LiDAR is an HDL-32E of 10 turns a second, or with --ouster an
OS1-128 of 1024 columns and 10 or 20 turns. A second LiDAR has ports of its own.
"""
import argparse
import json
import math
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

PORT, ODOMETRY = 12368, 12870
HEIGHT, RADIUS, TOP, WALL = 1.0, 0.15, 4.0, 25.0  # m
POLES = [(6, 4), (-7, 5), (12, -6), (-11, -8), (3, -9), (-3, 14)]  # m; their middle is 0, 10/6/10


def ranges(azimuth, elevations):
    """Millimetres for each beam; 0: none. Azimuth is clockwise, elevations are in rad."""
    dx, dy = math.cos(azimuth), -math.sin(azimuth)
    pole = math.inf
    for x, y in POLES:
        along, across = x * dx + y * dy, x * dy - y * dx
        if along > 0 and abs(across) < RADIUS:
            pole = min(pole, along - math.sqrt(RADIUS**2 - across**2))
    for elevation in elevations:
        slope = math.tan(elevation)
        ground = HEIGHT / -slope if slope < 0 else math.inf
        hit = pole if pole < ground and HEIGHT + pole * slope < TOP else min(ground, WALL)
        yield round(hit / math.cos(elevation) * 1000) if hit < 60 else 0


class Hdl32e:
    config = []

    def __init__(self, dual):
        self.returns = 2 if dual else 1
        self.mode = b"\x39\x21" if dual else b"\x37\x21"
        self.period = 552.96e-6 / self.returns  # s between two packets
        elevations = [math.radians(-30.67 + 4 / 3 * (i // 2) + 64 / 3 * (i % 2)) for i in range(32)]
        count = 181 * self.returns
        self.turn = []
        for packet in range(count):
            content = b""
            for block in range(0, 12, self.returns):
                part = (packet * 12 + block) / (count * 12)
                lasers = b"".join(struct.pack("<HB", r // 2, 100)
                                  for r in ranges(2 * math.pi * part, elevations))
                content += (b"\xff\xee" + struct.pack("<H", int(36000 * part)) + lasers) * self.returns
            self.turn.append(content)

    def section(self, i, folder):
        return f"driver = CVelodyneScanner\nmodel = HDL32\nposition_port = {PORT + 100 + i}\n"

    def packet(self, n):
        return self.turn[n % len(self.turn)] + struct.pack("<I", int(n * self.period * 1e6)) + self.mode


class Os1:
    config = ["--set", "sensor.model=os1_128", "--set", "sensor.turn=clockwise",
              "--set", "sensor.stamp_turn=0", "--set", "sensor.check_beams=false"]
    degrees = [22.5 - 45 * i / 127 for i in range(128)]

    def __init__(self, rate):
        self.rate = rate
        self.period = 1 / rate / 64
        elevations = [math.radians(degree) for degree in self.degrees]
        self.columns = [b"".join(struct.pack("<I8x", r)
                                 for r in ranges(2 * math.pi * i / 1024 - math.pi, elevations))
                        for i in range(1024)]

    def section(self, i, folder):
        format_ = {"columns_per_frame": 1024, "columns_per_packet": 16, "pixels_per_column": 128,
                   "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16"}
        (folder / "os1.json").write_text(json.dumps({
            "lidar_mode": f"1024x{self.rate}", "beam_altitude_angles": self.degrees,
            "beam_azimuth_angles": [0] * 128, "data_format": format_}))
        return f"driver = COusterScanner\nmetadata_file = {folder / 'os1.json'}\n"

    def packet(self, n):
        columns = b"".join(
            struct.pack("<QHH", int((n * 16 + i % 16) * self.period / 16 * 1e9), i, 1) + self.columns[i]
            for i in range(n % 64 * 16, n % 64 * 16 + 16))
        return struct.pack("<HH28x", 1, n // 64 % 65536) + columns + bytes(32)


def prepare(folder, lidar, lidars):
    """Files for pole-localize. \\return Options."""
    (folder / "poles.csv").write_text("e,n\n" + "".join(f"{500000 + x},{y}\n" for x, y in POLES))
    sensors = f"[odometry]\ndriver = CUdpOdometry\nudp_port = {ODOMETRY}\n"
    for i in range(lidars):
        sensors += (f"[lidar{i}]\npose_z = {HEIGHT}\naddress = 127.0.0.1\nsensorLabel = l{i}\n"
                    f"data_port = {PORT + i}\n" + lidar.section(i, folder))
    (folder / "sensors.ini").write_text(sensors)
    ending = "_SCAN" if isinstance(lidar, Hdl32e) else ""
    more = ["--set", "vehicle.lidars=" + " ".join(f"l{i}{ending}" for i in range(lidars))]
    return lidar.config + (more if lidars > 1 else [])


def wait_for_listener(process):
    while process.poll() is None:
        ports = [int(line.split()[1].split(":")[1], 16)
                 for line in pathlib.Path("/proc/net/udp").read_text().splitlines()[1:]]
        if PORT in ports and ODOMETRY in ports:
            return
        time.sleep(0.01)
    sys.exit(process.returncode)


def send(lidar, options):
    """At the times when a LiDAR would. \\return Packets of each LiDAR."""
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    out.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
    start, sent, odometry = time.perf_counter(), 0, 0
    while (now := time.perf_counter() - start) < options.seconds:
        if now >= odometry * 0.05:
            out.sendto(b"0 0 0", ("127.0.0.1", ODOMETRY))
            odometry += 1
        while sent * lidar.period <= now:
            packet = lidar.packet(sent)
            for i in range(options.lidars):
                out.sendto(packet, ("127.0.0.1", PORT + i))
            sent += 1
        time.sleep(1e-4)
    return sent


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--dual", action="store_true")
    parser.add_argument("--ouster", type=int, choices=[10, 20])
    parser.add_argument("--lidars", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=20)
    options = parser.parse_args()
    lidar = Os1(options.ouster) if options.ouster else Hdl32e(options.dual)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        more = prepare(folder, lidar, options.lidars)
        subprocess.run([options.bin / "pole-map", "--quiet", "import", "--input", folder / "poles.csv",
                        "--columns", "e,n", "--crs", "EPSG:25832", "--sigma-m", "0.05",
                        "--output", folder / "a.polemap"], check=True)
        process = subprocess.Popen(
            [options.bin / "pole-localize", "--config", "hdl32e.ini", "--sensors",
             folder / "sensors.ini", "--map", folder / "a.polemap", "--start", "0,0,0,1,5",
             "--output", folder / "out", "--stream", folder / "stream"] + more)
        wait_for_listener(process)
        sent = send(lidar, options)
        process.send_signal(signal.SIGINT)
        process.wait()
        summary = json.loads((folder / "out/summary.json").read_text())
    print(f"{options.lidars} x {sent / options.seconds:.0f} packets a second for "
          f"{options.seconds:g} s: {summary['lost_packets']} packets lost, "
          f"{summary['dropped_scans']} scans dropped")


if __name__ == "__main__":
    main()
