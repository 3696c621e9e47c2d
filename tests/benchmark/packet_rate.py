#!/usr/bin/env python3
"""Sends the packets of a standing HDL-32E to pole-localize at full rate; says what was lost.

Usage: tests/benchmark/packet_rate.py BIN [--dual] [--lidars N] [--seconds S]
BIN is the folder of the programs. A second LiDAR has ports of its own.
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
PERIOD = 552.96e-6  # s between two packets of one return
TURN = 181  # packets of one return in a turn
HEIGHT, RADIUS, TOP, WALL = 1.0, 0.15, 4.0, 25.0  # m
POLES = [(6, 4), (-7, 5), (12, -6), (-11, -8), (3, -9), (-3, 14)]  # m; their middle is 0, 10/6/10
ELEVATIONS = [math.radians(-30.67 + 4 / 3 * (i // 2) + 64 / 3 * (i % 2)) for i in range(32)]


def ranges(azimuth):
    """Units of 2 mm for each laser; azimuth is clockwise, rad."""
    dx, dy = math.cos(azimuth), -math.sin(azimuth)
    pole = math.inf
    for x, y in POLES:
        along, across = x * dx + y * dy, x * dy - y * dx
        if along > 0 and abs(across) < RADIUS:
            pole = min(pole, along - math.sqrt(RADIUS**2 - across**2))
    for elevation in ELEVATIONS:
        slope = math.tan(elevation)
        ground = HEIGHT / -slope if slope < 0 else math.inf
        hit = pole if pole < ground and HEIGHT + pole * slope < TOP else min(ground, WALL)
        yield round(hit / math.cos(elevation) / 0.002) if hit < 60 else 0


def turn(dual):
    """Packets without their last six bytes."""
    returns = 2 if dual else 1
    packets = []
    for packet in range(TURN * returns):
        content = b""
        for block in range(0, 12, returns):
            part = (packet * 12 + block) / (TURN * returns * 12)
            lasers = b"".join(struct.pack("<HB", r, 100) for r in ranges(2 * math.pi * part))
            content += (b"\xff\xee" + struct.pack("<H", int(36000 * part)) + lasers) * returns
        packets.append(content)
    return packets


def prepare(folder, lidars):
    """Files for pole-localize. \\return Options."""
    (folder / "poles.csv").write_text("e,n\n" + "".join(f"{500000 + x},{y}\n" for x, y in POLES))
    sensors = f"[odometry]\ndriver = CUdpOdometry\nudp_port = {ODOMETRY}\n"
    for i in range(lidars):
        sensors += (f"[lidar{i}]\ndriver = CVelodyneScanner\nmodel = HDL32\npose_z = {HEIGHT}\n"
                    f"address = 127.0.0.1\nsensorLabel = l{i}\n"
                    f"data_port = {PORT + i}\nposition_port = {PORT + 100 + i}\n")
    (folder / "sensors.ini").write_text(sensors)
    more = ["--set", "vehicle.lidars=" + " ".join(f"l{i}_SCAN" for i in range(lidars))]
    return more if lidars > 1 else []


def wait_for_listener(process):
    while process.poll() is None:
        ports = [int(line.split()[1].split(":")[1], 16)
                 for line in pathlib.Path("/proc/net/udp").read_text().splitlines()[1:]]
        if PORT in ports and ODOMETRY in ports:
            return
        time.sleep(0.01)
    sys.exit(process.returncode)


def send(options):
    """At the times when a LiDAR would. \\return Packets of each LiDAR."""
    packets = turn(options.dual)
    mode = b"\x39\x21" if options.dual else b"\x37\x21"
    period = PERIOD / (2 if options.dual else 1)
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    start, sent, odometry = time.perf_counter(), 0, 0
    while (now := time.perf_counter() - start) < options.seconds:
        if now >= odometry * 0.05:
            out.sendto(b"0 0 0", ("127.0.0.1", ODOMETRY))
            odometry += 1
        while sent * period <= now:
            clock = struct.pack("<I", int(sent * period * 1e6))
            for i in range(options.lidars):
                out.sendto(packets[sent % len(packets)] + clock + mode, ("127.0.0.1", PORT + i))
            sent += 1
        time.sleep(1e-4)
    return sent


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--dual", action="store_true")
    parser.add_argument("--lidars", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=20)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        more = prepare(folder, options.lidars)
        subprocess.run([options.bin / "pole-map", "--quiet", "import", "--input", folder / "poles.csv",
                        "--columns", "e,n", "--crs", "EPSG:25832", "--sigma-m", "0.05",
                        "--output", folder / "a.polemap"], check=True)
        process = subprocess.Popen(
            [options.bin / "pole-localize", "--config", "hdl32e.ini", "--sensors",
             folder / "sensors.ini", "--map", folder / "a.polemap", "--start", "0,0,0,1,5",
             "--output", folder / "out", "--stream", folder / "stream"] + more)
        wait_for_listener(process)
        sent = send(options)
        process.send_signal(signal.SIGINT)
        process.wait()
        summary = json.loads((folder / "out/summary.json").read_text())
    print(f"{options.lidars} x {sent / options.seconds:.0f} packets a second for "
          f"{options.seconds:g} s: {summary['lost_packets']} lost")


if __name__ == "__main__":
    main()
