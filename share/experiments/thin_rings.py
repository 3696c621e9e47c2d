#!/usr/bin/python3
"""Thins scans of KITTI's HDL-64E to fewer rings, as a LiDAR with fewer beams would see the street.

Usage: thin_rings.py FOLDER OUT EVERY CONFIG
  FOLDER  velodyne/*.bin (x y z intensity, float32), times.txt, poses.txt
  OUT     gets the same with every EVERY-th ring from the top, and settings.ini: CONFIG with these rings
"""
import pathlib
import re
import shutil
import sys

import numpy as np

# As `pole-extract --inspect` finds them on the kilometre: two blocks, each seen from a height above the origin.
UPPER = (0.203, [1.96, 1.59, 1.32, 0.89, 0.60, 0.20, -0.08, -0.44, -0.79, -1.19, -1.49, -1.83, -2.20, -2.54, -2.87,
                 -3.24, -3.54, -3.94, -4.22, -4.59, -4.92, -5.26, -5.62, -5.97, -6.34, -6.69, -7.02, -7.31, -7.70,
                 -8.08, -8.34, -8.74])
LOWER = (0.123, [-9.01, -9.56, -10.05, -10.46, -10.95, -11.59, -12.11, -12.56, -13.04, -13.49, -14.05, -14.61, -15.20,
                 -15.67, -16.19, -16.57, -17.21, -17.76, -18.35, -18.83, -19.36, -19.78, -20.27, -20.84, -21.37, -21.99,
                 -22.50, -22.92, -23.39, -24.04, -24.58, -25.08])


def nearest(points: np.ndarray, apex: float, table: list) -> tuple:
    """Index of the nearest elevation of a block, and how far off it is, degrees."""
    seen = np.degrees(np.arctan2(points[:, 2] - apex, np.hypot(points[:, 0], points[:, 1])))
    off = np.abs(seen[:, None] - np.array(table)[None, :])
    return off.argmin(axis=1), off.min(axis=1)


def rings(points: np.ndarray) -> np.ndarray:
    """Ring of each point, 0 the topmost."""
    upper, off_upper = nearest(points, *UPPER)
    lower, off_lower = nearest(points, *LOWER)
    return np.where(off_upper <= off_lower, upper, len(UPPER[1]) + lower)


def settings(config: str, every: int) -> str:
    first_lower = -len(UPPER[1]) % every
    lines = [
        "model = table  ; rings of KITTI's unit, every %d-th" % every,
        "elevations_deg = " + " ".join(map(str, UPPER[1][::every])),
        "lower_elevations_deg = " + " ".join(map(str, LOWER[1][first_lower::every])),
        "apex_m = %s %s" % (UPPER[0], LOWER[0]),
        "columns = 2083",
    ]
    return re.sub(r"^model = hdl64e.*$", "\n".join(lines), config, count=1, flags=re.M)


def main() -> None:
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    folder, out, every = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    (out / "velodyne").mkdir(parents=True, exist_ok=True)
    for name in ("times.txt", "poses.txt"):
        shutil.copy(folder / name, out / name)
    (out / "settings.ini").write_text(settings(pathlib.Path(sys.argv[4]).read_text(), every))
    for scan in sorted((folder / "velodyne").glob("*.bin")):
        points = np.fromfile(scan, np.float32).reshape(-1, 4)
        points[rings(points) % every == 0].tofile(out / "velodyne" / scan.name)


if __name__ == "__main__":
    main()
