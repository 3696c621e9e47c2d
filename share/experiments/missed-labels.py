#!/usr/bin/python3
"""Pictures of the labelled poles that a map lacks: the points of all scans around each, from two sides and from above.

Usage: missed-labels.py SCANS TRUTH MAP OUT
  SCANS  folder with velodyne/*.bin, poses.txt, times.txt; a LiDAR that turns clockwise, begins at the back and is
         stamped when it faces forward
  TRUTH  labelled poles (x,y,radius); MAP: the map (pole-map convert M.polemap --output M.csv)
  OUT    gets missed-N.png, six labels each, numbered by their line in TRUTH from 0; prints how many there are
One to one within 1 m. In the view from above, heights of 0.8 to 2.5 m; + is the label, x a pole of the map. Colours
are times. Needs python3-scipy and python3-matplotlib.
"""
import pathlib
import sys

import matplotlib
import numpy as np
from scipy.spatial.transform import Rotation

matplotlib.use("Agg")
from matplotlib import pyplot  # pylint: disable=wrong-import-position

from label_matching import matching, places  # pylint: disable=wrong-import-position

TURN = 0.1037  # s, of the LiDAR
FARTHEST = 25  # m, from the sensor to the label
HALF_SIDE = 2  # m, of a picture
PER_PICTURE = 6


class Drive:
    def __init__(self, folder):
        folder = pathlib.Path(folder)
        self.poses = np.loadtxt(folder / "poses.txt").reshape(-1, 3, 4)
        self.times = np.loadtxt(folder / "times.txt")
        self.files = sorted((folder / "velodyne").glob("*.bin"))

    def scan(self, k):
        """Points in the frame of the poses, corrected for the motion during the turn."""
        points = np.fromfile(self.files[k], np.float32).reshape(-1, 4)[:, :3].astype(float)
        before, after = max(0, k - 1), min(len(self.poses) - 1, k + 1)
        lasted = self.times[after] - self.times[before]
        rotation = self.poses[k, :, :3]
        velocity = rotation.T @ (self.poses[after, :, 3] - self.poses[before, :, 3]) / lasted
        turned = Rotation.from_matrix(self.poses[before, :, :3].T @ self.poses[after, :, :3]).as_rotvec() / lasted
        offset = -np.arctan2(points[:, 1], points[:, 0])[:, None] / (2 * np.pi) * TURN
        points += np.cross(turned * offset, points) + velocity * offset
        return points @ rotation.T + self.poses[k, :, 3]

    def around(self, places):
        """For each place the points (x, y, z, number of the scan) of a square around it."""
        found = [[] for _ in places]
        for k, pose in enumerate(self.poses):
            near = np.flatnonzero(np.linalg.norm(places - pose[:2, 3], axis=1) < FARTHEST)
            points = self.scan(k) if len(near) else None
            for i in near:
                inside = (np.abs(points[:, :2] - places[i]) < HALF_SIDE).all(axis=1)
                found[i].append(np.c_[points[inside], np.full(inside.sum(), k)])
        return [np.concatenate(parts) if parts else np.zeros((0, 4)) for parts in found]


def draw(axes, points, place, poles):
    ground = np.percentile(points[:, 2], 2) if len(points) else 0
    points = points - [*place, ground, 0]
    slab = points[(points[:, 2] > 0.8) & (points[:, 2] < 2.5)]
    for axis, (shown, u, v) in zip(axes, ((points, 0, 2), (points, 1, 2), (slab, 0, 1))):
        shown = shown[:: len(shown) // 30000 + 1]
        axis.scatter(shown[:, u], shown[:, v], s=0.6, c=shown[:, 3], cmap="jet", linewidths=0)
        axis.set(xlim=(-HALF_SIDE, HALF_SIDE), ylim=(-0.3, 5) if v == 2 else (-HALF_SIDE, HALF_SIDE), aspect="equal")
    axes[2].plot(0, 0, "k+")
    axes[2].plot(*(poles - place).T, "rx")


def main(scans, truth, map_file, out):
    drive, labels, poles = Drive(scans), places(truth), places(map_file)
    numbers = sorted(set(range(len(labels))) - matching(labels, poles))
    out = pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    around = drive.around(labels[numbers])
    for first in range(0, len(numbers), PER_PICTURE):
        part = range(first, min(first + PER_PICTURE, len(numbers)))
        figure, axes = pyplot.subplots(len(part), 3, figsize=(9, 3 * len(part)), squeeze=False)
        for row, i in zip(axes, part):
            draw(row, around[i], labels[numbers[i]], poles)
            row[0].set_title("label %d" % numbers[i])
        figure.savefig(out / ("missed-%d.png" % (first // PER_PICTURE)), dpi=70, bbox_inches="tight")
        pyplot.close(figure)
    print("%d of %d labels are not on the map: %s" % (len(numbers), len(labels), " ".join(map(str, numbers))))


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
