#!/usr/bin/python3
"""Size of a pole map beside a map of the points of the same scans.

Usage: map_size.py SCANS MAP.polemap
  SCANS  folder with velodyne/*.bin (float32 x y z intensity) and poses.txt (12 numbers a line)
  MAP    pole map made from them
The map of points has one point for each occupied cube of 0.1 or 0.2 m, three float32 each.
"""
import sys
from pathlib import Path

import numpy as np


def main(scans, pole_map):
    poses = np.loadtxt(scans / "poses.txt").reshape(-1, 3, 4)
    cubes = {0.1: set(), 0.2: set()}
    for file, pose in zip(sorted((scans / "velodyne").glob("*.bin")), poses):
        points = np.fromfile(file, np.float32).reshape(-1, 4)[:, :3].astype(float) @ pose[:, :3].T + pose[:, 3]
        for size, taken in cubes.items():
            keys = np.floor(points / size).astype(np.int64) @ np.array([1, 1 << 21, 1 << 42])
            taken.update(np.unique(keys).tolist())
    km = np.linalg.norm(np.diff(poses[:, :, 3], axis=0), axis=1).sum() / 1000
    print(f"{1000 * km:.0f} m, {len(poses)} scans")
    print(f"pole map             {pole_map.stat().st_size / 1e3 / km:10.1f} kB/km")
    for size, taken in cubes.items():
        print(f"points, cubes {size} m  {12 * len(taken) / 1e3 / km:10.0f} kB/km")


if len(sys.argv) != 3:
    sys.exit(__doc__)
main(Path(sys.argv[1]), Path(sys.argv[2]))
