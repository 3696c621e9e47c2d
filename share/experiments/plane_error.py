#!/usr/bin/python3
"""Errors of a trajectory in the frame of its truth, as a line of JSON.

Usage: plane_error.py TRUTH.tum ESTIMATE.tum COVARIANCES.csv
"earth_rms" and "earth_max": of the positions, m. "earth_nees": mean normalized squared error of x, y, yaw; 3 is
expected. Needs python3-numpy.
"""
import json
import sys

import numpy as np

from aligned_error import drive, nees

if len(sys.argv) != 4:
    sys.exit(__doc__)
right, heading, found, yaw = drive(sys.argv[1], sys.argv[2])
turns = yaw - heading
errors = np.column_stack([found - right, np.arctan2(np.sin(turns), np.cos(turns))])
distances = np.hypot(errors[:, 0], errors[:, 1])
print(json.dumps({"earth_rms": round(float(np.sqrt((distances ** 2).mean())), 3),
                  "earth_max": round(float(distances.max()), 3), "earth_nees": round(nees(errors, sys.argv[3:], first=0), 2)}))
