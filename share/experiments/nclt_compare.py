#!/usr/bin/python3
"""Compares poles, poses and localized drives of the NCLT session; prints JSON.

Usage: nclt_compare.py runs FOLDER                  errors of the runs of pole-localize, by halves of the drive
       nclt_compare.py poses PATH.tum OTHER.tum     other poses of the same drive against those of PATH
       nclt_compare.py poles MAP.csv OTHERS.csv PATH.tum [FRAME.tum]
OTHER.tum is first moved by the best rigid motion. MAP.csv: poles within 20 m of PATH; FRAME.tum are the poses of the
drive in the frame of the map, which moves it there. "aligned": after the best rigid motion of the poles on the others.
"windows": the same for each 100 m of PATH alone.
"""
import glob
import json
import sys

import numpy as np

WINDOW_M, SIDE_M, NEAR_M = 100, 20, 0.5


def rounded(value):
    return np.round(value, 3).tolist()


def positions(file):
    rows = np.loadtxt(file)
    return rows[:, 0], rows[:, 1:3]


def at_times(times, file):
    """Positions of the file at the nearest of its times."""
    stamps, found = positions(file)
    return found[np.abs(stamps[:, None] - times).argmin(axis=0)]


def rigid(a, b):
    """The rotation and shift that move the points a onto b."""
    cross = (a - a.mean(0)).T @ (b - b.mean(0))
    angle = np.arctan2(cross[0, 1] - cross[1, 0], np.trace(cross))
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return turn, b.mean(0) - a.mean(0) @ turn


def nearest(a, b):
    distances = np.hypot(*np.moveaxis(a[:, None] - b, 2, 0))
    return distances.min(axis=1), distances.argmin(axis=1)


def windows(path):
    way = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    begins = np.arange(0, way[-1] - WINDOW_M / 2, WINDOW_M)
    return [(int(begin), (way >= begin) & (way < begin + WINDOW_M)) for begin in begins]


def onto(poles, others):
    """The rigid motion of the poles onto the others by iterated nearest neighbours."""
    turn, shift = np.eye(2), np.zeros(2)
    for gate in (3, 2, 1.5, 1, 1, 1, 0.7, 0.7, 0.7):
        distance, index = nearest(poles @ turn + shift, others)
        if (distance < gate).sum() < 4:
            return None
        turn, shift = rigid(poles[distance < gate], others[index[distance < gate]])
    return turn, shift


def agreement(poles, others, centre):
    before = nearest(poles, others)[0]
    result = {"poles": len(poles), "near": int((before < NEAR_M).sum())}
    motion = onto(poles, others)
    if motion:
        turn, shift = motion
        after = nearest(poles @ turn + shift, others)[0]
        result |= {"near_aligned": int((after < NEAR_M).sum()), "median_aligned_m": rounded(np.median(after[after < 1])),
                   "shift_m": rounded(centre @ turn + shift - centre),
                   "turn_deg": rounded(np.degrees(np.arctan2(turn[0, 1], turn[0, 0])))}
    return result


def compare_poles(map_file, others_file, path_file, frame_file=None):
    poles, others = (np.loadtxt(file, delimiter=",", skiprows=1, usecols=(0, 1)) for file in (map_file, others_file))
    times, path = positions(path_file)
    if frame_file:
        turn, shift = rigid(at_times(times, frame_file), path)
        poles = poles @ turn + shift
    poles = poles[nearest(poles, path)[0] < SIDE_M]
    result = agreement(poles, others, path.mean(0))
    result["windows"] = [
        {"from_m": begin} | agreement(poles[nearest(poles, path[part])[0] < SIDE_M], others, path[part].mean(0))
        for begin, part in windows(path)]
    return result


def compare_poses(path_file, other_file):
    times, path = positions(path_file)
    other = at_times(times, other_file)
    turn, shift = rigid(other, path)
    errors = other @ turn + shift - path
    own = []
    for _, part in windows(path):
        t, s = rigid(other[part], path[part])
        own.append(np.sqrt(((other[part] @ t + s - path[part]) ** 2).sum(axis=1).mean()))
    distance = np.hypot(*errors.T)
    return {"mean_m": rounded(distance.mean()), "rms_m": rounded(np.sqrt((distance**2).mean())),
            "worst_m": rounded(distance.max()),
            "offset_by_window_m": [rounded(errors[part].mean(0)) for _, part in windows(path)],
            "rms_in_windows_m": rounded(np.mean(own))}


def run_errors(folder):
    """Scans without a pose, while the map is searched, have no error."""
    rows = [np.loadtxt(file, delimiter=",", skiprows=1, usecols=(0, 2, 5))
            for file in sorted(glob.glob(folder + "/run_*_errors.csv"))]
    states = [np.loadtxt(file, delimiter=",", skiprows=1, usecols=2, dtype=str)
              for file in sorted(glob.glob(folder + "/run_*_health.csv"))]
    scans = len(states[0])
    result = {"runs": len(rows), "scans": scans}
    for name, first, last in (("first_half", 0, scans // 2), ("second_half", scans // 2, scans)):
        parts = [run[(run[:, 0] >= first) & (run[:, 0] < last)] for run in rows]
        means = [part[:, 1].mean() for part in parts]
        ok = np.concatenate([state[part[:, 0].astype(int)] == "ok" for state, part in zip(states, parts)])
        position, heading = np.abs(np.concatenate(parts)[:, 1:]).T
        result[name] = {"mean_m": rounded(np.mean(means)),
                        "least_m": rounded(min(means)), "greatest_m": rounded(max(means)),
                        "rmse_m": rounded(np.mean([np.sqrt((part[:, 1] ** 2).mean()) for part in parts])),
                        "heading_deg": rounded(heading.mean()), "worst_m": rounded(position.max()),
                        "without_pose": last - first - min(map(len, parts)),
                        "ok": rounded(ok.mean()), "worst_ok_m": rounded(position[ok].max(initial=0))}
    return result


kinds = {"runs": (run_errors, 1, 1), "poses": (compare_poses, 2, 2), "poles": (compare_poles, 3, 4)}
function, least, most = kinds.get(sys.argv[1] if len(sys.argv) > 1 else "", (None, 0, 0))
if function is None or not least <= len(sys.argv) - 2 <= most:
    sys.exit(__doc__)
print(json.dumps(function(*sys.argv[2:])))
