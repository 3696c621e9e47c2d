#!/usr/bin/python3
"""Maps that end on the way, and what localization does there.

Usage: leaving_map.py cut TRUTH.tum METRES MAP.csv OUT.csv
       leaving_map.py score TRUTH.tum METRES RUN_FOLDER >OUT.json
cut: keeps the poles of the map that are nearest to the path in its first METRES, its third, and so on.
score: of the health and the errors of the runs of pole-localize in that folder. Each time that the vehicle left the map
counts once. "jumps": more than 20 m off beyond the map; "ok_wrong": `ok` and more than 0.5 m off, there or after it;
"lost_after_min_m": the shortest way beyond the map after which it was `lost`.
"""
import csv
import json
import pathlib
import sys

import numpy as np
from scipy.spatial import cKDTree


def path(file):
    poses = np.loadtxt(file)
    return poses[:, 1:3], np.concatenate(([0], np.cumsum(np.hypot(*np.diff(poses[:, 1:3], axis=0).T))))


def cut(truth, metres, source, target):
    places, along = path(truth)
    tree = cKDTree(places)
    with open(source) as read, open(target, "w") as write:
        write.write(read.readline())
        for line in read:
            x, y = (float(value) for value in line.split(",")[:2])
            if int(along[tree.query((x, y))[1]] / metres) % 2 == 0:
                write.write(line)


def column(file, name):
    with open(file) as lines:
        return [row[name] for row in csv.DictReader(lines)]


def score(truth, metres, folder):
    along = path(truth)[1]
    result = {"left": 0, "jumps": 0, "ok_wrong": 0, "ok_wrong_max_m": 0, "off_max_m": 0, "ok_again_max_m": 0,
              "never_ok_again": 0, "lost": 0, "lost_after_min_m": metres}
    for health in sorted(pathlib.Path(folder).glob("run_*_health.csv")):
        ok = np.array([state == "ok" for state in column(health, "state")])
        lost = np.array([state == "lost" for state in column(health, "state")])
        error = np.full(len(ok), np.nan)
        errors = str(health).replace("_health", "_errors")
        error[[int(scan) for scan in column(errors, "scan")]] = [float(e) for e in column(errors, "position_m")]
        part = (along[:len(ok)] / metres).astype(int)
        for number in range(1, part[-1], 2):
            off = np.flatnonzero(part == number)
            back = np.flatnonzero(part == number + 1)
            both = np.concatenate((off, back))
            wrong = ok[both] & (error[both] > 0.5)
            found = back[ok[back] & (error[back] <= 0.5)]
            result["left"] += 1
            result["jumps"] += bool(np.any(error[off] > 20))
            result["lost"] += bool(np.any(lost[off]))
            way = along[off[lost[off]]] - along[off[0]]
            result["lost_after_min_m"] = min(result["lost_after_min_m"], float(np.min(way, initial=metres)))
            result["ok_wrong"] += bool(np.any(wrong))
            result["ok_wrong_max_m"] = max(result["ok_wrong_max_m"], float(np.max(error[both][wrong], initial=0)))
            result["off_max_m"] = max(result["off_max_m"], float(np.nanmax(error[off])))
            if len(found):
                result["ok_again_max_m"] = max(result["ok_again_max_m"], float(along[found[0]] - along[back[0]]))
            else:
                result["never_ok_again"] += 1
    print(json.dumps(result))


if __name__ == "__main__":
    if len(sys.argv) == 6 and sys.argv[1] == "cut":
        cut(sys.argv[2], float(sys.argv[3]), *sys.argv[4:])
    elif len(sys.argv) == 5 and sys.argv[1] == "score":
        score(sys.argv[2], float(sys.argv[3]), sys.argv[4])
    else:
        sys.exit(__doc__)
