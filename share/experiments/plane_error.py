#!/usr/bin/python3
"""Errors of a trajectory in the frame of its truth, as a line of JSON.

Usage: plane_error.py TRUTH.tum ESTIMATE.tum COVARIANCES.csv
"earth_rms" and "earth_max": of the positions, m. "earth_nees": mean normalized squared error of x, y, yaw; 3 is
expected. Needs python3-numpy.
"""
import json
import sys

import numpy as np

if len(sys.argv) != 4:
    sys.exit(__doc__)
truth, found = np.loadtxt(sys.argv[1]), np.loadtxt(sys.argv[2])
table = np.loadtxt(sys.argv[3], delimiter=",", skiprows=1)[:, 5:]
truth = truth[[np.abs(truth[:, 0] - time).argmin() for time in found[:, 0]]]
turns = 2 * (np.arctan2(found[:, 6], found[:, 7]) - np.arctan2(truth[:, 6], truth[:, 7]))
errors = np.column_stack([found[:, 1:3] - truth[:, 1:3], np.arctan2(np.sin(turns), np.cos(turns))])
nees = [error @ np.linalg.solve(np.array([[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]]), error)
        for error, (xx, xy, xt, yy, yt, tt) in zip(errors, table)]
distances = np.hypot(errors[:, 0], errors[:, 1])
print(json.dumps({"earth_rms": round(float(np.sqrt((distances ** 2).mean())), 3),
                  "earth_max": round(float(distances.max()), 3), "earth_nees": round(float(np.mean(nees)), 2)}))
