#!/usr/bin/python3
"""How true a trajectory is in itself: errors after the best rigid motion of each piece.

Usage: local_error.py TRUTH.tum ESTIMATE.tum [METRES]     METRES: length of the pieces, 60 unless given
Prints the mean over the pieces of their rms position errors, m. The first 30 m are left out.
"""
import sys

import numpy as np


def positions(file):
    rows = np.loadtxt(file)
    return rows[:, 0], rows[:, 1:3]


def rigid_error(a, b):
    a, b = a - a.mean(0), b - b.mean(0)
    u, _, vt = np.linalg.svd(a.T @ b)
    turn = u @ np.diag([1, np.linalg.det(u @ vt)]) @ vt
    return np.sqrt(((a @ turn - b) ** 2).sum(1).mean())


def main(truth, estimate, metres):
    times, right = positions(truth)
    other, found = positions(estimate)
    found = found[[np.abs(other - t).argmin() for t in times]]
    way = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(right, axis=0).T))])
    errors = []
    for begin in np.arange(30, way[-1] - metres, 5):
        piece = (way >= begin) & (way <= begin + metres)
        errors.append(rigid_error(found[piece], right[piece]))
    if not errors:
        sys.exit(f"local_error.py: {truth} is shorter than {metres:g} m and the 30 m before")
    print(f"{np.mean(errors):.5f}")


if len(sys.argv) not in (3, 4):
    sys.exit(__doc__)
main(sys.argv[1], sys.argv[2], float(sys.argv[3]) if len(sys.argv) == 4 else 60.0)
