#!/usr/bin/python3
"""Positions from satellites for a drive with known poses, as `pole-map build --gnss` reads them.

Usage: gnss_fixes.py TRUTH.tum SEED >FIXES.csv
One fix a second: 1.5 m of white noise (its sigma), and 3 m that last (Gauss-Markov, 200 s), along each axis. For 5 %
of the time, in pieces of 20 s, they are off by another 30 m. The origin of the poses is at 48 N, 9 E.
Needs python3-numpy.
"""
import sys

import numpy as np

if len(sys.argv) != 3:
    sys.exit(__doc__)
rows = np.loadtxt(sys.argv[1])
random = np.random.default_rng(int(sys.argv[2]))
times = np.arange(rows[0, 0], rows[-1, 0], 1.0) + 0.05
places = np.column_stack([np.interp(times, rows[:, 0], rows[:, i]) for i in (1, 2)])
kept = np.exp(-1 / 200)
lasting = 3 * random.standard_normal(2)
# Of the ellipsoid WGS 84: radii of curvature along the meridian and across it.
latitude = np.radians(48)
share = 1 - 0.00669437999 * np.sin(latitude) ** 2
across, along = 6378137 / np.sqrt(share), 6378137 * (1 - 0.00669437999) / share ** 1.5
print("time,latitude,longitude,sigma")
for i, (time, place) in enumerate(zip(times, places)):
    lasting = kept * lasting + 3 * np.sqrt(1 - kept ** 2) * random.standard_normal(2)
    if i % 20 == 0:
        jump = 30 * random.standard_normal(2) if random.random() < 0.05 else 0
    east, north = place + lasting + jump + 1.5 * random.standard_normal(2)
    print(f"{time:.3f},{48 + np.degrees(north / along):.9f},{9 + np.degrees(east / across / np.cos(latitude)):.9f},1.5")
