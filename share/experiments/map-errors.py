#!/usr/bin/python3
"""Causes of the errors of a map, for map-errors.sh, which calls it.

Usage: map-errors.py LABELS JUDGED OUT
  LABELS  folder with truth_20m.csv and truth_40m.csv
  JUDGED  what stands at the labels that were missed (label, text, kind)
  OUT     has map.csv, poles.csv, scans.tum and candidates-C.csv; gets missed.csv, false.csv, ceiling.csv

Columns of missed.csv: number of the label, what stands there (kind, as judged from pictures; empty where it was not),
distance to the path, detections within 1 m and their greatest confidence, those of 0.65 or more and their sum, and
the cause:
  no detection  none within 1 m, at any confidence
  confidence    fewer than two reach 0.65, the map's least: rejected by what one scan shows
  map           two or more do, but no pole of the map came of them
Columns of false.csv: poles of the map without a label within 1 m, one to one.
"""
import collections
import csv
import pathlib
import sys

import numpy as np

from label_matching import MATCH, distance, matching, places, table

USED = 0.65  # [map] min_confidence of kitti.ini


def detections(out):
    """Places in the map and confidences."""
    rows = table(out / "poles.csv")
    path = np.loadtxt(out / "scans.tum")
    yaw = 2 * np.arctan2(path[:, 6], path[:, 7])
    scan = np.array([int(row["scan"]) for row in rows])
    own, turn = places(out / "poles.csv"), yaw[scan]
    turned = np.stack([own[:, 0] * np.cos(turn) - own[:, 1] * np.sin(turn),
                       own[:, 0] * np.sin(turn) + own[:, 1] * np.cos(turn)], axis=1)
    return path[scan, 1:3] + turned, np.array([float(row["confidence"]) for row in rows]), path[:, 1:3]


def cause(near, used):
    if not len(near):
        return "no detection"
    return "map" if len(used) > 1 else "confidence"


def write(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def missed_labels(labels, found, judged, seen):
    where, confidence, path = seen
    rows = []
    for k, label in enumerate(labels):
        if k in found:
            continue
        near = confidence[distance(where, label) <= MATCH]
        used = near[near >= USED]
        rows.append({"label": k, "kind": judged.get(k, ""), "path_m": f"{distance(path, label).min():.1f}",
                     "detections": len(near), "most": f"{near.max():.2f}" if len(near) else "", "used": len(used),
                     "sum_used": f"{used.sum():.1f}", "cause": cause(near, used)})
    return rows


def false_poles(out, labels, path):
    rows, poles = table(out / "map.csv"), places(out / "map.csv")
    right = matching(poles, labels)
    return [{"x": f"{pole[0]:.1f}", "y": f"{pole[1]:.1f}", "count": rows[k]["count"],
             "confidence": f"{float(rows[k]['confidence']):.2f}", "path_m": f"{distance(path, pole).min():.1f}",
             "label_m": f"{distance(labels, pole).min():.1f}"}
            for k, pole in enumerate(poles) if k not in right]


def ceiling(out, labels):
    rows = []
    for file in sorted(out.glob("candidates-*.csv")):
        candidates = places(file)
        reached = len(matching(labels, candidates))
        rows.append({"least_confidence": file.stem.split("-")[1], "candidates": len(candidates), "labels": reached,
                     "recall": f"{reached / len(labels):.3f}",
                     "f1_if_precision_is_1": f"{2 * reached / (len(labels) + reached):.3f}"})
    return rows


def main():
    folder, judged_file, out = map(pathlib.Path, sys.argv[1:4])
    near, far = places(folder / "truth_20m.csv"), places(folder / "truth_40m.csv")
    judged = {int(row["label"]): row["kind"] for row in table(judged_file)}
    seen = detections(out)
    missed = missed_labels(near, matching(near, places(out / "map.csv")), judged, seen)
    write(out / "missed.csv", missed)
    write(out / "false.csv", false_poles(out, far, seen[2]))
    write(out / "ceiling.csv", ceiling(out, near))
    for name, number in sorted(collections.Counter(row["cause"] for row in missed).items()):
        print(f"{name}: {number} of {len(missed)} missed labels")


if __name__ == "__main__":
    main()
