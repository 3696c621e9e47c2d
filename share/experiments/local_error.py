#!/usr/bin/python3
"""How true a trajectory is in itself: errors after the best rigid motion of each piece.

Usage: local_error.py TRUTH.tum ESTIMATE.tum [METRES]     METRES: length of the pieces, 60 unless given
Prints the mean over the pieces of their rms position errors, m. The first 30 m are left out.
"""
import sys

import numpy as np

from aligned_error import local_error, read


def main(truth, estimate, metres):
    times, right, _ = read(truth)
    other, found, _ = read(estimate)
    error = local_error(found[[np.abs(other - t).argmin() for t in times]], right, metres, first=30)
    if error is None:
        sys.exit(f"local_error.py: {truth} is shorter than {metres:g} m and the 30 m before")
    print(f"{error:.5f}")


if len(sys.argv) not in (3, 4):
    sys.exit(__doc__)
main(sys.argv[1], sys.argv[2], float(sys.argv[3]) if len(sys.argv) == 4 else 60.0)
