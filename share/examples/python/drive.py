#!/usr/bin/python3
"""From scan files to a map and to poses on it: drive.py MAPPED DRIVEN OUT.polemap [CONFIG]

MAPPED and DRIVEN are folders that pole-simulate writes: two drives in one street, say of two days.
The first is mapped at its true poses. On that map the second is localized by its odometry, from a
start that is 0.5 m off. Prints time, x, y, yaw and health of each scan. CONFIG is an INI file of
settings, or the name of an installed one; without it the LiDAR is an HDL-32E 1 m above ground.
"""

import pathlib
import sys

import numpy as np
import polemcl

CONFIG = sys.argv[4:5]  # one or none
SENSOR = {} if CONFIG else {"sensor.model": "hdl32e", "sensor.height_m": 1.0}


def poses_of(folder):
    """x, y, yaw of each scan, from the true poses (12 numbers a line, as KITTI)."""
    T = np.loadtxt(folder / "poses.txt").reshape(-1, 3, 4)
    return np.column_stack([T[:, 0, 3], T[:, 1, 3], np.arctan2(T[:, 1, 0], T[:, 0, 0])])


def poles_of(folder):
    """The poles of one scan after the other."""
    extractor = polemcl.PoleExtractor(*CONFIG, settings=SENSOR)
    for file in sorted((folder / "velodyne").glob("*.bin")):
        yield extractor.extract(np.fromfile(file, np.float32).reshape(-1, 4))


def build_map(folder):
    builder = polemcl.PoleMapBuilder(*CONFIG)
    for pose, poles in zip(poses_of(folder), poles_of(folder)):
        builder.add(pose, poles)
    return builder.build()


def localize(folder, pole_map, start):
    times = np.loadtxt(folder / "times.txt")
    odometry = np.loadtxt(folder / "odometry.txt")  # row i: from scan i to i + 1, with sigmas
    localizer = polemcl.Localizer(pole_map, *CONFIG, seed=1)
    localizer.start(start)
    motion = covariance = None  # none before the first scan
    for i, poles in enumerate(poles_of(folder)):
        if i > 0:
            motion, covariance = odometry[i - 1, :3], np.diag(odometry[i - 1, 3:] ** 2)
        yield localizer.step(times[i], motion, covariance, poles)


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit("usage: drive.py MAPPED DRIVEN OUT.polemap [CONFIG]")
    mapped, driven, file = map(pathlib.Path, sys.argv[1:4])
    pole_map = build_map(mapped)
    pole_map.save(file)
    start = poses_of(driven)[0] + (0.3, -0.4, 0)
    for update in localize(driven, polemcl.PoleMap.load(file), start):
        x, y, yaw = update.estimate.mean
        print(f"{update.time:.3f} {x:.3f} {y:.3f} {yaw:.4f} {update.health.state}")


if __name__ == "__main__":
    try:
        main()
    except polemcl.Error as error:
        sys.exit(f"drive.py: {error}")
