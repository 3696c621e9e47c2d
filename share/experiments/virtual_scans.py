#!/usr/bin/python3
"""Puts scans together to one cloud and shows it as a virtual LiDAR would see it from each pose of the drive.

Usage: virtual_scans.py FOLDER OUT
  FOLDER  velodyne/*.bin (x y z intensity, float32; turned clockwise, cut at the back), times.txt, poses.txt
  OUT     gets the same with virtual scans, and settings.ini, which describes their sensor

Points of all scans are corrected for motion, moved by the poses and thinned to one in each cube of 5 cm. A virtual scan
keeps the nearest point in each of 64 rows and 1024 columns, so what stands behind a wall stays hidden. Poles are then
extracted by the usual method.
"""
import pathlib
import shutil
import sys

import numpy as np

ROWS, COLUMNS, UP_DEG, DOWN_DEG = 64, 1024, 15.0, -25.0
NEAR_M, FAR_M, CUBE_M, TURN_S = 2.5, 30.0, 0.05, 0.1037
SETTINGS = """[sensor]
model = uniform
rings = %d
fov_up_deg = %g
fov_down_deg = %g
columns = %d
max_range_m = %g
""" % (ROWS, UP_DEG, DOWN_DEG, COLUMNS, FAR_M)


def corrected(points: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Points as seen from the pose at which the sensor faces forward. `motion`: that of a whole turn."""
    share = -np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi)
    yaw = np.arctan2(motion[1, 0], motion[0, 0]) * share
    x, y, z = points.T
    turned = np.stack([np.cos(yaw) * x - np.sin(yaw) * y, np.sin(yaw) * x + np.cos(yaw) * y, z], axis=1)
    return turned + share[:, None] * motion[:3, 3]


def turn_motion(poses: np.ndarray, times: np.ndarray, i: int) -> np.ndarray:
    """Motion during the turn of scan i: a share of that between its neighbours."""
    before, after = max(i - 1, 0), min(i + 1, len(poses) - 1)
    motion = np.linalg.inv(poses[before]) @ poses[after]
    share = TURN_S / (times[after] - times[before])
    yaw = np.arctan2(motion[1, 0], motion[0, 0]) * share
    result = np.eye(4)
    result[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    result[:3, 3] = motion[:3, 3] * share
    return result


def thinned(cloud: np.ndarray) -> np.ndarray:
    """One point in each cube, sorted by x."""
    cell = np.floor(cloud / CUBE_M).astype(np.int64)
    cell -= cell.min(axis=0)
    sizes = cell.max(axis=0) + 1
    first = np.unique((cell[:, 0] * sizes[1] + cell[:, 1]) * sizes[2] + cell[:, 2], return_index=True)[1]
    return cloud[first[np.argsort(cloud[first, 0], kind="stable")]]


def accumulated(scans: list, poses: np.ndarray, times: np.ndarray) -> np.ndarray:
    """All scans as one cloud in the frame of the poses."""
    parts = []
    for i, scan in enumerate(scans):
        points = np.fromfile(scan, np.float32).reshape(-1, 4)[:, :3]
        distance = np.linalg.norm(points, axis=1)
        points = points[(distance > NEAR_M) & (distance < FAR_M)]
        points = corrected(points, turn_motion(poses, times, i))
        parts.append((points @ poses[i, :3, :3].T + poses[i, :3, 3]).astype(np.float32))
    return thinned(np.concatenate(parts))


def view(cloud: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """The nearest point of each row and column, at the exact azimuth and the elevation of its row."""
    low, high = np.searchsorted(cloud[:, 0], [pose[0, 3] - FAR_M, pose[0, 3] + FAR_M])
    points = cloud[low:high]
    points = points[np.abs(points[:, 1] - pose[1, 3]) < FAR_M]
    points = (points - pose[:3, 3].astype(np.float32)) @ pose[:3, :3].astype(np.float32)
    distance = np.hypot(points[:, 0], points[:, 1])
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    step = (UP_DEG - DOWN_DEG) / (ROWS - 1)
    row = np.rint((UP_DEG - np.degrees(np.arctan2(points[:, 2], distance))) / step).astype(int)
    column = ((azimuth + np.pi) / (2 * np.pi) * COLUMNS).astype(int) % COLUMNS
    seen = np.flatnonzero((row >= 0) & (row < ROWS) & (distance > 1) & (distance < FAR_M))
    order = seen[np.argsort(-distance[seen], kind="stable")]
    nearest = np.full(ROWS * COLUMNS, -1)
    nearest[row[order] * COLUMNS + column[order]] = order  # the last one written is the nearest
    kept = nearest[nearest >= 0]
    elevation = np.radians(UP_DEG - step * row[kept])
    r, a = distance[kept], azimuth[kept]
    return np.stack([r * np.cos(a), r * np.sin(a), r * np.tan(elevation), 0 * r], axis=1).astype(np.float32)


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder, out = map(pathlib.Path, sys.argv[1:])
    (out / "velodyne").mkdir(parents=True, exist_ok=True)
    rows = np.loadtxt(folder / "poses.txt").reshape(-1, 3, 4)
    poses = np.concatenate([rows, np.tile([[[0, 0, 0, 1.0]]], (len(rows), 1, 1))], axis=1)
    scans = sorted((folder / "velodyne").glob("*.bin"))
    cloud = accumulated(scans, poses, np.loadtxt(folder / "times.txt"))
    for scan, pose in zip(scans, poses):
        view(cloud, pose).tofile(out / "velodyne" / scan.name)
    for name in ("times.txt", "poses.txt"):
        shutil.copy(folder / name, out / name)
    (out / "settings.ini").write_text(SETTINGS)


if __name__ == "__main__":
    main()
