#!/usr/bin/env python3
"""Measures the points and detections round the labelled poles of kitti-00-missed.sh, which calls it.

Usage: kitti-00-missed.py DRIVE OUT
  DRIVE  folder with velodyne/*.bin and poses.txt
  OUT    has truth.csv, map.csv, weak.csv and poles.csv; gets near.csv, labels.csv and missed.txt

Points are those of all scans, in the frame of the map. Heights count from the local ground: the 2 %
quantile of z of the points within 2 m of the label. Only heights of 0.5 to 4 m are used.

Columns of labels.csv:
  label, published      number among the labels near the path, number in the published file, both from 0
  path_m                distance to the nearest scan
  found, other_label_m  one to one within 1 m; distance to the nearest other label near the path
  scans                 scans within 20 m
  points_03, points_1   points within 0.3 and 1 m of the label
  column_m, radius_m    distance from the label to its column, and the column's radius, 0.2 or 0.4 m: the upright
                        cylinder, its axis within 1 m, that has the most clear heights (steps of 0.05 m; of
                        equals the thin one, then the one with the most points, then the nearest)
  filled                heights of 0.1 m, of 35, at which the column has a point
  clear                 those at which it has 4 times as many points as the ring round it has, 0.3 m wide
  bottom_m, top_m       of the clear heights
  beside                points in the ring for each one in the column
  width_1, _2, _3       width of what is there at 0.5 to 1.5 m, 1.5 to 2.5 m, 2.5 to 4 m: longer principal
                        axis, 5 % to 95 %, of the points within 0.5 m of the column's axis; empty below
                        10 points
  detections, conf_least, conf_median, conf_most
                        detections within 1 m, down to confidence 0
  used                  of these, those with a confidence of 0.3 or more, the least of the map in 1.0.0
  weak_m, weak_seen     nearest pole of the map without thresholds, if within 1 m, and its sightings
"""

import csv
import math
import pathlib
import sys

import numpy as np

from label_matching import MATCH, distance, matching, places, table

REACH, NEAR = 1.0, 20.0
LOW, HIGH, STEP = 0.5, 4.0, 0.1
RADII, RING, BAND = (0.2, 0.4), 0.3, 0.5
USED = 0.3


def points_near(drive, poses, labels):
    """For each label its points (x, y from the label, z) within 2.5 m."""
    parts = [[] for _ in labels]
    scans = sorted((drive / "velodyne").glob("*.bin"))
    if len(scans) != len(poses):
        sys.exit(f"kitti-00-missed.py: {len(scans)} scans, but {len(poses)} poses")
    for scan, pose in zip(scans, poses):
        cloud = np.fromfile(scan, "<f4").reshape(-1, 4)[:, :3].astype(float) @ pose[:, :3].T + pose[:, 3]
        for k, label in enumerate(labels):
            inside = cloud[(np.abs(cloud[:, 0] - label[0]) < 2.5) & (np.abs(cloud[:, 1] - label[1]) < 2.5)]
            parts[k].append(inside - [label[0], label[1], 0])
    return [np.concatenate(part) for part in parts]


def width(points):
    if len(points) < 10:
        return ""
    centred = points[:, :2] - points[:, :2].mean(axis=0)
    axis = np.linalg.eigh(centred.T @ centred)[1][:, 1]
    low, high = np.percentile(centred @ axis, [5, 95])
    return f"{high - low:.2f}"


def column(points):
    """The column with the most clear heights, of the points with heights of LOW to HIGH."""
    points = points[np.hypot(points[:, 0], points[:, 1]) <= REACH + max(RADII) + RING]
    cell = ((points[:, 2] - LOW) / STEP).astype(int)
    cells = round((HIGH - LOW) / STEP)
    grid = [(0.05 * i, 0.05 * j) for i in range(-20, 21) for j in range(-20, 21) if i * i + j * j <= 400]
    best = None
    for x, y in grid:
        away = np.hypot(points[:, 0] - x, points[:, 1] - y)
        for radius in RADII:
            core = np.bincount(cell[away <= radius], minlength=cells)[:cells]
            ring = np.bincount(cell[(away > radius) & (away <= radius + RING)], minlength=cells)[:cells]
            clear = (core > 0) & (core >= 4 * ring)
            key = (clear.sum(), -radius, core.sum(), -round(math.hypot(x, y), 6), x, y)
            if core.sum() and (best is None or key > best[0]):
                best = (key, x, y, radius, core, ring, clear)
    return best


def shape(cloud):
    result = dict.fromkeys(
        ["points_03", "points_1", "column_m", "radius_m", "filled", "clear", "bottom_m", "top_m", "beside",
         "width_1", "width_2", "width_3"], "")
    away = np.hypot(cloud[:, 0], cloud[:, 1])
    ground = np.percentile(cloud[away <= 2, 2], 2)
    points = cloud - [0, 0, ground]
    points = points[(points[:, 2] >= LOW) & (points[:, 2] < HIGH)]
    away = np.hypot(points[:, 0], points[:, 1])
    result["points_03"], result["points_1"] = int((away <= 0.3).sum()), int((away <= REACH).sum())
    best = column(points)
    if best is None:
        return result
    _, x, y, radius, core, ring, clear = best
    result["column_m"] = f"{math.hypot(x, y):.2f}"
    result["radius_m"] = f"{radius:.1f}"
    result["filled"], result["clear"] = int((core > 0).sum()), int(clear.sum())
    if clear.any():
        heights = LOW + STEP * np.flatnonzero(clear)
        result["bottom_m"], result["top_m"] = f"{heights[0]:.1f}", f"{heights[-1] + STEP:.1f}"
    result["beside"] = f"{ring.sum() / core.sum():.2f}"
    round_axis = points[np.hypot(points[:, 0] - x, points[:, 1] - y) <= BAND]
    for name, low, high in (("width_1", 0.5, 1.5), ("width_2", 1.5, 2.5), ("width_3", 2.5, 4.0)):
        result[name] = width(round_axis[(round_axis[:, 2] >= low) & (round_axis[:, 2] < high)])
    return result


def main():
    drive, out = map(pathlib.Path, sys.argv[1:3])
    poses = np.loadtxt(drive / "poses.txt").reshape(-1, 3, 4)
    path = poses[:, :2, 3]
    all_labels = places(out / "truth.csv")
    numbers = [k for k, label in enumerate(all_labels) if distance(path, label).min() <= NEAR]
    labels = all_labels[numbers]
    with open(out / "near.csv", "w") as file:
        file.write("x,y\n" + "".join(f"{x:.6f},{y:.6f}\n" for x, y in labels))
    found = matching(labels, places(out / "map.csv"))
    weak_rows, weak = table(out / "weak.csv"), places(out / "weak.csv")

    rows = table(out / "poles.csv")
    own = np.array([[float(row["x"]), float(row["y"])] for row in rows])
    confidence = np.array([float(row["confidence"]) for row in rows])
    scan = np.array([int(row["scan"]) for row in rows])
    yaw = np.arctan2(poses[scan, 1, 0], poses[scan, 0, 0])
    detections = path[scan] + np.stack([own[:, 0] * np.cos(yaw) - own[:, 1] * np.sin(yaw),
                                        own[:, 0] * np.sin(yaw) + own[:, 1] * np.cos(yaw)], axis=1)

    results = []
    for k, cloud in enumerate(points_near(drive, poses, labels)):
        others = distance(np.delete(labels, k, axis=0), labels[k])
        to_path, to_weak = distance(path, labels[k]), distance(weak, labels[k])
        row = {"label": k, "published": numbers[k], "path_m": f"{to_path.min():.1f}",
               "found": "yes" if k in found else "no", "other_label_m": f"{others.min():.2f}",
               "scans": int((to_path <= NEAR).sum())}
        row.update(shape(cloud))
        near = np.sort(confidence[distance(detections, labels[k]) <= REACH])
        least, median, most = (near[0], np.median(near), near[-1]) if len(near) else (None, None, None)
        row["detections"] = len(near)
        for name, value in (("least", least), ("median", median), ("most", most)):
            row["conf_" + name] = "" if value is None else f"{value:.2f}"
        row["used"] = int((near >= USED).sum())
        reached = to_weak.min() <= REACH
        row["weak_m"] = f"{to_weak.min():.2f}" if reached else ""
        row["weak_seen"] = weak_rows[int(to_weak.argmin())]["count"] if reached else ""
        results.append(row)

    with open(out / "labels.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, results[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(results)
    shown = [name for name in results[0] if name not in ("published", "found")]
    missed = [row for row in results if row["found"] == "no"]
    widths = {name: max(len(name), *(len(str(row[name]) or "-") for row in missed)) for name in shown}
    with open(out / "missed.txt", "w") as file:
        for row in [{name: name for name in shown}] + missed:
            file.write("  ".join((str(row[name]) or "-").rjust(widths[name]) for name in shown) + "\n")
        file.write(f"{len(found)} of {len(labels)} labelled poles found, {len(missed)} missed\n")


if __name__ == "__main__":
    main()
