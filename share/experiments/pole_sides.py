#!/usr/bin/python3
"""Poles on the two sides of a moving LiDAR, on the maps of motion-distortion.sh.

Usage: pole_sides.py OUT [SENSOR]     OUT: folder of results of motion-distortion.sh; SENSOR: mulran unless given
For each world: mean lateral error of the five runs, with standing turns and moving; then, for the poles left and
right of the path, the radius on the moving map over that on the standing one, and how far the pole moved to the
left (medians). Programs: build/bin, or POLEMCL_BIN.
"""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np


def poles_of(folder):
    top = Path(__file__).resolve().parents[2]
    program = Path(os.environ.get("POLEMCL_BIN", top / "build/bin")) / "pole-map"
    with tempfile.TemporaryDirectory() as place:
        table = Path(place) / "map.csv"
        subprocess.run([program, "convert", "--quiet", folder / "map.polemap", "--output", table], check=True,
                       stdout=subprocess.DEVNULL)
        return np.genfromtxt(table, delimiter=",", names=True)


def lateral_of(folder):
    runs = [np.genfromtxt(f, delimiter=",", names=True)["lateral_m"] for f in sorted(folder.glob("runs/*_errors.csv"))]
    return np.concatenate(runs).mean()


def main(out, sensor):
    for moving in sorted(out.glob(f"{sensor}-moving-[0-9]*")):
        world = moving.name.rsplit("-", 1)[1]
        still = out / f"{sensor}-still-{world}"
        a, b, path = poles_of(still), poles_of(moving), np.loadtxt(moving / "day0.tum")
        distance = np.hypot(a["x"][:, None] - b["x"], a["y"][:, None] - b["y"])
        own, other = np.where(distance.min(1) < 0.15)[0], distance.argmin(1)
        near = np.hypot(path[:, 1] - a["x"][own, None], path[:, 2] - a["y"][own, None]).argmin(1)
        yaw = 2 * np.arctan2(path[near, 6], path[near, 7])
        left = lambda x, y: -np.sin(yaw) * x + np.cos(yaw) * y
        side = left(a["x"][own] - path[near, 1], a["y"][own] - path[near, 2])
        ratio = b["radius"][other[own]] / a["radius"][own]
        moved = left(b["x"][other[own]] - a["x"][own], b["y"][other[own]] - a["y"][own])
        print(f"{world}: mean lateral error {lateral_of(still):.4f} m still, {lateral_of(moving):.4f} m moving")
        for name, chosen in (("left", side > 0), ("right", side < 0)):
            print(f"  {name:5} {chosen.sum():3} poles, {np.median(np.abs(side[chosen])):4.1f} m aside: radius ratio "
                  f"{np.median(ratio[chosen]):.3f}, moved left by {np.median(moved[chosen]):.4f} m")


if len(sys.argv) not in (2, 3):
    sys.exit(__doc__)
main(Path(sys.argv[1]), sys.argv[2] if len(sys.argv) == 3 else "mulran")
