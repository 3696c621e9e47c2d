"""A short simulated drive with what the programs make of it; shared by the tests of a process."""

import atexit
import functools
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np
import polemcl

CONFIG = "demo.ini"
SEED = 5
START = (0.9, 1.5, 127.0, 2.5, 5.0)  # x, y (m), yaw (deg), radius (m), heading (deg)


def program(name, *arguments):
    """Runs one of the programs of the build."""
    command = [os.path.join(os.environ["POLEMCL_BIN_DIR"], "pole-" + name), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.stderr}")
    return done.stdout


def lets_others_run(work):
    """Whether another thread can run Python while work() is under way.

    Python takes its lock away from no thread meanwhile, so that only work() itself can release it.
    """
    inside, seen = [False], [False]

    def repeat():
        for _ in range(500):
            inside[0] = True
            work()
            inside[0] = False
            if seen[0]:
                return

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    thread = threading.Thread(target=repeat)
    try:
        thread.start()
        while thread.is_alive() and not seen[0]:
            seen[0] = inside[0]
            time.sleep(0)
        thread.join()
    finally:
        sys.setswitchinterval(interval)
    return seen[0]


def no_poles():
    """No detection, all fields float64: NumPy has nothing to convert, which would release the lock."""
    return np.zeros(0, [(name, np.float64) for name in polemcl.detection_type.names])


@functools.lru_cache(maxsize=None)
def temporary_folder():
    folder = tempfile.TemporaryDirectory(prefix="polemcl-python-")
    atexit.register(folder.cleanup)
    return pathlib.Path(folder.name)


def simulated(name, *options):
    """What pole-simulate writes: 25 scans of an HDL-32E on 26 m."""
    folder = temporary_folder() / name
    program("simulate", "--quiet", "--config", CONFIG, "--set", "simulation.spacing_m=1",
            "--length", 26, "--output", folder, *options)
    return folder


@functools.lru_cache(maxsize=None)
def scans_folder():
    return simulated("scans")


@functools.lru_cache(maxsize=None)
def rawlog():
    file = temporary_folder() / "scans.rawlog"
    program("import", "folder", "--quiet", "--input", scans_folder(), "--output", file)
    return file


@functools.lru_cache(maxsize=None)
def truth():
    """The true poses: time, x, y, z, qx, qy, qz, qw."""
    return np.loadtxt(rawlog().with_suffix(".tum"))


def true_poses():
    """x, y, yaw of the robot."""
    x, y, z, w = truth()[:, 4:].T
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return np.column_stack([truth()[:, 1:3], yaw])


@functools.lru_cache(maxsize=None)
def points():
    """The points of each scan, (n, 4)."""
    files = sorted((scans_folder() / "velodyne").glob("*.bin"))
    return [np.fromfile(file, np.float32).reshape(-1, 4) for file in files]


@functools.lru_cache(maxsize=None)
def motions():
    """Motions and their covariances; those of the first scan are None."""
    rows = np.loadtxt(scans_folder() / "odometry.txt")
    rows[:, 2] = np.fmod(rows[:, 2] + np.pi, 2 * np.pi) - np.pi  # MRPT rounds headings like this
    return [(None, None)] + [(row[:3], np.diag(row[3:] ** 2)) for row in rows]


@functools.lru_cache(maxsize=None)
def pole_table():
    """The CSV of pole-extract."""
    file = temporary_folder() / "poles.csv"
    program("extract", "--quiet", "--config", CONFIG, "--input", rawlog(), "--csv", file,
            "--output", temporary_folder() / "poles.rawlog")
    return file


@functools.lru_cache(maxsize=None)
def map_file():
    """The map of pole-map build."""
    file = temporary_folder() / "street.polemap"
    program("map", "build", "--quiet", "--config", CONFIG, "--input", rawlog(),
            "--truth", rawlog().with_suffix(".tum"), "--output", file)
    return file


@functools.lru_cache(maxsize=None)
def localized():
    """The folder that pole-localize writes."""
    folder = temporary_folder() / "out"
    program("localize", "--quiet", "--config", CONFIG, "--input", rawlog(), "--map", map_file(),
            "--truth", rawlog().with_suffix(".tum"), "--output", folder, "--seed", SEED,
            "--start", ",".join(map(str, START)))
    return folder
