#!/usr/bin/python3
"""Puts scans together to one cloud and shows it as a virtual LiDAR would see it from each pose of the drive.

Usage: virtual_scans.py FOLDER OUT [--compensated] [--last N] [--level] [--height M] [--cloud FILE.pcd...]
  FOLDER         velodyne/*.bin (x y z intensity, float32; turned clockwise, cut at the back), times.txt, poses.txt
  OUT            gets the same with virtual scans, and settings.ini, which describes their sensor
  --compensated  the scans are corrected for motion already
  --last N       each pose sees only the scans from N - 1 before it to its own
  --level        the virtual LiDAR stands upright: of each pose, x, y, z and yaw count
  --height M     virtual LiDAR above ground, for settings.ini
  --cloud        show this map instead, in the frame of poses.txt; FOLDER needs no scans

Points of all scans are corrected for motion, moved by the poses and thinned to one in each cube of 5 cm. A virtual scan
keeps the nearest point in each of 64 rows and 1024 columns, so what stands behind a wall stays hidden. Poles are then
extracted by the usual method.
"""
import argparse
import ctypes
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


def read_pcd(file: str) -> np.ndarray:
    """x, y and z of a PCD file of float32 fields."""
    data = pathlib.Path(file).read_bytes()
    begin = data.index(b"\n", data.index(b"\nDATA ") + 1) + 1
    head = {words[0]: words[1:] for words in map(str.split, data[:begin].decode().splitlines()) if words}
    if set(head["SIZE"]) != {"4"} or set(head["TYPE"]) != {"F"} or set(head["COUNT"]) != {"1"}:
        sys.exit(f"{file}: fields that are not single float32 numbers; write it with such fields only")
    fields, points, body = len(head["FIELDS"]), int(head["POINTS"][0]), data[begin:]
    if head["DATA"] == ["binary_compressed"]:
        packed, size = np.frombuffer(body[:8], np.uint32).tolist()
        plain = ctypes.create_string_buffer(size)
        if ctypes.CDLL("liblzf.so.1").lzf_decompress(body[8 : 8 + packed], packed, plain, size) != size:
            sys.exit(f"{file}: its compressed points cannot be read")
        values = np.frombuffer(plain.raw, np.float32).reshape(fields, points).T
    elif head["DATA"] == ["binary"]:
        values = np.frombuffer(body, np.float32, fields * points).reshape(points, fields)
    else:
        values = np.array(body.split(), np.float32).reshape(points, fields)
    values = values[:, [head["FIELDS"].index(axis) for axis in "xyz"]]
    return values[np.isfinite(values).all(axis=1)]


def levelled(pose: np.ndarray) -> np.ndarray:
    """The pose without roll and pitch."""
    yaw = np.arctan2(pose[1, 0], pose[0, 0])
    result = pose.copy()
    result[:3, :3] = [[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]]
    return result


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


def placed(scans: list, poses: np.ndarray, times: np.ndarray, compensated: bool) -> list:
    """The points of each scan in the frame of the poses."""
    parts = []
    for i, scan in enumerate(scans):
        points = np.fromfile(scan, np.float32).reshape(-1, 4)[:, :3]
        distance = np.linalg.norm(points, axis=1)
        points = points[(distance > NEAR_M) & (distance < FAR_M)]
        if not compensated:
            points = corrected(points, turn_motion(poses, times, i))
        parts.append((points @ poses[i, :3, :3].T + poses[i, :3, 3]).astype(np.float32))
    return parts


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


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--compensated", action="store_true")
    parser.add_argument("--last", type=int)
    parser.add_argument("--level", action="store_true")
    parser.add_argument("--height", type=float)
    parser.add_argument("--cloud", nargs="+")
    return parser.parse_args()


def main() -> None:
    options = arguments()
    folder, out, last = options.folder, options.out, options.last
    (out / "velodyne").mkdir(parents=True, exist_ok=True)
    rows = np.loadtxt(folder / "poses.txt").reshape(-1, 3, 4)
    poses = np.concatenate([rows, np.tile([[[0, 0, 0, 1.0]]], (len(rows), 1, 1))], axis=1)
    if options.cloud:
        parts = [read_pcd(file) for file in options.cloud]
        last = None
    else:
        scans = sorted((folder / "velodyne").glob("*.bin"))
        parts = placed(scans, poses, np.loadtxt(folder / "times.txt"), options.compensated)
    cloud = None if last else thinned(np.concatenate(parts))
    for i, pose in enumerate(poses):
        seen = thinned(np.concatenate(parts[max(0, i + 1 - last) : i + 1])) if last else cloud
        view(seen, levelled(pose) if options.level else pose).tofile(out / "velodyne" / f"{i:06d}.bin")
    for name in ("times.txt", "poses.txt"):
        shutil.copy(folder / name, out / name)
    (out / "settings.ini").write_text(SETTINGS + (f"height_m = {options.height:g}\n" if options.height else ""))


if __name__ == "__main__":
    main()
