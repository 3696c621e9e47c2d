#!/usr/bin/python3
"""Motions in the plane from poses of an odometry: odometry.txt for `pole-import folder`.

Usage: planar_motions.py POSES OUT. POSES has 12 numbers a line (a 3 x 4 matrix by rows), of which only differences
count. Standard deviations: 2 % of the distance and 5 mm; 0.05 degrees and 2 % of the turn. Needs python3-numpy.
"""
import sys

import numpy as np


def main(poses, out):
    poses = [np.vstack([row.reshape(3, 4), [0, 0, 0, 1]]) for row in np.loadtxt(poses)]
    with open(out, "w", encoding="ascii") as file:
        file.write("# dx dy dyaw sx sy syaw: motion from scan i-1 to scan i (m, m, rad), standard deviations\n")
        for before, after in zip(poses, poses[1:]):
            motion = np.linalg.solve(before, after)
            (x, y), yaw = motion[:2, 3], np.arctan2(motion[1, 0], motion[0, 0])
            sigma = 0.005 + 0.02 * np.hypot(x, y)
            file.write("%.6f %.6f %.8f %.6f %.6f %.8f\n" % (x, y, yaw, sigma, sigma, 0.0009 + 0.02 * abs(yaw)))


if __name__ == "__main__":
    main(*sys.argv[1:])
