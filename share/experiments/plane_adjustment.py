#!/usr/bin/python3
"""Poses of a drive from the planes in its scans, as a check of published poses.

Usage: plane_adjustment.py DRIVE POLES OUT [SHIFT_M [SIDE]]
  DRIVE    folder with velodyne/*.bin (compensated for motion) and poses.txt (12 numbers a line)
  POLES    table of the poles of all scans (pole-extract --csv): points within 1 m of one are not used
  OUT      gets the adjusted poses, 12 numbers a line; the first one stays as it is
  SHIFT_M  disturbs the poses first by normal noise of this sigma, and 1 deg for each metre of it
  SIDE     "left" or "right": only points on this side of the vehicle, for two results that share no point
Each scan's planar points are paired with the planes of all scans within 15 m, and the distances are
minimized over all poses at once (Gauss-Newton, Cauchy weights), with a gate that shrinks from 1 to 0.2 m.
Needs python3-scipy.
"""

import csv
import pathlib
import sys

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

NEAREST, FARTHEST = 2.5, 50.0  # m; nearer is the vehicle
CELL = 0.25  # m; one point is kept in each cell
NEIGHBOURS, REACH = 15, 1.5  # points of a plane, and their greatest distance, m
THIN, WIDE = 0.03, 0.1  # greatest and least sigma of a plane's points across and along it, m
PAIRED = 15.0  # m between scans that are compared
SAMPLES = 1500  # points of a scan that are compared with another
SCALE = 0.03  # m; of the Cauchy weights
ROUNDS, CONVERGED = 25, 2e-4  # most rounds; least step, m


class Scan:
    """Points, those of planes, normals and centres of planes, in the frame of the LiDAR."""

    def __init__(self, path, poles, random, side):
        points = np.fromfile(path, np.float32).reshape(-1, 4)[:, :3].astype(float)
        if side:
            points = points[points[:, 1] > 0 if side == "left" else points[:, 1] < 0]
        distance = np.hypot(points[:, 0], points[:, 1])
        points = points[(distance > NEAREST) & (distance < FARTHEST)]
        if poles:
            points = points[cKDTree(np.array(poles)).query(points[:, :2])[0] > 1.0]
        _, first = np.unique(np.floor(points / CELL).astype(int), axis=0, return_index=True)
        self.points = points[np.sort(first)]
        self.tree = cKDTree(self.points)
        distance, neighbours = self.tree.query(self.points, k=NEIGHBOURS)
        around = self.points[neighbours]
        self.centres = around.mean(1)
        around = around - self.centres[:, None]
        values, vectors = np.linalg.eigh(np.einsum("nki,nkj->nij", around, around) / NEIGHBOURS)
        self.normals = vectors[:, :, 0]
        self.planar = (
            (distance[:, -1] < REACH) & (values[:, 0] < THIN**2) & (values[:, 1] > WIDE**2)
        )
        planar = np.flatnonzero(self.planar)
        self.samples = random.choice(planar, min(SAMPLES, len(planar)), replace=False)


def read_poles(path):
    poles = {}
    with open(path, encoding="utf-8") as table:
        for row in csv.DictReader(table):
            poles.setdefault(int(row["scan"]), []).append((float(row["x"]), float(row["y"])))
    return poles


def distances(one, other, pose_one, pose_other, gate):
    """Points of one scan in the map, normals of the planes of the other, distances to them."""
    (rotation, place), (other_rotation, other_place) = pose_one, pose_other
    points = one.points[one.samples] @ rotation.T + place
    found, nearest = other.tree.query(
        (points - other_place) @ other_rotation, distance_upper_bound=gate + 0.5
    )
    pair = np.isfinite(found)
    pair[pair] &= other.planar[nearest[pair]]
    nearest = nearest[pair]
    normals = other.normals[nearest] @ other_rotation.T
    centres = other.centres[nearest] @ other_rotation.T + other_place
    points = points[pair]
    error = ((points - centres) * normals).sum(1)
    own = one.normals[one.samples][pair] @ rotation.T
    good = (np.abs(error) < gate) & (np.abs((normals * own).sum(1)) > 0.9)
    return points[good], normals[good], error[good]


def round_of(scans, rotations, places, pairs, gate):
    """One Gauss-Newton step for all poses but the first; also the median distance."""
    count = len(scans)
    matrix, vector, medians = np.zeros((6 * count, 6 * count)), np.zeros(6 * count), []
    for i, j in pairs:
        points, normals, error = distances(
            scans[i], scans[j], (rotations[i], places[i]), (rotations[j], places[j]), gate
        )
        if len(error) < 50:
            continue
        weight = 1 / (1 + (error / SCALE) ** 2)
        derivative = np.hstack([
            normals, np.cross(points - places[i], normals),
            -normals, -np.cross(points - places[j], normals),
        ])
        at = np.r_[6 * i : 6 * i + 6, 6 * j : 6 * j + 6]
        matrix[np.ix_(at, at)] += derivative.T @ (weight[:, None] * derivative)
        vector[at] += derivative.T @ (weight * error)
        medians.append(np.median(np.abs(error)))
    matrix[:6, :6] += 1e12 * np.eye(6)
    step = -np.linalg.solve(matrix + 1e-6 * np.eye(6 * count), vector).reshape(count, 6)
    return step, float(np.median(medians))


def adjust(scans, rotations, places):
    count = len(scans)
    pairs = [
        (i, j) for i in range(count) for j in range(count)
        if i != j and np.linalg.norm(places[i] - places[j]) < PAIRED
    ]
    for turn in range(ROUNDS):
        gate = max(0.2, 0.8**turn)
        step, median = round_of(scans, rotations, places, pairs, gate)
        places = places + step[:, :3]
        rotations = Rotation.from_rotvec(step[:, 3:]).as_matrix() @ rotations
        largest = np.abs(step[:, :3]).max()
        print(f"gate {gate:.2f} m, median distance {median:.4f} m, largest step {largest:.4f} m")
        if gate == 0.2 and largest < CONVERGED:
            break
    return rotations, places


def main():
    if len(sys.argv) not in (4, 5, 6) or sys.argv[5:] not in ([], ["left"], ["right"]):
        sys.exit(__doc__)
    drive, poles, out = pathlib.Path(sys.argv[1]), read_poles(sys.argv[2]), sys.argv[3]
    shift = float(sys.argv[4]) if len(sys.argv) > 4 else 0.0
    random = np.random.default_rng(1)
    poses = np.loadtxt(drive / "poses.txt").reshape(-1, 3, 4)
    files = sorted((drive / "velodyne").glob("*.bin"))
    if len(files) != len(poses):
        sys.exit(f"plane_adjustment.py: {len(files)} scans, but {len(poses)} poses in {drive}")
    scans = [Scan(path, poles.get(k), random, "".join(sys.argv[5:])) for k, path in enumerate(files)]
    rotations, places = poses[:, :, :3].copy(), poses[:, :, 3].copy()
    if shift > 0:
        places[1:] += random.normal(0, shift, places[1:].shape)
        turns = random.normal(0, np.radians(shift), places[1:].shape)
        rotations[1:] = Rotation.from_rotvec(turns).as_matrix() @ rotations[1:]
    rotations, places = adjust(scans, rotations, places)
    adjusted = np.concatenate([rotations, places[:, :, None]], 2).reshape(len(scans), 12)
    np.savetxt(out, adjusted, fmt="%.6f")


if __name__ == "__main__":
    main()
