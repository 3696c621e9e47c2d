#!/usr/bin/python3
"""How much radius, top and bottom of a pole tell which pole it is, on the real drives.

Usage: pole_radii.py OUT        OUT: folder of results of real-drives.sh
Each pole of the localized scans, placed by the true pose, is compared with the map pole within 0.3 m ("same")
and with all poles of the map ("others", the poles of the scans in a drawn order). "information" is the mean
log ratio of the two distributions for the right pairs, in nats a pole, from histograms.
"""
import sys
from pathlib import Path

import numpy as np

BINS = {"radius": np.linspace(-0.3, 0.3, 61), "top": np.linspace(-8, 8, 81), "bottom": np.linspace(-8, 8, 81)}


def placed(poles, poses):
    scan = poles["scan"].astype(int)
    yaw = 2 * np.arctan2(poses[scan, 6], poses[scan, 7])
    x = poses[scan, 1] + np.cos(yaw) * poles["x"] - np.sin(yaw) * poles["y"]
    y = poses[scan, 2] + np.sin(yaw) * poles["x"] + np.cos(yaw) * poles["y"]
    return x, y


def shares(values, bins):
    counts, _ = np.histogram(values, bins)
    return (counts + 0.5) / np.sum(counts + 0.5)


def information(same, others, bins):
    p, q = shares(same, bins), shares(others, bins)
    return np.sum(p * np.log(p / q))


def main(folder):
    print(f"{'drive':26} {'matched':>8} {'':8} {'same: sd m':>11} {'median':>7} {'others: sd':>11} {'information':>12}")
    for drive in sorted(folder.glob("*/scans.csv")):
        mapped = np.genfromtxt(drive.parent / "map.csv", delimiter=",", names=True)
        poles = np.genfromtxt(drive, delimiter=",", names=True)
        x, y = placed(poles, np.loadtxt(drive.parent / "scans.tum"))
        distance = np.hypot(x[:, None] - mapped["x"], y[:, None] - mapped["y"])
        nearest, found = distance.argmin(1), distance.min(1) < 0.3
        for field, bins in BINS.items():
            seen, there = poles[field][found], mapped[field][nearest[found]]
            same = seen - there
            others = (np.random.default_rng(1).permutation(seen)[:, None] - mapped[field][None, :]).ravel()
            print(f"{drive.parent.name:26} {found.sum():8} {field:8} {same.std():11.3f} "
                  f"{np.median(np.abs(same)):7.3f} {others.std():11.3f} {information(same, others, bins):12.2f}")


if len(sys.argv) != 2:
    sys.exit(__doc__)
main(Path(sys.argv[1]))
