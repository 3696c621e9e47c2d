#!/usr/bin/python3
"""Errors of a trajectory in a frame of its own, after the best rigid motion, as a line of JSON.

Usage: aligned_error.py TRUTH.tum ESTIMATE.tum COVARIANCES.csv [SIGMA_M,SIGMA_DEG]
Several drives in one frame: the files of each kind with commas between them.
"rms" and "max": positions, after the best rigid motion of the whole drive, m. "local": mean rms of pieces of 60 m,
each after a motion of its own, m (null for shorter drives). "end_percent": error of the last position, the first
poses laid on each other, in percent of the way. "nees": mean normalized squared error of x, y, yaw against the first
pose; 3 is expected. The sigmas are those of the true poses. Needs python3-numpy.
"""
import json
import sys

import numpy as np


def read(file):
    rows = np.loadtxt(file)
    return rows[:, 0], rows[:, 1:3], 2 * np.arctan2(rows[:, 6], rows[:, 7])


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def rigid_errors(found, right):
    a, b = found - found.mean(0), right - right.mean(0)
    cross = a.T @ b
    return np.hypot(*(turned(a, np.arctan2(cross[0, 1] - cross[1, 0], np.trace(cross))) - b).T)


def driven(places):
    """The way to each place."""
    return np.concatenate([[0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])


def local_error(found, right, metres=60, first=0):
    """Mean rms of the pieces of this length, after the first metres; None if there are none."""
    way = driven(right)
    pieces = [(way >= begin) & (way <= begin + metres) for begin in np.arange(first, way[-1] - metres, 5)]
    errors = [np.sqrt((rigid_errors(found[p], right[p]) ** 2).mean()) for p in pieces]
    return float(np.mean(errors)) if errors else None


def nees(errors, files, sigmas=(0, 0), first=1):
    """Mean normalized squared error, from this row on."""
    table = np.vstack([np.loadtxt(file, delimiter=",", skiprows=1) for file in files])[:, 5:]
    extra = np.diag([sigmas[0], sigmas[0], np.radians(sigmas[1])]) ** 2
    values = []
    for error, (xx, xy, xt, yy, yt, tt) in list(zip(errors, table))[first:]:
        covariance = np.array([[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]]) + 2 * extra
        values.append(error @ np.linalg.solve(covariance + 1e-12 * np.eye(3), error))
    return float(np.mean(values))


def drive(truth, estimate):
    """Positions and headings of the truth and of the estimate."""
    times, right, heading = read(truth)
    stamps, found, yaw = read(estimate)
    chosen = [np.abs(times - stamp).argmin() for stamp in stamps]
    return right[chosen], heading[chosen], found, yaw


def mean(values):
    known = [value for value in values if value is not None]
    return round(float(np.mean(known)), 4) if known else None


def main(truths, estimates, covariances, sigmas):
    drives = [drive(*files) for files in zip(truths.split(","), estimates.split(","))]
    right, heading, found, yaw = [np.concatenate([d[i] for d in drives]) for i in range(4)]
    length = float(sum(driven(d[0])[-1] for d in drives))
    errors = rigid_errors(found, right)
    # Both in the frame of the first pose.
    own = turned(right - right[0], -heading[0]) - turned(found - found[0], -yaw[0])
    turns = heading - heading[0] - yaw + yaw[0]
    turns = np.arctan2(np.sin(turns), np.cos(turns))
    print(json.dumps({
        "length": round(length, 1),
        "rms": round(float(np.sqrt((errors ** 2).mean())), 4),
        "max": round(float(errors.max()), 4),
        "local": mean([local_error(found, right) for right, _, found, _ in drives]),
        "end_percent": round(100 * float(np.hypot(*own[-1])) / length, 3),
        "nees": round(nees(np.column_stack([own, turns]), covariances.split(","), sigmas), 2)}))


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    main(*sys.argv[1:4], [float(s) for s in sys.argv[4].split(",")] if len(sys.argv) == 5 else [0, 0])
