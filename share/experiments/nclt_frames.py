#!/usr/bin/python3
"""Lays out the key frames of the NCLT session 2013-01-10 and their map from a git repository.

Usage: nclt_frames.py GIT_DIR TRUTH.csv OUT
  GIT_DIR    some commit has data/ch9/: keyframes.txt, clouds 0.pcd, 1.pcd, ... and tiles map_data/*.pcd
  TRUTH.csv  rows of NCLT's truth: time in us or s, north, east, down, roll, pitch, yaw; other lines are left out
  OUT        gets frames/ (plain folder, poses of the LiDAR odometry), path/ (poses of the map), tiles/,
             truth.tum (of the robot; x east, y north), odometry.tum, rtk.tum, map.tum (of the sensor)

The clouds are in the frame of the sensor, which is turned by 90.703 degrees on the robot (NCLT's calibration).
"""
import pathlib
import subprocess
import sys

import numpy as np

from virtual_scans import read_pcd

# Columns of keyframes.txt: poses of the LiDAR odometry, of the satellites, and adjusted with loops and satellites.
TIME, ODOMETRY, SATELLITES, ADJUSTED = 1, 5, 12, 26


def git(folder: str, *words: str) -> bytes:
    return subprocess.run(["git", "--git-dir=" + folder, *words], check=True, stdout=subprocess.PIPE).stdout


def extract(folder: str, to: pathlib.Path) -> None:
    """Writes the files of data/ch9 of the newest commit with key frames; a copy can lack large ones."""
    for commit in git(folder, "rev-list", "--all").decode().split():
        tree = git(folder, "ls-tree", "-r", commit, "data/ch9").decode().splitlines()
        if any(line.endswith("data/ch9/0.pcd") for line in tree):
            break
    else:
        sys.exit(f"{folder}: no commit has data/ch9/0.pcd")
    for line in tree:
        name = line.split("\t")[1][len("data/ch9/") :]
        if name == "keyframes.txt" or name.endswith(".pcd"):
            found = subprocess.run(["git", "--git-dir=" + folder, "cat-file", "blob", line.split()[2]],
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            file = to / (name if "/" not in name else "tiles/" + name.split("/")[-1])
            if found.returncode == 0:
                file.write_bytes(found.stdout)
            else:
                print(f"nclt_frames.py: {name} is missing in {folder}", file=sys.stderr)


def matrices(rows: np.ndarray) -> np.ndarray:
    """Rows of the 3x4 matrices of poses x y z qx qy qz qw."""
    x, y, z, w = (rows[:, 3:] / np.linalg.norm(rows[:, 3:], axis=1)[:, None]).T
    turns = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), rows[:, 0]],
             [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), rows[:, 1]],
             [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), rows[:, 2]]]
    return np.moveaxis(np.array(turns), 2, 0).reshape(-1, 12)


def write_tum(file: pathlib.Path, times: np.ndarray, poses: np.ndarray) -> None:
    np.savetxt(file, np.column_stack([times, poses]), fmt="%.6f" + " %.9f" * 7)


def write_truth(table: str, file: pathlib.Path) -> None:
    rows = np.genfromtxt(table, delimiter=",")
    time, north, east, down, _, _, yaw = rows[np.isfinite(rows).all(axis=1)].T
    time = np.where(time > 1e12, time / 1e6, time)
    heading, none = np.pi / 2 - yaw, 0 * time
    write_tum(file, time, np.stack([east, north, -down, none, none, np.sin(heading / 2), np.cos(heading / 2)], axis=1))


def main() -> None:
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[3])
    for name in ("tiles", "path", "frames/velodyne"):
        (out / name).mkdir(parents=True, exist_ok=True)
    extract(sys.argv[1], out)
    frames = np.loadtxt(out / "keyframes.txt")
    for name, tum, column in (("frames", "odometry.tum", ODOMETRY), ("path", "map.tum", ADJUSTED)):
        poses = frames[:, column : column + 7]
        np.savetxt(out / name / "poses.txt", matrices(poses), fmt="%.9g")
        np.savetxt(out / name / "times.txt", frames[:, TIME], fmt="%.6f")
        write_tum(out / tum, frames[:, TIME], poses)
    write_truth(sys.argv[2], out / "truth.tum")
    write_tum(out / "rtk.tum", frames[:, TIME], frames[:, SATELLITES : SATELLITES + 7])
    for number in frames[:, 0].astype(int):
        points = read_pcd(out / f"{number}.pcd")
        np.column_stack([points, 0 * points[:, 0]]).astype(np.float32).tofile(out / f"frames/velodyne/{number:06d}.bin")
        (out / f"{number}.pcd").unlink()


if __name__ == "__main__":
    main()
