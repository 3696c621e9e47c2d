#!/usr/bin/python3
"""Scan matching on the real kilometre: odd scans registered by GICP to a point cloud of the even ones.

Usage: scan_matching.py KILOMETRE LASER_ODOMETRY OUT.json
  KILOMETRE       folder of real-drives.sh --kilometre: velodyne/, poses.txt, times.txt
  LASER_ODOMETRY  laser_odometry.txt beside its README: 12 numbers a line
Needs the Python module of small_gicp (github.com/koide3/small_gicp, measured with aea1313; cmake
-DBUILD_PYTHON_BINDINGS=ON) on PYTHONPATH, and python3-scipy. All points are corrected for the motion in a turn: those
of the map by the true poses, those of the scans by the odometry, as polemcl corrects its poles. Each scan starts from
the estimate before it, moved by the odometry; the first one from its true pose. Scans are thinned to one point in each
cube of 0.25 m; so is the map, or more. Settings are the library's defaults, with pairs up to 1 m.
NEES (3 where covariances are right): of x, y and heading, with the inverse of the library's Hessian, and 0.01 m and
0.03 degrees of the truth added, as for polemcl.
"""
import json
import pathlib
import sys
import time

import numpy as np
import small_gicp
from scipy.spatial.transform import Rotation

TURN = 0.1037  # s
SCAN_VOXEL = 0.25  # m
MAP_VOXELS = (0.25, 0.5, 1.0)  # m
TRUTH_SIGMA = np.array([0.01, 0.01, np.radians(0.03)])


def matrices(path):
    poses = np.tile(np.eye(4), (sum(1 for _ in open(path)), 1, 1))
    poses[:, :3] = np.loadtxt(path).reshape(-1, 3, 4)
    return poses


def corrected(points, motion, seconds):
    """Points as seen at the time stamp; the LiDAR turns clockwise and faces forward then."""
    turned, moved = Rotation.from_matrix(motion[:3, :3]).as_rotvec() / seconds, motion[:3, 3] / seconds
    offset = -np.arctan2(points[:, 1], points[:, 0])[:, None] / (2 * np.pi) * TURN
    return points + np.cross(turned * offset, points) + moved * offset


def planar_error(estimate, truth):
    """x, y and heading of the estimate in the frame of the true pose."""
    off = np.linalg.inv(truth) @ estimate
    return np.array([off[0, 3], off[1, 3], np.arctan2(off[1, 0], off[0, 0])])


class Drive:
    def __init__(self, folder, odometry):
        folder = pathlib.Path(folder)
        self.files = sorted((folder / "velodyne").glob("*.bin"))
        self.truth, self.times = matrices(folder / "poses.txt"), np.loadtxt(folder / "times.txt")
        self.odometry = matrices(odometry)

    def points(self, k, poses, before, after):
        """Corrected by the motion between two scans."""
        points = np.fromfile(self.files[k], np.float32).reshape(-1, 4)[:, :3].astype(float)
        motion = np.linalg.inv(poses[before]) @ poses[after]
        return corrected(points, motion, self.times[after] - self.times[before])

    def map(self, voxel):
        cloud = []
        for k in range(0, len(self.files), 2):
            points = self.points(k, self.truth, max(0, k - 2), min(len(self.files) - 2, k + 2))
            small = small_gicp.voxelgrid_sampling(points, voxel).points()[:, :3]
            cloud.append(small @ self.truth[k, :3, :3].T + self.truth[k, :3, 3])
        return small_gicp.preprocess_points(np.concatenate(cloud), downsampling_resolution=voxel)


def localize(drive, target, tree):
    estimate, errors, nees, seconds = drive.truth[1], [], [], []
    for k in range(1, len(drive.files), 2):
        started = time.process_time()
        before = max(1, k - 2)
        if k > 1:
            estimate = estimate @ np.linalg.inv(drive.odometry[before]) @ drive.odometry[k]
        points = drive.points(k, drive.odometry, before, k if k > 1 else k + 2)
        source, _ = small_gicp.preprocess_points(points, downsampling_resolution=SCAN_VOXEL)
        result = small_gicp.align(target, source, tree, init_T_target_source=estimate, max_correspondence_distance=1.0)
        estimate = result.T_target_source
        seconds.append(time.process_time() - started)
        errors.append(planar_error(estimate, drive.truth[k]))
        covariance = np.linalg.inv(result.H)[np.ix_([3, 4, 2], [3, 4, 2])] + np.diag(TRUTH_SIGMA**2)
        nees.append(errors[-1] @ np.linalg.solve(covariance, errors[-1]))
    return np.array(errors), np.array(nees), np.array(seconds)


def main(kilometre, odometry, out):
    drive = Drive(kilometre, odometry)
    results = []
    for voxel in MAP_VOXELS:
        target, tree = drive.map(voxel)
        errors, nees, seconds = localize(drive, target, tree)
        away = np.hypot(errors[:, 0], errors[:, 1])
        results.append({
            "map_voxel_m": voxel, "map_points": target.size(), "map_bytes": 12 * target.size(), "scans": len(away),
            "pos_mean": round(away.mean(), 5), "ang_mean_deg": round(np.degrees(np.abs(errors[:, 2])).mean(), 5),
            "pos_max": round(away.max(), 5), "nees_mean": round(nees.mean(), 3),
            "cpu_seconds_per_scan": round(float(np.median(seconds)), 4),
        })
        print(results[-1], flush=True)
    pathlib.Path(out).write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
