#!/usr/bin/python3
"""The way of an odometry in the plane, as a TUM file for `pole-import --odometry`.

Usage: planar_odometry.py POSES TIMES OUT.tum. POSES has 12 numbers a line (a 3 x 4 matrix by rows), of which only
differences count; TIMES one number a line, s. Needs python3-numpy.
"""
import sys

import numpy as np


def main(poses, times, out):
    poses = [np.vstack([row.reshape(3, 4), [0, 0, 0, 1]]) for row in np.loadtxt(poses)]
    place, heading = np.zeros(2), 0.0
    with open(out, "w", encoding="ascii") as file:
        for i, time in enumerate(np.loadtxt(times)[:len(poses)]):
            if i > 0:
                motion = np.linalg.solve(poses[i - 1], poses[i])
                cos, sin = np.cos(heading), np.sin(heading)
                place += np.array([[cos, -sin], [sin, cos]]) @ motion[:2, 3]
                heading += np.arctan2(motion[1, 0], motion[0, 0])
            file.write("%.6f %.6f %.6f 0 0 0 %.10f %.10f\n" % (time, *place, np.sin(heading / 2), np.cos(heading / 2)))


if __name__ == "__main__":
    main(*sys.argv[1:])
